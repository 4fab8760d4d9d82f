//! The command `serve`: the server, with its own workers.
use super::{
    arguments::{AdminLinkArguments, ProviderArguments, ServiceArguments, StorageArguments, WorkerTokenArguments},
    cancel_on_signal,
    folders::ServiceFolders,
    heartbeat,
    worker::{LocalWorkers, find_grader, queue_policy},
};
use crate::{
    db::{self, Address, Database},
    domain::{App, Options, Suites, TransferLimits},
    instruments::Instruments,
    ledger,
    lti::{self, Lti},
    net,
    oidc::Provider,
    queue::{Notifier, QueuePolicy},
    retention,
    store::Store,
    web,
};
use anyhow::{Context, Result, anyhow, bail};
use std::{
    io::Write as _,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, SystemTime, UNIX_EPOCH},
};

/// The number of seconds of a day.
const DAY_SECONDS: u64 = 24 * 3600;

/// The number of bytes of a mebibyte.
const MIB: u64 = 1 << 20;

/// The name of the file in the data folder that contains the server's public URL.
const ADDRESS_FILE: &str = "address";

/// The maximum time to wait for the grader's answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(20);

/// The time between two searches for expired data.
const CLEANUP_INTERVAL: Duration = Duration::from_secs(DAY_SECONDS / 4);

pub(super) async fn serve(arguments: &ServiceArguments) -> Result<()> {
    let stop = cancel_on_signal()?;
    // Listen before anything else, so that a server that can't listen changes nothing.
    let listener = tokio::net::TcpListener::bind(arguments.listen).await.with_context(|| {
        format!("cannot listen on {}; choose another address with --listen ADDRESS:PORT", arguments.listen)
    })?;
    let folders = ServiceFolders::open(&arguments.storage)?;
    let (database, address) = folders.open_database(&arguments.storage).await?;
    update_tables(&database, &folders, &address).await?;
    let store = folders.store(&arguments.storage)?;
    folders.clear()?;
    let notifier = Notifier::default();
    let local = format!("http://{}", listener.local_addr()?);
    let public = arguments.public_url.clone().unwrap_or_else(|| local.clone());
    std::fs::write(folders.data.join(ADDRESS_FILE), &public)?;
    let policy = queue_policy(&arguments.work);
    let max_pause = Duration::from_secs(arguments.patience);
    let provider = read_provider(&arguments.provider)?;
    let lti = Arc::new(Lti::new(arguments.lti_over_http));
    let options = Options {
        suites: read_suites(arguments.work.grader.as_deref()).await,
        grader: find_grader(arguments.work.grader.as_deref()).ok(),
        checker: read_checker(arguments.work.grader.as_deref()).await,
        incoming: folders.incoming.clone(),
        low_water: arguments.low_water * MIB,
        public: public.clone(),
        client_ip_source: arguments.client_address.clone(),
        max_pause,
        requests_per_minute: arguments.requests_per_minute,
        limits: TransferLimits::new(
            arguments.transfers as usize,
            arguments.keep_of_person * MIB,
            arguments.keep_of_course * MIB,
            arguments.keep_in_all * MIB,
        ),
        provider,
        lti: lti.clone(),
    };
    let app = App::new(database.clone(), store.clone(), notifier.clone(), policy, Instruments::new()?, options);
    let tick_database = database.clone();
    let tick = move || {
        let database = tick_database.clone();
        async move { ledger::tick(&database, &policy).await }
    };
    tokio::spawn(lti::send_scores(database.clone(), notifier.clone(), policy, lti, tick, stop.clone()));
    let keep_for = (arguments.keep_days > 0).then(|| Duration::from_secs(u64::from(arguments.keep_days) * DAY_SECONDS));
    tokio::spawn(clean_up(database.clone(), store.clone(), keep_for));
    let slots = match arguments.workers {
        Some(workers) => NonZeroUsize::new(workers),
        None => Some(std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)),
    };
    let grader = slots.map(|_| find_grader(arguments.work.grader.as_deref())).transpose()?;
    let working = grader.map(|grader| {
        let local =
            LocalWorkers { folders: folders.clone(), database: database.clone(), store, notifier, policy, grader };
        let stop = stop.clone();
        async move { local.work(&arguments.work, slots, None, stop).await }
    });
    let example = arguments.example.then_some(folders.flawed_program.as_path());
    print_greeting(&app, [&local, &public], example, arguments.work.grader.as_deref()).await?;
    heartbeat::notify_ready();
    let monitored = database.clone();
    tokio::spawn(heartbeat::send_heartbeats(folders.data.clone(), async move || monitored.is_healthy().await));
    let serving = net::serve(listener, web::router(app), stop.clone());
    match working {
        None => serving.await?,
        Some(working) => {
            let (served, worked) = tokio::join!(serving, working);
            worked.and(served.map_err(Into::into))?;
        }
    }
    database.close().await;
    tracing::info!("stopped");
    Ok(())
}

/// Returns the provider at which people sign in. The provider's secret is not a command-line option, because lists of
/// processes show options.
fn read_provider(arguments: &ProviderArguments) -> Result<Option<Provider>> {
    let ProviderArguments { oidc_issuer, oidc_client, oidc_secret_file, oidc_label, oidc_domain } = arguments;
    let (Some(issuer), Some(client)) = (oidc_issuer, oidc_client) else { return Ok(None) };
    let secret = match oidc_secret_file {
        Some(file) => std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?,
        None => std::env::var("FOSSSIM_OIDC_SECRET").context("--oidc-issuer needs --oidc-secret-file")?,
    };
    let (client, secret) = (client.clone(), secret.trim().to_owned());
    Ok(Some(Provider::new(issuer.clone(), client, secret, oidc_label.clone(), oidc_domain.clone())?))
}

/// Prints the server's URL and a link to sign in to standard output. The log, on standard error, contains no
/// secrets. If the server has the example course, this also prints the path of the flawed program.
async fn print_greeting(
    app: &App,
    [local, public]: [&str; 2],
    example: Option<&Path>,
    grader: Option<&Path>,
) -> Result<()> {
    let link = app.first_link().await.map_err(|problem| anyhow!("{}", problem.detail))?;
    let mut output = std::io::stdout();
    writeln!(output, "Listening on {local}")?;
    if let Some(link) = link {
        writeln!(output, "Sign in once as administrator at {public}/welcome/{}", link.reveal())?;
    }
    if let Some(program) = example {
        let link = app.example().await.map_err(|problem| anyhow!("{}: {}", problem.detail, problem.remedy))?;
        if let Some(link) = link {
            writeln!(output, "Sign in once as a student at {public}/welcome/{}", link.reveal())?;
        }
        if !program.exists() {
            let path = program.to_str().context("the data folder's name is not UTF-8")?;
            run_grader(grader, &["demo", "--program", path])
                .await
                .context("the example program could not be written")?;
        }
        writeln!(output, "A program with a mistake, to submit: {}", program.display())?;
    }
    Ok(output.flush()?)
}

/// Deletes expired artifacts, and files that killed servers left behind, at regular intervals.
async fn clean_up(database: Database, store: Store, keep_for: Option<Duration>) {
    loop {
        match retention::remove_expired(&database, &store, keep_for, retention::MIN_AGE).await {
            Ok(found) if found == retention::RemovalCounts::default() => {}
            Ok(found) => tracing::info!(found.submissions, found.artifacts, "old uploads and reports were removed"),
            Err(error) => tracing::warn!(%error, "old uploads and reports could not be removed"),
        }
        tokio::time::sleep(CLEANUP_INTERVAL).await;
    }
}

/// Reads the names of the grader's suites. A server whose workers are elsewhere may have no grader.
async fn read_suites(grader: Option<&Path>) -> Suites {
    let suites = async { Ok(Suites::read(&run_grader(grader, &["suite", "list", "--format", "json"]).await?)?) };
    suites.await.unwrap_or_else(|error: anyhow::Error| {
        tracing::warn!(error = format!("{error:#}"), "the grader does not list its suites: any name is accepted");
        Suites::default()
    })
}

/// Reads the page that checks traces in a browser from the grader; `None` if the grader was built without it.
async fn read_checker(grader: Option<&Path>) -> Option<String> {
    let page = async { Ok(String::from_utf8(run_grader(grader, &["page", "--output", "-"]).await?)?) };
    let page = page.await.inspect_err(|error: &anyhow::Error| {
        tracing::info!(error = format!("{error:#}"), "the grader was built without the page /check");
    });
    page.ok().filter(|page| !page.is_empty())
}

/// Runs the grader with arguments and returns its standard output.
async fn run_grader(grader: Option<&Path>, arguments: &[&str]) -> Result<Vec<u8>> {
    let mut command = tokio::process::Command::new(find_grader(grader)?);
    command.args(arguments).stdin(std::process::Stdio::null()).kill_on_drop(true);
    let output = tokio::time::timeout(ANSWER_TIMEOUT, command.output()).await.context("the grader timed out")??;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(output.stdout)
}

/// Updates the database's tables to this version. A SQLite database with data is copied first.
async fn update_tables(database: &Database, folders: &ServiceFolders, address: &Address) -> Result<()> {
    let version = db::read_version(database).await?;
    if version > 0 && version < db::NEWEST && matches!(address, Address::Sqlite(_)) {
        let copy = back_up(database, &folders.backups, version).await;
        let copy = copy.context("cannot back up the database before its tables change")?;
        tracing::info!(copy = %copy.display(), "the database was copied before its tables change");
    }
    let applied = db::migrate(database).await?;
    if applied > 0 {
        tracing::info!(version = db::NEWEST, "the tables are up to date");
    }
    Ok(())
}

/// Copies a SQLite database into a new file, which gets its name when it is complete. An incomplete copy that a killed
/// server left behind is removed.
async fn back_up(database: &Database, backups: &Path, version: i64) -> Result<PathBuf> {
    std::fs::create_dir_all(backups)?;
    for entry in std::fs::read_dir(backups)?.flatten() {
        if entry.file_name().to_string_lossy().contains(".partial") {
            std::fs::remove_file(entry.path())?;
        }
    }
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.as_millis());
    let copy = backups.join(format!("version-{version}-{now}.db"));
    let partial = copy.with_extension("db.partial");
    database.copy_to(&partial).await?;
    std::fs::File::open(&partial)?.sync_all()?;
    std::fs::rename(&partial, &copy)?;
    std::fs::File::open(backups)?.sync_all()?;
    Ok(copy)
}

/// Opens the database and the store, without listening for requests.
async fn open_service(storage: &StorageArguments, public: String) -> Result<(App, Database)> {
    let folders = ServiceFolders::find(storage)?;
    let (database, _) = folders.open_database(storage).await?;
    let store = folders.store(storage)?;
    let options = Options { public, incoming: folders.incoming, ..Options::default() };
    let (notifier, policy) = (Notifier::default(), QueuePolicy::default());
    Ok((App::new(database.clone(), store, notifier, policy, Instruments::new()?, options), database))
}

pub(super) async fn admin_link(arguments: &AdminLinkArguments) -> Result<()> {
    let last_used = || std::fs::read_to_string(arguments.storage.data.join(ADDRESS_FILE)).ok();
    let public = arguments.public_url.clone().or_else(last_used).unwrap_or_else(|| "http://127.0.0.1:8080".to_owned());
    let (app, database) = open_service(&arguments.storage, public).await?;
    let link = app.admin_link(&arguments.login).await.map_err(|problem| anyhow!("{}", problem.detail))?;
    println!("{}", app.welcome_address(&link));
    database.close().await;
    Ok(())
}

pub(super) async fn worker_token(arguments: &WorkerTokenArguments) -> Result<()> {
    let (app, database) = open_service(&arguments.storage, String::new()).await?;
    let token = app.worker_token(&arguments.name).await.map_err(|problem| anyhow!("{}", problem.detail))?;
    println!("{}", token.token);
    database.close().await;
    Ok(())
}
