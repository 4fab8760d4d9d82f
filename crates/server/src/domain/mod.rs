//! Roles and their rights. Requests reach the database only through one of these, and each offers only what its role
//! allows: a [`Visitor`] who is not signed in, a [`Person`] who is, a [`Member`] of a course with their own
//! submissions, its [`Staff`], an [`Admin`], and a [`Remote`] worker with the jobs that it holds. The type that a
//! handler takes names the role that it serves; without such a type it has nothing to read from.

mod accounts;
mod assignments;
mod counts;
mod courses;
mod platforms;
mod roles;
mod submissions;
mod view;

pub use accounts::identity::{Link, NewSecret, NewToken, TokenInfo};
pub use accounts::limits::{Transfer, TransferLimits};
pub use assignments::settings::Settings;
pub(crate) use assignments::settings::{moment, moment_schema};
pub use assignments::suites::{Suites, is_file_name};
pub use counts::Counts;
pub use courses::import::MemberLine;
pub use courses::members::MemberInfo;
pub use platforms::choice::{LinkStep, LinkTarget};
pub use platforms::launch::{LaunchTarget, LoginAnswer, LoginRequest};
pub use platforms::platform::{RosterRead, RosterWish, ScoreInfo};
pub use roles::admin::{Admin, CourseSize};
pub use roles::member::Member;
pub use roles::person::{CourseOf, Person};
pub use roles::remote::Remote;
pub use roles::staff::{AssignmentChange, NewSuite, Staff, UploadedSuite};
pub use roles::visitor::{Secrets, Visitor};
pub use submissions::again::RegradeOrder;
pub use submissions::failed::{AttemptChange, FailedScenes, KeptResult};
pub use submissions::mark::{Overview, Request, StudentHistory};
pub use submissions::regrade::{Change, Regrade, RegradeState};
pub use submissions::standings::{CountedSubmission, ShortStanding, Standing};
pub use submissions::submit::{SubmitResult, Upload};
pub use view::{Account, Assignment, Course, Event, History, Mark, Queue, QueueWorker, ResultView, Submission};

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

/// The parts of the service. Only this room uses those that hold data; all rooms may read the others.
#[derive(Debug, Clone)]
pub struct App(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    database: Database,
    store: Store,
    notifier: Notifier,
    /// The queue's patience.
    policy: QueuePolicy,
    /// Numbers for monitors.
    counts: Counts,
    /// Whether there is room, and whether it can be written.
    storage: Storage,
    /// Counts requests by account.
    throttle: Throttle,
    /// The standings of classes, shared by simultaneous requests.
    standings: SharedStandings,
    /// The key that signs data for a later check; it is stored nowhere else.
    signing_key: OnceCell<String>,
    instruments: Instruments,
    options: Options,
}

/// The settings of the service.
#[derive(Debug, Default)]
pub struct Options {
    /// The suites that come with the grader.
    pub suites: Suites,
    /// The grader, if there is one: it checks suites before they grade submissions.
    pub grader: Option<PathBuf>,
    /// The page that checks traces in a browser, where the grader has it.
    pub checker: Option<String>,
    /// The folder of uploads that are not stored yet.
    pub incoming: PathBuf,
    /// Uploads are rejected when fewer bytes are free on that disk.
    pub low_water: u64,
    /// The address that people know the service by.
    pub public: String,
    /// The source of a request's own address: the other end of its connection, or a header of the proxy.
    pub client_address: Option<ClientIpSource>,
    /// The longest time that a body may pause.
    pub patience: Duration,
    /// Requests of one account in a minute.
    pub requests_per_minute: u32,
    /// Transfers at one time, and bytes that are kept.
    pub limits: TransferLimits,
    /// The provider by which people sign in.
    pub provider: Option<Provider>,
    /// Speaks with learning platforms.
    pub lti: Arc<Lti>,
}

impl Deref for App {
    type Target = Options;

    fn deref(&self) -> &Options {
        &self.0.options
    }
}

pub use accounts::throttle::Throttle;
pub use accounts::turns::ArchiveTurn;

impl App {
    /// Creates an app on this database and store.
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

    /// Returns the server's counts about itself.
    pub fn instruments(&self) -> &Instruments {
        &self.0.instruments
    }

    /// Returns a link that signs in once, as people open it.
    pub fn welcome_address(&self, secret: &NewSecret) -> String {
        format!("{}/welcome/{}", self.public, secret.reveal())
    }

    /// Returns whether people come by HTTPS.
    pub fn is_secure(&self) -> bool {
        self.public.starts_with("https://")
    }

    /// Checks that there is room for an upload.
    ///
    /// # Errors
    /// When the disk is nearly full.
    pub fn ensure_room(&self) -> Result<(), crate::problem::Problem> {
        self.0.storage.ensure_room()
    }
}
