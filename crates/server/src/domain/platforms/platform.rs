//! Learning platforms as administrators register them, and the requests of a course's staff about its platforms.
use crate::domain::{
    Admin, App, Staff,
    accounts::identity,
    platforms::launch::{enroll, find_or_make},
};
use crate::{
    db::{DbError, FromRow, Row, read_row},
    lti::{self, Platform, PlatformSettings, score},
    problem::{Problem, ensure},
    values,
};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use utoipa::ToSchema;

/// The changes to a course's members that its platforms' lists require.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct RosterRead {
    /// The number of members that the platforms report.
    pub members: usize,
    /// The number of members who left.
    #[serde(rename = "left")]
    pub leaving_count: usize,
    /// The people who join, such as `Ada Lovelace (ada)`.
    #[serde(rename = "comes")]
    pub joining: Vec<String>,
    /// The people who leave, such as `Ada Lovelace (ada)`.
    #[serde(rename = "goes")]
    pub leaving: Vec<String>,
}

/// The changes that reading the list of members from a platform may make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RosterMode {
    /// Only report who would join and who would leave.
    Preview,
    /// Change the members, unless too many would leave.
    Apply,
    /// Change the members, even if many leave.
    Confirmed,
}

/// A score that was, or will be, sent to a platform.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct ScoreInfo {
    /// The name of the platform.
    pub platform: String,
    /// The login of the student.
    pub login: String,
    /// The score message, as JSON.
    #[schema(value_type = Object)]
    pub score: Value,
    /// The time of the score, in milliseconds since 1970.
    pub stamp: i64,
    /// The time when the platform accepted the score; `None` until then.
    pub sent_at: Option<i64>,
    /// The reason why the platform has not accepted the score.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
}

impl App {
    /// Returns the service's public keys.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn platform_keys(&self) -> Result<Value, Problem> {
        Ok(lti::public_keys(&self.0.database).await?)
    }
}

impl Admin {
    /// Returns all platforms.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn platforms(&self) -> Result<Vec<Platform>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, name, settings FROM platform WHERE disabled_at IS NULL ORDER BY name";
        Ok(transaction.all(statement, values![]).await?)
    }

    /// Registers a platform, or changes it.
    ///
    /// # Errors
    ///
    /// Fails if a setting is invalid.
    pub async fn set_platform(&self, name: &str, settings: &PlatformSettings) -> Result<Platform, Problem> {
        identity::check_slug("a platform's name", name)?;
        settings.check(self.app.lti.allows_http())?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT name FROM platform WHERE issuer = ? AND client = ? AND name <> ?";
        let registered = transaction.row(statement, values![&settings.issuer, &settings.client_id, name]).await?;
        if let Some(other_platform) = registered {
            let detail = format!("this issuer and client are registered as {}", other_platform.text("name")?);
            return Err(Problem::conflict(detail, "change that one"));
        }
        // Accounts belong to the people of one issuer, so the issuer cannot change.
        let before = transaction.row("SELECT issuer FROM platform WHERE name = ?", values![name]).await?;
        if before.is_some_and(|before| before.text("issuer").is_ok_and(|issuer| issuer != settings.issuer)) {
            return Err(Problem::conflict("another issuer is registered under this name", "give it another name"));
        }
        let text = serde_json::to_string(settings).map_err(|_| Problem::fault())?;
        let statement = "INSERT INTO platform (name, issuer, client, settings, created_at) VALUES (?, ?, ?, ?, {now})
            ON CONFLICT (name) DO UPDATE SET client = excluded.client, settings = excluded.settings,
               disabled_at = NULL
            RETURNING id, name, settings";
        let row = transaction.one(statement, values![name, &settings.issuer, &settings.client_id, text]).await?;
        let text = format!("registered {name}: {}, client {}", settings.issuer, settings.client_id);
        self.log_event(&mut transaction, "platform", &text).await?;
        transaction.commit().await?;
        Ok(Platform::from_row(&row)?)
    }

    /// Closes a platform: people can no longer launch from it, and no scores are sent to it. Accounts and courses stay.
    ///
    /// # Errors
    ///
    /// Fails if there is no platform with this name.
    pub async fn close_platform(&self, name: &str) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "UPDATE platform SET disabled_at = {now} WHERE name = ? AND disabled_at IS NULL";
        let closed = transaction.execute(statement, values![name]).await?;
        ensure(closed > 0, Problem::not_found("platform"))?;
        self.log_event(&mut transaction, "platform", &format!("closed {name}")).await?;
        Ok(transaction.commit().await?)
    }

    /// Creates a new key for signatures, which is used after an hour. The previous key is still published until the
    /// next one is created.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn new_platform_key(&self) -> Result<(), Problem> {
        lti::new_key(&self.app.0.database).await?;
        let mut transaction = self.app.0.database.begin().await?;
        self.log_event(&mut transaction, "platform", "created a key for learning platforms").await?;
        Ok(transaction.commit().await?)
    }
}

impl Staff {
    /// Reads the members of the course from its platforms. A member who is no longer listed leaves the course, unless
    /// staff added them; their submissions stay. The person who requests this stays in any case, and an empty list
    /// changes nothing.
    ///
    /// # Errors
    ///
    /// Fails if no platform offers a list, if a platform does not answer, or if more than a third of the members would
    /// leave without confirmation. In these cases nothing changes.
    pub async fn read_roster(&self, mode: RosterMode) -> Result<RosterRead, Problem> {
        let app = &self.app;
        let mut transaction = app.0.database.read().await?;
        let statement = "SELECT platform_course.id AS place, platform_course.memberships, platform.id, platform.name,
               platform.settings
            FROM platform_course
            JOIN platform ON platform.id = platform_course.platform AND platform.disabled_at IS NULL
            WHERE platform_course.course = ? AND platform_course.memberships IS NOT NULL
            ORDER BY platform_course.id";
        let rows = transaction.rows(statement, values![self.course]).await?;
        drop(transaction);
        if rows.is_empty() {
            let detail = "this course is connected with no learning platform";
            return Err(Problem::conflict(detail, "open an assignment from the platform once, as a teacher there"));
        }
        let mut total = RosterRead::default();
        for row in &rows {
            let (place, platform) = (row.int("place")?, Platform::from_row(row)?);
            let address = row.text("memberships")?;
            let people = lti::fetch_roster(&app.lti.client, &app.0.database, &platform, &address).await;
            let people = people.map_err(|fault| {
                tracing::warn!(platform = platform.name, %fault, "a roster can't be read");
                Problem::platform_failed(format!("{}: {fault}", platform.name))
            })?;
            let one = self.apply_roster(place, &platform, &people, mode).await?;
            total.members += one.members;
            total.leaving_count += one.leaving_count;
            total.joining.extend(one.joining);
            total.leaving.extend(one.leaving);
        }
        Ok(total)
    }

    async fn apply_roster(
        &self,
        platform_course: i64,
        platform: &Platform,
        people: &[lti::LtiPerson],
        mode: RosterMode,
    ) -> Result<RosterRead, Problem> {
        let course = self.course;
        let mut transaction = self.begin().await?;
        let members = "SELECT account.login, account.name FROM member JOIN account ON account.id = member.account
            WHERE member.course = ? ORDER BY account.login";
        let person = |row: &Row| {
            let login = row.text("login")?;
            Ok((login.clone(), format!("{} ({login})", row.text("name")?)))
        };
        let read_people = |rows: Vec<Row>| rows.iter().map(person).collect::<Result<BTreeMap<_, _>, DbError>>();
        let before = read_people(transaction.rows(members, values![course]).await?)?;
        let mut present = BTreeSet::new();
        for person in people {
            let Some(role) = person.role else { continue };
            let account = find_or_make(&mut transaction, platform, person).await?;
            let row =
                transaction.one("SELECT is_admin, disabled_at FROM account WHERE id = ?", values![account]).await?;
            present.insert(account);
            // A platform's list must not give rights to administrators or closed accounts.
            if row.flag("is_admin")? || row.maybe_int("disabled_at")?.is_some() {
                continue;
            }
            enroll(&mut transaction, platform.id, platform_course, course, account, role).await?;
        }
        // If the list is empty, the cause is probably a filter or an error of the platform.
        if present.is_empty() {
            return Ok(RosterRead::default());
        }
        let statement = "SELECT account FROM platform_member WHERE platform_course = ? ORDER BY account";
        let known_members = transaction.rows(statement, values![platform_course]).await?;
        for row in &known_members {
            let account = row.int("account")?;
            if present.contains(&account) || account == self.account.id {
                continue;
            }
            let statement = "DELETE FROM platform_member WHERE platform_course = ? AND account = ?";
            transaction.execute(statement, values![platform_course, account]).await?;
            let statement = "DELETE FROM member WHERE course = ? AND account = ? AND platform = ?
                AND NOT EXISTS (SELECT 1 FROM platform_member
                    JOIN platform_course ON platform_course.id = platform_member.platform_course
                    WHERE platform_course.course = member.course AND platform_member.account = member.account)";
            transaction.execute(statement, values![course, account, platform.id]).await?;
        }
        let after = read_people(transaction.rows(members, values![course]).await?)?;
        let missing_in = |others: &BTreeMap<_, _>, these: &BTreeMap<_, String>| {
            these.iter().filter(|(login, _)| !others.contains_key(*login)).map(|(_, who)| who.clone()).collect()
        };
        let (joining, leaving): (Vec<_>, Vec<_>) = (missing_in(&before, &after), missing_in(&after, &before));
        let (members, leaving_count) = (present.len(), leaving.len());
        let read = RosterRead { members, leaving_count, joining, leaving };
        if mode == RosterMode::Preview {
            return Ok(read);
        }
        if mode == RosterMode::Apply && leaving_count * 3 > before.len() {
            return Err(Problem::conflict(
                format!("{leaving_count} of {} members would leave: {}", before.len(), read.leaving.join(", ")),
                "check who would be added and removed (preview), then confirm it (confirm)",
            ));
        }
        let text = format!("read {members} members from {}; {leaving_count} left", platform.name);
        self.log_event(&mut transaction, "roster", None, &text).await?;
        transaction.commit().await?;
        Ok(read)
    }

    /// Returns the messages to platforms about an assignment's scores.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn scores(&self, slug: &str) -> Result<Vec<ScoreInfo>, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let statement = "SELECT platform.name AS platform, account.login, platform_score.content, platform_score.stamp,
               platform_score.sent_at, platform_score.fault
            FROM platform_score
            JOIN platform_link ON platform_link.id = platform_score.link
            JOIN platform_course ON platform_course.id = platform_link.platform_course
            JOIN platform ON platform.id = platform_course.platform
            JOIN account ON account.id = platform_score.account
            WHERE platform_link.assignment = ? ORDER BY platform.name, account.login, platform_link.id";
        let rows = transaction.rows(statement, values![assignment.id]).await?;
        let read = |row: &Row| {
            let score = serde_json::from_str(&row.text("content")?).unwrap_or_default();
            Ok(read_row!(row => ScoreInfo { platform, login, stamp, sent_at, fault; score }))
        };
        Ok(rows.iter().map(read).collect::<Result<_, DbError>>()?)
    }

    /// Sends all scores of an assignment again, even if platforms already have them. Returns their number.
    ///
    /// # Errors
    ///
    /// Fails if there is no such assignment.
    pub async fn send_scores(&self, slug: &str) -> Result<usize, Problem> {
        let assignment = self.assignment(slug).await?;
        let mut transaction = self.begin().await?;
        let count = score::send_all(&mut transaction, assignment.id, true).await?;
        let text = format!("sent {count} scores of {slug} again");
        self.log_event(&mut transaction, "scores", Some(assignment.id), &text).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(count)
    }
}
