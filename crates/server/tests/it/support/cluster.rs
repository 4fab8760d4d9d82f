//! Starts PostgreSQL for tests. It is from the system's packages, runs in a temporary folder, and is reached by a
//! socket in that folder.
//!
//! [`Cluster`] is a separate server, for tests that kill it. All test processes share the server [`Shared`]. The first
//! process starts it, and a shell script stops it when no test has used it for a while.
use fosssim_server::db::Address;
use fosssim_testing::{Need, skip};
use std::{
    fs::{self, File},
    os::unix::{
        fs::{PermissionsExt, chown},
        process::CommandExt,
    },
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
    time::{Duration, Instant},
};

/// PostgreSQL's programs, and the user that runs them, because the server does not run as root.
struct Programs {
    folder: PathBuf,
    user: Option<(u32, u32)>,
}

impl Programs {
    /// Finds the programs; `None` if PostgreSQL is not installed.
    fn find() -> Option<Self> {
        let mut folders: Vec<PathBuf> = fs::read_dir("/usr/lib/postgresql")
            .map(|versions| versions.flatten().map(|version| version.path().join("bin")).collect())
            .unwrap_or_default();
        folders.sort();
        let newest = folders.into_iter().rev().find(|folder| folder.join("initdb").exists());
        let Some(folder) = newest else {
            skip(Need::Postgres, "PostgreSQL is not installed (apt-get install postgresql)");
            return None;
        };
        // SAFETY: geteuid has no preconditions.
        let user = (unsafe { libc::geteuid() } == 0).then(|| {
            let id = |flag: &str| -> u32 {
                let output = Command::new("id").args([flag, "postgres"]).output().expect("id");
                String::from_utf8_lossy(&output.stdout)
                    .trim()
                    .parse()
                    .expect("the user postgres of PostgreSQL's package")
            };
            (id("-u"), id("-g"))
        });
        Some(Self { folder, user })
    }

    fn as_its_user(&self, mut command: Command) -> Command {
        if let Some((user, group)) = self.user {
            command.uid(user).gid(group);
        }
        command
    }

    fn command(&self, name: &str) -> Command {
        let mut command = self.as_its_user(Command::new(self.folder.join(name)));
        command.stdin(Stdio::null()).current_dir("/");
        command
    }

    fn own(&self, folder: &Path) {
        fs::create_dir_all(folder).expect("a folder");
        fs::set_permissions(folder, fs::Permissions::from_mode(0o755)).expect("permissions");
        if let Some((user, group)) = self.user {
            chown(folder, Some(user), Some(group)).expect("an owner");
        }
    }

    fn init(&self, data: &Path) {
        let output = self
            .command("initdb")
            .args(["--auth=trust", "--username=fosssim", "--encoding=UTF8", "--locale=C", "--no-sync", "-D"])
            .arg(data)
            .output()
            .expect("initdb");
        assert!(output.status.success(), "initdb: {}", String::from_utf8_lossy(&output.stderr));
    }

    fn server(&self, folder: &Path, fsync: bool) -> Command {
        let mut command = self.command("postgres");
        let log = File::options().create(true).append(true).open(folder.join("log")).expect("a log");
        command.arg("-D").arg(folder.join("data")).arg("-k").arg(folder);
        for setting in [
            "listen_addresses=",
            "max_connections=200",
            "shared_buffers=16MB",
            if fsync { "fsync=on" } else { "fsync=off" },
        ] {
            command.args(["-c", setting]);
        }
        command.stdout(Stdio::null()).stderr(log);
        command
    }

    fn is_ready(&self, folder: &Path) -> bool {
        let status = self.command("pg_isready").arg("-q").arg("-h").arg(folder).status();
        status.expect("pg_isready").success()
    }

    fn wait_until_ready(&self, folder: &Path) {
        let start = Instant::now();
        while !self.is_ready(folder) {
            let log = || fs::read_to_string(folder.join("log")).unwrap_or_default();
            assert!(start.elapsed() < Duration::from_secs(120), "PostgreSQL does not start: {}", log());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn create_database(&self, folder: &Path) -> Address {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("test_{}_{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let output = self
            .command("psql")
            .arg("-h")
            .arg(folder)
            .args(["-U", "fosssim", "-d", "postgres", "-qc", &format!("DROP DATABASE IF EXISTS {name} WITH (FORCE)")])
            .args(["-c", &format!("CREATE DATABASE {name}")])
            .output()
            .expect("psql");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let folder = folder.to_str().expect("a plain path").replace('/', "%2F");
        Address::Postgres(format!("postgres://fosssim@{folder}/{name}"))
    }
}

/// A separate server.
pub(crate) struct Cluster {
    programs: Programs,
    folder: tempfile::TempDir,
    server: Option<std::process::Child>,
}

impl Cluster {
    /// Starts a new server that really writes to the disk; `None` if PostgreSQL is not installed.
    pub(crate) fn start() -> Option<Self> {
        let programs = Programs::find()?;
        let folder = tempfile::tempdir().expect("a folder");
        programs.own(folder.path());
        programs.init(&folder.path().join("data"));
        let mut cluster = Self { programs, folder, server: None };
        cluster.resume();
        Some(cluster)
    }

    /// Starts the server again.
    pub(crate) fn resume(&mut self) {
        // A killed server leaves its socket's lock behind. The new server notices that its owner has ended.
        self.server = Some(self.programs.server(self.folder.path(), true).spawn().expect("postgres"));
        self.programs.wait_until_ready(self.folder.path());
    }

    /// Kills the server and all its processes together, like a power cut that does not affect the disk.
    pub(crate) fn kill(&mut self) {
        let Some(mut server) = self.server.take() else { return };
        let children = fs::read_to_string(format!("/proc/{0}/task/{0}/children", server.id())).unwrap_or_default();
        server.kill().expect("kill");
        server.wait().expect("wait");
        for child in children.split_whitespace() {
            // SAFETY: a signal to a process that this test's own server started.
            unsafe { libc::kill(child.parse().expect("a number"), libc::SIGKILL) };
        }
    }

    pub(crate) fn new_database(&self) -> Address {
        self.programs.create_database(self.folder.path())
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        self.kill();
    }
}

/// The server that all test processes share. It runs at least as long as this value exists.
pub(crate) struct Shared {
    programs: Programs,
    folder: PathBuf,
    _user: File,
}

impl Shared {
    /// Returns the server of all test processes, and starts it if it is not running.
    #[expect(clippy::zombie_processes, reason = "server and watcher outlive the test that happens to start them")]
    pub(crate) fn join() -> Option<Self> {
        let programs = Programs::find()?;
        // SAFETY: geteuid has no preconditions.
        let folder = std::env::temp_dir().join(format!("fosssim-postgres-{}", unsafe { libc::geteuid() }));
        programs.own(&folder);
        let lock = |name: &str| {
            File::options().create(true).truncate(false).write(true).open(folder.join(name)).expect("a lock file")
        };
        let door = lock("door");
        door.lock().expect("the door");
        if is_running(&folder.join("data")) {
            // A busy machine answers slowly. Data that other tests use are never removed.
            programs.wait_until_ready(&folder);
        } else {
            drop(fs::remove_dir_all(folder.join("data")));
            programs.init(&folder.join("data"));
            programs.server(&folder, false).process_group(0).spawn().expect("postgres");
            programs.wait_until_ready(&folder);
            // The script stops the server when no test uses it: tests hold a shared lock on `users`. The next test
            // waits until the server has ended.
            let script = "cd \"$0\" && pid=$(head -n1 data/postmaster.pid) &&
                while sleep 15 && [ \"$(head -n1 data/postmaster.pid)\" = \"$pid\" ]; do
                    if flock door -c \"flock --nonblock users true &&
                        '$1' stop --silent --mode=fast --pgdata=data && rm -r data\"
                    then exit; fi
                done";
            programs
                .as_its_user(Command::new("sh"))
                .args(["-c", script])
                .arg(&folder)
                .arg(programs.folder.join("pg_ctl"))
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .process_group(0)
                .spawn()
                .expect("a watching shell");
        }
        let user = lock("users");
        user.lock_shared().expect("a share");
        Some(Self { programs, folder, _user: user })
    }

    /// Creates an empty database.
    pub(crate) fn new_database(&self) -> Address {
        self.programs.create_database(&self.folder)
    }
}

/// Returns whether the server whose process number is in this data folder is still running.
fn is_running(data: &Path) -> bool {
    let Ok(file) = fs::read_to_string(data.join("postmaster.pid")) else { return false };
    let number = file.lines().next().unwrap_or_default();
    // A process that has ended is still listed until its parent has queried it.
    let state = fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
    state.contains("(postgres)") && !state.contains("(postgres) Z")
}

/// PgBouncer in front of the tests' server, with the strictest settings for its clients: every transaction gets another
/// connection, prepared statements are not known, and no start-up setting is ignored.
pub(crate) struct Pooler {
    folder: tempfile::TempDir,
    command: Command,
    server: std::process::Child,
}

impl Pooler {
    /// Starts PgBouncer; `None` if it is not installed.
    pub(crate) fn start(cluster: &Shared) -> Option<Self> {
        let program = Path::new("/usr/sbin/pgbouncer");
        if !program.exists() {
            skip(Need::Pgbouncer, "PgBouncer is not installed (apt-get install pgbouncer)");
            return None;
        }
        let folder = tempfile::tempdir().expect("a folder");
        cluster.programs.own(folder.path());
        let place = folder.path().display();
        let settings = format!(
            "[databases]\n* = host={} user=fosssim\n[pgbouncer]\nlisten_addr =\nunix_socket_dir = {place}\n\
             logfile = {place}/log\nauth_type = any\npool_mode = transaction\ndefault_pool_size = 4\n\
             server_round_robin = 1\n",
            cluster.folder.display()
        );
        fs::write(folder.path().join("settings"), settings).expect("settings");
        let mut command = cluster.programs.as_its_user(Command::new(program));
        command.arg("--quiet").arg(folder.path().join("settings"));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let server = command.spawn().expect("pgbouncer");
        let pooler = Self { folder, command, server };
        pooler.wait_until_ready();
        Some(pooler)
    }

    fn socket(&self) -> PathBuf {
        self.folder.path().join(".s.PGSQL.6432")
    }

    fn wait_until_ready(&self) {
        let start = Instant::now();
        while !self.socket().exists() {
            let log = || fs::read_to_string(self.folder.path().join("log")).unwrap_or_default();
            assert!(start.elapsed() < Duration::from_secs(60), "PgBouncer does not start: {}", log());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Kills PgBouncer, and starts it again after a pause.
    pub(crate) fn kill_for(&mut self, pause: Duration) {
        self.server.kill().expect("kill");
        self.server.wait().expect("wait");
        fs::remove_file(self.socket()).expect("its socket");
        std::thread::sleep(pause);
        self.server = self.command.spawn().expect("pgbouncer");
        self.wait_until_ready();
    }

    /// Returns the address of the same database through the pooler.
    pub(crate) fn address(&self, direct: &Address) -> Address {
        let Address::Postgres(url) = direct else { panic!("no PostgreSQL: {direct}") };
        let name = url.rsplit('/').next().expect("a name");
        let folder = self.folder.path().to_str().expect("a plain path").replace('/', "%2F");
        Address::Postgres(format!("postgres://fosssim@{folder}:6432/{name}"))
    }
}

impl Drop for Pooler {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
    }
}
