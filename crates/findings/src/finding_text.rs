//! Describes findings in sentences. Each sentence contains the place, the expected value and the actual value.
//!
//! Vectors are written with as many digits as are needed to distinguish them. Other numbers are written exactly, with
//! an exponent if they would otherwise be long. Reports that show values side by side use the fields of
//! [`FindingDetail`] instead.
use super::finding::{Finding, FindingDetail, FindingKind, Part, PolynomialPlace, RecordPart, Role};
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, Stage, StepError},
    trace::LoggedImpulse,
};
use fosssim_num::{
    number_format::format_exact,
    vector::{self, Vec2},
};
use std::fmt::{self, Display, Formatter};

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "step {}: {}", self.step, self.describe())
    }
}

/// A finding, written without its step.
struct SteplessFinding<'a>(&'a Finding);

impl Finding {
    /// Returns the text of the finding without its step. In sentences about the first record, bodies "start" somewhere;
    /// in those about other records, they "end" there.
    pub fn describe(&self) -> impl Display + '_ {
        SteplessFinding(self)
    }
}

/// The text about a decision that differs because coefficients are missing. The trace's other polynomials show whether
/// a factor explains why they are missing.
const LOSS_TEXT: &str = "the trace's polynomials lack the coefficients for it";
const MOVED_TEXT: &str = "matches neither the motion before the pair's response or failsafe nor the one after";
const OTHER_FORM_TEXT: &str = "the other of the two accepted forms; a program must use one of them throughout";
const OMITTED_PAIR_TEXT: &str = "are close enough for the penalty force, but no force was applied between them";
const DOUBLED_PAIR_TEXT: &str = "are close enough for the penalty force, but the force between them was applied twice";
const DROPPING_TEXT: &str = "the course's library drops leading ones below 1e-12";

impl Display for SteplessFinding<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let is_first = self.0.step == 0;
        let verb = if is_first { "starts" } else { "ends" };
        match self.0.detail {
            FindingDetail::MissedCollision { expected } => {
                let Impulse { pair, normal, time } = expected;
                let (pair, time, normal) = (PairText(pair), ExactNumber(time), VectorText(normal.into()));
                write!(f, "{pair} collide at time {time} with normal {normal}, but the trace has no such collision")
            }
            FindingDetail::SuperfluousCollision { actual } => {
                let LoggedImpulse { normal, time, .. } = actual;
                let (pair, time, normal) = (LoggedPair(&actual), ExactNumber(time), VectorText(normal.into()));
                write!(f, "the trace has a collision of {pair} at time {time} with normal {normal}, but there is none")
            }
            FindingDetail::WrongNormal { expected, actual, .. } => {
                let pair = PairText(expected.pair);
                let (expected, actual) = (expected.normal, actual.normal);
                let difference = VectorDifference { expected: [expected.x, expected.y], actual: [actual.x, actual.y] };
                write!(f, "{pair}: contact normal {difference}")
            }
            FindingDetail::PolynomialCount { expected, actual, per_pass } => {
                write!(f, "{actual} polynomials logged, expected {expected}")?;
                write_passes(f, count_whole_passes(expected, actual, per_pass))
            }
            FindingDetail::PassCount { part, expected, actual } => {
                let part = if part == Part::Impulses { "before the mid record" } else { "in the geometric part" };
                write!(f, "{actual} detection {} {part}, expected {expected}", pass_noun(actual))
            }
            FindingDetail::PolynomialDegree { place, expected, actual_size, .. } => write!(
                f,
                "{place}: {actual_size} coefficients, expected {} (leading ones below 1e-12 dropped)",
                expected.coefficients().len()
            ),
            FindingDetail::VanishingPolynomial { place, .. } => {
                write!(f, "{place}: all coefficients of the reference are tiny, but the trace has a larger one")
            }
            FindingDetail::Coefficient { place, power, expected, actual, .. } => {
                write!(f, "{place}, {}: {}, expected {}", PowerText(power), ExactNumber(actual), ExactNumber(expected))
            }
            FindingDetail::Position { particle, expected, actual, .. } => {
                write!(f, "particle {particle} {verb} at {}", VectorDifference { expected, actual })
            }
            FindingDetail::Velocity { particle, expected, actual, .. } => {
                write!(f, "particle {particle} {verb} with velocity {}", VectorDifference { expected, actual })
            }
            FindingDetail::ContactTime { expected: Impulse { pair, time, .. }, actual } => {
                let times = [time, actual.time].map(ExactNumber);
                write!(f, "{} collide at time {}, but the trace says {}", PairText(pair), times[0], times[1])
            }
            FindingDetail::RepeatedCollision { actual } => {
                write!(f, "the collision of {} is logged more than once", LoggedPair(&actual))
            }
            FindingDetail::PassPositions { place } => write!(f, "{place}: {MOVED_TEXT}"),
            FindingDetail::RecordsDiffer { part } => f.write_str(describe_record_difference(part, is_first)),
            FindingDetail::ImpossibleLog => f.write_str("a polynomial has more coefficients than any detection has"),
            FindingDetail::TrimmedDecision { place, collides } => {
                let outcome = if collides { "collide" } else { "do not collide" };
                let (pair, pass) = (PairText(place.pair), PassText(place.pass));
                write!(f, "{pair} ({pass}) {outcome}; {LOSS_TEXT}, and decide otherwise ({DROPPING_TEXT})")
            }
            FindingDetail::TrimmedTime { place, expected, actual } => write_trimmed_time(f, place, [expected, actual]),
            FindingDetail::BeyondReach { particle, position, velocity } => write!(
                f,
                "the step starts or ends with particle {particle} at {} with velocity {}: no run of the scene leads to \
                 such states",
                VectorText(position),
                VectorText(velocity)
            ),
            FindingDetail::MixedForms { place } => write!(f, "{place}: {OTHER_FORM_TEXT}"),
            FindingDetail::PairForce { pair, is_doubled: false } => write!(f, "{} {OMITTED_PAIR_TEXT}", PairText(pair)),
            FindingDetail::PairForce { pair, is_doubled: true } => write!(f, "{} {DOUBLED_PAIR_TEXT}", PairText(pair)),
            FindingDetail::NoResult { error } => {
                write!(f, "no next state follows from the trace's own state, because {}", MissingResult(error))
            }
        }
    }
}

/// Writes the sentence about a time of impact that is wrong because coefficients are missing. The expected time comes
/// first.
fn write_trimmed_time(f: &mut Formatter<'_>, place: PolynomialPlace, times: [f64; 2]) -> fmt::Result {
    let (pair, pass, [expected, actual]) = (PairText(place.pair), PassText(place.pass), times.map(ExactNumber));
    write!(f, "{pair} ({pass}) collide at time {expected}; {LOSS_TEXT}, and have time {actual} ({DROPPING_TEXT})")
}

/// Returns the sentence about the part in which the two records of a step differ.
const fn describe_record_difference(part: RecordPart, is_first: bool) -> &'static str {
    match part {
        RecordPart::Impulses if is_first => "the first record contains impulses, although nothing has moved yet",
        RecordPart::Polynomials if is_first => "the first record contains polynomials, although nothing has moved yet",
        RecordPart::State => "the state changes between the step's two records",
        RecordPart::Impulses => "the step's two records contain different impulses",
        RecordPart::Polynomials => "the mid record's polynomials are not the first ones of the end record",
    }
}

/// Writes by how many detection passes a log is too long (`true`) or too short. Nothing is written if the number is not
/// whole.
fn write_passes(f: &mut Formatter<'_>, passes: Option<(usize, bool)>) -> fmt::Result {
    let Some((passes, more)) = passes else { return Ok(()) };
    write!(f, ": {passes} detection {} too {}", pass_noun(passes), if more { "many" } else { "few" })
}

const fn pass_noun(passes: usize) -> &'static str {
    if passes == 1 { "pass" } else { "passes" }
}

/// The text of two vectors and their distance, the wrong vector first. The vectors have as many digits as are needed to
/// distinguish them.
struct VectorDifference {
    expected: [f64; 2],
    actual: [f64; 2],
}

impl Display for VectorDifference {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let ([ex, ey], [ax, ay]) = (self.expected, self.actual);
        let distance = vector::length(Vec2::new(ax - ex, ay - ey));
        let power =
            |number: f64| format!("{number:e}").split_once('e').and_then(|(_, power)| power.parse::<i32>().ok());
        // The distance has two digits, and each vector has at least six.
        let truncate = |vector: [f64; 2]| {
            let size = vector.into_iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            let minimum = power(size).map(|power| 5 - power);
            let decimals = power(distance).map(|power| 1 - power).max(minimum).unwrap_or(0);
            VectorText(vector.map(|value| truncate_to_places(value, decimals, power(value))))
        };
        write!(f, "{}, expected {}, distance ", truncate([ax, ay]), truncate([ex, ey]))?;
        let rounded = format!("{distance:.2e}").parse().unwrap_or(distance);
        if (1e-4..1e6).contains(&distance) { write!(f, "{rounded}") } else { write!(f, "{rounded:e}") }
    }
}

/// Returns a value rounded to a number of decimal places. A negative number means places before the decimal point.
fn truncate_to_places(value: f64, decimals: i32, power: Option<i32>) -> f64 {
    // Seventeen digits identify a double, so more are not needed.
    let digits = power.map_or(0, |power| (power + decimals).clamp(0, 16));
    let text = match (usize::try_from(digits), usize::try_from(decimals.max(0))) {
        (Ok(digits), _) if decimals > 15 || value.abs() >= 1e9 => format!("{value:.digits$e}"),
        (_, Ok(decimals)) => format!("{value:.decimals$}"),
        _ => value.to_string(),
    };
    text.parse().unwrap_or(value)
}

/// A number, written as the shortest text that reads back as the same number.
struct ExactNumber(f64);

impl Display for ExactNumber {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // Zero is written without its sign.
        if self.0.is_finite() { f.write_str(&format_exact(self.0 + 0.0)) } else { write!(f, "{}", self.0) }
    }
}

/// The text of a point or a vector, such as `(0.5, 1)`.
struct VectorText([f64; 2]);

impl Display for VectorText {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", ExactNumber(self.0[0]), ExactNumber(self.0[1]))
    }
}

/// Returns the number of whole detection passes by which two counts differ, and whether the trace has more; `None` if
/// the number is not whole.
pub fn count_whole_passes(expected: usize, actual: usize, per_pass: usize) -> Option<(usize, bool)> {
    let difference = actual.abs_diff(expected);
    (per_pass > 0 && difference > 0 && difference.is_multiple_of(per_pass))
        .then(|| (difference / per_pass, actual > expected))
}

/// Returns whether a text has only visible ASCII characters and blanks. Reports check all their texts with it. It is in
/// this crate because this crate is optimized, unlike the reports' crate.
pub fn is_visible_ascii(text: &str) -> bool {
    text.bytes().all(|byte| (b' '..=b'~').contains(&byte))
}

impl Display for PolynomialPlace {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} polynomial of {} ({})", self.role, PairText(self.pair), PassText(self.pass))
    }
}

impl Display for Role {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Display for FindingKind {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The text of the reason why a step has no result.
#[derive(Debug, Clone, Copy)]
pub struct MissingResult(pub StepError);

impl Display for MissingResult {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            StepError::RootSearch { pair, .. } => write!(
                f,
                "the root search of {} would never end: a coefficient is not finite, or absurdly small",
                PairText(pair)
            ),
            StepError::Newton { .. } => f.write_str("Newton's method finds no solution of the implicit equation"),
            StepError::VortexHessian { .. } => {
                f.write_str("a vortex force has no Hessian, which implicit integrators need")
            }
            StepError::Work { .. } => {
                f.write_str("judging needed many times the work of the reference's run, and was stopped at this limit")
            }
        }
    }
}

/// The text of a pair, such as `particle 3 and edge 1`.
#[derive(Debug, Clone, Copy)]
pub struct PairText(pub Pair);

impl Display for PairText {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Pair { kind, first, second } = self.0;
        write_pair(f, kind, &first, &second)
    }
}

fn write_pair(f: &mut Formatter<'_>, kind: PairKind, first: &dyn Display, second: &dyn Display) -> fmt::Result {
    match kind {
        PairKind::ParticleParticle => write!(f, "particles {first} and {second}"),
        kind => write!(f, "particle {first} and {} {second}", kind.second_name()),
    }
}

/// The text of a pair as a trace names it. The pair may not exist in the scene.
struct LoggedPair<'a>(&'a LoggedImpulse);

impl Display for LoggedPair<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let LoggedImpulse { kind, first, second, .. } = self.0;
        match self.0.kind() {
            Some(known) => write_pair(f, known, first, second),
            None => write!(f, "a pair of unknown kind {kind} ({first}, {second})"),
        }
    }
}

/// The text of a detection pass, such as `detection of impulse round 2`.
#[derive(Debug, Clone, Copy)]
pub struct PassText(pub Pass);

impl Display for PassText {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0.stage {
            Stage::Simple | Stage::ContinuousTime => f.write_str("the step's only detection pass"),
            Stage::Impulses { round } => write!(f, "detection of impulse round {}", round + 1),
            Stage::Geometric { round: 0 } => f.write_str("detection before the rigid failsafe"),
            Stage::Geometric { round } => write!(f, "detection after failsafe round {round}"),
        }
    }
}

/// The text of the coefficient of a power of t, such as `coefficient of t^3` or `constant coefficient`.
#[derive(Debug, Clone, Copy)]
pub struct PowerText(pub usize);

impl Display for PowerText {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => f.write_str("constant coefficient"),
            1 => f.write_str("coefficient of t"),
            power => write!(f, "coefficient of t^{power}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_num::polynomial::Polynomial;

    #[test]
    fn a_finding_reads_as_a_sentence() {
        let pair = Pair { kind: PairKind::ParticleEdge, first: 3, second: 1 };
        let pass = Pass { stage: Stage::Impulses { round: 1 }, index: 1 };
        let place = PolynomialPlace { pass, pair, role: Role::Overlap, index: 17 };
        let polynomial = Polynomial::untrimmed(&[1.0, 2.0, 3.0]);
        let detail = FindingDetail::Coefficient {
            place,
            power: 2,
            expected: 3.5,
            actual: 4.0,
            residual: 0.5,
            rescaled: None,
            expected_polynomial: polynomial,
            actual_polynomial: polynomial,
        };
        assert_eq!(
            Finding { step: 14, frame: 28, detail }.to_string(),
            "step 14: overlap polynomial of particle 3 and edge 1 (detection of impulse round 2), coefficient of t^2: \
            4, expected 3.5"
        );
    }

    #[test]
    fn particles_start_in_the_first_record_and_end_in_the_others() {
        let detail = FindingDetail::Position { particle: 2, expected: [0.0, 1.0], actual: [0.0, 3.0], residual: 2.0 };
        let words = |step| Finding { step, frame: 0, detail }.to_string();
        assert_eq!(words(0), "step 0: particle 2 starts at (0, 3), expected (0, 1), distance 2");
        assert_eq!(words(1), "step 1: particle 2 ends at (0, 3), expected (0, 1), distance 2");
        let detail = FindingDetail::RecordsDiffer { part: RecordPart::Impulses };
        assert_eq!(
            Finding { step: 0, frame: 0, detail }.to_string(),
            "step 0: the first record contains impulses, although nothing has moved yet"
        );
    }

    #[test]
    fn vectors_have_as_many_digits_as_tell_them_apart() {
        let words = |expected, actual| VectorDifference { expected, actual }.to_string();
        assert_eq!(
            words([0.123_456_789_012, -1.0], [0.123_456_789_912, -1.0]),
            "(0.12345678991, -1), expected (0.12345678901, -1), distance 9e-10"
        );
        assert_eq!(
            words([1.0 / 3.0, 2.0 / 3.0], [0.5, 2.0 / 3.0]),
            "(0.5, 0.666667), expected (0.333333, 0.666667), distance 0.167"
        );
        assert_eq!(words([1e300, 0.0], [f64::NAN, 0.0]), "(NaN, 0), expected (1e300, 0), distance NaN");
        // If one vector is very large, the other one keeps its digits.
        assert_eq!(
            words([-0.764_179_123, 0.137_576_456], [-6.935_630_093_907_413e130, 2.5e130]),
            "(-6.93563e130, 2.5e130), expected (-0.764179, 0.137576), distance 7.37e130"
        );
        assert_eq!(
            words([0.528_655_4, 0.000_123_4], [12.0, 3.4e17]),
            "(12, 3.4e17), expected (0.528655, 0.000123), distance 3.4e17"
        );
    }

    #[test]
    fn whole_passes_are_counted() {
        let words = |expected, actual, per_pass| {
            let detail = FindingDetail::PolynomialCount { expected, actual, per_pass };
            Finding { step: 1, frame: 2, detail }.describe().to_string()
        };
        assert_eq!(words(40, 60, 20), "60 polynomials logged, expected 40: 1 detection pass too many");
        assert_eq!(words(60, 20, 20), "20 polynomials logged, expected 60: 2 detection passes too few");
        assert_eq!(words(60, 61, 20), "61 polynomials logged, expected 60");
        assert_eq!(words(0, 61, 0), "61 polynomials logged, expected 0");
        let detail = FindingDetail::PassCount { part: Part::Impulses, expected: 2, actual: 1 };
        let one = Finding { step: 1, frame: 2, detail }.describe().to_string();
        assert_eq!(one, "1 detection pass before the mid record, expected 2");
    }
}
