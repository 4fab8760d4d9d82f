//! The students of the catalog on small random scenes: a mistake is explained correctly, and a correct variant is not
//! explained at all.
use super::{Explanation, Numbers, PairKind, Sample, Subject, compare, explain_polynomials, particle_lists, samples};
use fosssim_judge::fair::formulas::BoundedPairMotion;
use fosssim_model::{
    scene::{Collision, Display, Edge, HalfPlane, Integrator, Particle, Scene},
    sim::{Pair, PairMotion, PointMotion},
};
use fosssim_num::vector::{Vec2, vector_at};
use fosssim_student::assignments::t2m2::{Inputs, formulas};
use fosssim_student::{Area, CATALOG, FALSE_POSITIVES, Object, Row, RowKind, StepLog, Student, World, step};

/// The kind of motion and of bodies in the scenes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    /// All bodies move, and no two quantities are equal.
    General,
    /// All bodies move as before, in a small step, so that leading coefficients are small or dropped.
    Slow,
    /// The scenes are as in courses: equal radii, unit normals, edges whose endpoints are fixed.
    Plain,
}

const BODIES: usize = 5;

fn scene(numbers: &mut Numbers, style: Style) -> Scene {
    let plain = style == Style::Plain;
    let particle = |numbers: &mut Numbers, index: usize| {
        let fixed = plain && index < 3;
        Particle {
            position: numbers.vector(3.0),
            velocity: if fixed { Vec2::zeros() } else { numbers.vector(7.0) },
            mass: 1.0,
            fixed,
            radius: if plain { 0.25 } else { 0.3 + numbers.next(0.2) },
            tag: None,
        }
    };
    let edge = |numbers: &mut Numbers, first: usize| Edge {
        first,
        second: first + 1,
        radius: if plain { 0.25 } else { 0.3 + numbers.next(0.2) },
    };
    let normal = |numbers: &mut Numbers| if plain { Vec2::new(0.0, 1.0) } else { numbers.vector(2.0) };
    Scene {
        duration: 1.0,
        time_step: if style == Style::Slow { 0.001 } else { 0.1 },
        integrator: Integrator::ExplicitEuler,
        collision: Collision::Hybrid { restitution: 1.0, max_iterations: 1, stiffness: 0.0, thickness: 0.0 },
        particles: (0..BODIES).map(|index| particle(numbers, index)).collect(),
        edges: [0, 1, 3].into_iter().map(|first| edge(numbers, first)).collect(),
        half_planes: (0..2).map(|_| HalfPlane { point: numbers.vector(3.0), normal: normal(numbers) }).collect(),
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    }
}

/// Returns the number of polynomials that a student returns for a pair.
fn passed_on(row: &Row, kind: PairKind) -> usize {
    match row.id {
        "handover-position-only" => kind.polynomial_count() - 1,
        "handover-approach-only" => 1,
        _ => kind.polynomial_count(),
    }
}

/// Returns the first detection pass of the first step in many small scenes.
fn first_passes(row: &Row, style: Style) -> Vec<Sample> {
    let mut numbers = Numbers(3);
    let mut samples = Vec::new();
    for number in 0..40 {
        let world = World::new(scene(&mut numbers, style), Student::new(Some(row.mistake)));
        let mut state = world.initial_state();
        let start = state.clone();
        let mut log = StepLog::default();
        if step(&world, &mut state, &mut log, &mut |_, _| {}).is_err() {
            continue;
        }
        let mut lists = log.polynomials.iter().map(|list| list.coefficients().to_vec());
        let body = |index: usize| {
            let place = vector_at(&start.x, index);
            let end = place + world.scene.time_step * vector_at(&start.v, index);
            PointMotion { start: place, shift: end - place }
        };
        let radius = |index: usize| world.scene.particles[index].radius;
        for pair in world.pairs() {
            let one = pair.particle;
            let (motion, second) = match pair.object {
                Object::Particle(two) => {
                    (PairMotion::Particles { centers: [body(one), body(two)], radii: [radius(one), radius(two)] }, two)
                }
                Object::Edge(index) => {
                    let edge = world.scene.edges[index];
                    let (center, ends) = (body(one), [body(edge.first), body(edge.second)]);
                    (PairMotion::Edge { center, ends, radii: [radius(one), edge.radius] }, index)
                }
                Object::HalfPlane(index) => {
                    let HalfPlane { point, normal } = world.scene.half_planes[index];
                    (PairMotion::HalfPlane { center: body(one), radius: radius(one), point, normal }, index)
                }
            };
            let kind = motion.kind();
            samples.push(Sample {
                step: number + 1,
                pass: 0,
                pair: Pair { kind, first: one as u32, second: second as u32 },
                motion,
                polynomials: lists.by_ref().take(passed_on(row, kind)).collect(),
            });
        }
    }
    samples
}

fn concerns_polynomials(row: &Row) -> bool {
    let areas = [Area::ParticleParticle, Area::ParticleEdge, Area::ParticleHalfPlane, Area::Handover];
    areas.contains(&row.area) && !row.id.ends_with("-empty")
}

/// Correct variants that this search would report as wrong. The search is used only if the judge finds an error.
const ACCUSED_IF_ASKED: [&str; 4] =
    ["normalized-largest", "normalized-norm", "normalized-per-pair", "interpolated-all"];

#[test]
fn correct_variants_are_not_reported() {
    let is_known = |id: &str| FALSE_POSITIVES.contains(&id) || ACCUSED_IF_ASKED.contains(&id);
    for style in [Style::General, Style::Slow, Style::Plain] {
        for row in CATALOG.iter().filter(|row| row.kind == RowKind::Variant && !is_known(row.id)) {
            assert_eq!(explain_polynomials(&first_passes(row, style)), [], "{} {style:?}", row.id);
        }
    }
}

/// Mistakes that use a value of another object in a formula, which the pair alone does not show.
const OF_OTHERS: [&str; 10] = [
    "pp-position-index",
    "pp-next-radius",
    "pe-first-edge-radius",
    "pe-first-end-radius",
    "pe-second-end-radius",
    "pe-radius-index",
    "pe-position-index",
    "ph-radius-index",
    "ph-first-half-plane",
    "ph-position-index",
];

fn mistakes() -> impl Iterator<Item = &'static Row> {
    let is_asked = |row: &&Row| concerns_polynomials(row) && !OF_OTHERS.contains(&row.id);
    CATALOG.iter().filter(|row| row.kind == RowKind::Wrong).filter(is_asked)
}

/// The keys of the explanations of some mistakes: the text fits the mistake, not only the numbers.
const EXPECTED_KEYS: [(&str, &str); 25] = [
    ("pp-radii-squared-apart", "radii-squared-apart"),
    ("pp-radius-not-squared", "radius-not-squared"),
    ("pp-one-radius", "first-radius-only"),
    ("pp-end-positions", "end-positions"),
    ("pp-first-still", "particle-still"),
    ("pp-no-approach", "constant"),
    ("pe-edge-still", "edge-still"),
    ("pe-endpoints-swapped", "endpoints-swapped"),
    ("pe-radius-unscaled", "radius-unscaled"),
    ("pe-three-terms", "cut"),
    ("pe-square-no-eh", "term-missing"),
    ("pe-cubic-parentheses", "term-sign"),
    ("pe-linear-one-sh", "term-factor"),
    ("pe-no-cubic", "coefficient-zero"),
    ("pe-alpha-high-unscaled", "one-unscaled"),
    ("pe-alpha-high-is-low", "other-polynomial"),
    ("pe-approach-constant-alpha", "constant-alpha"),
    ("pe-approach-old-letter", "letter"),
    ("ph-no-point", "no-point"),
    ("ph-approach-no-speed", "no-speed-factor"),
    ("handover-lowest-first", "reversed"),
    ("handover-negated", "negated"),
    ("handover-single-precision", "single-precision"),
    ("handover-position-only", "missing-polynomials"),
    ("handover-monic", "monic"),
];

/// Checks the key of the first explanation of a mistake, if [`EXPECTED_KEYS`] has it.
fn check_key(row: &Row, found: &[Explanation]) {
    if let Some((_, key)) = EXPECTED_KEYS.iter().find(|(id, _)| *id == row.id) {
        assert_eq!(found.first().map(|one| one.key.as_str()), Some(*key), "{}: {found:#?}", row.id);
    }
}

/// If no two quantities are equal, every mistake is reported once and reproduced completely.
#[test]
fn mistakes_of_the_catalog_are_explained() {
    assert!(EXPECTED_KEYS.iter().all(|(id, _)| mistakes().any(|row| row.id == *id)));
    for (row, style) in mistakes().flat_map(|row| [(row, Style::General), (row, Style::Slow)]) {
        let found = explain_polynomials(&first_passes(row, style));
        let few = if row.id == "handover-approach-only" { 2 } else { 1 };
        assert_eq!(found.len(), few, "{} {style:?}: {found:#?}", row.id);
        if style == Style::General {
            check_key(row, &found);
        }
        for one in &found {
            assert_eq!(one.reproduced, one.samples, "{} {style:?}: {one:#?}", row.id);
            assert!(one.samples >= 200, "{} {style:?}: {one:#?}", row.id);
        }
    }
}

/// In plain scenes some mistakes are not visible. The visible ones are explained as well as in other scenes.
#[test]
fn mistakes_of_the_catalog_are_explained_in_plain_scenes() {
    let hidden = [
        "pp-first-radius-twice",
        "pp-second-radius-twice",
        "pe-particle-radius-twice",
        "pe-edge-radius-twice",
        "ph-no-normal-square",
        "ph-normal-length",
    ];
    for row in mistakes() {
        let found = explain_polynomials(&first_passes(row, Style::Plain));
        assert_eq!(found.is_empty(), hidden.contains(&row.id), "{}: {found:#?}", row.id);
        check_key(row, &found);
        assert!(found.iter().all(|one| one.reproduced == one.samples), "{}: {found:#?}", row.id);
    }
}

/// Three weights of any size fit three samples, which proves nothing. The radii are multiplied here.
#[test]
fn odd_weights_from_few_samples_are_not_named() {
    let multiplied = |motion: &PairMotion| {
        let PairMotion::Particles { radii: [r1, r2], .. } = motion else { panic!("no particles") };
        let mut lists = particle_lists(motion);
        lists[0][2] += r1 * r2 * r1 * r2 - (r1 + r2) * (r1 + r2);
        lists
    };
    let few = samples(PairKind::ParticleParticle, 3, particle_lists).into_iter();
    let few: Vec<Sample> = (few.zip([[2.0, 3.0], [3.0, 4.0], [3.0, 3.0]]))
        .map(|(sample, radii)| {
            let PairMotion::Particles { centers, .. } = sample.motion else { panic!("no particles") };
            let motion = PairMotion::Particles { centers, radii };
            Sample { polynomials: multiplied(&motion), motion, ..sample }
        })
        .collect();
    assert_eq!(
        explain_polynomials(&few).iter().map(|one| one.key.as_str()).collect::<Vec<_>>(),
        [Explanation::UNEXPLAINED]
    );
}

/// For each polynomial, every formula gives the polynomial that the fair rules expect, including the right quintic.
#[test]
fn the_tables_are_the_formulas_of_the_fair_rules() {
    let mut numbers = Numbers(5);
    for kind in PairKind::ALL {
        for _ in 0..200 {
            let motion = numbers.motion(kind);
            let (judged, inputs) = (BoundedPairMotion::from(&motion).polynomials(), Inputs::new(&motion));
            for (number, &subject) in Subject::all_of_kind(kind).iter().enumerate() {
                for (form, formula) in formulas::readings(subject).iter().enumerate() {
                    let is_other = subject == Subject::EdgeApproach && form == 1;
                    let right =
                        if is_other { judged.other_form(number).expect("an edge") } else { judged.polynomial(number) };
                    let values: Vec<f64> = right.iter().map(|coefficient| coefficient.value).collect();
                    let table = formula.polynomial(&inputs);
                    assert!(compare::polynomial_matches(&table, &values, 1.0), "{subject:?}: {table:?} and {right:?}");
                    assert_eq!(table.len(), right.len());
                }
            }
        }
    }
}
