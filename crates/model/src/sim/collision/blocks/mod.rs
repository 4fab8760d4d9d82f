//! A detection pass whose polynomials only have to be logged: several pairs of one kind at a time, in lanes.
//!
//! Every formula is the pair's own, evaluated in the same order, and every lane rounds like a single number;
//! polynomials, decisions and counts are therefore those of [`super::pass`] bit for bit, however pairs are put
//! together. Where inputs are so large that a NaN could arise, or are one, there are no blocks.
//!
//! `lists` holds what lanes are loaded from, `group` computes blocks of pairs, `rows` goes through them in the order of
//! the trace, `settle` decides about single ones and writes them.
mod group;
mod lists;
mod rows;
mod settle;

use super::super::{
    bodies::Bodies, observer::Impulse, pairs::PassCursor, polynomial_bytes::PolynomialBytes, search::SearchCounts,
    step_error::StepError,
};
use fosssim_num::lanes::Instructions;
use group::Group;
use lists::{Lists, RefreshedBody};
use rows::Pairs;

/// The inputs of a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setting<'a> {
    /// The scene's constants.
    pub bodies: &'a Bodies,
    /// Number of the step, from 1.
    pub step: u32,
    /// Positions at the start of the step.
    pub q_start: &'a [f64],
    /// Displacements within the step, after the responses so far.
    pub displacements: &'a [f64],
}

/// Processes the pairs of passes; keeps its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Blocks {
    /// The instructions that suit the scene, once it is known.
    instructions: Option<Instructions>,
    /// Steps of the scene.
    steps: u32,
    lists: Lists,
    group: Group,
}

impl Blocks {
    /// Creates the blocks for a scene with this many steps.
    pub fn new(steps: u32) -> Self {
        Self { steps, ..Self::default() }
    }

    /// Prepares a pass. Returns false if pairs have to be computed one by one.
    pub fn prepare(&mut self, setting: Setting<'_>) -> bool {
        self.group.clear();
        self.lists.prepare(setting)
    }

    /// Takes over the displacements of these particles. Returns false if the rest has to be computed one by one.
    pub fn refresh(&mut self, setting: Setting<'_>, moved: [usize; 3]) -> bool {
        // Fixed particles stay, and so do all results about them.
        moved.into_iter().all(|particle| match self.lists.refresh(setting, particle) {
            RefreshedBody::Same => true,
            RefreshedBody::Moved { is_end } => {
                self.group.spoil(particle, is_end);
                true
            }
            RefreshedBody::TooLarge => false,
        })
    }

    /// Advances to the next hit and past it; to the end if there is none. Polynomials are appended to `bytes`.
    ///
    /// # Errors
    /// [`StepError::RootSearch`]
    pub fn next_hit(
        &mut self,
        setting: Setting<'_>,
        place: &mut PassCursor,
        counts: &mut SearchCounts,
        bytes: Option<&mut PolynomialBytes>,
    ) -> Result<Option<Impulse>, StepError> {
        let Self { instructions, steps, lists, group } = self;
        let pairs = || u64::from(*steps).saturating_mul(setting.bodies.pairs() as u64);
        let instructions = instructions.get_or_insert_with(|| Instructions::for_pairs(pairs()));
        instructions.run(Pairs { lists, group, setting, place, counts, bytes })
    }
}

#[cfg(test)]
mod tests;
