//! For every embedded scene, a readable summary of the reference's events, as a snapshot: a change of behavior is a
//! diff, which `cargo insta review` accepts or rejects.
use fosssim_oracle::{
    scene::{self, Scene},
    sim::{PairKindMap, RootSearch, Simulation, pairs},
    suite::library,
    trace::{EventCounts, Frame, Layout, Reader, Recorder},
};
use sha2::{Digest, Sha256};

#[test]
fn summaries_of_all_embedded_scenes() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("summaries");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let mut scenes = 0;
    for name in library::scene_names() {
        let scene =
            scene::read(name, library::find_scene(name).expect("an embedded scene")).expect("a sound scene").scene;
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        let mut observers =
            (Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state()), EventCounts::new(&scene));
        for _ in 0..scene.step_count() {
            simulation.step(&mut observers).expect("a step");
        }
        let (recorder, counts) = observers;
        let trace = recorder.finish().expect("memory").0;
        let text = described(&counts) + &described_trace(&scene, &trace, &counts);
        settings.bind(|| insta::assert_snapshot!(name.replace('/', "--"), text));
        scenes += 1;
    }
    assert!(scenes >= 48, "{scenes} scenes");
}

fn described(counts: &EventCounts) -> String {
    let of_kinds = |numbers: PairKindMap<u64>| {
        let words: Vec<String> = numbers.iter().map(|(kind, number)| format!("{number} {}", kind.name())).collect();
        words.join(", ")
    };
    format!(
        "passes         {} simple, {} continuous-time, {} impulse, {} geometric\n\
         calls          {}\n\
         hits           {}\n",
        counts.simple_passes,
        counts.continuous_time_passes,
        counts.impulse_passes,
        counts.geometric_passes,
        of_kinds(counts.calls),
        of_kinds(counts.hits),
    )
}

/// Describes a trace, with its first forty collisions.
fn described_trace(scene: &Scene, trace: &[u8], counts: &EventCounts) -> String {
    let layout = Layout::for_scene(scene);
    let (mut reader, mut frame) = (Reader::from_slice(trace, layout), Frame::default());
    let (mut collisions, mut polynomials) = (Vec::new(), 0);
    while reader.next(&mut frame).expect("a sound record") {
        let record = reader.record_count() - 1;
        if record > 0 && !layout.is_mid_record(record) {
            let step = layout.step_of_record(record);
            collisions.extend(frame.impulses.iter().map(|impulse| format!("  step {step}: {impulse}\n")));
            polynomials += frame.polynomials.len() as u64;
        }
    }
    let impulses = collisions.len() as u64;
    assert_eq!(reader.offset(), trace.len() as u64);
    assert!(!layout.has_polynomials || polynomials == counts.polynomials);
    let counted = |count: usize, thing| format!("{count} {thing}{}", if count == 1 { "" } else { "s" });
    let parts = [
        scene.collision.kind().name().to_owned(),
        counted(layout.steps as usize, "step"),
        counted(layout.particles, "particle"),
        counted(scene.edges.len(), "edge"),
        counted(scene.half_planes.len(), "half-plane"),
    ];
    let (bytes, records) = (counted(trace.len(), "byte"), counted(layout.records() as usize, "record"));
    let mut text = format!("scene          {}\n", parts.join(", "));
    text += &format!("trace          {bytes}, {} of {records}\n", reader.record_count());
    if layout.has_impulses {
        text += &format!("impulses       {impulses}\n");
    }
    if layout.has_polynomials {
        let per_pass = pairs(scene).polynomial_count();
        text += &format!("polynomials    {polynomials} ({per_pass} per detection pass)\n");
    }
    if impulses > 0 {
        text += "collisions\n";
        text.extend(collisions.iter().take(40).cloned());
    }
    if impulses > 40 {
        text += &format!("  and {} more\n", impulses - 40);
    }
    let digest: String = Sha256::digest(trace).iter().map(|byte| format!("{byte:02x}")).collect();
    text + &format!("sha256         {digest}\n")
}
