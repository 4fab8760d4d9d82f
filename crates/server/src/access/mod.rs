//! Roles and their rights. Requests get their hands on the database through one of these only, and each offers what its
//! role allows and nothing else: a [`Visitor`] who is not signed in, a [`Person`] who is, a [`Member`] of a course with
//! their own submissions, its [`Staff`], an [`Admin`], and a [`Remote`] worker with the jobs that it holds. A handler
//! says whom it serves by the type it takes, and one that forgets to has nothing to read from.

mod admin;
mod again;
mod bulk;
mod campaign;
mod choice;
mod counts;
mod example;
mod failed;
mod identity;
mod import;
mod launch;
mod limits;
mod mark;
mod member;
mod members;
mod password;
mod person;
mod platform;
mod regrade;
mod remote;
mod removal;
mod request;
mod settings;
mod staff;
mod standings;
mod submit;
mod suites;
mod throttle;
mod turns;
mod view;
mod visitor;

pub use admin::Admin;
pub use again::RegradeOrder;
pub use choice::{LinkStep, LinkTarget};
pub use counts::Counts;
pub use failed::{AttemptChange, FailedScenes};
pub use identity::{Link, NewSecret, NewToken, TokenInfo};
pub use import::MemberLine;
pub use launch::{LaunchTarget, LoginAnswer, LoginRequest};
pub use limits::{Transfer, TransferLimits};
pub use mark::{Overview, Request, StudentHistory};
pub use member::Member;
pub use members::MemberInfo;
pub use password::Passwords;
pub use person::{CourseOf, Person};
pub use platform::{RosterRead, RosterWish, ScoreInfo};
pub use regrade::{Change, Regrade, RegradeState};
pub use remote::Remote;
pub use settings::Settings;
pub(crate) use settings::{moment, moment_schema};
pub use staff::{AssignmentChange, Staff};
pub use standings::{ShortStanding, Standing};
pub use submit::{SubmitResult, Upload};
pub use suites::{Suites, is_file_name};
pub use view::{Account, Assignment, Course, Event, History, Mark, Queue, QueueWorker, ResultView, Submission};
pub use visitor::{Secrets, Visitor};

use crate::{
    db::Database,
    instruments::Instruments,
    lti::Lti,
    queue::{Notifier, QueuePolicy},
    storage::Storage,
    store::Store,
};
use axum_client_ip::ClientIpSource;
use standings::SharedStandings;
use std::{ops::Deref, path::PathBuf, sync::Arc, time::Duration};
use tokio::sync::OnceCell;

/// The parts of the service. Those that hold data are for this room alone; the rest everybody may read.
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
    /// How classes stand, for many who ask at one time.
    standings: SharedStandings,
    /// Signs what is looked at again, and stands nowhere.
    signing_key: OnceCell<String>,
    instruments: Instruments,
    options: Options,
}

/// How the service is to be.
#[derive(Debug, Default)]
pub struct Options {
    /// The suites that come with the grader.
    pub suites: Suites,
    /// The grader, where there is one: it looks at suites before anybody is graded by them.
    pub grader: Option<PathBuf>,
    /// The page that checks traces in a browser, where the grader has it.
    pub checker: Option<String>,
    /// Where uploads wait until they are stored.
    pub incoming: PathBuf,
    /// Uploads are refused when fewer bytes are free on that disk.
    pub low_water: u64,
    /// The address that people know the service by.
    pub public: String,
    /// Where a request's own address is found: the other end of its connection, or a header of the proxy.
    pub client_address: Option<ClientIpSource>,
    /// How long a body may pause.
    pub patience: Duration,
    /// Requests of one account in a minute.
    pub requests_per_minute: u32,
    /// Transfers at one time, and bytes that are kept.
    pub limits: TransferLimits,
    /// The parts that signing in with passwords needs; nothing where that is not allowed.
    pub passwords: Option<Passwords>,
    /// Speaks with learning platforms.
    pub lti: Arc<Lti>,
}

impl Deref for App {
    type Target = Options;

    fn deref(&self) -> &Options {
        &self.0.options
    }
}

pub use throttle::Throttle;
pub use turns::ArchiveTurn;

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
