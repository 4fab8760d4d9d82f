//! The work of the fuzz targets. The ordinary tests replay the seeds through the same functions.
use fosssim_oracle::{
    diagnose,
    judge::{Book, Ruling, replay},
    sandbox,
    scene::{Collision, Scene, original},
    sim::{RootSearch, Simulation},
    suite::{config, results},
    trace::{Frame, Layout, LenientFrame, LenientReader, Reader, Recorder, TraceError, Writer},
};

/// The scenes of the `trace` target, one per collision type.
pub const SCENES: [&str; 5] = [
    r#"<scene><duration time="0.3"/><integrator type="explicit-euler" dt="0.1"/><collision type="none"/>
        <particle m="1" px="0" py="0" vx="1" vy="2" fixed="0" radius="0.1"/></scene>"#,
    r#"<scene><duration time="0.3"/><integrator type="symplectic-euler" dt="0.1"/>
        <collision type="penalty" k="10" thickness="0.1"/>
        <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0" radius="0.3"/>
        <particle m="2" px="0.5" py="0" vx="0" vy="0" fixed="0" radius="0.3"/></scene>"#,
    r#"<scene><duration time="0.3"/><integrator type="explicit-euler" dt="0.1"/><collision type="simple" COR="0.5"/>
        <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0" radius="0.3"/>
        <particle m="2" px="0.5" py="0" vx="0" vy="0" fixed="0" radius="0.3"/>
        <halfplane px="0" py="-0.2" nx="0" ny="1"/></scene>"#,
    r#"<scene><duration time="0.2"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="continuous-time" COR="1"/>
        <particle m="1" px="0" py="0.5" vx="0" vy="-4" fixed="0" radius="0.25"/>
        <halfplane px="0" py="0" nx="0" ny="1"/></scene>"#,
    r#"<scene><duration time="0.2"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="hybrid" COR="0.5" maxiters="2" k="1" thickness="0.01"/>
        <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.1"/>
        <particle m="1" px="1" py="0" vx="0" vy="0" fixed="0" radius="0.1"/>
        <particle m="1" px="0.4" py="0.5" vx="0" vy="-4" fixed="0" radius="0.1"/>
        <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-0.15" nx="0" ny="1"/></scene>"#,
];

/// Scenes with more steps, particles, edges or half-planes are not simulated.
const SMALL: usize = 6;

/// Reads a scene. If a small scene is accepted, it is simulated, and its recording is read again.
pub fn scene(bytes: &[u8]) {
    let Ok(read) = original::read(bytes) else { return };
    let mut scene = read.scene;
    let sizes = [scene.particles.len(), scene.edges.len(), scene.half_planes.len(), scene.forces.len()];
    if sizes.into_iter().any(|size| size > SMALL) {
        return;
    }
    if let Collision::Hybrid { max_iterations, .. } = &mut scene.collision {
        *max_iterations = (*max_iterations).min(5);
    }
    if let Ok((layout, trace, true)) = record(&scene, SMALL) {
        let mut reader = Reader::from_slice(&trace, layout);
        let mut frame = Frame::default();
        while reader.next(&mut frame).expect("our own recording is sound") {
            assert!(reader.notes().is_empty(), "our own recording has nothing odd: {:?}", reader.notes());
        }
        assert_eq!(reader.offset(), trace.len() as u64);
    }
}

/// Returns the recording of at most `steps` steps with its layout, and whether all steps had a result.
pub fn record(scene: &Scene, steps: usize) -> std::io::Result<(Layout, Vec<u8>, bool)> {
    let steps = scene.step_count().min(u32::try_from(steps).unwrap_or(u32::MAX));
    let layout = Layout { steps, ..Layout::for_scene(scene) };
    let mut simulation = Simulation::new(scene, RootSearch::default());
    let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
    let sound = (0..steps).all(|_| simulation.step(&mut recorder).is_ok());
    Ok((layout, recorder.finish()?.0, sound))
}

/// Reads a trace in every way and judges it. The first byte chooses the scene.
pub fn trace(bytes: &[u8]) {
    let Some((&choice, trace)) = bytes.split_first() else { return };
    let xml = SCENES[usize::from(choice) % SCENES.len()];
    let scene = original::read(xml.as_bytes()).expect("our own scene").scene;
    let layout = Layout::for_scene(&scene);

    let strict = frames(Reader::from_slice(trace, layout));
    assert_eq!(strict, frames(Reader::new(trace, layout)), "knowing the length makes no difference");

    let mut lenient = LenientReader::new(trace, layout);
    let mut frame = LenientFrame::default();
    let stop = (0..layout.records()).find_map(|_| lenient.next(&mut frame).err());
    assert!(stop.is_none() || strict.is_err(), "what the strict reader accepts, the lenient one does: {stop:?}");

    let options = replay::Options { threads: 1, ..replay::Options::default() };
    let outcome = replay::judge(&scene, trace, &options, &mut ());
    let has_verdict = outcome.parity.overall != fosssim_oracle::judge::Overall::None;
    assert_eq!(has_verdict, outcome.stop.is_none() && outcome.parity.endless_step.is_none());
}

/// Numbers that overflow, underflow or are not finite, as seeds of [`judge`].
pub const EXTREMES: [f64; 10] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e100, -1e100, 1e155, f64::MAX, 1e-160, 5e-324, 0.0];

/// Returns the recording of a scene. All positions and velocities from the second record on are one number.
pub fn extreme(choice: usize, value: f64) -> Vec<u8> {
    let scene = original::read(SCENES[choice].as_bytes()).expect("our own scene").scene;
    let (layout, trace, _) = record(&scene, usize::MAX).expect("writing to memory");
    let (mut reader, mut writer) = (Reader::from_slice(&trace, layout), Writer::new(Vec::new(), layout));
    let mut frame = Frame::default();
    while reader.next(&mut frame).expect("our own recording is sound") {
        if reader.record_count() > 1 {
            frame.state.positions.fill(value);
            frame.state.velocities.fill(value);
        }
        writer.write_frame(&frame);
    }
    writer.finish().expect("writing to memory").0
}

/// Returns a scene, a trace of it made from these bytes, and its recording. The first byte chooses the scene, and the
/// others are the trace. If the trace is too short, the rest comes from the recording, so that a few bytes make a
/// complete trace.
fn whole(bytes: &[u8]) -> Option<(Scene, Vec<u8>, Vec<u8>)> {
    let (&choice, start) = bytes.split_first()?;
    let xml = SCENES[usize::from(choice) % SCENES.len()];
    let scene = original::read(xml.as_bytes()).expect("our own scene").scene;
    let (_, recorded, _) = record(&scene, usize::MAX).expect("writing to memory");
    let trace = [start, recorded.get(start.len()..).unwrap_or_default()].concat();
    Some((scene, trace, recorded))
}

/// Explains a complete trace.
pub fn explain(bytes: &[u8]) {
    let Some((scene, trace, recorded)) = whole(bytes) else { return };
    let explanations = diagnose::explain(&scene, &trace);
    assert!(trace != recorded || explanations.is_empty(), "nothing is wrong with the recording: {explanations:?}");
}

/// Judges a complete trace by both rule books.
pub fn judge(bytes: &[u8]) {
    let Some((scene, trace, _)) = whole(bytes) else { return };
    let options = replay::Options { threads: 1, uses_fair_rules: true, ..replay::Options::default() };
    let outcome = replay::judge(&scene, &trace[..], &options, &mut ());
    for book in [Book::Parity, Book::Fair] {
        let account = outcome.findings_by(book);
        let is_accepted = outcome.ruling(book) == Ruling::Accepted;
        assert!(account.wrong_steps <= u64::from(outcome.steps_judged), "a step is wrong once");
        assert!(!is_accepted || account.wrong_steps == 0, "what is accepted has no wrong step");
        assert!(is_accepted || outcome.right_steps(book) < outcome.steps, "a rejected trace has a wrong step");
    }
    let finite = |value: &f64| value.is_finite();
    if outcome.ruling(Book::Fair) == Ruling::Accepted {
        let mut reader = Reader::from_slice(&trace, Layout::for_scene(&scene));
        let mut frame = Frame::default();
        while reader.next(&mut frame).expect("what is accepted is sound") {
            assert!(frame.state.positions.iter().chain(&frame.state.velocities).all(finite), "no physics, no points");
        }
    }
}

/// Reads a suite. The positions of its errors must be in the text.
pub fn suite(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match config::read(text) {
        Ok(suite) => {
            let total: f64 = suite.groups.iter().map(|group| group.marking.points).sum();
            assert!(total.is_finite() && total >= 0.0, "points are numbers: {total}");
        }
        Err(error) => {
            let text = error.to_string();
            assert!(!text.trim().is_empty(), "a rejection without a reason");
        }
    }
}

/// Reads a line of the journal. Writing and reading it again changes nothing.
pub fn journal(bytes: &[u8]) {
    let Some(entry) = results::read_line(bytes) else { return };
    let again = results::format_line(&entry.key, &entry.submission, &entry.result);
    let same = results::read_line(&again).expect("our own line is sound");
    // The comparison is not by `==`, because NaN must also stay the same.
    assert_eq!(format!("{same:?}"), format!("{entry:?}"));
}

/// Reads messages between the grader and its supervisor.
pub fn wire(bytes: &[u8]) -> usize {
    sandbox::read_messages(bytes)
}

/// Returns the number of records and of their bytes, or the error.
fn frames(mut reader: Reader<&[u8]>) -> Result<(u64, u64), TraceError> {
    let mut frame = Frame::default();
    while reader.next(&mut frame)? {}
    Ok((reader.record_count(), reader.offset()))
}
