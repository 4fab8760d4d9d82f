//! The arguments of the server's commands. The doc comments are the help texts.
use crate::db::Address;
use axum_client_ip::ClientIpSource;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::{net::SocketAddr, num::NonZeroUsize, path::PathBuf};

/// The service of fosssim-oracle: receives submissions, grades them and keeps the grades.
#[derive(Debug, Parser)]
#[command(name = "fosssim-server", version, max_term_width = 100)]
pub(super) struct Arguments {
    /// The form in which the log is printed.
    #[arg(long, value_enum, default_value_t = LogFormat::Text, env = "FOSSSIM_LOG_FORMAT", global = true)]
    pub(super) log_format: LogFormat,
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum LogFormat {
    /// Print readable lines of text.
    Text,
    /// Print one JSON object per line.
    Json,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    Serve(ServiceArguments),
    Worker(WorkerArguments),
    AdminLink(AdminLinkArguments),
    WorkerToken(WorkerTokenArguments),
    Backup(BackupArguments),
    Restore(RestoreArguments),
    Health(HealthArguments),
    LookThrough(ArchiveCheckArguments),
    /// Prints the description of the API (OpenAPI).
    Openapi,
    /// Prints the manual page of the program, or of a command.
    Man {
        command: Option<String>,
    },
    /// Prints a script that completes commands and options in a shell.
    Completions {
        shell: clap_complete::Shell,
    },
}

/// The locations of the database and the files.
#[derive(Debug, Args)]
pub(super) struct StorageArguments {
    /// The folder of the database, the artifacts and the jobs' working folders.
    #[arg(long, value_name = "DIR", default_value = "fosssim-data", env = "FOSSSIM_DATA")]
    pub(super) data: PathBuf,
    /// The database: sqlite:FILE or postgres://USER:PASSWORD@HOST/NAME. The default is a SQLite file in the data
    /// folder.
    #[arg(long, value_name = "ADDRESS", env = "FOSSSIM_DATABASE", hide_env_values = true)]
    pub(super) database: Option<Address>,
    /// A bucket for artifacts instead of a folder in the data folder: s3://BUCKET/PREFIX. The usual variables such as
    /// AWS_ACCESS_KEY_ID give access.
    #[arg(long, value_name = "s3://BUCKET/PREFIX", env = "FOSSSIM_STORE")]
    pub(super) store: Option<String>,
}

/// The settings of the server's own workers.
#[derive(Debug, Args)]
pub(super) struct WorkloadArguments {
    /// The number of scenes that run in parallel in one grading.
    #[arg(long, value_name = "N", default_value = "1")]
    pub(super) threads: NonZeroUsize,
    /// The grader; by default the program fosssim-oracle in this program's folder.
    #[arg(long, value_name = "PROGRAM")]
    pub(super) grader: Option<PathBuf>,
    /// The number of seconds without a report from a worker after which its jobs are given to other workers.
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub(super) lease: u64,
    /// The number of failures after which a job is given up.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub(super) tries: u32,
}

/// Runs the server: it receives submissions, shows grades, and grades with its own workers.
#[derive(Debug, Args)]
pub(super) struct ServiceArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    /// The address on which the server listens. By default only this machine can reach it. For other machines, put a
    /// proxy with HTTPS in front.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8080", env = "FOSSSIM_LISTEN")]
    pub(super) listen: SocketAddr,
    /// The public URL of the server, such as https://grades.example.org. With https, cookies are sent only over
    /// HTTPS.
    #[arg(long, value_name = "URL", env = "FOSSSIM_PUBLIC_URL", value_parser = parse_public_url)]
    pub(super) public_url: Option<String>,
    /// The number of parallel gradings in this process; with 0, only other workers grade. The default is one per core.
    #[arg(long, value_name = "N", env = "FOSSSIM_WORKERS")]
    pub(super) workers: Option<usize>,
    /// The number of requests that an account may send per minute.
    #[arg(long, value_name = "N", default_value = "600", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) requests_per_minute: u32,
    /// The number of seconds without data after which a request is aborted.
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub(super) patience: u64,
    /// The number of parallel uploads and downloads of an account.
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) transfers: u32,
    /// The header in which the proxy states a client's address, such as XRealIp or RightmostXForwardedFor. Without it,
    /// limits by address apply to the proxy.
    #[arg(long, value_name = "HEADER", env = "FOSSSIM_CLIENT_ADDRESS")]
    pub(super) client_address: Option<ClientIpSource>,
    /// The limit in MiB for the uploads and reports of a person, in all courses; 0 for no limit.
    #[arg(long, value_name = "MIB", default_value_t = 4096)]
    pub(super) keep_of_person: u64,
    /// The limit in MiB for the uploads and reports of a course; 0 for no limit.
    #[arg(long, value_name = "MIB", default_value_t = 1024 * 1024)]
    pub(super) keep_of_course: u64,
    /// The limit in MiB for all uploads and reports; 0 for no limit.
    #[arg(long, value_name = "MIB", default_value_t = 0)]
    pub(super) keep_in_all: u64,
    /// The minimum free space on the data folder's disk, in MiB. Below it, uploads are rejected, so that accepted
    /// uploads can still be graded.
    #[arg(long, value_name = "MIB", default_value_t = 512)]
    pub(super) low_water: u64,
    #[command(flatten)]
    pub(super) provider: ProviderArguments,
    /// The number of days for which uploads and reports are kept; 0 for no limit. Grades and their history are always
    /// kept.
    #[arg(long, value_name = "DAYS", default_value_t = 0, env = "FOSSSIM_KEEP_DAYS")]
    pub(super) keep_days: u32,
    /// Allows learning platforms without HTTPS, for tests on one machine.
    #[arg(long)]
    pub(super) lti_over_http: bool,
    /// On a new server, creates a course with an assignment and a student, and writes a program with a mistake to
    /// submit.
    #[arg(long)]
    pub(super) example: bool,
    #[command(flatten)]
    pub(super) work: WorkloadArguments,
}

/// The OpenID Connect provider of an organization.
#[derive(Debug, Args)]
pub(super) struct ProviderArguments {
    /// The issuer of an OpenID Connect provider at which people sign in, such as https://login.example.org. Its client
    /// secret is in --oidc-secret-file, or in the variable FOSSSIM_OIDC_SECRET.
    #[arg(long, value_name = "URL", env = "FOSSSIM_OIDC_ISSUER", requires = "oidc_client")]
    pub(super) oidc_issuer: Option<String>,
    /// This server's client ID at the provider.
    #[arg(long, value_name = "ID", env = "FOSSSIM_OIDC_CLIENT", requires = "oidc_issuer")]
    pub(super) oidc_client: Option<String>,
    /// The file with the client secret.
    #[arg(long, value_name = "FILE", env = "FOSSSIM_OIDC_SECRET_FILE", requires = "oidc_issuer")]
    pub(super) oidc_secret_file: Option<PathBuf>,
    /// The provider's name on the sign-in page. The default is the provider's host.
    #[arg(long, value_name = "NAME", env = "FOSSSIM_OIDC_LABEL", requires = "oidc_issuer")]
    pub(super) oidc_label: Option<String>,
    /// Only people with a confirmed mail address in this domain can sign in. An account that staff created belongs to
    /// the person whose mail address has the account's login before the @.
    #[arg(long, value_name = "DOMAIN", env = "FOSSSIM_OIDC_DOMAIN", requires = "oidc_issuer")]
    pub(super) oidc_domain: Option<String>,
}

/// Returns the scheme and host of a URL that an administrator typed.
fn parse_public_url(text: &str) -> Result<String, String> {
    let authority = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://"));
    let host = authority.map(|host| host.trim_end_matches('/')).unwrap_or_default();
    if host.is_empty() || host.contains(['/', '?', '#', '@', ' ']) {
        return Err("the URL must be https://HOST or http://HOST:PORT without a path".to_owned());
    }
    Ok(text.trim_end_matches('/').to_owned())
}

/// Prints a sign-in link for an administrator who has no other way to sign in. It works once.
#[derive(Debug, Args)]
pub(super) struct AdminLinkArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    /// The administrator's login.
    #[arg(default_value = "admin")]
    pub(super) login: String,
    /// The server's public URL. The default is the URL with which the server was last started.
    #[arg(long, value_name = "URL", env = "FOSSSIM_PUBLIC_URL", value_parser = parse_public_url)]
    pub(super) public_url: Option<String>,
}

/// Prints a new token for a worker, as the page "Administration" does.
#[derive(Debug, Args)]
pub(super) struct WorkerTokenArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    /// The name of the worker's machine.
    #[arg(default_value = "this-machine")]
    pub(super) name: String,
}

/// Copies the database and all uploads and reports into a new folder, while the server runs. PostgreSQL is copied by
/// pg_dump, which must be installed.
#[derive(Debug, Args)]
pub(super) struct BackupArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    /// The new folder for the backup.
    #[arg(value_name = "FOLDER")]
    pub(super) output: PathBuf,
}

/// Creates a data folder from a backup. The data folder must be empty, and so must a PostgreSQL database.
#[derive(Debug, Args)]
pub(super) struct RestoreArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    /// A folder that `backup` created.
    #[arg(value_name = "FOLDER")]
    pub(super) backup: PathBuf,
}

/// Checks whether a server or a worker is healthy, and reports the result by the exit code, for probes. A server is
/// given by its URL, and a worker by its data folder.
#[derive(Debug, Args)]
pub(super) struct HealthArguments {
    /// The server's URL.
    #[arg(long, value_name = "URL", value_parser = parse_public_url)]
    pub(super) server: Option<String>,
    /// The worker's data folder.
    #[arg(long, value_name = "DIR", default_value = "fosssim-data")]
    pub(super) data: PathBuf,
}

/// Checks an upload; the server runs this command for each archive.
#[derive(Debug, Args)]
#[command(hide = true)]
pub(super) struct ArchiveCheckArguments {
    #[arg(long)]
    pub(super) form: Option<String>,
    #[arg(long, default_value = "")]
    pub(super) wanted: String,
    #[arg(long)]
    pub(super) program: Option<String>,
    #[arg(long)]
    pub(super) into: Option<PathBuf>,
    pub(super) file: PathBuf,
}

/// Grades the submissions in the queue.
#[derive(Debug, Args)]
pub(super) struct WorkerArguments {
    #[command(flatten)]
    pub(super) storage: StorageArguments,
    #[command(flatten)]
    pub(super) work: WorkloadArguments,
    /// The number of parallel gradings. The default is one per core.
    #[arg(long, value_name = "N")]
    pub(super) slots: Option<NonZeroUsize>,
    /// The URL of a server on another machine for which this worker grades. The worker then needs no database.
    #[arg(long, value_name = "URL", conflicts_with = "database", value_parser = parse_public_url)]
    pub(super) server: Option<String>,
    /// The file with the worker's token, which an administrator creates on the page "Administration".
    #[arg(long, value_name = "FILE")]
    pub(super) token_file: Option<PathBuf>,
    /// The name of this worker; by default the host and the process ID.
    #[arg(long)]
    pub(super) name: Option<String>,
}
