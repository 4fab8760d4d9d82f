//! Counts a step's logged detection passes, and finds the positions that they provably used.
use super::Follower;
use crate::finding::{FindingDetail, Part};
use fosssim_model::{
    scene::Collision,
    sim::{Pair, Stage},
};

impl<'a> Follower<'a> {
    /// Counts the logged passes before and after the mid record.
    pub(super) fn count_passes(&mut self) {
        let (Some(mid), per_pass) = (self.records.mid, self.context.polynomials_per_pass) else { return };
        let (before, total) = (mid.polynomials.len(), self.records.end.polynomials.len());
        if per_pass == 0 {
            return;
        }
        let before = if self.is_hybrid() { before } else { total };
        let are_whole_passes = before.is_multiple_of(per_pass) && total.is_multiple_of(per_pass) && before <= total;
        self.logged_passes = are_whole_passes.then(|| [before / per_pass, (total - before) / per_pass]);
    }

    /// Compares the numbers of passes.
    pub(super) fn compare_pass_counts(&mut self) {
        let Some(_) = self.records.mid else { return };
        if self.context.polynomials_per_pass == 0 && self.records.end.polynomials.is_empty() {
            return;
        }
        let Some(logged) = self.logged_passes else {
            let (expected, actual) = (
                (self.passes[0] + self.passes[1]) * self.context.polynomials_per_pass,
                self.records.end.polynomials.len(),
            );
            self.add_finding(FindingDetail::PolynomialCount {
                expected,
                actual,
                per_pass: self.context.polynomials_per_pass,
            });
            self.has_error[1] = true;
            return;
        };
        for (index, part) in [Part::Impulses, Part::Geometric].into_iter().enumerate() {
            // An error in the first part may decide whether the geometric part runs, so another finding would have the
            // same cause.
            let follows = index == 1 && self.has_error[0];
            if logged[index] != self.passes[index] {
                if !self.has_error[index] && !follows {
                    self.add_finding(FindingDetail::PassCount {
                        part,
                        expected: self.passes[index],
                        actual: logged[index],
                    });
                }
                self.has_error[index] = true;
                self.has_error[1] = true;
            }
        }
    }

    pub(super) fn is_hybrid(&self) -> bool {
        matches!(self.context.scene.collision, Collision::Hybrid { .. })
    }

    /// Returns 1 for the geometric stage, otherwise 0.
    pub(super) fn stage_index(&self) -> usize {
        usize::from(matches!(self.pass.stage, Stage::Geometric { .. }))
    }

    /// Returns the positions at the end of the motion that this pass checks, if the trace contains them. Returns `None`
    /// if the trace does not prove which positions the pass uses.
    pub(super) fn known_positions(&self) -> Option<&'a [f64]> {
        let [before, after] = self.logged_passes?;
        let number = self.passes[self.stage_index()];
        match self.pass.stage {
            Stage::Impulses { .. } if number == before && after == 0 => Some(&self.records.mid?.state.positions),
            Stage::Geometric { .. } if number == after => Some(&self.records.end.state.positions),
            _ => None,
        }
    }

    /// Returns whether a response or the failsafe has moved an object of the pair.
    pub(super) fn is_moved(&self, pair: Pair) -> bool {
        self.context.particles(pair).into_iter().flatten().any(|particle| self.moved_particles[particle])
    }
}
