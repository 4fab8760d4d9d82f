//! The blocks of a scene's records, and the number of records.
use crate::{assignments::ImpulseList, scene::Scene};

/// The structure of a scene's traces (trace-format.md 1, 2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Layout {
    /// The number of particles N.
    pub particles: usize,
    /// Whether records contain an impulse list (`simple`, `continuous-time`, `hybrid`).
    pub has_impulses: bool,
    /// Whether records contain polynomials and each step has a mid record (`continuous-time`, `hybrid`).
    pub has_polynomials: bool,
    /// The number of steps.
    pub steps: u32,
}

impl Layout {
    /// Returns the layout of the traces of `scene`.
    pub fn for_scene(scene: &Scene) -> Self {
        let records = scene.collision.handling().records;
        let (impulses, polynomials) = (records.impulses != ImpulseList::Absent, records.has_polynomials);
        Self {
            particles: scene.particles.len(),
            has_impulses: impulses,
            has_polynomials: polynomials,
            steps: scene.step_count(),
        }
    }

    /// Returns the number of bytes of positions and velocities, 32 N.
    pub const fn state_bytes(&self) -> usize {
        32 * self.particles
    }

    /// Returns the number of records per step: 2 with a mid record, otherwise 1.
    pub const fn records_per_step(&self) -> u32 {
        if self.has_polynomials { 2 } else { 1 }
    }

    /// Returns the number of records of a complete trace, including the initial one.
    pub fn records(&self) -> u64 {
        1 + u64::from(self.records_per_step()) * u64::from(self.steps)
    }

    /// Returns whether a trace of `bytes` bytes contains only a state for each step although records of this layout
    /// contain more. Programs whose library has no collisions write such traces.
    pub fn is_states_only(&self, bytes: u64) -> bool {
        let more = self.has_impulses || self.has_polynomials;
        more && self.particles > 0 && bytes == (1 + u64::from(self.steps)) * self.state_bytes() as u64
    }

    /// Returns the step of record `record`, from 1, or 0 for the initial record.
    pub fn step_of_record(&self, record: u64) -> u32 {
        u32::try_from(record.div_ceil(u64::from(self.records_per_step()))).unwrap_or(u32::MAX)
    }

    /// Returns whether record `record` is a mid record, i.e. not the last one of its step.
    pub fn is_mid_record(&self, record: u64) -> bool {
        self.has_polynomials && record % 2 == 1
    }

    /// Returns the number of the end record of step `step`; 0 is the initial record.
    pub fn end_record(&self, step: u32) -> u64 {
        u64::from(self.records_per_step()) * u64::from(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_and_steps_correspond() {
        let layout = Layout { particles: 1, has_impulses: true, has_polynomials: true, steps: 3 };
        assert_eq!((0..layout.records()).map(|r| layout.step_of_record(r)).collect::<Vec<_>>(), [0, 1, 1, 2, 2, 3, 3]);
        assert_eq!((0..3).map(|r| layout.is_mid_record(r)).collect::<Vec<_>>(), [false, true, false]);
        assert_eq!(layout.end_record(3), 6);
        let layout = Layout { has_polynomials: false, ..layout };
        assert_eq!((0..layout.records()).map(|r| layout.step_of_record(r)).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert!(!layout.is_mid_record(1));
        assert!(layout.is_states_only(4 * 32) && !layout.is_states_only(4 * 32 + 8));
        assert!(!Layout { has_impulses: false, ..layout }.is_states_only(4 * 32), "that is all that there should be");
    }
}
