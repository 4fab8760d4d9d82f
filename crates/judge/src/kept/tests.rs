//! A trace that was kept is the trace again, and of a right one next to nothing is kept.
use super::*;
use crate::samples::{BOUNCE, ZONES, changed, relog, run, scene, written};
use fosssim_model::trace::Frame;

/// Reads a few bytes at a time.
struct Slowly<'a>(&'a [u8]);

impl Read for Slowly<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = buffer.len().min(7);
        self.0.read(&mut buffer[..count])
    }
}

fn kept<'a>(scene: &'a Scene, trace: &[u8], most: usize) -> KeptTrace<'a> {
    let keeper = TraceKeeper::new(scene, most);
    let options = Options { fair: true, threads: 1, ..Options::default() };
    keeper.judge(Slowly(trace), &options, &mut ());
    keeper.into_kept()
}

/// A long scene of that kind.
fn long(text: &str) -> Scene {
    let mut scene = scene(text);
    scene.duration *= 40.0;
    scene
}

type Change = fn(&mut Vec<Frame>);

#[test]
fn what_was_kept_reads_as_the_trace_did() {
    let changes: [Change; 7] = [
        |_| {},
        |frames| frames[7].state.velocities[1] += 1e-3,
        |frames| frames[20].state.positions[0] = f64::NAN,
        |frames| frames[0].state.positions[0] += 1.0,
        |frames| relog(&mut frames[30], |_, own| own.iter().map(|c| c + 1e-3).collect()),
        |frames| frames.push(frames[1].clone()),
        |frames| frames.iter_mut().for_each(|frame| relog(frame, |_, own| own.iter().map(|c| 3.0 * c).collect())),
    ];
    for text in [BOUNCE, ZONES] {
        let scene = long(text);
        for (number, change) in changes.into_iter().enumerate() {
            let trace = changed(&scene, change);
            for cut in [0, 5, 100, trace.len() / 2] {
                let trace = &trace[..trace.len() - cut];
                let keeper = TraceKeeper::new(&scene, trace.len() + 1);
                let mut reader = Slowly(trace);
                keeper.judge(&mut reader, &Options { fair: true, ..Options::default() }, &mut ());
                keeper.read_on(reader);
                let kept = keeper.into_kept();
                assert!(kept.bytes(usize::MAX) == trace, "change {number}, cut by {cut}");
                assert!(kept.is_whole() && kept.late().is_empty(), "change {number}, cut by {cut}");
                let mut slowly = Vec::new();
                let mut again = kept.beginning();
                let mut few = [0; 5];
                while let Ok(count @ 1..) = again.read(&mut few) {
                    slowly.extend_from_slice(&few[..count]);
                }
                assert!(slowly == trace, "change {number}, cut by {cut}");
            }
        }
    }
}

#[test]
fn of_a_right_trace_only_the_first_record_is_kept() {
    let scene = long(ZONES);
    let trace = written(&scene, &run(&scene, ()));
    let kept = kept(&scene, &trace, trace.len());
    let [Piece::Bytes(first), Piece::Own { done: 0, steps, .. }] = &kept.store.pieces[..] else {
        panic!("{:?}", kept.store.pieces)
    };
    assert_eq!((*steps, kept.is_whole()), (scene.steps(), true));
    let rest = kept.store.tail.capacity() + first.len();
    assert!(20 * rest < 19 * trace.len(), "{rest} of {}", trace.len());
}

#[test]
fn of_what_does_not_fit_the_wrong_steps_are_kept() {
    let scene = long(ZONES);
    let most = 4000;
    let trace = changed(&scene, |frames| {
        // Steps that differ, and then wrong ones.
        for frame in &mut frames[1..] {
            relog(frame, |_, own| own.iter().map(|c| 3.0 * c).collect());
        }
        let last = frames.len() - 1;
        for index in [last, last - 8] {
            frames[index].state.velocities[0] += 1.0;
        }
    });
    let kept = kept(&scene, &trace, most);
    assert!(!kept.is_whole());
    let beginning = kept.bytes(usize::MAX);
    assert!(trace.starts_with(&beginning) && (most..trace.len() / 2).contains(&beginning.len()), "{}", beginning.len());
    let last = scene.steps();
    let steps: Vec<u32> = kept.late().iter().map(|late| late.step).collect();
    assert!(steps.ends_with(&[last]) && steps.contains(&(last - 4)), "{steps:?}");
    assert!(trace.ends_with(&kept.late().last().expect("a step").records));
}

#[test]
fn nothing_is_kept_of_a_record_that_is_too_large() {
    let scene = scene(BOUNCE);
    let mut store = KeptBytes::new(Layout::of(&scene), 1000);
    store.keep(&[1; 100], true);
    let place = StepPlace { step: 1, before: 0, begin: 40, last: 60, end: 100, is_own: false };
    store.pass(&place);
    let large = vec![2; LATE];
    store.keep(&large, true);
    store.keep(&large, true);
    assert_eq!((store.end(), store.tail.capacity(), store.is_closed), (100 + 2 * LATE as u64, 0, true));
    let (begin, end) = (100, store.end());
    store.pass(&StepPlace { step: 2, before: 60, begin, last: begin, end, is_own: false });
    // The record behind it may be a wrong step again.
    store.keep(&[3; 50], true);
    store.wrong = 4;
    store.pass(&StepPlace { step: 4, before: end, begin: end + 10, last: end + 20, end: end + 30, is_own: false });
    let late: Vec<(u32, usize)> = store.late.iter().map(|late| (late.step, late.records.len())).collect();
    assert_eq!(late, [(4, 30)]);
    assert!(matches!(&store.pieces[..], [Piece::Bytes(bytes)] if *bytes == [1; 100]));
}

#[test]
fn nothing_is_kept_for_nobody() {
    let scene = long(BOUNCE);
    let trace = changed(&scene, |frames| frames[3].state.velocities[1] += 1.0);
    let kept = kept(&scene, &trace, 0);
    assert!(kept.bytes(usize::MAX).is_empty() && kept.late().is_empty() && !kept.is_whole());
}

#[test]
fn what_nobody_judges_is_kept_as_far_as_it_fits() {
    let scene = long(BOUNCE);
    let trace = written(&scene, &run(&scene, ()));
    let most = trace.len() / 2;
    let keeper = TraceKeeper::new(&scene, most);
    io::copy(&mut keeper.reader(Slowly(&trace)), &mut io::sink()).expect("read");
    let kept = keeper.into_kept();
    assert!(!kept.is_whole() && kept.bytes(usize::MAX) == trace[..most]);
}
