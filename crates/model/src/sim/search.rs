//! Root searches: whether they may be left out, and how many there were.

/// Whether a certificate may stand in for a root search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RootSearch {
    /// Search only where no certificate excludes an impact. The traces are the same.
    #[default]
    WhereNeeded,
    /// Always search.
    Always,
    /// Search always, ask the certificate too, and count where they disagree.
    Audit,
}

/// Counts of the root searches so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SearchCounts {
    /// Detection calls.
    pub calls: u64,
    /// Calls whose roots were searched.
    pub searched: u64,
    /// Calls excluded by a certificate.
    pub excluded: u64,
    /// Audit only: a certificate excluded an impact that the root finder found. Must stay zero.
    pub disagreements: u64,
    /// Steps of root searches that led to no zero ([`Zeros::fruitless`](fosssim_num::rpoly::Zeros::fruitless)).
    pub fruitless: u64,
}

impl SearchCounts {
    /// What these calls cost, counted in calls that a certificate excludes. It is the same on every machine.
    #[must_use]
    pub const fn work(&self) -> u64 {
        self.calls + SEARCH_WORK * self.searched + self.fruitless
    }
}

impl std::ops::AddAssign for SearchCounts {
    fn add_assign(&mut self, other: Self) {
        self.calls += other.calls;
        self.searched += other.searched;
        self.excluded += other.excluded;
        self.disagreements += other.disagreements;
        self.fruitless += other.fruitless;
    }
}

/// What was counted since `before`.
impl std::ops::Sub for SearchCounts {
    type Output = Self;
    fn sub(self, before: Self) -> Self {
        Self {
            calls: self.calls - before.calls,
            searched: self.searched - before.searched,
            excluded: self.excluded - before.excluded,
            disagreements: self.disagreements - before.disagreements,
            fruitless: self.fruitless - before.fruitless,
        }
    }
}

/// A root search takes as long as so many detection calls without one.
const SEARCH_WORK: u64 = 16;
