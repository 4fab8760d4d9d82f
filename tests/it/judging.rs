//! The fast path of judging for correct traces has the same outcome as the full path.
use fosssim_oracle::{
    judge::replay::{self, Options},
    scene::{Scene, original},
    student::{self, CATALOG, Student},
    suite::library,
};
use rayon::prelude::*;

/// Checks that both paths of judging give the same result for a trace, in every field.
pub fn compare(name: &str, scene: &Scene, trace: &[u8]) {
    let [one, other] = [false, true].map(|one_by_one| {
        let options =
            Options { threads: 1, uses_fair_rules: true, judges_individually: one_by_one, ..Options::default() };
        // The results are compared as text, because NaN does not equal NaN.
        format!("{:?}", replay::judge(scene, trace, &options, &mut ()))
    });
    assert!(one == other, "{name}:\n{one}\n{other}");
}

#[test]
fn mistakes_are_judged_the_same_one_by_one() {
    for name in ["ContinuousTimeTests/spinning-edge-sweeps-balls", "GeometricTests/rows-collected-over-many-rounds"] {
        let scene = original::read(library::find_scene(name).expect("a scene")).expect("a sound scene").scene;
        CATALOG.par_iter().for_each(|row| {
            let trace =
                student::record_trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
            compare(&format!("{} on {name}", row.id), &scene, &trace);
        });
    }
}
