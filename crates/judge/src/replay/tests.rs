//! Tests of batches and limits, inside the module.
mod ways;

use super::*;
use crate::{finding::FindingKind, rules::Ruling, samples::changed_reference_trace};
use fosssim_model::trace::{Frame, Reader, Recorder, Writer};
use fosssim_num::vector::Vec2;

/// Returns a scene in which a pass logs more bytes than the reader's buffer holds.
fn crowd() -> Scene {
    let ball = |number: usize| {
        format!(r#"<particle m="1" px="{number}" py="0" vx="0" vy="0.{number:03}" fixed="0" radius="0.1"/>"#)
    };
    let balls: String = (0..120).map(ball).collect();
    let xml = format!(
        r#"<scene><duration time="0.2"/><integrator type="explicit-euler" dt="0.1"/>
            <collision type="continuous-time"/>{balls}</scene>"#
    );
    fosssim_model::scene::read("crowd", xml.as_bytes()).expect("a scene").scene
}

/// A batch contains as many records as fit into its memory, for lists of every size.
#[test]
fn a_batch_counts_all_lists() {
    let scene = crate::samples::scene(crate::samples::BOUNCE_SCENE);
    let scene = Scene { duration: 100.0, ..scene };
    let impulse = LoggedImpulse { kind: 2, first: 0, second: 0, normal: Vec2::zeros(), time: 0.5 };
    for (impulses, polynomials) in [(40_000, 0), (0, 200_000)] {
        let trace = changed_reference_trace(&scene, |frames| {
            for frame in &mut frames[1..21] {
                frame.impulses = vec![impulse; impulses];
                (0..polynomials).for_each(|_| frame.polynomials.push(&[]));
            }
        });
        let mut replay = Replay::new(&scene, LenientReader::new(&trace[..], Layout::for_scene(&scene)), true);
        replay.read_initial().expect("a first record");
        let mut batch = Batch::default();
        assert!(replay.read_batch(&mut batch, BATCH_STEPS).is_none());
        assert!(batch.filled == 1 && batch.bytes > 1_000_000, "{} steps, {} bytes", batch.filled, batch.bytes);
    }
}

/// The contacts of a full record are distinguished without comparing every contact with all others.
#[test]
fn a_crowd_of_contacts_is_judged() {
    let scene = crate::samples::scene(crate::samples::BOUNCE_SCENE);
    let of = |second| LoggedImpulse { kind: 9, first: 0, second, normal: Vec2::zeros(), time: 0.5 };
    let trace = changed_reference_trace(&scene, |frames| {
        for frame in &mut frames[1..3] {
            frame.impulses.extend((0..500_000).map(of).chain([of(7), of(7)]));
        }
    });
    let outcome = crate::samples::judge_by_both(&scene, &trace);
    assert_eq!(outcome.parity.findings.counts.get(FindingKind::SuperfluousCollision), 500_002);
    let fair = outcome.fair.expect("asked");
    let counts =
        [FindingKind::SuperfluousCollision, FindingKind::RepeatedCollision].map(|kind| fair.findings.counts.get(kind));
    assert_eq!(counts, [500_000, 2]);
}

#[test]
fn a_record_beyond_the_memory_is_wrong_by_its_length_or_not_judged() {
    let scene = crowd();
    let layout = Layout::for_scene(&scene);
    let mut simulation = Simulation::new(&scene, Default::default());
    let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
    (0..2).for_each(|_| simulation.step(&mut recorder).expect("a step"));
    let right = recorder.finish().expect("memory").0;
    // This is the same trace with an additional polynomial at the end of every list.
    let (mut reader, mut writer) = (Reader::from_slice(&right, layout), Writer::new(Vec::new(), layout));
    let mut frame = Frame::default();
    while reader.next(&mut frame).expect("a frame") {
        frame.polynomials.push(&[1.0]);
        writer.write_frame(&frame);
    }
    let longer = writer.finish().expect("memory").0;
    for threads in [1, 2] {
        let options = Options { threads, ..Options::default() };
        let judge = |memory, mut trace: &[u8]| judge_with_memory(memory, None, &scene, &mut trace, &options, &mut ());
        let whole = judge(usize::MAX, &right);
        assert!(whole.stop.is_none() && whole.parity.findings.counts.total() == 0, "{whole:?}");
        let Some(Stop::Trace { step: 1, frame: 2, cause: ReadFailure::Limit, what, .. }) = judge(0, &right).stop else {
            panic!("not judged")
        };
        assert!(what.to_string().contains("14280 polynomials, as many as it should have"), "{what}");
        let wrong = judge(0, &longer);
        assert!(wrong.stop.is_none() && wrong.parity.findings.wrong_steps == 2, "{wrong:?}");
        assert!(wrong.parity.findings.examples[0].to_string().contains("14281 polynomials"), "{wrong:?}");
    }
}

/// A state without a next state is a wrong result, but the fair rules judge the rest of the trace.
#[test]
fn a_step_without_result_ends_nothing_but_the_originals_rules() {
    let scene = crate::samples::scene(crate::samples::ZONES_SCENE);
    let trace = changed_reference_trace(&scene, |frames| {
        let layout = Layout::for_scene(&scene);
        frames[usize::try_from(layout.end_record(1)).expect("small")].state.positions[4] = f64::NAN;
    });
    for threads in [1, 2] {
        let judge = |fair, trace: &[u8]| {
            judge_with_memory(
                usize::MAX,
                None,
                &scene,
                &mut { trace },
                &Options { uses_fair_rules: fair, threads, ..Options::default() },
                &mut (),
            )
        };
        let both = judge(true, &trace);
        assert!(matches!(both.parity.endless_step, Some(StepError::RootSearch { step: 2, .. })), "{both:?}");
        assert_eq!(
            (both.steps_judged, [Book::Parity, Book::Fair].map(|book| both.ruling(book))),
            (3, [Ruling::WrongAnswer; 2])
        );
        assert_eq!([Book::Parity, Book::Fair].map(|book| both.steps_judged_by(book)), [1, 3]);
        let fair = &both.fair.as_ref().expect("asked").findings;
        assert_eq!((fair.counts.get(FindingKind::NoResult), fair.wrong_steps), (1, 2), "{fair:?}");
        let parity = judge(false, &trace);
        assert_eq!(format!("{:?}", parity.parity), format!("{:?}", both.parity));
        assert_eq!((parity.steps_judged, parity.ruling(Book::Parity)), (1, Ruling::WrongAnswer));
        // A trace that cannot be read is bad, regardless of earlier findings.
        assert_eq!(judge(true, &trace[..trace.len() - 40]).ruling(Book::Fair), Ruling::BadTrace);
    }
}
