//! Limits the requests of an account by a bucket of tokens that refills over time. Requests count by account and not by
//! address, because a whole lecture hall may share an address. Sign-ins count by address, because the account is not
//! known before the sign-in.
use std::{
    collections::HashMap,
    hash::{DefaultHasher, Hash, Hasher},
    net::{IpAddr, Ipv6Addr},
    sync::{Mutex, PoisonError},
    time::Instant,
};

/// The number of buckets above which full buckets are removed from memory.
const MAX_BUCKETS: usize = 10_000;

/// The token buckets of all accounts.
#[derive(Debug, Default)]
pub struct Throttle(Mutex<HashMap<i64, (f64, Instant)>>);

impl Throttle {
    /// Takes a token from an account's bucket, and returns whether there was one. A bucket holds at most the tokens of
    /// one minute.
    pub(in crate::domain) fn try_acquire(&self, account: i64, per_minute: u32, now: Instant) -> bool {
        let capacity = f64::from(per_minute);
        let mut buckets = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let level_now = |(level, at): (f64, Instant)| {
            (level + now.saturating_duration_since(at).as_secs_f64() * capacity / 60.0).min(capacity)
        };
        if buckets.len() > MAX_BUCKETS {
            buckets.retain(|_, bucket| level_now(*bucket) < capacity);
        }
        let bucket = buckets.entry(account).or_insert((capacity, now));
        let level = level_now(*bucket);
        let is_allowed = level >= 1.0;
        *bucket = (if is_allowed { level - 1.0 } else { level }, now);
        is_allowed
    }

    /// Puts a token back into the bucket, for a request that should not count.
    pub(in crate::domain) fn return_token(&self, account: i64) {
        let mut buckets = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((level, _)) = buckets.get_mut(&account) {
            *level += 1.0;
        }
    }
}

/// Returns the number of the bucket for an address and a purpose. A user of IPv6 has 2^64 addresses, so all addresses
/// of a network share one bucket.
pub(in crate::domain) fn bucket_id(address: Option<IpAddr>, what: &str) -> i64 {
    let network = address.map(|address| match address.to_canonical() {
        IpAddr::V6(address) => Ipv6Addr::from_bits(address.to_bits() >> 64 << 64).into(),
        address @ IpAddr::V4(_) => address,
    });
    let mut hasher = DefaultHasher::new();
    (network, what).hash(&mut hasher);
    // Accounts have positive numbers, so negative ones are free for addresses.
    -hasher.finish().cast_signed().saturating_abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_bucket_empties_and_fills_for_each_account() {
        let throttle = Throttle::default();
        let start = Instant::now();
        let passed = (0..20).filter(|_| throttle.try_acquire(1, 12, start)).count();
        assert_eq!(passed, 12);
        assert!(throttle.try_acquire(2, 12, start), "another account has its own");
        assert!(!throttle.try_acquire(1, 12, start + Duration::from_secs(4)));
        assert!(throttle.try_acquire(1, 12, start + Duration::from_secs(9)));
        assert!(!throttle.try_acquire(1, 12, start + Duration::from_secs(9)));
        throttle.return_token(1);
        assert!(throttle.try_acquire(1, 12, start + Duration::from_secs(9)));
    }
}
