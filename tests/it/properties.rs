//! Properties of judging that hold for every scene and all damaged traces.
use crate::workspace::{embedded, simulate};
use fosssim_oracle::{
    judge::{
        Outcome, Overall, Stop,
        replay::{self, Options},
    },
    scene::Scene,
    sim::{RootSearch, Simulation},
    suite::library,
    trace::Layout,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn judge(scene: &Scene, trace: &[u8], threads: usize, root_search: RootSearch) -> Outcome {
    replay::judge(scene, trace, &Options { threads, root_search, stop_at_first: false, ..Options::default() }, &mut ())
}

#[test]
fn simulated_traces_pass_and_the_audit_agrees() {
    let mut searched = 0;
    for name in library::scene_names() {
        let scene = embedded(name);
        let trace = simulate(&scene);
        let outcome = judge(&scene, &trace, 2, RootSearch::Audit);
        assert_eq!(
            outcome.parity.overall,
            Overall::Passed,
            "{name}: {:?} {:?}",
            outcome.parity.findings.first_divergence,
            outcome.stop
        );
        assert!(!outcome.trailing_bytes && outcome.damage.is_none());
        let mut simulation = Simulation::new(&scene, RootSearch::Audit);
        (0..scene.step_count()).for_each(|_| simulation.step(&mut ()).expect("a step"));
        let counts = simulation.search_counts();
        assert_eq!(counts.disagreements, 0, "{name}");
        searched += counts.searched;
    }
    assert!(searched > 10_000, "the audit searched {searched} times only");
}

#[test]
fn a_run_can_be_cut_short_at_its_first_wrong_step() {
    let scene = embedded(library::scene_names().find(|name| name.starts_with("SimpleTests/")).expect("a scene"));
    let mut trace = simulate(&scene);
    trace[..8].copy_from_slice(&1e3_f64.to_le_bytes());
    let options = Options { threads: 1, root_search: RootSearch::OnDemand, stop_at_first: true, ..Options::default() };
    let outcome = replay::judge(&scene, &trace[..], &options, &mut ());
    assert_eq!(
        (outcome.steps_judged, outcome.parity.findings.wrong_steps, outcome.parity.overall),
        (1, 1, Overall::Failed)
    );
}

/// Returns the contents of an outcome as text, so that NaN can be compared.
fn told(outcome: &Outcome) -> String {
    format!("{outcome:?}")
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Damaged bytes cause no panic and no endless loop, and the result is the same for every number of threads.
    #[test]
    fn damaged_traces_have_one_verdict_on_all_threads(
        which in 0_usize..1000,
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20),
        cut in proptest::option::of(any::<prop::sample::Index>()),
    ) {
        let names: Vec<_> = library::scene_names().collect();
        let scene = embedded(names[which % names.len()]);
        let mut trace = simulate(&scene);
        for (place, byte) in changes {
            let place = place.index(trace.len());
            trace[place] ^= byte;
        }
        if let Some(cut) = cut {
            trace.truncate(cut.index(trace.len()));
        }
        let one = judge(&scene, &trace, 1, RootSearch::OnDemand);
        let many = judge(&scene, &trace, 3, RootSearch::Always);
        prop_assert_eq!(told(&one), told(&many));
        if let Some(Stop::Trace { frame, .. }) = one.stop {
            prop_assert!(frame <= Layout::for_scene(&scene).records());
        }
    }
}
