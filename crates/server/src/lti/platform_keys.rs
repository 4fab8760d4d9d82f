//! The keys that platforms publish. They are kept for an hour. If a message names an unknown key, they are read again,
//! because platforms change their keys.
use super::{Client, Platform, Rejection, crypto::PublicKey};
use serde::Deserialize;
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

/// The time for which keys are used without reading them again.
const KEY_LIFETIME: Duration = Duration::from_secs(3600);

/// The time for which known keys are still used if the platform does not answer.
const STALE_LIFETIME: Duration = Duration::from_secs(24 * 3600);

/// The minimum pause between two requests for unknown keys, because strangers can name any key.
const MIN_PAUSE: Duration = Duration::from_secs(5);

/// The keys of each platform, by the platform's ID.
#[derive(Debug, Default)]
pub(super) struct PlatformKeys(Mutex<HashMap<i64, KnownKeys>>);

#[derive(Debug, Clone)]
struct KnownKeys {
    url: String,
    keys: Vec<PublicKey>,
    read_at: Option<Instant>,
    requested_at: Instant,
}

#[derive(Deserialize)]
struct KeySet {
    keys: Vec<serde_json::Value>,
}

#[derive(Deserialize)]
struct PublishedKey {
    kty: String,
    kid: Option<String>,
    n: String,
    e: String,
    alg: Option<String>,
    r#use: Option<String>,
}

/// Returns the keys of a set that can be used with RS256.
fn usable_keys(set: KeySet) -> Vec<PublicKey> {
    let keys = set.keys.into_iter().filter_map(|key| serde_json::from_value::<PublishedKey>(key).ok());
    let usable = keys.filter(|key| {
        key.kty == "RSA"
            && key.alg.as_deref().is_none_or(|alg| alg == "RS256")
            && key.r#use.as_deref().is_none_or(|purpose| purpose == "sig")
    });
    usable.filter_map(|key| Some(PublicKey { kid: key.kid?, n: key.n, e: key.e })).collect()
}

impl PlatformKeys {
    fn find_keys(&self, platform: &Platform) -> Option<KnownKeys> {
        let all_keys = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all_keys.get(&platform.id).filter(|all_keys| all_keys.url == platform.settings.keys_url).cloned()
    }

    /// Returns the platform's key that is called `kid`.
    pub(super) async fn fetch(&self, client: &Client, platform: &Platform, kid: &str) -> Result<PublicKey, Rejection> {
        let find_key = |cached: &KnownKeys| cached.keys.iter().find(|key| key.kid == kid).cloned();
        let cached = self.find_keys(platform);
        if let Some(cached) = &cached {
            if cached.read_at.is_some_and(|at| at.elapsed() < KEY_LIFETIME)
                && let Some(key) = find_key(cached)
            {
                return Ok(key);
            }
            if cached.requested_at.elapsed() < MIN_PAUSE {
                return find_key(cached).ok_or(Rejection::UnknownKey);
            }
        }
        let answer = client.get(platform, &platform.settings.keys_url).await;
        let keys = answer.and_then(|answer| answer.read("the platform's keys").map(usable_keys));
        let (now, url) = (Instant::now(), platform.settings.keys_url.clone());
        let updated = match keys {
            Ok(keys) => KnownKeys { url, keys, read_at: Some(now), requested_at: now },
            Err(error) => {
                tracing::warn!(platform = platform.name, %error, "a platform's keys can't be read");
                let before = cached.filter(|known| known.read_at.is_some_and(|at| at.elapsed() < STALE_LIFETIME));
                let none = || KnownKeys { url, keys: Vec::new(), read_at: None, requested_at: now };
                KnownKeys { requested_at: now, ..before.unwrap_or_else(none) }
            }
        };
        let found = find_key(&updated);
        let unreachable = updated.read_at.is_none();
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(platform.id, updated);
        found.ok_or(if unreachable { Rejection::NoKeys } else { Rejection::UnknownKey })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_other_kinds_are_passed_over() {
        let set = br#"{"keys": [
            {"kty": "RSA", "kid": "a", "n": "AQ", "e": "AQAB", "alg": "RS256", "use": "sig"},
            {"kty": "RSA", "kid": "plain", "n": "AQ", "e": "AQAB"},
            {"kty": "RSA", "kid": "encrypts", "n": "AQ", "e": "AQAB", "use": "enc"},
            {"kty": "RSA", "kid": "other", "n": "AQ", "e": "AQAB", "alg": "PS512"},
            {"kty": "RSA", "n": "AQ", "e": "AQAB"},
            {"kty": "EC", "kid": "curve", "crv": "P-256", "x": "AQ", "y": "AQ"},
            {"kty": "oct", "kid": "shared", "k": "AQ"}, 7]}"#;
        let read = |set: &[u8]| serde_json::from_slice(set).map(usable_keys);
        let names: Vec<String> = read(set).expect("a set").into_iter().map(|key| key.kid).collect();
        assert_eq!(names, ["a", "plain"]);
        assert!(read(b"[]").is_err() && read(b"no").is_err());
    }
}
