//! Judges a step's polynomials.
use super::{CallMotion, Follower};
use crate::{
    fair::{
        compare::{Match, Mismatch, compare, shows_factor},
        formulas::{BoundedPairMotion, ExpectedPolynomials},
        polynomial::{LoggedPolynomial, PolynomialJudgment, compare_first, wrong_polynomial_finding},
    },
    finding::{FindingDetail, PolynomialPlace, Role},
};
use fosssim_model::sim::{Pair, PairKind};
use fosssim_num::bounded::BoundedValue;

/// The comparison of each polynomial of a call. The rest of the array is unused.
type PolynomialComparisons = [Result<Match, Mismatch>; PairKind::MAX_POLYNOMIALS];

impl<'a> Follower<'a> {
    /// Compares a pair's logged polynomials, which begin at `index`, with the expected ones. Returns whether all are
    /// right. A polynomial that depends on the program's factor counts as right if the particles' positions are known.
    pub(super) fn review(
        &mut self,
        pair: Pair,
        [q_start, q_end]: [&[f64]; 2],
        index: usize,
        quick_matches: &[Option<Match>],
    ) -> bool {
        let count = quick_matches.len();
        // The first approach polynomial that shows its form is compared with bounds.
        let is_form_known = pair.kind != PairKind::ParticleEdge || self.judgment.course_form.is_some();
        if is_form_known && quick_matches.iter().all(Option::is_some) {
            for (number, found) in quick_matches.iter().flatten().enumerate() {
                self.judgment.add_share_and_factor(pair.kind, number, found);
            }
            return true;
        }
        let bounds = self.sensitivity.and_then(|known| known.passes.get(self.pass.index as usize));
        let motion = |q_end: &[f64], bounds: Option<&Vec<f64>>| {
            let motion = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end);
            bounds.map_or(motion, |bounds| motion.widen(self.context.particles(pair), bounds))
        };
        let mut bounded_motion = motion(q_end, bounds);
        let mut expected = bounded_motion.polynomials();
        let matches = |expected: &ExpectedPolynomials, quick_matches: &[Option<Match>]| -> PolynomialComparisons {
            std::array::from_fn(|number| match quick_matches.get(number) {
                None => Ok(Match { scale: None, tolerance_share: 0.0 }),
                Some(Some(found)) => Ok(*found),
                Some(None) => compare_first(&self.judgment, expected, &self.logged_polynomial(pair, index, number)),
            })
        };
        let mut results = matches(&expected, quick_matches);
        if results.iter().any(Result::is_err)
            && let Some(known) = self.known_positions()
        {
            let other_motion = motion(known, None);
            let other = other_motion.polynomials();
            let others = matches(&other, &[None; PairKind::MAX_POLYNOMIALS][..count]);
            if others.iter().filter(|result| result.is_err()).count()
                < results.iter().filter(|result| result.is_err()).count()
            {
                (bounded_motion, expected, results) = (other_motion, other, others);
            }
        }
        let (mut has_right_approach, mut is_right) = (false, true);
        for (number, result) in results.into_iter().enumerate().take(count) {
            let logged = self.logged_polynomial(pair, index, number);
            let is_known = self.known_positions().is_some()
                || result.is_err() && self.is_proven(&expected, &results, pair, index, number);
            // After an error that moves the particles, their positions are unknown.
            let is_reached = is_known || !self.has_error[self.stage_index()];
            let pended = self.judgment.pending_count();
            let judgment = self.judgment.record_evidence(&expected, &logged, result, is_reached);
            let is_pending = self.judgment.pending_count() > pended;
            match judgment {
                PolynomialJudgment::Right => {}
                PolynomialJudgment::RightForm => has_right_approach = true,
                PolynomialJudgment::DependsOnFactor => {
                    has_right_approach |= expected.other_form(number).is_some() && self.judgment.right_form.is_some();
                    is_right &= is_reached;
                }
                PolynomialJudgment::Wrong(mismatch) => {
                    is_right = false;
                    self.report_wrong_polynomial(&logged, &expected, mismatch, is_known);
                }
            }
            // Positions after a response have the round-off of the response.
            self.judgment.has_finding_after_response |=
                self.is_moved(pair) && (is_pending || matches!(judgment, PolynomialJudgment::Wrong(_)));
        }
        self.call.motion = Some(CallMotion { motion: bounded_motion, has_right_approach });
        is_right
    }

    /// Returns polynomial `number` of a call whose first polynomial is at `index`.
    fn logged_polynomial(&self, pair: Pair, index: usize, number: usize) -> LoggedPolynomial<'a> {
        let (role, index) = (Role::from_number(pair.kind, number), index + number);
        let place = PolynomialPlace { pass: self.pass, pair, role, index };
        LoggedPolynomial { place, number, coefficients: self.records.end.polynomials.get(index) }
    }

    /// Returns whether another polynomial of the pair that comes from the same coordinates is right, so that the pair
    /// has the right position. The polynomials of overlap and approach depend on the distance of the objects. The other
    /// two polynomials of a particle and an edge depend on the position along the edge.
    fn is_proven(
        &self,
        expected: &ExpectedPolynomials,
        results: &PolynomialComparisons,
        pair: Pair,
        index: usize,
        number: usize,
    ) -> bool {
        let other = match pair.kind {
            PairKind::ParticleEdge => 3 - number,
            PairKind::ParticleParticle | PairKind::ParticleHalfPlane => 1 - number,
        };
        let list = self.logged_polynomial(pair, index, other).coefficients;
        let proves = |expected: &[BoundedValue], result: Result<Match, Mismatch>| {
            result.is_ok_and(|found| found.scale.is_some()) && shows_factor(expected, list)
        };
        proves(expected.polynomial(other), results[other])
            || expected.other_form(other).is_some_and(|right| proves(right, compare(right, list, &[1.0])))
    }

    fn report_wrong_polynomial(
        &mut self,
        logged: &LoggedPolynomial<'_>,
        expected: &ExpectedPolynomials,
        mismatch: Mismatch,
        is_known: bool,
    ) {
        let (stage, kind, number) = (self.stage_index(), logged.place.pair.kind, logged.number);
        if !is_known {
            if self.has_error[stage] {
                return;
            }
            if self.is_moved(logged.place.pair) {
                // A formula that is known to be wrong is wrong at all positions.
                if !self.wrong_formulas[kind][number] {
                    self.add_finding(FindingDetail::PassPositions { place: logged.place });
                    self.has_error[stage] = true;
                }
                return;
            }
        }
        self.wrong_formulas[kind][number] = true;
        self.add_finding(wrong_polynomial_finding(logged, expected.polynomial(number), mismatch));
    }

    /// Records the form of an approach polynomial that is identical to the reference's.
    pub(super) fn record_course_form(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], index: usize) {
        if pair.kind == PairKind::ParticleEdge && self.judgment.course_form.is_none() {
            let expected = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end).polynomials();
            self.judgment.record_course_form(&expected, &self.logged_polynomial(pair, index, 3));
        }
    }

    /// Returns the pass, pair and index of the call's first polynomial.
    pub(super) fn call_place(&self, pair: Pair) -> PolynomialPlace {
        let index = self.next_polynomial.map_or(0, |next| next - pair.kind.polynomial_count());
        PolynomialPlace { pass: self.pass, pair, role: Role::Overlap, index }
    }
}
