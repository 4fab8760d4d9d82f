//! Statements that are written once for both engines. The parts that differ are in braces.
use super::Dialect;

/// Returns the parts of a script that belong to an engine. Lines between `-- only sqlite` or `-- only postgres` and `--
/// end` belong to one engine only.
pub(super) fn join_parts(script: &str, dialect: Dialect) -> String {
    let other = match dialect {
        Dialect::Sqlite => "-- only postgres",
        Dialect::Postgres => "-- only sqlite",
    };
    let mut skips = false;
    let mut lines = String::with_capacity(script.len());
    for line in script.lines() {
        skips = line == other || (skips && line != "-- end");
        if !skips {
            lines.push_str(line);
            lines.push('\n');
        }
    }
    lines
}

/// Renders the statement for an engine. `{now}` is the engine's clock, and `{int}`, `{id}`, `{strict}` and `{queue}`
/// are words of table definitions. `{for update}`, `{for removal}` and `{skip locked}` lock the selected rows. `{each}`
/// lists the rows of a JSON array, which is passed as a value and read as `wanted.value`. `{strpos}` finds the position
/// of one string in another, and `{quoted}` converts a string to JSON. For PostgreSQL, placeholders are numbered.
/// Statements contain no other braces or question marks: values are never part of a statement's text.
pub(super) fn render_statement(statement: &str, dialect: Dialect) -> String {
    let substitutes: [(&str, &str); 11] = match dialect {
        Dialect::Sqlite => [
            ("{now}", "CAST(unixepoch('now', 'subsec') * 1000 AS INTEGER)"),
            ("{int}", "INTEGER"),
            ("{id}", "INTEGER PRIMARY KEY AUTOINCREMENT"),
            ("{strict}", "STRICT"),
            ("{queue}", "STRICT"),
            // SQLite has one writer, so no other connection can lock a row.
            ("{skip locked}", ""),
            ("{for update}", ""),
            ("{each}", "json_each(?) AS wanted"),
            ("{strpos}", "instr"),
            ("{for removal}", ""),
            ("{quoted}", "json_quote"),
        ],
        Dialect::Postgres => [
            // now() is not used, because it is constant within a transaction, and a lease begins when it is given.
            ("{now}", "CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)"),
            ("{int}", "BIGINT"),
            ("{id}", "BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY"),
            ("{strict}", ""),
            // Each row of the queue changes five times, so pages keep free space for new versions of rows, and dead
            // rows are removed early.
            ("{queue}", "WITH (fillfactor = 70, autovacuum_vacuum_scale_factor = 0.02)"),
            // NO KEY allows other transactions to write rows that refer to this row. Otherwise two transactions could
            // wait for each other: one holds a referring row and needs this one, and the other holds this row and needs
            // the referring one.
            ("{skip locked}", "FOR NO KEY UPDATE SKIP LOCKED"),
            ("{for update}", "FOR NO KEY UPDATE"),
            ("{each}", "json_array_elements_text(CAST(? AS json)) AS wanted (value)"),
            ("{strpos}", "strpos"),
            // With FOR UPDATE, other transactions cannot write rows that refer to this one either.
            ("{for removal}", "FOR UPDATE"),
            ("{quoted}", "to_json"),
        ],
    };
    let mut text = statement.to_owned();
    for (placeholder, meaning) in substitutes {
        text = text.replace(placeholder, meaning);
    }
    if dialect == Dialect::Sqlite {
        return text;
    }
    let number = |(count, part): (usize, &str)| if count > 0 { format!("${count}{part}") } else { part.to_owned() };
    text.split('?').enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_engine_gets_its_own_words() {
        let statement = "SELECT id FROM job WHERE a = ? AND b < {now} AND c = ? {skip locked}";
        assert_eq!(
            render_statement(statement, Dialect::Postgres),
            "SELECT id FROM job WHERE a = $1 AND b < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT) \
             AND c = $2 FOR NO KEY UPDATE SKIP LOCKED"
        );
        assert_eq!(
            render_statement(statement, Dialect::Sqlite),
            "SELECT id FROM job WHERE a = ? AND b < CAST(unixepoch('now', 'subsec') * 1000 AS INTEGER) AND c = ? "
        );
    }
}
