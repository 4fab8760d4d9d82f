//! For every embedded scene, a readable summary of the reference's events, as a snapshot: a change of behavior is a
//! diff, which `cargo insta review` accepts or rejects.
use fosssim_oracle::{
    scene,
    sim::{PairKindMap, RootSearch, Simulation},
    suite::library,
    trace::{EventCounts, Layout, Recorder, Summary},
};

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
        let text = format!("{}{}", described(&counts), Summary::for_scene(&scene, &trace[..]));
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
