use super::*;
use fosssim_findings::disclosure::Disclosure;
use fosssim_judge::{Book, Damage, FindingCounts, Ruling};
use fosssim_model::trace::TraceFormatError;
use std::time::Duration;

fn says(reason: Reason) -> String {
    summarize(&SceneResult::without_run("a/b", 15, Verdict::WrongAnswer, reason))
}

#[test]
fn files_instead_of_the_program_are_reported_in_one_sentence() {
    let says = |found| says(Reason::Unusable(UnusableReason::NoProgram { sought: "FOSSSim".to_owned(), found }));
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    assert_eq!(says(FolderContents::Nothing), "the upload has no program called FOSSSim; it is empty");
    let closed = FolderContents::Unreadable("permission denied".to_owned());
    assert_eq!(says(closed), "the upload has no program called FOSSSim: it can't be read: permission denied");
    let found = FolderContents::Others { names: names(&["fosssim-sample", "main.cpp"]), more: 0, elsewhere: None };
    assert_eq!(says(found), "the upload has no program called FOSSSim; it contains fosssim-sample, main.cpp");
    let elsewhere = Some("work/build/FOSSSim".to_owned());
    assert_eq!(
        says(FolderContents::Others { names: names(&["a", "work/"]), more: 6, elsewhere }),
        "the upload has no program called FOSSSim; it contains a, work/ and 6 more; \
         work/build/FOSSSim is not in the expected folder"
    );
}

#[test]
fn a_limit_says_how_far_the_trace_came() {
    let stopped = |limit, steps| {
        let why = Reason::Program(ProgramProgress { limit: Some(limit), steps });
        let result = SceneResult::without_run("a/b", 15, Verdict::TimeLimit, why);
        summarize(&SceneResult { ended: Some(RunEnd::WallLimit), ..result })
    };
    let time = Limit::Time(Duration::from_millis(2500));
    assert_eq!(stopped(time, 4), "the program used up its wall time (2.5 s) at step 5 of 15");
    assert_eq!(stopped(time, 15), "the program used up its wall time (2.5 s) after its last step");
    let crash = SceneResult::without_run(
        "a/b",
        15,
        Verdict::RuntimeError,
        Reason::Program(ProgramProgress { limit: None, steps: 4 }),
    );
    let crash = SceneResult { ended: Some(RunEnd::Signaled(11)), ..crash };
    assert!(summarize(&crash).ends_with("; the last complete record belongs to step 4 of 15"), "{}", summarize(&crash));
    assert!(!describe_ending(&crash).contains("step"), "the same in many scenes: {}", describe_ending(&crash));
    assert!(stopped(Limit::Memory(512 << 20), 0).ends_with("(512 MiB) at step 1 of 15"));
}

#[test]
fn a_wrong_trace_says_how_many_steps_and_where_first() {
    let steps = |wrong| says(Reason::Wrong(WrongTrace::Steps { wrong, first: 3, kind: FindingKind::Coefficient }));
    assert_eq!(steps(12), "12 of 15 steps are wrong, first step 3: wrong coefficient");
    assert_eq!(steps(1), "1 of 15 steps is wrong, first step 3: wrong coefficient");
    assert_eq!(says(Reason::Wrong(WrongTrace::Undisclosed)), "the trace is wrong");
    assert_eq!(
        says(Reason::Wrong(WrongTrace::FirstRecord(FindingKind::Position))),
        "the first record is wrong: wrong position"
    );
    assert_eq!(says(Reason::Right), "all 15 steps are right");
}

#[test]
fn details_contain_only_visible_values() {
    let result = SceneResult::without_run("a/b", 15, Verdict::WrongAnswer, Reason::Wrong(WrongTrace::Undisclosed));
    assert_eq!(list_details(&result), [""; 0]);
    let first = DisclosedFinding::Place { step: 4, kind: FindingKind::Position, place: FindingPlace::Particle(2) };
    let objects = DisclosedFinding::Place {
        step: 5,
        kind: FindingKind::SuperfluousCollision,
        place: FindingPlace::Objects(1, 2),
    };
    let mut counts = FindingCounts::default();
    counts.add(FindingKind::Position, 7);
    counts.add(FindingKind::SuperfluousCollision, 2);
    // A kind that occurs only in damaged records has no example.
    counts.add(FindingKind::Velocity, 1);
    let told = Disclosure {
        official: Book::Fair,
        parity: DisclosedBook {
            ruling: Ruling::WrongAnswer,
            wrong_steps: 7,
            counts,
            first_divergence: Some(first.clone()),
            examples: vec![objects, first],
        },
        fair: None,
        residuals: None,
        damage: Some(Damage {
            frame: 1,
            step: 1,
            offset: 77,
            what: TraceFormatError::NegativeSize { polynomial: 3, size: -1 },
        }),
        trailing_bytes: true,
    };
    let result = SceneResult { disclosure: Some(told), ended: Some(RunEnd::Exited(127)), ..result };
    let lines = list_details(&result);
    assert!(lines[0].starts_with("exit code 127 usually means"));
    assert_eq!(
        lines[1..],
        [
            "first difference: step 4, particle 2: wrong position",
            "counts: superfluous collision (2), wrong position (7)",
            "damaged at byte 77 (frame 1): polynomial 3 has the negative size -1",
            "bytes follow the last record",
        ]
    );
}
