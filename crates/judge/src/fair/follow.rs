//! The observer that follows a submission through one step, and charges what can't be followed.
use super::{
    compare::{Match, Mismatch, compare, possible_factors},
    contact,
    formulas::{Expected, Motion},
    judgement::row,
    probe::Sensitivity,
    step::{Context, Pending, Records, StepJudgement},
};
use crate::finding::{Detail, Finding, Part, PolynomialPlace, Role};
use fosssim_model::{
    scene::Collision,
    sim::{Decision, Detection, Impulse, Observer, Pair, PairKind, Pass, Resume, Stage, State, Time, Zone},
    trace::LoggedImpulse,
};
use fosssim_num::{
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    vector::Vec2,
};

/// A decision as it was followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    pub pair: Pair,
    pub pass: Pass,
    pub decision: Decision,
}

/// Follows one step; filled in by the simulation, read by [`super::step`].
pub(super) struct Follower<'a> {
    context: &'a Context<'a>,
    records: Records<'a>,
    /// What is known of the step's sensitivity to round-off, on a second look.
    sensitivity: Option<&'a Sensitivity>,
    /// Decisions (by number of the call) that are turned round: borderline ones, in hybrid scenes.
    flips: &'a [usize],
    /// What was found.
    pub judged: StepJudgement,
    /// All decisions of the step.
    pub decisions: Vec<Followed>,
    /// Calls of hybrid scenes whose decisions round-off may flip, in order (on a second look).
    pub borderline: Vec<usize>,
    pass: Pass,
    /// Passes so far: before the mid record, and after it.
    passes: [usize; 2],
    /// Passes in the trace; `None` where its polynomials don't come in whole passes.
    logged_passes: Option<[usize; 2]>,
    /// The number in the end record's list of the pass's next polynomial; `None` when it is not logged.
    next: Option<usize>,
    /// Particles that a response or the failsafe has moved since positions were last known.
    moved: Vec<bool>,
    /// Whether the part before the mid record, or the geometric part, has an error that its result may follow from.
    spoilt: [bool; 2],
    /// Polynomials that were wrong of known positions in this step.
    wrong_formulas: [[bool; 4]; 3],
    /// Factors of polynomials so far.
    hints: [[Option<f64>; 4]; 3],
    /// Polynomials that hold nothing but round-off, to be judged when factors are known.
    deferred: Vec<(PolynomialPlace, usize, Expected)>,
    /// Logged impulses that a decision has used.
    used: Vec<bool>,
    /// The call's decision by the reference's own polynomials, where it must be compared.
    own_decision: Option<bool>,
    /// What the call's polynomials should be.
    expected: Option<(Motion, Expected)>,
}

impl<'a> Follower<'a> {
    /// Follows the step that `records` hold.
    pub fn new(
        context: &'a Context<'a>,
        records: Records<'a>,
        sensitivity: Option<&'a Sensitivity>,
        flips: &'a [usize],
    ) -> Self {
        let judged = StepJudgement { step: records.step, frame: records.frame, ..StepJudgement::default() };
        let mut follower = Self {
            context,
            records,
            sensitivity,
            flips,
            judged,
            decisions: Vec::new(),
            borderline: Vec::new(),
            pass: Pass { stage: Stage::Simple, index: 0 },
            passes: [0; 2],
            logged_passes: None,
            next: None,
            moved: vec![false; context.scene.particles.len()],
            spoilt: [false; 2],
            wrong_formulas: [[false; 4]; 3],
            hints: [[None; 4]; 3],
            deferred: Vec::new(),
            used: vec![false; records.end.impulses.len()],
            own_decision: None,
            expected: None,
        };
        follower.count_passes();
        follower
    }

    /// Ends the step, which left the reference in `state`.
    pub fn finish(&mut self, state: &State) {
        self.settle_passes();
        self.settle_deferred();
        self.settle_impulses();
        if !self.spoilt[1] {
            let frame = self.records.frame;
            let bounds = self.sensitivity.map(|known| &known.end);
            contact::states(self.context, &mut self.judged, frame, state, &self.records.end.state, bounds);
        }
    }

    fn charge(&mut self, detail: Detail) {
        let (step, frame) = (self.records.step, self.records.frame);
        self.judged.charge(Finding { step, frame, detail });
    }

    /// How many passes are logged before the mid record and after it.
    fn count_passes(&mut self) {
        let (Some(mid), per_pass) = (self.records.mid, self.context.per_pass) else { return };
        let (before, all) = (mid.polynomials.len(), self.records.end.polynomials.len());
        if per_pass == 0 {
            return;
        }
        let is_hybrid = matches!(self.context.scene.collision, Collision::Hybrid { .. });
        let before = if is_hybrid { before } else { all };
        let whole = before.is_multiple_of(per_pass) && all.is_multiple_of(per_pass) && before <= all;
        self.logged_passes = whole.then(|| [before / per_pass, (all - before) / per_pass]);
    }

    /// Compares the numbers of passes.
    fn settle_passes(&mut self) {
        let Some(_) = self.records.mid else { return };
        if self.context.per_pass == 0 && self.records.end.polynomials.is_empty() {
            return;
        }
        let Some(logged) = self.logged_passes else {
            let (expected, actual) =
                ((self.passes[0] + self.passes[1]) * self.context.per_pass, self.records.end.polynomials.len());
            self.charge(Detail::PolynomialCount { expected, actual, per_pass: self.context.per_pass });
            self.spoilt[1] = true;
            return;
        };
        for (index, part) in [Part::Impulses, Part::Geometric].into_iter().enumerate() {
            // Whether the geometric part runs follows from what happened before.
            let follows = index == 1 && self.spoilt[0];
            if logged[index] != self.passes[index] {
                if !self.spoilt[index] && !follows {
                    self.charge(Detail::PassCount { part, expected: self.passes[index], actual: logged[index] });
                }
                self.spoilt[index] = true;
                self.spoilt[1] = true;
            }
        }
    }

    /// Judges what holds nothing but round-off by the factors of other polynomials.
    fn settle_deferred(&mut self) {
        for (place, number, expected) in std::mem::take(&mut self.deferred) {
            let (hints, count) = self.hints(row(place.pair.kind), number);
            let hints = &hints[..count];
            let actual = self.records.end.polynomials.get(place.index);
            let Err(mismatch) = compare(expected.polynomial(number), actual, hints) else { continue };
            match possible_factors(expected.polynomial(number), actual) {
                Some(factors) if self.hints[row(place.pair.kind)][number].is_none() => {
                    let detail = self.wrong_polynomial(place, number, &expected, mismatch);
                    let finding = Finding { step: self.records.step, frame: self.records.frame, detail };
                    self.judged.pending.push(Pending { finding, place: (row(place.pair.kind), number), factors });
                }
                _ => self.charge_polynomial(place, number, &expected, mismatch),
            }
        }
    }

    /// The factors that a polynomial may have which does not tell its own: that of the same polynomial of other pairs,
    /// then those of other polynomials, or 1.
    fn hints(&self, row: usize, number: usize) -> ([f64; 13], usize) {
        let mut hints = [1.0; 13];
        let mut count = 0;
        for hint in std::iter::once(self.hints[row][number]).chain(self.hints.into_iter().flatten()).flatten() {
            if !hints[..count].contains(&hint) {
                hints[count] = hint;
                count += 1;
            }
        }
        (hints, count.max(1))
    }

    /// Charges impulses that belong to no decision.
    fn settle_impulses(&mut self) {
        for index in 0..self.used.len() {
            if self.used[index] {
                continue;
            }
            let actual = self.records.end.impulses[index];
            let earlier = self.records.end.impulses[..index].iter();
            let repeats = |other: &LoggedImpulse| {
                (other.kind, other.first, other.second) == (actual.kind, actual.first, actual.second)
            };
            let detail = if earlier.clone().any(repeats) && !self.is_hybrid() {
                Detail::RepeatedCollision { actual }
            } else {
                Detail::SuperfluousCollision { actual }
            };
            self.charge(detail);
        }
    }

    fn is_hybrid(&self) -> bool {
        matches!(self.context.scene.collision, Collision::Hybrid { .. })
    }

    fn part(&self) -> usize {
        usize::from(matches!(self.pass.stage, Stage::Geometric { .. }))
    }

    /// Positions at the end of the step that this pass sees for certain, because the trace holds them.
    fn known_positions(&self) -> Option<&'a [f64]> {
        let [before, after] = self.logged_passes?;
        let number = self.passes[self.part()];
        match self.pass.stage {
            Stage::Impulses { .. } if number == before && after == 0 => Some(&self.records.mid?.state.positions),
            Stage::Geometric { .. } if number == after => Some(&self.records.end.state.positions),
            _ => None,
        }
    }

    /// Whether a response or the failsafe has moved an object of the pair.
    fn is_moved(&self, pair: Pair) -> bool {
        self.context.particles(pair).into_iter().flatten().any(|particle| self.moved[particle])
    }

    /// Compares a pair's logged polynomials, which begin at `index`, with what they should be.
    fn review(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], index: usize, count: usize) {
        let bounds = self.sensitivity.and_then(|known| known.passes.get(self.pass.index as usize));
        let motion = |q_end: &[f64], bounds: Option<&Vec<f64>>| {
            let motion = Motion::of(self.context.scene, pair, q_start, q_end);
            bounds.map_or(motion, |bounds| motion.widened(self.context.particles(pair), bounds))
        };
        let mut seen = motion(q_end, bounds);
        let mut expected = seen.polynomials();
        let log = &self.records.end.polynomials;
        let hints: [_; 4] = std::array::from_fn(|number| self.hints(row(pair.kind), number));
        let matches = |expected: &Expected| -> [Result<Match, Mismatch>; 4] {
            std::array::from_fn(|number| {
                if number >= count {
                    return Ok(Match { scale: None, share: 0.0 });
                }
                let (hints, known) = &hints[number];
                compare(expected.polynomial(number), log.get(index + number), &hints[..*known])
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
        for (number, result) in results.into_iter().enumerate().take(count) {
            let place =
                PolynomialPlace { pass: self.pass, pair, role: Role::of(pair.kind, number), index: index + number };
            let mut result = result;
            if let Some(right) = expected.other_form(number) {
                let other = compare(right, log.get(place.index), &hints[number].0[..hints[number].1]);
                match (&result, &other) {
                    (Ok(_), Err(_)) => self.judged.course_form = self.judged.course_form.or(Some(place)),
                    (Err(_), Ok(_)) => {
                        self.judged.right_form = self.judged.right_form.or(Some(place));
                        expected = expected.with_right_approach();
                    }
                    _ => {}
                }
                result = result.or(other);
            }
            match result {
                Ok(Match { scale, share }) => {
                    self.judged.shares.coefficient = self.judged.shares.coefficient.max(share);
                    if let Some(scale) = scale {
                        self.hints[row(pair.kind)][number] = Some(scale);
                        let range = &mut self.judged.scales[row(pair.kind)][number];
                        *range =
                            Some(range.map_or([scale; 2], |[low, high]| [f64::min(low, scale), f64::max(high, scale)]));
                    }
                }
                Err(mismatch) => {
                    let tells_no_factor = possible_factors(expected.polynomial(number), log.get(place.index)).is_some();
                    if tells_no_factor {
                        self.deferred.push((place, number, expected));
                    } else {
                        self.charge_polynomial(place, number, &expected, mismatch);
                    }
                }
            }
        }
        self.expected = Some((seen, expected));
    }

    /// Notes that an approach polynomial which is the reference's bit for bit is of the course's form, where the two
    /// forms differ.
    fn note_course_form(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], index: usize) {
        let number = 3;
        if pair.kind != PairKind::ParticleEdge || self.judged.course_form.is_some() {
            return;
        }
        let logged = self.records.end.polynomials.get(index + number);
        let expected = Motion::of(self.context.scene, pair, q_start, q_end).polynomials();
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
            if !self.wrong_formulas[row(place.pair.kind)][number] {
                self.charge(Detail::PassPositions { place });
                self.spoilt[part] = true;
            }
            return;
        }
        self.wrong_formulas[row(place.pair.kind)][number] = true;
        self.charge(self.wrong_polynomial(place, number, expected, mismatch));
    }

    fn wrong_polynomial(
        &self,
        place: PolynomialPlace,
        number: usize,
        expected: &Expected,
        mismatch: Mismatch,
    ) -> Detail {
        let actual = self.records.end.polynomials.get(place.index);
        let right: Vec<f64> = expected.polynomial(number).iter().map(|c| c.value).collect();
        let (right, shown) =
            (Polynomial::trimmed(&right), Polynomial::untrimmed(&actual[..actual.len().min(MAX_COEFFICIENTS)]));
        match mismatch {
            Mismatch::Coefficient { power, expected, actual, .. } => Detail::Coefficient {
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
                Detail::PolynomialDegree { place, expected: right, actual_size: actual.len(), actual: shown }
            }
        }
    }

    /// The place of the call's first polynomial.
    fn place(&self, pair: Pair) -> PolynomialPlace {
        let index = self.next.map_or(0, |next| next - pair.kind.polynomials());
        PolynomialPlace { pass: self.pass, pair, role: Role::Overlap, index }
    }

    /// Whether round-off may flip the decision of this call.
    fn is_borderline(&self, call: usize) -> bool {
        match &self.expected {
            Some((motion, expected)) => contact::is_borderline(motion, expected),
            None => self.sensitivity.is_some_and(|known| known.flipped.contains(&call)),
        }
    }

    /// The logged impulse that this decision is about.
    fn logged(&mut self, pair: Pair) -> Option<LoggedImpulse> {
        let same = |logged: &LoggedImpulse| {
            logged.kind == pair.kind.code()
                && i64::from(logged.first) == i64::from(pair.first)
                && i64::from(logged.second) == i64::from(pair.second)
        };
        let all = self.records.end.impulses.iter().enumerate();
        let (index, logged) = all.clone().find(|(index, logged)| !self.used[*index] && same(logged))?;
        self.used[index] = true;
        Some(*logged)
    }

    /// Follows a logged decision.
    fn follow(&mut self, pair: Pair, own: Decision) -> Decision {
        let call = self.decisions.len();
        let logged = self.logged(pair);
        match (own, logged) {
            (Decision::Miss { .. }, None) => own,
            (Decision::Hit { time, normal }, Some(actual)) => {
                let own = Impulse { pair, normal, time };
                let known = self.expected.as_ref().map(|(motion, expected)| (motion, expected));
                let finding = contact::hit(self.context, &self.records, known, own, &actual, &mut self.judged);
                if let Some(detail) = finding {
                    self.charge(detail);
                }
                contact::followed(actual).unwrap_or(Decision::Hit { time, normal })
            }
            (Decision::Hit { time, normal }, None) => {
                if self.is_borderline(call) {
                    self.judged.borderline(self.pass, pair, false);
                } else {
                    self.charge(Detail::MissedCollision { expected: Impulse { pair, normal, time } });
                }
                Decision::Miss { time: Time::Found(time) }
            }
            (Decision::Miss { .. }, Some(actual)) => {
                if self.is_borderline(call) {
                    self.judged.borderline(self.pass, pair, true);
                } else {
                    self.charge(Detail::SuperfluousCollision { actual });
                }
                contact::followed(actual).unwrap_or(own)
            }
        }
    }
}

impl Observer for Follower<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass;
        if matches!(pass.stage, Stage::Geometric { round: 0 }) {
            // The geometric part starts from the mid record, which is known.
            self.moved.fill(false);
        }
        let part = self.part();
        let number = self.passes[part];
        self.passes[part] += 1;
        self.next = self.logged_passes.filter(|logged| number < logged[part]).map(|logged| {
            let passes = if part == 0 { number } else { logged[0] + number };
            passes * self.context.per_pass
        });
    }

    fn solve(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        self.own_decision = None;
        self.expected = None;
        let Some(index) = self.next else { return };
        self.next = Some(index + polynomials.len());
        let records = self.records;
        let logged = |number: usize| records.end.polynomials.get(index + number);
        let same = polynomials.iter().enumerate().all(|(number, own)| {
            let (own, logged) = (own.coefficients(), logged(number));
            own.len() == logged.len() && own.iter().zip(logged).all(|(own, logged)| own.to_bits() == logged.to_bits())
        });
        if same {
            if self.sensitivity.is_some() || !self.is_hybrid() {
                // Should the decision be disputed, it must be known how far round-off may reach.
                let motion = Motion::of(self.context.scene, pair, q_start, q_end);
                self.expected = Some((motion, motion.polynomials()));
            }
            self.note_course_form(pair, q_start, q_end, index);
            return;
        }
        let findings = self.judged.total();
        self.review(pair, q_start, q_end, index, polynomials.len());
        let right = self.judged.total() == findings;
        let lost = polynomials.iter().enumerate().any(|(number, own)| own.coefficients().len() != logged(number).len());
        if right && lost {
            self.judged.lost += 1;
            self.own_decision = contact::outcome(polynomials);
        }
        // What the submission solved is what decides, even if it is wrong: a wrong polynomial is charged once.
        if (0..polynomials.len()).all(|number| contact::is_searchable(logged(number))) {
            for (number, own) in polynomials.iter_mut().enumerate() {
                *own = Polynomial::untrimmed(logged(number));
            }
        }
    }

    fn decide(&mut self, pair: Pair, decision: Decision) -> Decision {
        let call = self.decisions.len();
        let collides = matches!(decision, Decision::Hit { .. });
        if self.own_decision.is_some_and(|own| own != collides) {
            // Lost coefficients do not count as round-off: their loss is the factor's fault.
            let certain = self
                .expected
                .as_ref()
                .is_some_and(|(motion, expected)| contact::decides(motion, expected) == Some(!collides));
            if certain {
                let place = self.place(pair);
                self.charge(Detail::TrimmedDecision { place, collides: !collides });
            } else {
                self.judged.borderline(self.pass, pair, collides);
            }
        }
        let decision = match self.pass.stage {
            Stage::Simple | Stage::ContinuousTime => self.follow(pair, decision),
            Stage::Impulses { .. } | Stage::Geometric { .. } if self.flips.contains(&call) => match decision {
                Decision::Hit { time, .. } => {
                    self.judged.borderline(self.pass, pair, false);
                    Decision::Miss { time: Time::Found(time) }
                }
                Decision::Miss { .. } => {
                    self.judged.borderline(self.pass, pair, true);
                    self.expected.as_ref().map_or(decision, |(motion, expected)| {
                        let time = contact::possible_time(expected);
                        let normal = motion.normal(time);
                        Decision::Hit { time, normal: Vec2::new(normal.x.value, normal.y.value) }
                    })
                }
            },
            _ => decision,
        };
        if self.sensitivity.is_some() && self.is_hybrid() && self.is_borderline(call) {
            self.borderline.push(call);
        }
        self.decisions.push(Followed { pair, pass: self.pass, decision });
        decision
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        let collides = matches!(detection.decision, Decision::Hit { .. });
        if collides && matches!(self.pass.stage, Stage::ContinuousTime | Stage::Impulses { .. }) {
            for particle in self.context.particles(detection.pair).into_iter().flatten() {
                self.moved[particle] = true;
            }
        }
    }

    fn failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        for &particle in zone.particles {
            self.moved[particle as usize] = true;
        }
    }

    fn synchronise(&mut self, state: &mut State) -> Resume {
        let Some(mid) = self.records.mid else { return Resume::Own };
        if let Some(logged) = self.logged_passes
            && logged[0] != self.passes[0]
            && !self.spoilt[0]
        {
            self.charge(Detail::PassCount { part: Part::Impulses, expected: self.passes[0], actual: logged[0] });
            self.spoilt[0] = true;
        }
        if !self.spoilt[0] {
            let bounds = self.sensitivity.map(|known| &known.mid);
            contact::states(self.context, &mut self.judged, self.records.frame - 1, state, &mid.state, bounds);
        }
        let is_finite = mid.state.positions.iter().chain(&mid.state.velocities).all(|value| value.is_finite());
        if is_finite {
            state.positions.copy_from_slice(&mid.state.positions);
            state.velocities.copy_from_slice(&mid.state.velocities);
        }
        Resume::Synchronised
    }
}
