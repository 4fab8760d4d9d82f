//! Compares one step of the trace with the reference while the reference computes it.
//!
//! [`Tally`] is the observer of that step. It compares every polynomial with the next one of the trace's list at the
//! end of its pass. Therefore only one pass of the reference's log is stored. Findings about polynomials count only if
//! the two lists have the same length, which is known at the end of the step (oracle-behavior.md 6.2).
mod pending;

use pending::PendingFindings;

use super::{
    contacts::{Contacts, logged_key, pair_key},
    counts::FindingCounts,
    finding::{Finding, FindingDetail, FindingKind, PolynomialPlace, Role},
    parity::Residuals,
    progress::Remark,
};
use fosssim_model::{
    scene::Scene,
    sim::{Impulse, Observer, Pairs, Pass, PolynomialBytes, ResumeState, State, StepController, WantedPairs, pairs},
    trace::{LenientFrame, LoggedImpulse},
};
use fosssim_num::{
    polynomial::MAX_COEFFICIENTS,
    tolerances::{
        PARITY_COEFFICIENT_DIFFERENCE, PARITY_MAX_RESIDUAL, PARITY_NORMAL_DISTANCE, PARITY_ZERO_COEFFICIENT_SUM,
    },
    vector::{has_same_bits, length, vector_at},
};

/// Below this sum of absolute values, identical coefficients always pass the original's comparison. `(O*s)/s` then
/// differs from `O` by at most two roundings, 2 * 2^-53 * 1e5. This is less than a quarter of
/// [`PARITY_COEFFICIENT_DIFFERENCE`]. Above it the original may reject even its own output (oracle-behavior.md 8.10),
/// so the comparison is made as it is written.
const SAFE_SUM: f64 = 1e5;

/// The result of judging one step. Its memory is reused from step to step.
#[derive(Debug, Default)]
pub(super) struct StepResult {
    /// The original's lines about this step, in its order.
    pub(super) remarks: Vec<Remark>,
    /// The number of findings of each kind.
    pub(super) counts: FindingCounts,
    /// The first finding of each kind, in the order in which they were found.
    pub(super) first_findings: Vec<Finding>,
    /// The residuals of each particle's position and velocity. The caller adds them up in the order of the steps.
    pub(super) residuals: Vec<(f64, f64)>,
    /// Whether the step's states, impulses and polynomials are identical to the reference's, after small leading
    /// coefficients are dropped.
    pub(super) is_identical: bool,
}

impl StepResult {
    /// Resets the result to that of a step without findings.
    pub(super) fn clear(&mut self) {
        self.remarks.clear();
        self.first_findings.clear();
        self.residuals.clear();
        self.counts = FindingCounts::default();
        self.is_identical = false;
    }

    /// Returns the number of findings of each kind after the first.
    pub(super) fn further_counts(&self) -> FindingCounts {
        let mut further = FindingCounts::default();
        for kind in self.first_findings.iter().map(Finding::kind) {
            further.add(kind, self.counts.get(kind).saturating_sub(1));
        }
        further
    }

    fn record(&mut self, finding: Finding) {
        let kind = finding.kind();
        if self.counts.get(kind) == 0 {
            self.first_findings.push(finding);
        }
        self.counts.add(kind, 1);
    }
}

/// The buffers of a tally, which are kept from step to step.
#[derive(Debug, Default)]
pub(super) struct TallyBuffers {
    /// The pairs that a pass checks.
    order: Pairs,
    /// The reference's polynomials of the current pass.
    own: PolynomialBytes,
    impulses: Vec<Impulse>,
    pending: PendingFindings,
}

impl TallyBuffers {
    /// Creates empty buffers for steps of this scene.
    pub(super) fn new(scene: &Scene) -> Self {
        Self { order: pairs(scene), ..Self::default() }
    }
}

/// The observer that compares one step.
pub(super) struct Tally<'a> {
    step: u32,
    frame_number: u64,
    /// The end record of this step without its small leading coefficients.
    frame: &'a LenientFrame,
    /// The mid record, if the layout has one.
    mid: Option<&'a LenientFrame>,
    /// Whether the reference's impulses are logged. `hybrid` logs none.
    logs_impulses: bool,
    buffers: &'a mut TallyBuffers,
    result: &'a mut StepResult,
    passes: usize,
    /// The number of polynomials of the reference so far.
    polynomials: usize,
    /// Whether everything compared so far is identical.
    is_identical: bool,
}

impl<'a> Tally<'a> {
    /// Creates a tally of `step`, whose end record is `frame`. Clears `result` first.
    pub(super) fn new(
        (step, frame_number): (u32, u64),
        frame: &'a LenientFrame,
        mid: Option<&'a LenientFrame>,
        logs_impulses: bool,
        buffers: &'a mut TallyBuffers,
        result: &'a mut StepResult,
    ) -> Self {
        buffers.own.clear();
        buffers.impulses.clear();
        buffers.pending.clear();
        result.clear();
        Self {
            step,
            frame_number,
            frame,
            mid,
            logs_impulses,
            buffers,
            result,
            passes: 0,
            polynomials: 0,
            is_identical: true,
        }
    }

    /// Returns the result of quickly comparing the trace's next polynomial with the expected bytes `own`.
    #[inline]
    fn compare_quickly(&self, own: &[u8]) -> QuickComparison {
        let (index, log) = (self.polynomials, &self.frame.polynomials);
        if index >= log.len() {
            return QuickComparison::Undecided;
        }
        let actual = log.get(index);
        match (actual.len(), own.len()) {
            (0, 0) => QuickComparison::Same,
            (1, 8) => compare_quickly::<1>(own, actual),
            (2, 16) => compare_quickly::<2>(own, actual),
            (3, 24) => compare_quickly::<3>(own, actual),
            (4, 32) => compare_quickly::<4>(own, actual),
            (5, 40) => compare_quickly::<5>(own, actual),
            (6, 48) => compare_quickly::<6>(own, actual),
            _ => QuickComparison::Undecided,
        }
    }

    /// Returns whether the lists have the same length, and only a part of the trace's list was kept.
    pub(super) fn has_equal_lists(&self) -> bool {
        self.frame.is_cut() && self.frame.logged_polynomials == self.polynomials
    }

    /// Ends the step, and compares impulses, the number of polynomials and the states, in the original's order.
    pub(super) fn finish(mut self, reference: &State, has_impulses: bool, has_polynomials: bool) {
        if has_impulses {
            self.compare_impulses();
        }
        if has_polynomials {
            self.is_identical &= self.frame.logged_polynomials == self.polynomials;
            self.finish_polynomials();
        }
        let is_same = is_same_state(reference, &self.frame.state);
        self.is_identical &= is_same;
        self.result.is_identical = self.is_identical;
        // Residuals between equal numbers are zero and add nothing; residuals between infinities are NaN and are
        // skipped.
        if !is_same || !reference.is_finite() {
            self.compare_states(reference);
        }
    }

    fn finding(&self, detail: FindingDetail) -> Finding {
        Finding { step: self.step, frame: self.frame_number, detail }
    }

    /// Compares the impulses: missed, superfluous, wrong normals, printed in this order (oracle-behavior.md 6.1).
    fn compare_impulses(&mut self) {
        let own = std::mem::take(&mut self.buffers.impulses);
        let theirs = &self.frame.impulses;
        self.is_identical &= own.len() == theirs.len()
            && own.iter().zip(theirs).all(|(own, logged)| LoggedImpulse::from(*own).is_same(logged));
        let logged_contacts = Contacts::from_impulses(theirs);
        let logged = |own: &Impulse| pair_key(own.pair).and_then(|key| logged_contacts.indices_of(key).next());
        let mut own_keys: Vec<_> = own.iter().filter_map(|own| pair_key(own.pair)).collect();
        own_keys.sort_unstable();
        for expected in own.iter().filter(|own| logged(own).is_none()) {
            self.result.remarks.push(Remark::Missed(*expected));
            self.result.record(self.finding(FindingDetail::MissedCollision { expected: *expected }));
        }
        for actual in theirs.iter().filter(|logged| own_keys.binary_search(&logged_key(logged)).is_err()) {
            self.result.remarks.push(Remark::Superfluous(*actual));
            self.result.record(self.finding(FindingDetail::SuperfluousCollision { actual: *actual }));
        }
        for expected in &own {
            let Some(actual) = logged(expected).map(|index| &theirs[index]) else { continue };
            let residual = length(actual.normal - expected.normal);
            // In the original a NaN normal passes, because it tests whether the distance is larger than the bound.
            if residual > PARITY_NORMAL_DISTANCE {
                self.result.remarks.push(Remark::WrongNormal { actual: *actual, expected: *expected });
                let detail = FindingDetail::WrongNormal { expected: *expected, actual: *actual, residual };
                self.result.record(self.finding(detail));
            }
        }
        self.buffers.impulses = own;
    }

    /// Completes the findings about polynomials. If the number of polynomials is wrong, that is the only finding
    /// (oracle-behavior.md 6.2).
    fn finish_polynomials(&mut self) {
        let actual = self.frame.logged_polynomials;
        if actual != self.polynomials {
            let per_pass = self.polynomials.checked_div(self.passes).unwrap_or(0);
            let detail = FindingDetail::PolynomialCount { expected: self.polynomials, actual, per_pass };
            self.result.remarks.push(Remark::Polynomials(FindingKind::PolynomialCount, 1));
            self.result.record(self.finding(detail));
            return;
        }
        self.buffers.pending.deliver(self.result);
    }

    /// Compares the states by Euclidean residuals per particle (oracle-behavior.md 6.3).
    fn compare_states(&mut self, reference: &State) {
        let (mut positions, mut velocities) = (0, 0);
        for particle in 0..reference.positions.len() / 2 {
            let theirs = &self.frame.state;
            let (expected, actual) =
                (vector_at(&reference.positions, particle), vector_at(&theirs.positions, particle));
            let position = length(expected - actual);
            // The comparison is negated so that a NaN is a finding, because it fails the accumulated residual.
            if !(position < PARITY_MAX_RESIDUAL) {
                let (expected, actual) = (expected.into(), actual.into());
                let detail = FindingDetail::Position { particle, expected, actual, residual: position };
                self.result.record(self.finding(detail));
                positions += 1;
            }
            let (expected, actual) =
                (vector_at(&reference.velocities, particle), vector_at(&theirs.velocities, particle));
            let velocity = length(expected - actual);
            if !(velocity < PARITY_MAX_RESIDUAL) {
                let (expected, actual) = (expected.into(), actual.into());
                let detail = FindingDetail::Velocity { particle, expected, actual, residual: velocity };
                self.result.record(self.finding(detail));
                velocities += 1;
            }
            self.result.residuals.push((position, velocity));
        }
        debug_assert_eq!(self.result.counts.get(FindingKind::Position), positions);
        debug_assert_eq!(self.result.counts.get(FindingKind::Velocity), velocities);
    }

    /// Compares the next polynomial of the reference as in oracle-behavior.md 6.2. `place` returns its pass, pair and
    /// index, and is called only for a finding.
    pub(super) fn compare_polynomial(&mut self, expected: &[f64], place: impl Fn() -> PolynomialPlace) {
        let index = self.polynomials;
        self.polynomials += 1;
        if index >= self.frame.polynomials.len() {
            return;
        }
        let actual = self.frame.polynomials.get(index);
        if are_equal_and_safe(expected, actual) {
            return;
        }
        self.is_identical = self.is_identical && has_same_bits(expected, actual);
        if !is_accepted(expected, actual) {
            let at = (self.step, self.frame_number);
            self.buffers.pending.compare(at, expected, actual, place);
        }
    }
}

impl Observer for Tally<'_> {
    fn begin_pass(&mut self, _pass: Pass) {
        self.passes += 1;
    }

    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Bytes(&mut self.buffers.own)
    }

    /// Compares the pass's polynomials.
    fn end_pass(&mut self, pass: Pass, _hits: usize) {
        let mut own = std::mem::take(&mut self.buffers.own);
        let order = std::mem::take(&mut self.buffers.order);
        let mut coefficients = [0.0; MAX_COEFFICIENTS];
        // The original accepts identical coefficients of this size, and never rejects NaN.
        let is_small = own.max_modulus() < SAFE_SUM / MAX_COEFFICIENTS as f64;
        for (number, bytes) in own.iter().enumerate() {
            let index = self.polynomials;
            match self.compare_quickly(bytes) {
                QuickComparison::Same if is_small => {
                    self.polynomials += 1;
                    continue;
                }
                QuickComparison::Factor => {
                    self.polynomials += 1;
                    self.is_identical = false;
                    continue;
                }
                QuickComparison::Same | QuickComparison::Undecided => {}
            }
            let slots = coefficients.iter_mut().zip(bytes.as_chunks::<8>().0);
            slots.for_each(|(slot, bytes)| *slot = f64::from_le_bytes(*bytes));
            self.compare_polynomial(&coefficients[..bytes.len() / 8], || {
                let (_, pair, which) =
                    order.locate_polynomial(number).expect("a pass logs the polynomials of these pairs");
                PolynomialPlace { pass, pair, role: Role::from_number(pair.kind, which), index }
            });
        }
        own.clear();
        (self.buffers.own, self.buffers.order) = (own, order);
    }

    fn observe_impulse(&mut self, impulse: &Impulse) {
        if self.logs_impulses {
            self.buffers.impulses.push(*impulse);
        }
    }

    /// Returns the tally itself, which replaces the state in the middle of the step with the mid record's, without
    /// comparing it (oracle-behavior.md 4.2).
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for Tally<'_> {
    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        if let Some(mid) = self.mid {
            self.is_identical &= mid.logged_polynomials == self.polynomials && is_same_state(state, &mid.state);
            state.clone_from(&mid.state);
        }
        ResumeState::Own
    }
}

/// Adds one step's residuals in the original's order: particle by particle (oracle-behavior.md 6.3).
pub(super) fn add_residuals(total: &mut Residuals, step: &[(f64, f64)]) {
    for &(position, velocity) in step {
        total.accumulated_position += position;
        total.accumulated_velocity += velocity;
        if position > total.maximum_position {
            total.maximum_position = position;
        }
        if velocity > total.maximum_velocity {
            total.maximum_velocity = velocity;
        }
    }
}

/// Returns whether two states are equal bit for bit.
fn is_same_state(own: &State, other: &State) -> bool {
    has_same_bits(&own.positions, &other.positions) && has_same_bits(&own.velocities, &other.velocities)
}

/// Returns whether the original accepts a polynomial (oracle-behavior.md 6.2), because it is right up to a factor, is
/// zero, or contains a NaN.
fn is_accepted(own: &[f64], actual: &[f64]) -> bool {
    let (sum_actual, sum_own) = (sum_of_moduli(actual), sum_of_moduli(own));
    if own.len() != actual.len() {
        return false;
    }
    if sum_own < PARITY_ZERO_COEFFICIENT_SUM {
        return sum_actual < PARITY_ZERO_COEFFICIENT_SUM;
    }
    let is_alike =
        |(own, actual): (&f64, &f64)| !((actual - (own * sum_actual) / sum_own).abs() > PARITY_COEFFICIENT_DIFFERENCE);
    own.iter().zip(actual).fold(true, |all, pair| all & is_alike(pair))
}

/// The result of quickly comparing a polynomial of the trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum QuickComparison {
    /// The polynomial is identical to the reference's.
    Same,
    /// The polynomial differs by a factor, and [`is_accepted`] accepts it.
    Factor,
    /// The quick comparison does not decide.
    Undecided,
}

/// Returns the result of comparing both polynomials with one division for all coefficients. Its rounding differs from
/// the original's by less than a hundredth of the bound.
#[inline]
fn compare_quickly<const LENGTH: usize>(own: &[u8], actual: &[f64]) -> QuickComparison {
    let (Some(actual), Some(own)) = (actual.first_chunk::<LENGTH>(), own.as_chunks::<8>().0.first_chunk::<LENGTH>())
    else {
        return QuickComparison::Undecided;
    };
    let own = own.map(f64::from_le_bytes);
    let difference = own.iter().zip(actual).fold(0, |all, (own, actual)| all | own.to_bits() ^ actual.to_bits());
    if difference == 0 {
        return QuickComparison::Same;
    }
    let (mut sum_own, mut sum_actual) = (0.0, 0.0);
    for (own, actual) in own.iter().zip(actual) {
        sum_own += own.abs();
        sum_actual += actual.abs();
    }
    let factor = sum_actual / sum_own;
    let mut all = sum_own >= PARITY_ZERO_COEFFICIENT_SUM;
    for (own, actual) in own.iter().zip(actual) {
        let rescaled = own * factor;
        all &= ((actual - rescaled).abs() <= 0.9 * PARITY_COEFFICIENT_DIFFERENCE) & (rescaled.abs() <= 1e3);
    }
    if all { QuickComparison::Factor } else { QuickComparison::Undecided }
}

/// Returns the sum of absolute values, left to right from zero.
fn sum_of_moduli(coefficients: &[f64]) -> f64 {
    coefficients.iter().fold(0.0, |sum, c| sum + c.abs())
}

/// Returns whether two lists are identical, and small enough that the original's comparison provably accepts them.
#[inline]
fn are_equal_and_safe(own: &[f64], actual: &[f64]) -> bool {
    if own.len() != actual.len() {
        return false;
    }
    let mut sum = 0.0;
    let mut difference = 0;
    for (o, a) in own.iter().zip(actual) {
        difference |= o.to_bits() ^ a.to_bits();
        sum += o.abs();
    }
    difference == 0 && sum < SAFE_SUM
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_large_coefficients_are_compared_as_the_original_does() {
        assert!(are_equal_and_safe(&[1.0, -2.0], &[1.0, -2.0]));
        assert!(!are_equal_and_safe(&[1.0, -2.0], &[1.0, 2.0]));
        assert!(!are_equal_and_safe(&[0.0], &[-0.0]));
        assert!(!are_equal_and_safe(&[1e6, 1.0], &[1e6, 1.0]));
        assert!(!are_equal_and_safe(&[f64::NAN], &[f64::NAN]));
        assert!(!are_equal_and_safe(&[1.0], &[1.0, 2.0]));
    }

    /// Every polynomial for which the quick comparison finds a factor is accepted, and it finds the factor of many
    /// polynomials.
    #[test]
    fn polynomials_with_a_clear_factor_are_accepted() {
        let mut seed = 1_u64;
        let mut next = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut clear = 0;
        for round in 0..20_000 {
            let size = [1.0, 1e-9, 1e2, 1e4][(next() * 4.0) as usize];
            let own: [f64; 3] = std::array::from_fn(|_| (next() - 0.5) * size);
            let (factor, noise) = ([0.5, 1.0, 1.0 / 3.0, 7.0][round % 4], [0.0, 1e-12, 1e-10, 2e-10][round / 4 % 4]);
            let actual = own.map(|own| factor * own + noise * (next() - 0.5));
            let bytes: Vec<u8> = own.iter().flat_map(|own| own.to_le_bytes()).collect();
            match compare_quickly::<3>(&bytes, &actual) {
                QuickComparison::Same => assert!(has_same_bits(&own, &actual)),
                QuickComparison::Factor => {
                    assert!(is_accepted(&own, &actual) && !has_same_bits(&own, &actual), "{own:?} {actual:?}");
                    clear += 1;
                }
                QuickComparison::Undecided => assert!(!has_same_bits(&own, &actual)),
            }
        }
        assert!(clear > 5000, "{clear}");
        let nan = [f64::NAN, 1.0, 1.0];
        assert_eq!(compare_quickly::<3>(&[0; 24], &nan), QuickComparison::Undecided);
    }

    #[test]
    fn a_nan_residual_raises_no_maximum_but_poisons_the_sum() {
        let mut total = Residuals::default();
        add_residuals(&mut total, &[(f64::NAN, 0.5), (0.25, 0.25)]);
        assert!(total.accumulated_position.is_nan());
        assert_eq!(total.maximum_position, 0.25);
        assert_eq!(total.accumulated_velocity, 0.75);
        assert_eq!(total.maximum_velocity, 0.5);
    }
}
