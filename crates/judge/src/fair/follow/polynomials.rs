//! What a step's polynomials are charged for.
use super::{Deferred, Follower, Seen};
use crate::{
    fair::{
        compare::{Match, Mismatch, compare, fits_with_no_factor, possible_factors},
        formulas::{BoundedPairMotion, Expected},
        step_judgement::Pending,
    },
    finding::{Finding, FindingDetail, PolynomialPlace, Role},
};
use fosssim_model::sim::{Pair, PairKind};
use fosssim_num::polynomial::{MAX_COEFFICIENTS, Polynomial};

fosssim_model::drops_leading!();

impl Follower<'_> {
    /// Compares a pair's logged polynomials, which begin at `index`, with what they should be. Whether they are right as far as
    /// the place of the particles is known.
    pub(super) fn review(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], index: usize, count: usize) -> bool {
        let bounds = self.sensitivity.and_then(|known| known.passes.get(self.pass.index as usize));
        let motion = |q_end: &[f64], bounds: Option<&Vec<f64>>| {
            let motion = BoundedPairMotion::of(self.context.scene, pair, q_start, q_end);
            bounds.map_or(motion, |bounds| motion.widened(self.context.particles(pair), bounds))
        };
        let mut seen = motion(q_end, bounds);
        let mut expected = seen.polynomials();
        let log = &self.records.end.polynomials;
        let hints: [_; PairKind::MOST_POLYNOMIALS] = std::array::from_fn(|number| self.hints(pair.kind, number));
        let matches = |expected: &Expected| -> [Result<Match, Mismatch>; 4] {
            std::array::from_fn(|number| {
                if number >= count {
                    return Ok(Match { scale: None, share: 0.0 });
                }
                let (own, logged) = (expected.polynomial(number), log.get(index + number));
                // Where there is another form, nobody asks what is wrong with this one.
                if expected.other_form(number).is_some() && fits_with_no_factor(own, logged) {
                    return Err(Mismatch::TooLong);
                }
                compare(own, logged, &hints[number])
            })
        };
        let mut results = matches(&expected);
        if results.iter().any(Result::is_err)
            && let Some(known) = self.known_positions()
        {
            let other_motion = motion(known, None);
            let other = other_motion.polynomials();
            let others = matches(&other);
            if others.iter().filter(|result| result.is_err()).count()
                < results.iter().filter(|result| result.is_err()).count()
            {
                (seen, expected, results) = (other_motion, other, others);
            }
        }
        let (mut has_right_approach, mut is_right) = (false, true);
        for (number, result) in results.into_iter().enumerate().take(count) {
            let place =
                PolynomialPlace { pass: self.pass, pair, role: Role::of(pair.kind, number), index: index + number };
            let mut result = result;
            // That another one of the course's form is right tells nothing new, whatever the other form says.
            let tells_nothing = result.is_ok() && self.judged.course_form.is_some();
            if let Some(right) = expected.other_form(number).filter(|_| !tells_nothing) {
                let other = compare(right, log.get(place.index), &hints[number]);
                match (&result, &other) {
                    (Ok(_), Err(_)) => self.judged.course_form = self.judged.course_form.or(Some(place)),
                    (Err(_), Ok(_)) => {
                        self.judged.right_form = self.judged.right_form.or(Some(place));
                        expected = expected.with_right_approach();
                        has_right_approach = true;
                    }
                    _ => {}
                }
                result = result.or(other);
            }
            match result {
                Ok(Match { scale, share }) => {
                    self.judged.shares.coefficient = self.judged.shares.coefficient.max(share);
                    if let Some(scale) = scale {
                        self.factors[pair.kind][number] = Some(scale);
                        self.judged.scale(pair.kind, number, scale);
                    }
                }
                Err(mismatch) => {
                    let tells_no_factor = possible_factors(expected.polynomial(number), log.get(place.index)).is_some();
                    if tells_no_factor {
                        let is_reached = self.known_positions().is_some() || !self.spoilt[self.part()];
                        let is_certain = self.known_positions().is_some() || is_reached && !self.is_moved(pair);
                        self.deferred.extend(is_certain.then_some(Deferred { place, number, expected }));
                        is_right &= is_reached;
                    } else {
                        is_right = false;
                        self.charge_polynomial(place, number, &expected, mismatch);
                    }
                }
            }
        }
        self.seen = Some(Seen { motion: seen, has_right_approach });
        is_right
    }

    /// The factors that a polynomial may have which does not tell its own: that of the same polynomial of another pair of its
    /// kind, or 1. Factors of other polynomials vouch for nothing.
    fn hints(&self, kind: PairKind, number: usize) -> [f64; 2] {
        [self.factors[kind][number].unwrap_or(1.0), 1.0]
    }

    /// Judges what does not tell its factor by those of the same polynomial of other pairs.
    pub(super) fn settle_deferred(&mut self) {
        for Deferred { place, number, expected } in std::mem::take(&mut self.deferred) {
            let hints = self.hints(place.pair.kind, number);
            let actual = self.records.end.polynomials.get(place.index);
            let Err(mismatch) = compare(expected.polynomial(number), actual, &hints) else { continue };
            let Some(factors) = possible_factors(expected.polynomial(number), actual) else { continue };
            let detail = self.wrong_polynomial(place, number, &expected, mismatch);
            let finding = Finding { step: self.records.step, frame: self.records.frame, detail };
            self.judged.pend(Pending::new(finding, (place.pair.kind, number), factors));
        }
    }

    /// Notes that an approach polynomial which is the reference's bit for bit is of the course's form, where the two
    /// forms differ.
    pub(super) fn note_course_form(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], index: usize) {
        let number = 3;
        if pair.kind != PairKind::ParticleEdge || self.judged.course_form.is_some() {
            return;
        }
        let logged = self.records.end.polynomials.get(index + number);
        let expected = BoundedPairMotion::of(self.context.scene, pair, q_start, q_end).polynomials();
        if expected.other_form(number).is_some_and(|right| compare(right, logged, &[1.0]).is_err()) {
            let role = Role::of(pair.kind, number);
            self.judged.course_form = Some(PolynomialPlace { pass: self.pass, pair, role, index: index + number });
        }
    }

    fn charge_polynomial(&mut self, place: PolynomialPlace, number: usize, expected: &Expected, mismatch: Mismatch) {
        let part = self.part();
        let is_known = self.known_positions().is_some();
        if self.spoilt[part] && !is_known {
            // Where the particles are by now, nobody knows.
            return;
        }
        if self.is_moved(place.pair) && !is_known {
            // A formula that is known to be wrong is wrong here, too, wherever the particles are.
            if !self.wrong_formulas[place.pair.kind][number] {
                self.charge(FindingDetail::PassPositions { place });
                self.spoilt[part] = true;
            }
            return;
        }
        self.wrong_formulas[place.pair.kind][number] = true;
        self.charge(self.wrong_polynomial(place, number, expected, mismatch));
    }

    fn wrong_polynomial(
        &self,
        place: PolynomialPlace,
        number: usize,
        expected: &Expected,
        mismatch: Mismatch,
    ) -> FindingDetail {
        let actual = self.records.end.polynomials.get(place.index);
        let right: Vec<f64> = expected.polynomial(number).iter().map(|c| c.value).collect();
        let (right, shown) =
            (Polynomial::trimmed(&right), Polynomial::untrimmed(&actual[..actual.len().min(MAX_COEFFICIENTS)]));
        match mismatch {
            Mismatch::Coefficient { power, expected, actual, .. } => FindingDetail::Coefficient {
                place,
                power,
                expected,
                actual,
                residual: (actual - expected).abs(),
                rescaled: None,
                expected_polynomial: right,
                actual_polynomial: shown,
            },
            Mismatch::TooLong => {
                FindingDetail::PolynomialDegree { place, expected: right, actual_size: actual.len(), actual: shown }
            }
        }
    }

    /// The place of the call's first polynomial.
    pub(super) fn place(&self, pair: Pair) -> PolynomialPlace {
        let index = self.next.map_or(0, |next| next - pair.kind.polynomials());
        PolynomialPlace { pass: self.pass, pair, role: Role::Overlap, index }
    }
}
