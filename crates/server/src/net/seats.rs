//! Places for connections. When all are taken, or an address has its share, anybody who comes takes the place of a
//! connection that waits: that has sent no whole request, or none since its last answer. Those lose nothing but time.
use std::{
    collections::{BTreeMap, HashMap},
    net::IpAddr,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};
use tokio_util::sync::CancellationToken;

/// All places.
#[derive(Clone)]
pub(super) struct Seats {
    most: usize,
    plan: Arc<Mutex<SeatPlan>>,
}

/// The connections by address.
#[derive(Default)]
struct SeatPlan {
    /// Numbers connections, and tells who waits longest.
    next: u64,
    taken: usize,
    addresses: HashMap<IpAddr, Guests>,
}

/// The connections of an address.
#[derive(Default)]
struct Guests {
    taken: usize,
    /// Those that wait, longest first, and how to end them.
    waiting: BTreeMap<u64, CancellationToken>,
}

/// A connection's place, until it is dropped.
pub(super) struct Seat {
    address: IpAddr,
    cut: CancellationToken,
    /// The number by which it waits; 0 where it does not.
    waits: AtomicU64,
    seats: Seats,
}

impl Seats {
    pub(super) fn new(most: usize) -> Self {
        Self { most, plan: Arc::default() }
    }

    /// The most places of an address: half of them, so that others have the rest.
    pub(super) fn share(&self) -> usize {
        self.most / 2
    }

    fn plan(&self) -> MutexGuard<'_, SeatPlan> {
        self.plan.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A place, if one is free or can be had from somebody who waits. A proxy speaks for many, and has no share.
    pub(super) fn take(&self, address: IpAddr, is_proxy: bool) -> Option<Seat> {
        let mut plan = self.plan();
        let own = plan.addresses.get(&address).map_or(0, |guests| guests.taken);
        if !is_proxy && own >= self.share() && !plan.cut(address) {
            return None;
        }
        if plan.taken >= self.most && !plan.cut_of_the_many() {
            return None;
        }
        let cut = CancellationToken::new();
        let number = plan.next();
        plan.taken += 1;
        let guests = plan.addresses.entry(address).or_default();
        guests.taken += 1;
        guests.waiting.insert(number, cut.clone());
        drop(plan);
        Some(Seat { address, cut, waits: AtomicU64::new(number), seats: self.clone() })
    }

    /// Ends the connection that waits longest, of the address that has most of those.
    pub(super) fn cut_one(&self) {
        self.plan().cut_of_the_many();
    }

    /// Ends all connections that wait.
    pub(super) fn cut_waiting(&self) {
        while self.plan().cut_of_the_many() {}
    }
}

impl SeatPlan {
    fn next(&mut self) -> u64 {
        self.next += 1;
        self.next
    }

    /// Ends the connection of an address that waits longest; whether there was one. Its place is free at once.
    fn cut(&mut self, address: IpAddr) -> bool {
        let Some(guests) = self.addresses.get_mut(&address) else { return false };
        let Some((_, cut)) = guests.waiting.pop_first() else { return false };
        cut.cancel();
        guests.taken -= 1;
        self.taken -= 1;
        true
    }

    fn cut_of_the_many(&mut self) -> bool {
        let many = self.addresses.iter().max_by_key(|(_, guests)| guests.waiting.len());
        many.map(|(address, _)| *address).is_some_and(|address| self.cut(address))
    }
}

impl Seat {
    /// Cancelled when its place was given away.
    pub(super) fn cut(&self) -> CancellationToken {
        self.cut.clone()
    }

    /// It has sent a whole request: its place is its own.
    pub(super) fn asked(&self) {
        let mut plan = self.seats.plan();
        if let Some(guests) = plan.addresses.get_mut(&self.address) {
            guests.waiting.remove(&self.waits.swap(0, Ordering::Relaxed));
        }
    }

    /// It was answered, and waits.
    pub(super) fn answered(&self) {
        let mut plan = self.seats.plan();
        if self.cut.is_cancelled() {
            return;
        }
        let number = plan.next();
        if let Some(guests) = plan.addresses.get_mut(&self.address) {
            guests.waiting.insert(number, self.cut.clone());
            self.waits.store(number, Ordering::Relaxed);
        }
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.asked();
        let mut plan = self.seats.plan();
        // A connection that was cut gave the place up then.
        let left = !self.cut.is_cancelled();
        plan.taken -= usize::from(left);
        if let Some(guests) = plan.addresses.get_mut(&self.address) {
            guests.taken -= usize::from(left);
            if guests.taken == 0 {
                plan.addresses.remove(&self.address);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(last: u8) -> IpAddr {
        IpAddr::from([10, 0, 0, last])
    }

    #[test]
    fn who_asks_for_nothing_gives_its_place_away() {
        let seats = Seats::new(8);
        let (flood, other) = (address(1), address(2));
        let mut half_open: Vec<Seat> = (0..4).map(|_| seats.take(flood, false).expect("a place")).collect();
        // Four of eight are its share: the fifth takes the first one's place.
        half_open.push(seats.take(flood, false).expect("a place"));
        assert!(half_open[0].cut().is_cancelled() && !half_open[1].cut().is_cancelled());
        let asked = seats.take(other, false).expect("a place");
        asked.asked();
        let more: Vec<Seat> = (3..6).map(|last| seats.take(address(last), false).expect("a place")).collect();
        // All eight are taken: another address gets one of those who have most.
        let late = seats.take(address(9), false).expect("a place");
        assert!(half_open[1].cut().is_cancelled());
        assert!(!asked.cut().is_cancelled() && more.iter().all(|seat| !seat.cut().is_cancelled()));
        drop((half_open, more, late, asked));
        assert_eq!(seats.plan().taken, 0);
        assert!(seats.plan().addresses.is_empty());
    }

    #[test]
    fn who_is_being_answered_is_never_cut() {
        let seats = Seats::new(4);
        let busy: Vec<Seat> = (0..2).map(|_| seats.take(address(1), false).expect("a place")).collect();
        busy.iter().for_each(Seat::asked);
        assert!(seats.take(address(1), false).is_none(), "its share is taken");
        assert!(seats.take(address(1), true).is_some(), "a proxy has no share");
        busy[0].answered();
        let next = seats.take(address(1), false).expect("the place of the one that was answered");
        assert!(busy[0].cut().is_cancelled() && !busy[1].cut().is_cancelled());
        busy[0].answered();
        drop(busy);
        next.asked();
        drop(next);
        assert_eq!(seats.plan().taken, 0);
    }
}
