//! The database's tables and their changes over time. Each change is a separate file, which is applied once and never
//! edited afterwards. All missing changes are applied in one transaction, so that a database is never between two
//! versions.
use super::{Database, DbError, Dialect};
use crate::{secret::to_hex, values};
use sha2::{Digest, Sha256};
use thiserror::Error;

/// All changes, the oldest first. The number of a change is its position in this list, from 1.
const MIGRATIONS: [(&str, &str); 30] = [
    ("first tables", include_str!("migrations/0001_first_tables.sql")),
    ("people", include_str!("migrations/0002_people.sql")),
    ("answers", include_str!("migrations/0003_answers.sql")),
    ("platforms", include_str!("migrations/0004_platforms.sql")),
    ("columns", include_str!("migrations/0005_columns.sql")),
    ("workers", include_str!("migrations/0006_workers.sql")),
    ("suite versions", include_str!("migrations/0007_suite_versions.sql")),
    ("people of their own", include_str!("migrations/0008_people_of_their_own.sql")),
    ("kept bytes", include_str!("migrations/0009_kept_bytes.sql")),
    ("published", include_str!("migrations/0010_published.sql")),
    ("removal", include_str!("migrations/0011_removal.sql")),
    ("marks", include_str!("migrations/0012_marks.sql")),
    ("health", include_str!("migrations/0013_health.sql")),
    ("shared answers", include_str!("migrations/0014_shared_answers.sql")),
    ("taken back", include_str!("migrations/0015_taken_back.sql")),
    ("progress", include_str!("migrations/0016_progress.sql")),
    ("failed scenes", include_str!("migrations/0017_failed_scenes.sql")),
    ("asked for", include_str!("migrations/0018_asked_for.sql")),
    ("suites of courses", include_str!("migrations/0019_suites_of_courses.sql")),
    ("server secret", include_str!("migrations/0020_server_secret.sql")),
    ("no suspicions", include_str!("migrations/0021_no_suspicions.sql")),
    ("no quarantine", include_str!("migrations/0022_no_quarantine.sql")),
    ("regrades at once", include_str!("migrations/0023_regrades_at_once.sql")),
    ("no invitations", include_str!("migrations/0024_no_invitations.sql")),
    ("no sums", include_str!("migrations/0025_no_sums.sql")),
    ("no pauses", include_str!("migrations/0026_no_pauses.sql")),
    ("equal programs", include_str!("migrations/0027_equal_programs.sql")),
    ("parts of grades", include_str!("migrations/0028_parts_of_grades.sql")),
    ("no passwords", include_str!("migrations/0029_no_passwords.sql")),
    ("groups of suites", include_str!("migrations/0030_groups_of_suites.sql")),
];

/// The version of the tables that this program uses.
pub const NEWEST: i64 = MIGRATIONS.len() as i64;

/// PostgreSQL's number for the lock that prevents two servers from migrating in parallel. The number is arbitrary.
const LOCK_NUMBER: i64 = 0x6673_6f5f_6d69_6772;

/// The reason why the tables can't be updated.
#[derive(Debug, Error)]
pub enum MigrateError {
    /// A newer program has changed the tables.
    #[error(
        "the database has version {found}, but this program knows versions up to {NEWEST}: start the newer program, or \
        restore the backup that it made"
    )]
    Newer {
        /// The version of the database's tables.
        found: i64,
    },
    /// An applied change differs from the one in this program.
    #[error("change {number} ({name}) was applied with a different text: this program was built from changed sources")]
    Changed {
        /// The number of the change, from 1.
        number: i64,
        /// The name of the change.
        name: &'static str,
    },
    /// A statement failed, or the database does not answer.
    #[error(transparent)]
    Database(#[from] DbError),
}

/// Returns the version of the tables; 0 for an empty database.
///
/// # Errors
/// Fails if the database does not answer.
pub async fn read_version(database: &Database) -> Result<i64, DbError> {
    let mut transaction = database.read().await?;
    let table_count = match transaction.dialect() {
        Dialect::Sqlite => "SELECT count(*) AS n FROM sqlite_master WHERE name = 'schema_change'",
        Dialect::Postgres => {
            "SELECT count(*) AS n FROM pg_tables WHERE schemaname = current_schema() AND tablename = 'schema_change'"
        }
    };
    if transaction.one(table_count, values![]).await?.int("n")? == 0 {
        return Ok(0);
    }
    transaction.one("SELECT coalesce(max(number), 0) AS n FROM schema_change", values![]).await?.int("n")
}

/// Applies the missing changes and returns their number. Several servers may call this at the same time.
///
/// # Errors
///
/// Fails if a newer program has used the database, or the database fails. After an error nothing has changed.
pub async fn migrate(database: &Database) -> Result<usize, MigrateError> {
    let mut transaction = database.begin().await?;
    if transaction.dialect() == Dialect::Postgres {
        // The lock is held until the transaction ends.
        transaction.rows("SELECT CAST(pg_advisory_xact_lock(?) AS TEXT) AS held", values![LOCK_NUMBER]).await?;
    }
    transaction
        .script(
            "CREATE TABLE IF NOT EXISTS schema_change (
                number {int} PRIMARY KEY, name TEXT NOT NULL, digest TEXT NOT NULL, applied_at {int} NOT NULL
            ) {strict}",
        )
        .await?;
    let applied = transaction.rows("SELECT number, digest FROM schema_change ORDER BY number", values![]).await?;
    let found = applied.last().map_or(Ok(0), |row| row.int("number"))?;
    if found > NEWEST {
        return Err(MigrateError::Newer { found });
    }
    let mut count = 0;
    for (number, (name, script)) in (1..).zip(MIGRATIONS) {
        let digest = to_hex(&Sha256::digest(script));
        if let Some(row) = applied.iter().find(|row| row.int("number").is_ok_and(|applied| applied == number)) {
            if row.text("digest")? != digest {
                return Err(MigrateError::Changed { number, name });
            }
            continue;
        }
        transaction.script(script).await?;
        let statement = "INSERT INTO schema_change (number, name, digest, applied_at) VALUES (?, ?, ?, {now})";
        transaction.execute(statement, values![number, name, digest]).await?;
        count += 1;
    }
    transaction.commit().await?;
    Ok(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A database to which one of these changes was applied rejects a program in which the change's text differs, even
    /// in a comment.
    #[test]
    fn changes_that_databases_have_stay_as_they_are() {
        let known = MIGRATIONS[..29].iter().fold(Sha256::new(), |known, (_, script)| known.chain_update(script));
        let digest = to_hex(&known.finalize());
        assert_eq!(digest, "c299705b0d6cbf6af7edd79ce5f0c2168df8d4ca4dbd4e4a7d0e038b47ab2e09");
    }
}
