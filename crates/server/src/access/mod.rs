//! Who may do what. Requests get their hands on the database through one of these only, and each offers what its role
//! allows and nothing else: a [`Visitor`] who is not signed in, a [`Person`] who is, a [`Member`] of a course with
//! their own submissions, its [`Staff`], an [`Admin`], and a [`Remote`] worker with the jobs that it holds. A handler
//! says whom it serves by the type it takes, and one that forgets to has nothing to read from.

mod account;
mod admin;
mod again;
mod bulk;
mod campaign;
mod choice;
mod counts;
mod example;
mod file_name;
mod identity;
mod import;
mod invitation;
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
mod submit;
mod suites;
mod suspicion;
mod throttle;
mod view;
mod visitor;

pub use account::Account;
pub use admin::Admin;
pub use campaign::run as work_on_regrades;
pub use choice::{Choice, Chosen};
pub use counts::Counts;
pub use file_name::is_file_name;
pub use identity::{NewSecret, Session};
pub use import::Imported;
pub use invitation::Invitation;
pub use launch::{Launched, LoginAnswer, LoginRequest};
pub use limits::{Limits, Transfer};
pub use mark::{Request, Work};
pub use member::Member;
pub use members::{Added, MemberInfo};
pub use password::Passwords;
pub use person::{CourseOf, Person, TokenInfo};
pub use platform::{RosterRead, ScoreInfo};
pub use regrade::{Change, Doing, Regrade, RegradeState};
pub use remote::Remote;
pub use request::Secrets;
pub use settings::Settings;
pub(crate) use settings::{moment, moment_schema};
pub use staff::{Staff, Standing};
pub use submit::{Accepted, Upload};
pub use suites::Suites;
pub use suspicion::Suspicion;
pub use view::{Assignment, Course, Event, Graded, History, Mark, Queue, QueueWorker, Submission};
pub use visitor::{Metrics, Visitor};

use crate::{
    db::Database,
    instruments::Instruments,
    lti::Lti,
    queue::{Bell, Ear, Policy},
    storage::Storage,
    store::Store,
};
use std::{path::PathBuf, sync::Arc, time::Duration};
use tokio_util::sync::CancellationToken;

/// What the service stands on. Its parts are for this room alone.
#[derive(Debug, Clone)]
pub struct House(Arc<Parts>);

/// What a house is built from.
#[derive(Debug)]
pub struct Parts {
    /// The database.
    pub database: Database,
    /// The store of artefacts.
    pub store: Store,
    /// Rings when something happens.
    pub bell: Bell,
    /// The queue's patience.
    pub policy: Policy,
    /// The suites that come with the grader.
    pub suites: Suites,
    /// The grader, where there is one: it looks at suites before anybody is graded by them.
    pub grader: Option<PathBuf>,
    /// Numbers for monitors.
    pub counts: Counts,
    /// Whether there is room, and whether it can be written.
    pub storage: Storage,
    /// What the server counts about itself.
    pub instruments: Instruments,
    /// Where uploads wait until they are stored.
    pub incoming: PathBuf,
    /// The address that people know the service by.
    pub public: String,
    /// How long a body may pause.
    pub patience: Duration,
    /// Requests of one account in a minute.
    pub requests_per_minute: u32,
    /// Counts these requests.
    pub throttle: Throttle,
    /// Transfers at one time, and bytes that are kept.
    pub limits: Limits,
    /// What signing in with passwords needs; nothing where that is not allowed.
    pub passwords: Option<Passwords>,
    /// Speaks with learning platforms.
    pub lti: Arc<Lti>,
    /// Cancelled when the server is to end: whoever waits for something to happen stops waiting.
    pub closing: CancellationToken,
}

pub use throttle::Throttle;

impl House {
    /// A house from its parts.
    pub fn new(parts: Parts) -> Self {
        Self(Arc::new(parts))
    }

    /// The address that people know the service by.
    pub fn public(&self) -> &str {
        &self.0.public
    }

    /// A link that signs in once, as people open it.
    pub fn welcome_address(&self, secret: &NewSecret) -> String {
        format!("{}/welcome/{}", self.public(), secret.reveal())
    }

    /// A link to an invitation.
    pub fn invitation_address(&self, secret: &NewSecret) -> String {
        format!("{}/invitation/{}", self.public(), secret.reveal())
    }

    /// What the server counts about itself.
    pub fn instruments(&self) -> &Instruments {
        &self.0.instruments
    }

    /// The suites that come with the grader.
    pub fn suites(&self) -> &Suites {
        &self.0.suites
    }

    /// The grader, where there is one.
    pub fn grader(&self) -> Option<&std::path::Path> {
        self.0.grader.as_deref()
    }

    /// Whether people come by HTTPS.
    pub fn is_secure(&self) -> bool {
        self.0.public.starts_with("https://")
    }

    /// How long a body may pause.
    pub fn patience(&self) -> Duration {
        self.0.patience
    }

    /// Where uploads wait until they are stored.
    pub fn incoming(&self) -> &std::path::Path {
        &self.0.incoming
    }

    /// Whether there is room for an upload.
    ///
    /// # Errors
    /// When the disk is nearly full.
    pub fn has_room(&self) -> Result<(), crate::problem::Problem> {
        self.0.storage.has_room()
    }

    /// Whether learning platforms may be reached, and people come from them, without HTTPS.
    pub fn is_lti_over_http(&self) -> bool {
        self.0.lti.over_http()
    }

    /// Waits until the server is to end.
    pub async fn closing(&self) {
        self.0.closing.cancelled().await;
    }

    /// Hears whatever happens.
    pub fn ear(&self) -> Ear {
        self.0.bell.ear()
    }
}
