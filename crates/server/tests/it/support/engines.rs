//! Fresh databases of each engine.
use super::cluster;
use fosssim_server::db::{self, Address, Database};
use std::future::Future;

/// A separate database, which is removed at the end.
pub(crate) struct Fresh {
    pub(crate) database: Database,
    pub(crate) address: Address,
    _folder: Option<tempfile::TempDir>,
    pub(crate) pooler: Option<cluster::Pooler>,
    _cluster: Option<cluster::Shared>,
}

impl Fresh {
    /// Creates a SQLite file in a separate folder, without tables.
    pub(crate) async fn sqlite() -> Option<Self> {
        let folder = tempfile::tempdir().expect("a folder");
        let address = Address::Sqlite(folder.path().join("fosssim.db"));
        let database = Database::open(&address).await.expect("a database");
        Some(Self { database, address, _folder: Some(folder), pooler: None, _cluster: None })
    }

    /// Creates a SQLite file in the given folder, without tables.
    pub(crate) async fn sqlite_in(folder: &std::path::Path) -> Self {
        let address = Address::Sqlite(folder.join("fosssim.db"));
        let database = Database::open(&address).await.expect("a database");
        Self { database, address, _folder: None, pooler: None, _cluster: None }
    }

    /// Creates a database in the tests' PostgreSQL server, without tables; `None` if PostgreSQL is not installed.
    pub(crate) async fn postgres() -> Option<Self> {
        let cluster = cluster::Shared::join()?;
        let address = cluster.new_database();
        let database = Database::open(&address).await.expect("a database");
        Some(Self { database, address, _folder: None, pooler: None, _cluster: Some(cluster) })
    }

    /// Creates such a database behind PgBouncer; `None` if one of them is not installed.
    pub(crate) async fn pooled() -> Option<Self> {
        let cluster = cluster::Shared::join()?;
        let pooler = cluster::Pooler::start(&cluster)?;
        let address = pooler.address(&cluster.new_database());
        let database = Database::open(&address).await.expect("a database");
        Some(Self { database, address, _folder: None, pooler: Some(pooler), _cluster: Some(cluster) })
    }

    /// Returns the database with all tables.
    pub(crate) async fn with_tables(self) -> Self {
        db::migrate(&self.database).await.expect("tables");
        self
    }
}

/// Runs a test's future to its end.
pub(crate) fn run<T>(future: impl Future<Output = T>) -> T {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .expect("a runtime")
        .block_on(future)
}

/// Declares a test for each engine from each `async fn name(fresh: Fresh)`.
macro_rules! on_both_engines {
    ($($name:ident),* $(,)?) => {
        $crate::support::engines::tests! { sqlite, $($name)* }
        $crate::support::engines::tests! { postgres, $($name)* }
    };
}
pub(crate) use on_both_engines;

/// Declares a test of behavior that does not depend on the engine. Every handler's statements run on PostgreSQL in
/// `web::roles`.
macro_rules! on_sqlite {
    ($($name:ident),* $(,)?) => {
        $crate::support::engines::tests! { sqlite, $($name)* }
    };
}
pub(crate) use on_sqlite;

/// Declares a test for each engine, and another one behind a pooler.
macro_rules! on_all_engines {
    ($($name:ident),* $(,)?) => {
        $crate::support::engines::on_both_engines! { $($name),* }
        $crate::support::engines::tests! { pooled, $($name)* }
    };
}
pub(crate) use on_all_engines;

macro_rules! tests {
    ($engine:ident, $($name:ident)*) => {
        mod $engine {
            $(#[test]
            fn $name() {
                $crate::support::engines::run(async {
                    let Some(fresh) = $crate::support::engines::Fresh::$engine().await else { return };
                    super::$name(fresh.with_tables().await).await;
                });
            })*
        }
    };
}
pub(crate) use tests;
