//! The author of a program, with the mistakes made in it.
use super::{Area, Mistake, StepMistake};

/// The author of a program, who makes one mistake, none, or several in different parts of the assignment.
#[derive(Debug, Clone, Copy, Default)]
pub struct Student {
    mistakes: [Option<Mistake>; Student::MAX_MISTAKES],
    /// The areas of the mistakes, one bit each. Most queries are about areas without a mistake.
    areas: u64,
    /// Whether one of the mistakes is a slip in a quantity ([`StepMistake::Edit`]).
    pub(super) has_slips: bool,
    uses_right_approach: bool,
}

impl Student {
    /// The maximum number of mistakes of one student.
    pub const MAX_MISTAKES: usize = 8;

    /// Creates a student with an optional mistake.
    pub fn new(mistake: Option<Mistake>) -> Self {
        Self::default().with_mistake(mistake)
    }

    /// Returns the student with a further mistake. If two mistakes concern the same formula or rule, only the first is
    /// made. A student with [`Student::MAX_MISTAKES`] mistakes stays unchanged.
    #[must_use]
    pub fn with_mistake(mut self, mistake: Option<Mistake>) -> Self {
        if let Some(free) = self.mistakes.iter_mut().find(|slot| slot.is_none()) {
            *free = mistake;
            self.areas |= mistake.map_or(0, |mistake| area_bit(mistake.area()));
            self.has_slips |= matches!(mistake, Some(Mistake::Step(StepMistake::Edit(_))));
        }
        self
    }

    /// Returns the mistakes. In the array, free slots follow them.
    pub(super) fn mistakes(&self) -> impl Iterator<Item = Mistake> {
        self.mistakes.iter().map_while(|mistake| *mistake)
    }

    /// Returns whether the student makes `mistake`.
    pub fn makes(&self, mistake: impl Into<Mistake>) -> bool {
        let mistake = mistake.into();
        self.mistakes().any(|made| made == mistake)
    }

    /// Returns whether the student makes no mistake of the catalog.
    pub(super) fn makes_no_mistake(&self) -> bool {
        self.mistakes[0].is_none()
    }

    /// Returns the first mistake in the first of `areas` that has one, or `None` if no area has a mistake.
    pub fn mistake_in(&self, areas: &[Area]) -> Option<Mistake> {
        let mut here = areas.iter().filter(|area| self.areas & area_bit(**area) != 0);
        here.find_map(|area| self.mistakes().find(|mistake| mistake.area() == *area))
    }

    /// Returns the student's first mistake that is among `rows`, or `None` if there is none.
    pub(super) fn mistake_among(&self, rows: &[Mistake]) -> Option<Mistake> {
        self.mistakes().find(|mistake| rows.contains(mistake))
    }

    /// Returns the student with the corrected particle-edge approach (collisions.md 2). This approach counts as correct
    /// as well, and can be combined with any mistakes.
    #[must_use]
    pub fn with_right_approach(self) -> Self {
        Self { uses_right_approach: true, ..self }
    }

    /// Returns whether the student uses the mathematically right particle-edge approach instead of the supplied one.
    pub fn has_right_approach(&self) -> bool {
        self.uses_right_approach || self.makes(Mistake::QuinticRightRearranged)
    }
}

const fn area_bit(area: Area) -> u64 {
    1 << area as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_mistakes_are_made_each_in_its_place() {
        let student = Student::new(Some(Mistake::ParticleParticleNoTwo))
            .with_mistake(Some(Mistake::ResponseSign))
            .with_mistake(None);
        assert!(student.makes(Mistake::ParticleParticleNoTwo) && student.makes(Mistake::ResponseSign));
        assert!(!student.makes(Mistake::ParticleParticleEmpty));
        assert_eq!(student.mistake_in(&[Area::Response]), Some(Mistake::ResponseSign));
        assert_eq!(student.mistake_in(&[Area::Handover, Area::ParticleParticle]), Some(Mistake::ParticleParticleNoTwo));
        assert_eq!(student.mistake_in(&[Area::Failsafe]), None);
    }
}
