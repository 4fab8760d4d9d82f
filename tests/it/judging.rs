//! The shortcut of judging for what is right at once: the outcome is that of the full way.
use fosssim_oracle::{
    judge::replay::{self, Options},
    scene::original,
    student::{self, CATALOGUE, Row, RowKind, Student},
    suite::library,
};
use rayon::prelude::*;

/// Both ways say the same of a sample's trace, to the last field.
fn compare(row: &Row, name: &str) {
    let scene = original::read(library::scene(name).expect("a scene")).expect("a sound scene").scene;
    let trace = student::trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
    let [one, other] = [false, true].map(|one_by_one| {
        let options = Options { threads: 1, fair: true, one_by_one, ..Options::default() };
        // As text, which compares NaN, too.
        format!("{:?}", replay::judge(&scene, &trace[..], &options, &mut ()))
    });
    assert!(one == other, "{} {name}:\n{one}\n{other}", row.id);
}

#[test]
fn other_arithmetic_is_judged_the_same_one_by_one() {
    let rows: Vec<&Row> = CATALOGUE.iter().filter(|row| row.kind == RowKind::Variant).collect();
    let names: Vec<&str> = library::names().collect();
    rows.par_iter().for_each(|row| names.par_iter().for_each(|name| compare(row, name)));
}

#[test]
fn mistakes_are_judged_the_same_one_by_one() {
    let names = ["ContinuousTimeTests/spinning-edge-sweeps-balls", "GeometricTests/rows-collected-over-many-rounds"];
    CATALOGUE.par_iter().for_each(|row| names.iter().for_each(|name| compare(row, name)));
}
