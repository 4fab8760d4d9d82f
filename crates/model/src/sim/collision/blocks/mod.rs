//! A detection pass whose polynomials are only logged: several pairs of one kind at a time, in lanes.
//!
//! Every formula is the pair's own, evaluated in the same order, and every lane rounds like a single number.
//! Polynomials, decisions and counts are therefore identical to those of [`super::pass`], regardless of the grouping.
//! If inputs are NaN, or so large that a NaN could result, no blocks are used.
//!
//! `lists` holds the numbers from which lanes are loaded, `group` computes blocks of pairs, `rows` visits them in the
//! order of the trace, and `row_decision` decides single pairs and writes their polynomials.
mod group;
mod lists;
mod row_decision;
mod rows;

use super::super::{
    bodies::Bodies, observer::Impulse, pairs::PassCursor, polynomial_bytes::PolynomialBytes, search::SearchCounts,
    step_error::StepError,
};
use fosssim_num::lanes::Instructions;
use group::PairGroup;
use lists::{Lists, RefreshResult};
use rows::HitSearch;

/// The inputs of a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct PassInput<'a> {
    /// The constants of the scene.
    pub bodies: &'a Bodies,
    /// The number of the step, from 1.
    pub step: u32,
    /// The positions at the start of the step.
    pub q_start: &'a [f64],
    /// The displacements within the step, after the responses so far.
    pub displacements: &'a [f64],
}

/// Processes the pairs of passes, and reuses its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Blocks {
    /// The processor instructions for the scene, `None` until they are chosen.
    instructions: Option<Instructions>,
    /// The number of steps of the scene.
    steps: u32,
    lists: Lists,
    group: PairGroup,
}

impl Blocks {
    /// Creates the blocks for a scene with `steps` steps.
    pub fn new(steps: u32) -> Self {
        Self { steps, ..Self::default() }
    }

    /// Prepares a pass. Returns false if pairs have to be computed one by one.
    pub fn prepare(&mut self, input: PassInput<'_>) -> bool {
        self.group.clear();
        self.lists.prepare(input)
    }

    /// Copies the displacements of `moved`. Returns false if the remaining pairs must be computed one by one.
    pub fn refresh(&mut self, input: PassInput<'_>, moved: [usize; 3]) -> bool {
        // Fixed particles do not move, so all results about them are kept.
        moved.into_iter().all(|particle| match self.lists.refresh(input, particle) {
            RefreshResult::Same => true,
            RefreshResult::Moved { is_end } => {
                self.group.invalidate(particle, is_end);
                true
            }
            RefreshResult::TooLarge => false,
        })
    }

    /// Advances past the next hit, or to the end if there is none. Polynomials are appended to `bytes`.
    ///
    /// # Errors
    /// Fails with [`StepError::RootSearch`] if a root search would never end.
    pub fn find_next_hit(
        &mut self,
        input: PassInput<'_>,
        cursor: &mut PassCursor,
        counts: &mut SearchCounts,
        bytes: Option<&mut PolynomialBytes>,
    ) -> Result<Option<Impulse>, StepError> {
        let Self { instructions, steps, lists, group } = self;
        let pairs = || u64::from(*steps).saturating_mul(input.bodies.estimate_pair_count() as u64);
        let instructions = instructions.get_or_insert_with(|| Instructions::for_pairs(pairs()));
        instructions.run(HitSearch { lists, group, input, cursor, counts, bytes })
    }
}

#[cfg(test)]
mod tests;
