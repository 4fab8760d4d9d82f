//! Traces: readers return what writers wrote, and no bytes make a reader panic or use unlimited memory.
use crate::corpus;
use fosssim_oracle::{
    num::vector::Vec2,
    scene::original,
    sim::{RootSearch, Simulation, State},
    trace::{
        Frame, Layout, LenientFrame, LenientReader, LoggedImpulse, ReadFailure, Reader, RecordList, Recorder,
        TraceError, TraceFormatError, Writer,
    },
};
use proptest::test_runner::RngSeed;
use proptest::{collection::vec, prelude::*};

/// Returns any bits, including NaN and infinities, and ordinary numbers.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<u64>().prop_map(f64::from_bits), -10.0..10.0, Just(0.0), Just(-0.0), Just(1e-13), Just(f64::NAN)]
}

fn layout() -> impl Strategy<Value = Layout> {
    let lists = prop_oneof![Just((false, false)), Just((true, false)), Just((true, true))];
    (0_usize..4, lists, 0_u32..4).prop_map(|(particles, (impulses, polynomials), steps)| Layout {
        particles,
        has_impulses: impulses,
        has_polynomials: polynomials,
        steps,
    })
}

fn impulse() -> impl Strategy<Value = LoggedImpulse> {
    (-1..4, any::<i32>(), -1..3, number(), number(), number()).prop_map(|(kind, first, second, x, y, time)| {
        LoggedImpulse { kind, first, second, normal: Vec2::new(x, y), time }
    })
}

fn frame(layout: Layout) -> impl Strategy<Value = Frame> {
    let impulses = if layout.has_impulses { 4 } else { 0 };
    let polynomials = if layout.has_polynomials { 6 } else { 0 };
    let numbers = || vec(number(), 2 * layout.particles);
    (numbers(), numbers(), vec(impulse(), 0..=impulses), vec(vec(number(), 0..8), 0..=polynomials)).prop_map(
        |(positions, velocities, impulses, polynomials)| {
            let mut frame = Frame { state: State { positions, velocities }, impulses, ..Frame::default() };
            polynomials.iter().for_each(|p| frame.polynomials.push(p));
            frame
        },
    )
}

fn trace() -> impl Strategy<Value = (Layout, Vec<Frame>)> {
    layout().prop_flat_map(|layout| {
        let records = usize::try_from(layout.records()).unwrap();
        (Just(layout), vec(frame(layout), records))
    })
}

fn write(layout: Layout, frames: &[Frame]) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), layout);
    frames.iter().for_each(|frame| writer.write_frame(frame));
    writer.finish().unwrap().0
}

/// Reads strictly to the end and writes the same records again.
fn rewrite(mut reader: Reader<impl std::io::Read>) -> Result<Vec<u8>, TraceError> {
    let mut writer = Writer::new(Vec::new(), reader.layout());
    let mut frame = Frame::default();
    while reader.next(&mut frame)? {
        writer.write_frame(&frame);
    }
    Ok(writer.finish().unwrap().0)
}

/// Reads with both readers. For all bytes, the memory stays proportional to them.
fn read_anything(layout: Layout, bytes: &[u8]) -> Result<(), TestCaseError> {
    let known = rewrite(Reader::from_slice(bytes, layout));
    let unknown = rewrite(Reader::new(bytes, layout));
    prop_assert_eq!(&known, &unknown, "the known length makes no difference");
    let mut lenient = LenientReader::from_slice(bytes, layout);
    let mut frame = LenientFrame::default();
    for record in 0..layout.records() {
        let Err(stop) = lenient.next(&mut frame) else { continue };
        prop_assert!(known.is_err(), "the strict reader accepts what the lenient one does not: {}", stop);
        prop_assert_eq!(stop.error.frame, record);
        return Ok(());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn written_values_are_read_again((layout, frames) in trace(), trailing in vec(any::<u8>(), 0..40)) {
        let mut bytes = write(layout, &frames);
        let sound = bytes.len();
        bytes.extend_from_slice(&trailing);
        prop_assert_eq!(&rewrite(Reader::from_slice(&bytes, layout)).unwrap(), &bytes[..sound]);
        let mut reader = Reader::new(&bytes[..], layout);
        let mut frame = Frame::default();
        while reader.next(&mut frame).unwrap() {}
        prop_assert_eq!(reader.offset(), sound as u64);
    }

    #[test]
    fn both_readers_agree_on_sound_traces((layout, frames) in trace()) {
        let bytes = write(layout, &frames);
        let mut lenient = LenientReader::new(&bytes[..], layout);
        let mut read = LenientFrame::default();
        for frame in &frames {
            lenient.next(&mut read).unwrap();
            prop_assert!(read.note.is_none());
            let trimmed: Vec<Vec<u64>> = frame
                .polynomials
                .iter()
                .map(|p| p.iter().skip_while(|c| c.abs() < 1e-12).map(|c| c.to_bits()).collect())
                .collect();
            let actual: Vec<Vec<u64>> =
                read.polynomials.iter().map(|p| p.iter().map(|c| c.to_bits()).collect()).collect();
            prop_assert_eq!(&trimmed, &actual);
            let kept = frame.polynomials.iter().zip(&trimmed).all(|(a, b)| a.len() == b.len());
            prop_assert_eq!(read.is_unchanged, kept);
            let (state, impulses) = (read.state.clone(), read.impulses.clone());
            let again = Frame { state, impulses, polynomials: frame.polynomials.clone() };
            prop_assert_eq!(write(layout, &[again]), write(layout, std::slice::from_ref(frame)));
        }
        prop_assert!(!lenient.has_more());
    }

    #[test]
    fn random_bytes_do_no_harm(layout in layout(), bytes in vec(any::<u8>(), 0..600)) {
        read_anything(layout, &bytes)?;
    }

    #[test]
    fn mutated_traces_do_no_harm(
        (layout, frames) in trace(),
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = write(layout, &frames);
        if bytes.is_empty() {
            return Ok(());
        }
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        read_anything(layout, &bytes)?;
        bytes.truncate(cut.index(bytes.len()));
        read_anything(layout, &bytes)?;
    }
}

/// Returns a trace of one particle and one step, with an impulse and two polynomials in each later record, and the
/// offset of each of its records.
fn small() -> (Layout, Vec<u8>) {
    let layout = Layout { particles: 1, has_impulses: true, has_polynomials: true, steps: 1 };
    let state = State { positions: vec![1.0, 2.0], velocities: vec![3.0, 4.0] };
    let initial = Frame { state, ..Frame::default() };
    let mut later = initial.clone();
    later.impulses.push(LoggedImpulse { kind: 2, first: 0, second: 0, normal: Vec2::new(0.0, 1.0), time: 0.5 });
    later.polynomials.push(&[1.0, 2.0, 3.0]);
    later.polynomials.push(&[4.0]);
    (layout, write(layout, &[initial, later.clone(), later]))
}

#[test]
fn every_cut_of_a_small_trace_is_named() {
    let (layout, bytes) = small();
    // A later record consists of: state 32, count 4, impulse 36, count 4, polynomials 28 and 12.
    assert_eq!(bytes.len(), 40 + 2 * 116);
    for cut in 0..bytes.len() {
        let error = rewrite(Reader::from_slice(&bytes[..cut], layout)).unwrap_err();
        let record = if cut < 40 { 0 } else { 1 + (cut as u64 - 40) / 116 };
        let begin = if record == 0 { 0 } else { 40 + 116 * (record - 1) };
        let inside = cut as u64 - begin;
        let (offset, what) = match (record, inside) {
            (0, 0) => (0, TraceFormatError::Empty),
            (records, 0) => (0, TraceFormatError::TooFewRecords { records, expected: 3 }),
            (_, 1..32) => (0, TraceFormatError::State { needs: 32, left: inside }),
            (_, 32..36) => (32, TraceFormatError::CountCut { list: RecordList::Impulses, left: inside - 32 }),
            (0, _) => (36, TraceFormatError::CountCut { list: RecordList::Polynomials, left: inside - 36 }),
            (_, 36..72) => {
                let what = TraceFormatError::CountBeyondEnd {
                    list: RecordList::Impulses,
                    count: 1,
                    needs: 36,
                    left: inside - 36,
                };
                (32, what)
            }
            (_, 72..76) => (72, TraceFormatError::CountCut { list: RecordList::Polynomials, left: inside - 72 }),
            (_, 76..80) => (76, TraceFormatError::PolynomialCut { polynomial: 0, count: 2 }),
            (_, 80..104) => (76, TraceFormatError::SizeBeyondEnd { polynomial: 0, size: 3, left: inside - 80 }),
            (_, 104..108) => (104, TraceFormatError::PolynomialCut { polynomial: 1, count: 2 }),
            _ => (104, TraceFormatError::SizeBeyondEnd { polynomial: 1, size: 1, left: inside - 108 }),
        };
        let step = u32::from(record > 0);
        assert_eq!(error, TraceError { offset: begin + offset, frame: record, step, what }, "cut at {cut}");
        assert_eq!(rewrite(Reader::new(&bytes[..cut], layout)).unwrap_err(), error, "cut at {cut}, unknown length");
    }
}

#[test]
fn oddities_are_noted_and_read_over() {
    let (layout, mut bytes) = small();
    bytes[40 + 36] = 7;
    bytes[156 + 40] = 9;
    let mut reader = Reader::from_slice(&bytes, layout);
    let mut frame = Frame::default();
    let mut notes = Vec::new();
    while reader.next(&mut frame).unwrap() {
        notes.extend(reader.notes().iter().map(|note| (note.offset, note.what.clone())));
    }
    let outside = TraceFormatError::IndexOutOfRange { impulse: 0, object: "particle".into(), index: 9, count: 1 };
    assert_eq!(notes, [(76, TraceFormatError::UnknownKind { impulse: 0, kind: 7 }), (192, outside)]);
}

#[test]
fn negative_counts_are_rejected() {
    let (layout, mut bytes) = small();
    bytes[40 + 35] = 0xff;
    let error = rewrite(Reader::from_slice(&bytes, layout)).unwrap_err();
    let count = i32::from_le_bytes([1, 0, 0, 0xff]);
    assert_eq!((error.offset, error.what), (72, TraceFormatError::NegativeCount { list: RecordList::Impulses, count }));
}

/// Returns the example of trace-format.md 3 with one of the collision types.
fn example(collision: &str) -> Vec<u8> {
    let xml = format!(
        r#"<scene><duration time="0.5"/><integrator type="explicit-euler" dt="0.5"/><collision type="{collision}"
            COR="1" maxiters="5" k="0" thickness="0"/>
            <particle m="1" px="0" py="0.5" vx="0" vy="-1" fixed="0" radius="0.25"/>
            <halfplane px="0" py="0" nx="0" ny="1"/></scene>"#
    );
    let scene = original::read(xml.as_bytes()).expect("a scene").scene;
    let mut simulation = Simulation::new(&scene, RootSearch::default());
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).unwrap();
    }
    recorder.finish().unwrap().0
}

#[test]
fn the_annotated_example_is_recorded_byte_for_byte() {
    let numbers = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let integers = |integers: &[i32]| integers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let initial = [numbers(&[0.0, 0.5, 0.0, -1.0]), integers(&[0, 0])].concat();
    let later = [
        numbers(&[0.0, 1.0, 0.0, 1.0]),
        integers(&[1, 2, 0, 0]),
        numbers(&[-0.0, -0.25, 0.5]),
        integers(&[2, 3]),
        numbers(&[-0.25, 0.5, -0.1875]),
        integers(&[2]),
        numbers(&[-0.25, 0.25]),
    ]
    .concat();
    assert_eq!(example("continuous-time"), [initial, later.clone(), later].concat());

    // At the end of the step the particle is exactly on the plane, so there is no impulse.
    let simple = example("simple");
    assert_eq!(simple.len(), 72);
    assert_eq!(simple[36..], [numbers(&[0.0, 0.0, 0.0, -1.0]), integers(&[0])].concat());
    assert_eq!((example("none").len(), example("penalty").len()), (64, 64));
    let hybrid = example("hybrid");
    assert_eq!(hybrid.len(), 312);
    assert_eq!(hybrid[40 + 32..40 + 40], integers(&[0, 4]));
    assert_eq!(hybrid[40..176], hybrid[176..], "no geometric part, so the records of the step are equal");
}

/// Reads the corpus's traces as the original does: its output shows whether and why it stopped.
#[test]
fn lenient_reading_stops_where_the_original_stopped() {
    let Some(folder) = corpus::folder() else { return };
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text("manifest.json")).unwrap();
    let layout = |scene: &str| {
        let scene = manifest["scenes"].as_array().unwrap().iter().find(|s| s["scene"] == scene).unwrap();
        let polynomials = ["continuous-time", "hybrid"].contains(&scene["collision"].as_str().unwrap());
        let number = |key: &str| scene[key].as_u64().unwrap();
        let (particles, steps) = (number("particles") as usize, number("steps") as u32);
        Layout { particles, has_impulses: polynomials, has_polynomials: polynomials, steps }
    };
    let mut cases = 0;
    for row in text("verdicts.jsonl").lines() {
        let row: serde_json::Value = serde_json::from_str(row).unwrap();
        let Some(file) = row["trace_file"].as_str() else { continue };
        let end = row["oracle_end"].as_str().unwrap();
        let bytes = corpus::unpack(&folder.join(file));
        let layout = layout(row["scene"].as_str().unwrap());
        let mut reader = LenientReader::from_slice(&bytes, layout);
        let mut frame = LenientFrame::default();
        let stop = (0..layout.records()).find_map(|_| reader.next(&mut frame).err());
        let said = |text: &str| row["stdout"].as_str().unwrap().contains(text);
        let cause = stop.as_ref().map(|stop| stop.cause);
        match end {
            "exit 0" => assert_eq!(cause, None, "{file}"),
            "exit 1" if said("Failed to load timestep") => assert_eq!(cause, Some(ReadFailure::State), "{file}"),
            "exit 1" if said("deserialize") => assert_eq!(cause, Some(ReadFailure::Impulses), "{file}"),
            "signal 6" => assert!(cause.is_some(), "{file}"),
            // The original did not end its computation, so the trace may have any contents.
            "timeout" => {}
            other => panic!("{file}: {other} {stop:?}"),
        }
        cases += 1;
    }
    corpus::ran("lenient reading", cases);
}
