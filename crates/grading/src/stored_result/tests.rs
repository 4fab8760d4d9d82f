mod explanations;

use super::*;
use crate::{
    ResultKey, Verdict,
    disclosure::{DisclosedBook, DisclosedFinding, Disclosure},
    result::{
        Activity, BadTrace, Failure, FolderContents, Limit, Measurements, NotRunReason, ProgramProgress, Reason,
        SavedTrace, UnusableReason, WrongTrace,
    },
};
use fosssim_findings::FindingPlace;
use fosssim_judge::{
    Book, Damage, Finding, FindingCounts, FindingDetail, FindingKind, Part, PolynomialPlace, ReadFailure, RecordPart,
    RescaledCoefficient, Residuals, Role, Ruling, fair::Cause,
};
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, Stage, StepError},
    trace::{LoggedImpulse, RecordList, TraceFormatError},
};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use fosssim_sandbox::{RunEnd, StartProblem};
use std::{path::PathBuf, time::Duration};

fn key() -> ResultKey {
    ResultKey::from_program(&blake3::hash(b"program"), b"scene", &[])
}

/// Returns a result after it was written and read again.
fn again(result: &SceneResult) -> SceneResult {
    let entry = read_line(&format_line(&key(), "submission", result)).expect("our own form is sound");
    assert_eq!((&entry.key, entry.submission.as_str()), (&key(), "submission"));
    entry.result
}

fn pair(kind: PairKind) -> Pair {
    Pair { kind, first: 3, second: 1 }
}

/// Returns a finding of every kind, with unusual numbers.
fn findings() -> Vec<Finding> {
    let pass = |stage| Pass { stage, index: 2 };
    let place = |kind, stage, role| PolynomialPlace { pass: pass(stage), pair: pair(kind), role, index: 17 };
    let first = place(PairKind::ParticleParticle, Stage::Simple, Role::Overlap);
    let second = place(PairKind::ParticleEdge, Stage::ContinuousTime, Role::AlphaAboveZero);
    let third = place(PairKind::ParticleHalfPlane, Stage::Impulses { round: 4 }, Role::AlphaBelowOne);
    let last = place(PairKind::ParticleEdge, Stage::Geometric { round: 1 }, Role::Approach);
    let expected =
        Impulse { pair: pair(PairKind::ParticleEdge), normal: Vec2::new(-0.0, f64::INFINITY), time: 1.0 / 3.0 };
    let actual = LoggedImpulse { kind: 9, first: -1, second: 2, normal: Vec2::new(5e-324, -1e308), time: 0.1 };
    let polynomial = Polynomial::untrimmed(&[1e-300, f64::NEG_INFINITY, 0.3]);
    let rescaled = RescaledCoefficient { power: 1, expected: 1.0, actual: 2.5, residual: 1.5 };
    let details = [
        FindingDetail::MissedCollision { expected },
        FindingDetail::SuperfluousCollision { actual },
        FindingDetail::WrongNormal { expected, actual, residual: 0.7 },
        FindingDetail::PolynomialCount { expected: 4, actual: 8, per_pass: 4 },
        FindingDetail::PassCount { part: Part::Impulses, expected: 1, actual: 2 },
        FindingDetail::PassCount { part: Part::Geometric, expected: 1, actual: 2 },
        FindingDetail::PolynomialDegree {
            place: first,
            expected: polynomial,
            actual_size: 9,
            actual: Polynomial::untrimmed(&[]),
        },
        FindingDetail::VanishingPolynomial { place: second, expected: polynomial, actual: polynomial },
        FindingDetail::Coefficient {
            place: third,
            power: 2,
            expected: 0.1,
            actual: 0.2,
            residual: 0.1,
            rescaled: Some(rescaled),
            expected_polynomial: polynomial,
            actual_polynomial: polynomial,
        },
        FindingDetail::Position { particle: 2, expected: [0.1, 0.2], actual: [-0.0, 1e17], residual: f64::INFINITY },
        FindingDetail::Velocity { particle: 2, expected: [0.1, 0.2], actual: [0.3, 0.4], residual: 0.5 },
        FindingDetail::ContactTime { expected, actual },
        FindingDetail::RepeatedCollision { actual },
        FindingDetail::PassPositions { place: last },
        FindingDetail::RecordsDiffer { part: RecordPart::State },
        FindingDetail::RecordsDiffer { part: RecordPart::Impulses },
        FindingDetail::RecordsDiffer { part: RecordPart::Polynomials },
        FindingDetail::ImpossibleLog,
        FindingDetail::TrimmedDecision { place: last, collides: true },
        FindingDetail::TrimmedTime { place: last, expected: 0.5, actual: 2.0 },
        FindingDetail::BeyondReach { particle: 0, position: [1e300, 0.0], velocity: [0.0, f64::NEG_INFINITY] },
        FindingDetail::MixedForms { place: last },
        FindingDetail::PairForce { pair: last.pair, is_doubled: true },
        FindingDetail::NoResult { error: StepError::Newton { step: 7 } },
    ];
    details.into_iter().map(|detail| Finding { step: 7, frame: 14, detail }).collect()
}

fn wrong() -> SceneResult {
    let examples: Vec<_> = findings().into_iter().map(DisclosedFinding::Full).collect();
    let places = [
        FindingPlace::Step,
        FindingPlace::Pair(pair(PairKind::ParticleHalfPlane)),
        FindingPlace::Particle(3),
        FindingPlace::Objects(-1, i32::MAX),
    ];
    let mut counts = FindingCounts::default();
    for (number, kind) in FindingKind::ALL.into_iter().enumerate() {
        counts.add(kind, u64::MAX / 20 * (number as u64 % 2));
    }
    let account = DisclosedBook {
        ruling: Ruling::WrongAnswer,
        wrong_steps: u64::MAX,
        counts,
        first_divergence: examples.first().cloned(),
        examples,
    };
    let told = |place| DisclosedFinding::Place { step: 0, kind: FindingKind::MixedForms, place };
    let fair = DisclosedBook {
        ruling: Ruling::BadTrace,
        first_divergence: None,
        examples: places.map(told).into(),
        ..account.clone()
    };
    let residuals = Residuals { accumulated_position: f64::INFINITY, maximum_position: 0.1, ..Residuals::default() };
    let damage = Damage {
        frame: 1,
        step: 2,
        offset: 3,
        what: TraceFormatError::CountCut { list: RecordList::Impulses, left: 3 },
    };
    let why = Reason::Wrong(WrongTrace::Steps { wrong: 3, first: 7, kind: FindingKind::Coefficient });
    SceneResult {
        ended: Some(RunEnd::Exited(0)),
        difference_cause: Some(Cause::ContactTime),
        disclosure: Some(Disclosure {
            official: Book::Fair,
            parity: account,
            fair: Some(fair),
            residuals: Some(residuals),
            damage: Some(damage),
            trailing_bytes: true,
        }),
        explanations: explanations::all(),
        right_steps: 3,
        measured: Measurements {
            cpu: Duration::new(5, 123_456_789),
            wall: Duration::MAX,
            judging: Duration::ZERO,
            memory: Some(u64::MAX),
        },
        stdout: "out\u{1b}[31m\u{202e}\0".to_owned(),
        card: Some("0123".to_owned()),
        ..SceneResult::without_run("Group/scene", 5, Verdict::WrongAnswer, why)
    }
}

#[test]
fn a_result_reads_back_the_same_to_the_last_bit() {
    let result = wrong();
    // Equality ignores the sign of a zero; this comparison does not.
    assert_eq!(format!("{:?}", again(&result)), format!("{result:?}"));
    let nan = FindingDetail::WrongNormal {
        expected: Impulse { pair: pair(PairKind::ParticleEdge), normal: Vec2::new(0.0, 1.0), time: f64::NAN },
        actual: LoggedImpulse { kind: 0, first: 0, second: 0, normal: Vec2::new(f64::NAN, 0.0), time: 0.0 },
        residual: f64::NAN,
    };
    let mut strange = result;
    let told = strange.disclosure.as_mut().expect("something");
    told.parity.examples = vec![DisclosedFinding::Full(Finding { step: 1, frame: 1, detail: nan })];
    assert_eq!(format!("{:?}", again(&strange)), format!("{strange:?}"));
}

#[test]
fn every_reason_and_every_end_reads_back() {
    let unreadable = |cause| BadTrace::Unreadable {
        frame: 9,
        step: 5,
        cause,
        offset: 77,
        damage: TraceFormatError::CountCut { list: RecordList::Impulses, left: 3 },
    };
    let errors = [
        StepError::RootSearch { step: 1, pair: pair(PairKind::ParticleEdge) },
        StepError::Newton { step: 2 },
        StepError::VortexHessian { step: 3 },
        StepError::Work { step: 4 },
    ];
    let causes = [ReadFailure::State, ReadFailure::Impulses, ReadFailure::Memory, ReadFailure::Limit, ReadFailure::Io];
    let others = FolderContents::Others { names: vec!["a/".to_owned()], more: 3, elsewhere: Some("b/c".to_owned()) };
    let mut reasons: Vec<Reason> = vec![
        Reason::Right,
        Reason::NoTrace,
        Reason::Program(ProgramProgress { limit: None, steps: 7 }),
        Reason::Program(ProgramProgress { limit: Some(Limit::Time(Duration::from_millis(1500))), steps: 3 }),
        Reason::Program(ProgramProgress { limit: Some(Limit::Memory(1 << 30)), steps: 0 }),
        Reason::Stopped,
        Reason::DoesNotBuild,
    ];
    let wrong = [
        WrongTrace::Undisclosed,
        WrongTrace::Nothing,
        WrongTrace::FirstRecord(FindingKind::Position),
        WrongTrace::Damaged,
        WrongTrace::SmallErrors,
    ];
    reasons.extend(wrong.map(Reason::Wrong));
    reasons.extend([WrongTrace::Borderline, WrongTrace::Undecided].map(Reason::Wrong));
    reasons.extend(errors.map(|error| Reason::Wrong(WrongTrace::NoResult(error))));
    reasons.extend(causes.map(|cause| Reason::Trace(unreadable(cause))));
    reasons.extend([BadTrace::StatesOnly, BadTrace::Damaged, BadTrace::TrailingBytes].map(Reason::Trace));
    let total = NotRunReason::Total(Duration::from_secs(600));
    reasons.extend(
        [NotRunReason::Limits { scenes: 3, verdict: Verdict::MemoryLimit }, total, NotRunReason::FailFast]
            .map(Reason::Skipped),
    );
    let missing = StartProblem::MissingInterpreter { interpreter: "/bin/x".to_owned(), hint: "; install it".into() };
    for found in [FolderContents::Unreadable("no".to_owned()), FolderContents::Nothing, others] {
        reasons.push(Reason::Unusable(UnusableReason::NoProgram { sought: "FOSSSim".to_owned(), found }));
    }
    reasons.push(Reason::Unusable(UnusableReason::CouldNotStart(missing.clone())));
    reasons.push(Reason::Unusable(UnusableReason::Unreadable("closed".to_owned())));
    reasons.push(Reason::Failed(Failure::Machine("no space".to_owned())));
    let kept = SavedTrace::In(PathBuf::from("faults/a.bin"));
    let lost = SavedTrace::Lost { folder: PathBuf::from("faults"), error: "full".to_owned() };
    for (stage, trace) in [
        (None, None),
        (Some(Activity::Judging), Some(kept)),
        (Some(Activity::Explaining), Some(lost)),
        (Some(Activity::Drawing), None),
    ] {
        reasons.push(Reason::Failed(Failure::Panic { stage, fault: "at x.rs:1".to_owned(), trace }));
    }
    for reason in reasons {
        let result = SceneResult::without_run("a/b", 5, Verdict::RuntimeError, reason);
        assert_eq!(again(&result), result);
    }
    for ended in [
        RunEnd::Exited(-1),
        RunEnd::Signaled(11),
        RunEnd::CpuLimit,
        RunEnd::TraceLimit,
        RunEnd::Violation { call: "ptrace".to_owned() },
        RunEnd::CouldNotStart(missing),
        RunEnd::Canceled,
    ] {
        let result = SceneResult {
            ended: Some(ended),
            ..SceneResult::without_run("a/b", 5, Verdict::RuntimeError, Reason::Stopped)
        };
        assert_eq!(again(&result), result);
    }
}

#[test]
fn another_version_and_damage_are_not_read() {
    let written = String::from_utf8(format_line(&key(), "submission", &wrong())).expect("text");
    assert!(read_line(written.as_bytes()).is_some());
    assert_eq!(written.find('\n'), Some(written.len() - 1), "one line");
    assert!(
        read_line(
            written
                .replacen(&format!("\"form\":{FORM_VERSION}"), &format!("\"form\":{}", FORM_VERSION + 1), 1)
                .as_bytes()
        )
        .is_none()
    );
    assert!(read_line(written.replacen("\"coefficient\"", "\"coeficient\"", 1).as_bytes()).is_none());
    let seven = "[1,2,3,4,5,6,7]";
    let many = written.replacen("[1e-300,\"-inf\",0.3]", seven, 1);
    assert!(many.contains(seven) && read_line(many.as_bytes()).is_none(), "no polynomial is that long");
    assert!(read_line(&written.as_bytes()[..written.len() - 3]).is_none());
}
