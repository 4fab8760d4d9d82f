//! Whether a pooler stands between this process and PostgreSQL, which gives every transaction another connection: what
//! is said there to a session, such as LISTEN, stays behind in a connection of others.
use sqlx::{ConnectOptions, Executor, PgConnection, Row, postgres::PgConnectOptions};
use std::time::Duration;

/// How often it is looked: a pooler may give the same connection by chance.
const ROUNDS: usize = 4;

/// A pool of one connection has none for a second client.
const PATIENCE: Duration = Duration::from_secs(2);

/// Whether two transactions of one client reach two connections, or two clients share one.
///
/// # Errors
/// When the database can't be reached.
pub(crate) async fn is_pooled(options: &PgConnectOptions) -> Result<bool, sqlx::Error> {
    let (mut one, mut two) = (options.connect().await?, options.connect().await?);
    for _ in 0..ROUNDS {
        let first = process(&mut one).await?;
        // One that takes turns gives another connection next.
        if process(&mut one).await? != first {
            return Ok(true);
        }
        // Keeps the connection that it gets.
        two.execute(sqlx::raw_sql("BEGIN")).await?;
        let second = process(&mut two).await?;
        let again = if second == first {
            None
        } else {
            tokio::time::timeout(PATIENCE, process(&mut one)).await.ok().transpose()?
        };
        two.execute(sqlx::raw_sql("ROLLBACK")).await?;
        if again != Some(first) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The number of the database's process that answers. One simple query, which is a transaction of its own.
async fn process(connection: &mut PgConnection) -> Result<i32, sqlx::Error> {
    connection.fetch_one(sqlx::raw_sql("SELECT pg_backend_pid() AS pid")).await?.try_get("pid")
}
