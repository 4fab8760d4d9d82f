//! Prints the catalog of mistakes as a table or as JSON.
use std::io::{self, Write};

use crate::student::{Area, Row, RowKind, all_rows};
use serde::Serialize;

#[derive(Serialize)]
struct Listing {
    schema: &'static str,
    mistakes: Vec<Entry>,
}

/// A mistake as the listing shows it.
#[derive(Serialize)]
struct Entry {
    id: &'static str,
    kind: &'static str,
    area: Area,
    explanation: &'static str,
    term: &'static str,
}

impl From<&Row> for Entry {
    fn from(row: &Row) -> Self {
        Self { id: row.id, kind: row.kind.name(), area: row.area, explanation: row.summary, term: row.term }
    }
}

/// Prints the catalog to standard output.
pub fn print(json: bool) -> anyhow::Result<u8> {
    let text = if json {
        let listing = Listing { schema: "fosssim-sample/1", mistakes: all_rows().map(Entry::from).collect() };
        serde_json::to_string_pretty(&listing)? + "\n"
    } else {
        render_table()
    };
    match io::stdout().write_all(text.as_bytes()) {
        // It is not an error if the reader has closed the pipe.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(0),
        result => Ok(result.map(|()| 0)?),
    }
}

fn render_table() -> String {
    let mut text = String::new();
    for (kind, title) in [
        (RowKind::Wrong, "Mistakes: the result is wrong."),
        (RowKind::Variant, "Variants: the same mathematics with other arithmetic."),
    ] {
        let rows: Vec<&Row> = all_rows().filter(|row| row.kind == kind).collect();
        text += &format!("{title} ({})\n\n", rows.len());
        for row in rows {
            text += &format!("  {:36} {}\n", row.id, row.summary);
        }
        text.push('\n');
    }
    text
}
