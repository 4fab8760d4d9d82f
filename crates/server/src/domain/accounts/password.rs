//! Passwords, for servers that allow them: a way to sign in next to links and tokens.
//!
//! They are kept as Argon2id digests with the parameters that OWASP recommends (Password Storage Cheat Sheet: 19 MiB,
//! two passes, one lane). Each check costs that memory and some hundredths of a second of a core, so that only a few
//! run at one time. Wrong passwords slow down the address that sends them, never the person: from another address the
//! right password still works.
use crate::domain::{
    App, NewSecret, Person, Throttle, Visitor,
    accounts::identity::{self, Way},
    accounts::throttle,
};
use crate::{
    problem::{Problem, ensure},
    secret::{hex, random_hex},
    values,
};
use argon2::{Algorithm, Argon2, Params, Version};
use std::{
    net::IpAddr,
    time::{Duration, Instant},
};
use tokio::sync::Semaphore;

/// Memory in KiB, passes, lanes.
const COST: (u32, u32, u32) = (19 * 1024, 2, 1);

/// Digests that are computed at one time: more would only cost memory.
static ROOM: Semaphore = Semaphore::const_new(2);

/// The longest wait for a turn.
const PATIENCE: Duration = Duration::from_secs(10);

/// Wrong passwords in a minute from one address, for one login.
const TRIES: u32 = 10;

/// Wrong passwords in a minute from one address, for whatever logins. A lecture hall may be one address.
const TRIES_OF_ADDRESS: u32 = 60;

/// The greatest length of a password.
const LENGTH: std::ops::RangeInclusive<usize> = 10..=200;

/// The parts that passwords need: a server that does not allow passwords has none of them.
#[derive(Debug, Default)]
pub struct Passwords {
    tries: Throttle,
}

/// Returns the digest of a password with a salt.
fn digest(password: &str, salt: &str) -> Result<String, Problem> {
    let fault = |_| Problem::fault();
    let params = Params::new(COST.0, COST.1, COST.2, Some(32)).map_err(fault)?;
    let mut key = [0; 32];
    Argon2::new(Algorithm::Argon2id, Version::V0x13, params)
        .hash_password_into(password.as_bytes(), salt.as_bytes(), &mut key)
        .map_err(fault)?;
    Ok(format!("argon2id$m={},t={},p={}${salt}${}", COST.0, COST.1, COST.2, hex(&key)))
}

/// Returns whether a password matches the kept one. Without a kept password the same work is done, so that the time
/// reveals nothing.
fn is_kept(password: &str, kept: Option<&str>) -> Result<bool, Problem> {
    let salt = kept.and_then(|kept| kept.split('$').nth(2)).unwrap_or("0123456789abcdef0123456789abcdef");
    let digest = digest(password, salt)?;
    let Some(kept) = kept else { return Ok(false) };
    // Looked at to the end, wherever they differ.
    let differs = digest.bytes().zip(kept.bytes()).fold(0, |differs, (one, other)| differs | (one ^ other));
    Ok(differs == 0 && digest.len() == kept.len())
}

/// Does something with a password when it is its turn, away from the threads that must not wait.
async fn in_turn<T: Send + 'static>(work: impl FnOnce() -> Result<T, Problem> + Send + 'static) -> Result<T, Problem> {
    let turn = tokio::time::timeout(PATIENCE, ROOM.acquire()).await;
    let turn = turn.map_err(|_| Problem::unavailable("too many people sign in at this moment"))?;
    let turn = turn.map_err(|_| Problem::fault())?;
    let done = tokio::task::spawn_blocking(move || {
        let done = work();
        drop(turn);
        done
    });
    done.await.map_err(|_| Problem::fault())?
}

impl Passwords {
    /// Counts a try to sign in, also for an unknown name, until it proves right.
    fn try_of(&self, address: Option<IpAddr>, login: &str) -> Result<Try<'_>, Problem> {
        let bucket = |word: &str| throttle::bucket(address, word);
        // No login is empty.
        let buckets = [(bucket(""), TRIES_OF_ADDRESS), (bucket(login), TRIES)];
        let now = Instant::now();
        for (place, (bucket, most)) in buckets.into_iter().enumerate() {
            if !self.tries.pass(bucket, most, now) {
                buckets[..place].iter().for_each(|(bucket, _)| self.tries.put_back(*bucket));
                return Err(Problem::too_many("too many wrong passwords came from your address"));
            }
        }
        Ok(Try { passwords: self, buckets: buckets.map(|(bucket, _)| bucket) })
    }
}

/// A try that counts as wrong unless it turns out to be right.
struct Try<'a> {
    passwords: &'a Passwords,
    buckets: [i64; 2],
}

impl Try<'_> {
    fn note_right(&self) {
        self.buckets.iter().for_each(|bucket| self.passwords.tries.put_back(*bucket));
    }
}

impl App {
    /// Returns the parts that passwords need, where passwords are allowed.
    fn passwords(&self) -> Result<&Passwords, Problem> {
        self.passwords.as_ref().ok_or_else(Problem::no_passwords)
    }

    /// Returns whether people may sign in with a password.
    pub fn takes_passwords(&self) -> bool {
        self.passwords.is_some()
    }
}

impl Visitor {
    /// Signs in with a password.
    ///
    /// # Errors
    /// When it is not the account's, there is no such account, or there were too many tries. The first two are not
    /// distinguished.
    pub async fn sign_in_by_password(&self, login: &str, password: &str) -> Result<NewSecret, Problem> {
        let passwords = self.app.passwords()?;
        let attempt = passwords.try_of(self.secrets.address, login)?;
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, password FROM account WHERE login = ? AND disabled_at IS NULL";
        let row = transaction.row(statement, values![login]).await?;
        drop(transaction);
        let kept = row.as_ref().map(|row| row.maybe_text("password")).transpose()?.flatten();
        let (given, of_account) = (password.to_owned(), kept.clone());
        let right = in_turn(move || is_kept(&given, of_account.as_deref())).await?;
        let (true, Some(row)) = (right, row) else { return Err(Problem::wrong_password()) };
        attempt.note_right();
        let account = row.int("id")?;
        let mut transaction = self.app.0.database.begin().await?;
        // It may have been changed, or the account shut, while the digest was computed.
        let statement = "SELECT id FROM account WHERE id = ? AND password = ? AND disabled_at IS NULL {for update}";
        let still = transaction.row(statement, values![account, kept]).await?;
        ensure(still.is_some(), Problem::wrong_password())?;
        let session = identity::begin_session(&mut transaction, account, Way::Own).await?;
        transaction.commit().await?;
        Ok(session)
    }
}

impl Person {
    /// Sets or changes one's own password; a change requires the old one. All sessions end, so that the old password
    /// signs nobody in any more, and so does all that links of a course's staff made: the account belongs to this
    /// person alone.
    ///
    /// # Errors
    /// When the old one is wrong, the new one is too short, or the person did not sign in lately.
    pub async fn set_password(&self, old: &str, new: &str) -> Result<(), Problem> {
        let passwords = self.app.passwords()?;
        if !LENGTH.contains(&new.chars().count()) || new == self.account.login || new.chars().any(char::is_control) {
            return Err(Problem::invalid("a password must be 10 to 200 characters long, and not the login"));
        }
        self.at_browser()?;
        let mut transaction = self.app.0.database.read().await?;
        let row = transaction.one("SELECT password FROM account WHERE id = ?", values![self.account.id]).await?;
        drop(transaction);
        let kept = row.maybe_text("password")?;
        if kept.is_none() {
            self.lately_at_browser()?;
        }
        let attempt = passwords.try_of(self.address, &self.account.login)?;
        let (old, new, of_account) = (old.to_owned(), new.to_owned(), kept.clone());
        let digest = in_turn(move || match of_account {
            Some(kept) if !is_kept(&old, Some(&kept))? => Err(Problem::wrong_password()),
            _ => digest(&new, &random_hex()),
        });
        let digest = digest.await?;
        attempt.note_right();
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "UPDATE account SET password = ? WHERE id = ? AND coalesce(password, '') = ?";
        let changed =
            transaction.execute(statement, values![digest, self.account.id, kept.unwrap_or_default()]).await?;
        ensure(changed > 0, Problem::conflict("the password was changed meanwhile", "sign in again"))?;
        identity::end_sessions(&mut transaction, self.account.id).await?;
        identity::end_vouched(&mut transaction, self.account.id).await?;
        Ok(transaction.commit().await?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_password_is_known_again_and_no_other() {
        let kept = digest("correct horse battery", &random_hex()).expect("a digest");
        assert!(kept.starts_with("argon2id$m=19456,t=2,p=1$") && !kept.contains("horse"), "{kept}");
        assert!(is_kept("correct horse battery", Some(&kept)).expect("an answer"));
        for (other, kept) in [
            ("correct horse batter", Some(kept.as_str())),
            ("", Some(kept.as_str())),
            ("correct horse battery", None),
            ("correct horse battery", Some("argon2id$m=19456,t=2,p=1$")),
            ("correct horse battery", Some("")),
        ] {
            assert!(!is_kept(other, kept).unwrap_or(false), "{other} {kept:?}");
        }
        assert_ne!(
            digest("the same one", &random_hex()).expect("one"),
            digest("the same one", &random_hex()).expect("two")
        );
    }
}
