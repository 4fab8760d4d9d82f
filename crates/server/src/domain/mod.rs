//! Roles and their rights. Requests reach the database only through a role, and the type of each role has only the
//! functions that the role allows. The roles are a [`Visitor`] who is not signed in, a [`Person`] who is signed in, a
//! [`Member`] of a course with their own submissions, its [`Staff`], an [`Admin`], and a [`RemoteWorker`] with its
//! jobs. The type that a handler takes names the role that it serves; a handler without such a type cannot read data.

mod accounts;
mod assignments;
mod counts;
mod courses;
mod platforms;
mod roles;
mod submissions;
mod view;

pub use accounts::identity::{Link, NewSecret, NewToken, TokenInfo};
pub use accounts::limits::{ArchiveTurn, Transfer, TransferLimits};
pub use assignments::settings::Settings;
pub(crate) use assignments::settings::{read_moment, time_schema};
pub use assignments::suites::{SuiteGroup, Suites, UploadedSuite, is_file_name};
pub use counts::Counts;
pub use courses::import::MemberLine;
pub use courses::members::MemberInfo;
pub use platforms::choice::{LinkStep, LinkTarget, propose_slug};
pub use platforms::launch::{LaunchTarget, LoginAnswer, LoginRequest};
pub use platforms::platform::{RosterMode, RosterRead, ScoreInfo};
pub use roles::admin::{Admin, CourseSize, ListedAccount};
pub use roles::member::Member;
pub use roles::person::{CourseMembership, Person};
pub use roles::remote::RemoteWorker;
pub use roles::staff::{AssignmentChange, NewSuite, Staff};
pub use roles::visitor::{Secrets, Visitor};
pub use submissions::attempt_changes::{AttemptChange, FailedScenes, StoredResult};
pub use submissions::mark::{Overview, Request, StudentHistory};
pub use submissions::regrade::{Change, Regrade, RegradeState, StaffGrade};
pub use submissions::repeated_grading::EnqueuedJobs;
pub use submissions::standings::{CountedSubmission, ShortStanding, Standing};
pub use submissions::submit::{SubmitResult, Upload};
pub use view::{
    Account, Assignment, Course, Event, EventQuery, History, Mark, Queue, QueueWorker, ResultView, Submission,
};

use crate::{
    db::Database,
    instruments::Instruments,
    lti::Lti,
    oidc::Provider,
    queue::{Notifier, QueuePolicy},
    storage::Storage,
    store::Store,
};
use axum_client_ip::ClientIpSource;
use std::{ops::Deref, path::PathBuf, sync::Arc, time::Duration};
use submissions::standings::SharedStandings;
use tokio::sync::OnceCell;

/// The parts of the service. Only this module uses the parts that contain data; other modules may read the rest.
#[derive(Debug, Clone)]
pub struct App(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    database: Database,
    store: Store,
    notifier: Notifier,
    /// The rules by which the queue gives jobs to workers.
    policy: QueuePolicy,
    /// The numbers for monitoring, which are kept for a second.
    counts: Counts,
    /// The free space on the data folder's disk, and whether the disk can be written.
    storage: Storage,
    /// The limits on the rate of each account's requests.
    throttle: Throttle,
    /// The standings of classes, which simultaneous requests share.
    standings: SharedStandings,
    /// The key with which the service signs data that it receives back later. It is read from the database when it is
    /// first needed.
    signing_key: OnceCell<String>,
    instruments: Instruments,
    options: Options,
}

/// The settings of the service.
#[derive(Debug, Default)]
pub struct Options {
    /// The suites of the grader.
    pub suites: Suites,
    /// The grader, if this server has one. It checks suites before they are used for grading.
    pub grader: Option<PathBuf>,
    /// The page that checks traces in a browser, if the grader contains it.
    pub checker: Option<String>,
    /// The folder in which uploads are received before they are stored.
    pub incoming: PathBuf,
    /// The number of free bytes on the disk below which uploads are rejected.
    pub low_water: u64,
    /// The public URL of the service.
    pub public: String,
    /// The source of a client's address: the connection itself, or a header of the proxy.
    pub client_ip_source: Option<ClientIpSource>,
    /// The maximum pause while a request's body is received.
    pub max_pause: Duration,
    /// The maximum number of requests of one account per minute.
    pub requests_per_minute: u32,
    /// The limits of parallel transfers and of stored bytes.
    pub limits: TransferLimits,
    /// The provider at which people sign in, if there is one.
    pub provider: Option<Provider>,
    /// The client for requests to learning platforms.
    pub lti: Arc<Lti>,
}

impl Deref for App {
    type Target = Options;

    fn deref(&self) -> &Options {
        &self.0.options
    }
}

pub use accounts::throttle::Throttle;

impl App {
    /// Creates an app with a database and a store.
    pub fn new(
        database: Database,
        store: Store,
        notifier: Notifier,
        policy: QueuePolicy,
        instruments: Instruments,
        options: Options,
    ) -> Self {
        let storage = Storage::new(database.clone(), store.clone(), options.incoming.clone(), options.low_water);
        let (counts, throttle) = (Counts::default(), Throttle::default());
        let (signing_key, standings) = (OnceCell::new(), SharedStandings::default());
        Self(Arc::new(Parts {
            database,
            store,
            notifier,
            policy,
            counts,
            storage,
            throttle,
            standings,
            signing_key,
            instruments,
            options,
        }))
    }

    /// Returns the counters and times that the server measures about itself.
    pub fn instruments(&self) -> &Instruments {
        &self.0.instruments
    }

    /// Returns the URL of a sign-in link.
    pub fn welcome_address(&self, secret: &NewSecret) -> String {
        format!("{}/welcome/{}", self.public, secret.reveal())
    }

    /// Returns whether the public URL uses HTTPS.
    pub fn is_secure(&self) -> bool {
        self.public.starts_with("https://")
    }

    /// Checks that the disk has space for an upload.
    ///
    /// # Errors
    ///
    /// Fails if the disk is nearly full.
    pub fn ensure_disk_space(&self) -> Result<(), crate::problem::Problem> {
        self.0.storage.ensure_disk_space()
    }
}
