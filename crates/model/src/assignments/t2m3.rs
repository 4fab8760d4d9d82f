//! Theme 2, Milestone 3: the contest, a penalty force between many bodies that finds its pairs fast (simulation.md 3).
use super::{Definition, Dropping};

/// It brings no collision type: its scenes are `penalty` scenes with the contest's detection.
pub(super) const DEFINITION: Definition = Definition {
    key: "t2m3",
    title: "Theme 2, Milestone 3",
    handlings: &[],
    pairs: &[],
    dropping: Dropping::Leading,
    version: "Fall 2010 v.A",
    verdict: "Hybrid Collisions Passed",
    tells_times: true,
};
