//! Other coordinates, lengths and names change only the names.
//!
//! Quarter turns and mirrors only exchange and negate coordinates, so every sum of products keeps its bits. A
//! power of two as the unit of length also keeps them, unless an absolute constant matters. Other maps change the
//! round-off, so each step is compared from the same state, if no decision depends on round-off.
use super::{
    built_in,
    crowd::{Wanted, crowd, hybrid},
    mended::Mended,
    search,
    transform::{Map, reversed, with_ends_exchanged, with_particles_reversed},
};
use fosssim_oracle::{
    num::{
        bounded::BoundedValue,
        decision::{HitCertainty, decide},
        polynomial::Polynomial,
        vector::{Vec2, length},
    },
    scene::{Collision, CollisionDetection, Integrator, Scene},
    sim::{Decision, Detection, Observer, Pair, PairKind, RootSearch, Simulation, State},
};
use proptest::prelude::*;
use rayon::prelude::*;
use std::cell::Cell;

/// A detection: the pair, its polynomials, and the time and normal of a hit.
type Heard = (Pair, Vec<Polynomial>, Option<(f64, Vec2)>);

/// The results of a step.
#[derive(Debug, Default, PartialEq)]
struct Story {
    detections: Vec<Heard>,
    middle: Option<State>,
}

impl Observer for Story {
    fn begin_step(&mut self, _step: u32) {
        *self = Self::default();
    }
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let hit = match detection.decision {
            Decision::Hit { time, normal } => Some((time, normal)),
            Decision::Miss { .. } => None,
        };
        self.detections.push((detection.pair, detection.polynomials.to_vec(), hit));
    }
    fn observe_synchronization(&mut self, state: &State) {
        self.middle = Some(state.clone());
    }
}

impl Story {
    /// Returns the results as the map changes them.
    fn mapped(&self, map: &Map) -> Self {
        let square = map.factor * map.factor;
        let detection = |(pair, polynomials, hit): &Heard| {
            let scales = if pair.kind == PairKind::ParticleEdge {
                [square * square, square, square, square * square * square]
            } else {
                [square; 4]
            };
            let scaled = |(polynomial, scale): (&Polynomial, f64)| {
                let coefficients: Vec<f64> = polynomial.coefficients().iter().map(|c| scale * c).collect();
                Polynomial::untrimmed(&coefficients)
            };
            let polynomials = polynomials.iter().zip(scales).map(scaled).collect();
            (*pair, polynomials, hit.map(|(time, normal)| (time, map.vector(normal))))
        };
        Self {
            detections: self.detections.iter().map(detection).collect(),
            middle: self.middle.as_ref().map(|state| map.state(state)),
        }
    }

    /// Returns whether the other results have dropped other coefficients as too small.
    fn drops_others(&self, other: &Self) -> bool {
        self.detections.iter().zip(&other.detections).any(|(one, two)| {
            one.1.iter().zip(&two.1).any(|(one, two)| one.coefficients().len() != two.coefficients().len())
        })
    }
}

/// Simulates the scene and its image side by side. Returns how many steps were the same, and what ended the comparison:
/// `None` if nothing did, otherwise whether a coefficient was dropped on one side only.
fn same_steps(scene: &Scene, map: &Map) -> (u32, Option<bool>) {
    let mut one = Simulation::new(scene, RootSearch::OnDemand);
    let mut two = Simulation::new(&map.scene(scene), RootSearch::OnDemand);
    let (mut left, mut right) = (Story::default(), Story::default());
    for step in 0..scene.step_count() {
        one.step(&mut left).expect("an ordinary step");
        two.step(&mut right).expect("an ordinary step");
        if left.mapped(map) != right || map.state(one.state()) != *two.state() {
            return (step, Some(left.drops_others(&right)));
        }
    }
    (scene.step_count(), None)
}

/// Returns whether the integrator is explicit. The linear solver chooses pivots by rows and columns, which a turn
/// exchanges.
fn is_explicit(scene: &Scene) -> bool {
    !matches!(scene.integrator, Integrator::ImplicitEuler | Integrator::LinearizedImplicitEuler)
}

/// Returns whether forces are summed along x. The contest's penalty force is summed in the order of a sweep along x,
/// which a turn changes.
fn sums_along_x(scene: &Scene) -> bool {
    matches!(scene.collision, Collision::Penalty { detection: CollisionDetection::Contest, .. })
}

/// Returns whether the scene has layers in boxes. The contest's boxes do not turn with the bodies, so they contain
/// other bodies whose layers alone are near.
fn has_layers_in_boxes(scene: &Scene) -> bool {
    sums_along_x(scene) && matches!(scene.collision, Collision::Penalty { thickness, .. } if thickness > 0.0)
}

#[test]
fn quarter_turns_and_mirrors_change_no_bit() {
    let maps = [[[0.0, -1.0], [1.0, 0.0]], [[-1.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]];
    let different: Vec<String> = built_in()
        .par_iter()
        .filter(|(_, scene)| is_explicit(scene) && !sums_along_x(scene))
        .flat_map_iter(|(name, scene)| {
            let maps = maps.map(|rows| Map { rows, ..Map::NONE });
            let differs = move |map: Map| same_steps(scene, &map).1.map(|_| format!("{name} {:?}", map.rows));
            maps.into_iter().filter_map(differs)
        })
        .collect();
    assert!(different.is_empty(), "{different:#?}");
}

/// Scenes of slow bodies, and of edges in rigid zones.
const ABOUT_THE_BOUND: [&str; 5] = [
    "barely-closing",
    "impact-exactly-past-step-end",
    "rows-collected-over-many-rounds",
    "small-and-large-turns-of-fractional-masses",
    "funnel-of-fractional-masses",
];

/// Newton's method stops at an absolute bound, and coefficients are dropped at an absolute bound.
#[test]
fn powers_of_two_as_unit_of_length_change_no_bit() {
    let cases: Vec<(String, (u32, Option<bool>), u32)> = built_in()
        .par_iter()
        .filter(|(_, scene)| scene.integrator != Integrator::ImplicitEuler)
        .flat_map_iter(|(name, scene)| {
            [4.0, 0.5].map(|factor| {
                let map = Map { factor, ..Map::NONE };
                (format!("{name} times {factor}"), same_steps(scene, &map), scene.step_count())
            })
        })
        .collect();
    let unexplained: Vec<&String> = cases.iter().filter(|case| case.1.1 == Some(false)).map(|case| &case.0).collect();
    assert!(unexplained.is_empty(), "{unexplained:#?}");
    // In these scenes, coefficients are near the absolute bound below which the course's library drops them.
    let is_about_the_bound = |name: &str| ABOUT_THE_BOUND.iter().any(|scene| name.contains(scene));
    let others = cases.iter().filter(|case| !is_about_the_bound(&case.0));
    let (whole, all) = (others.clone().filter(|case| case.1.0 == case.2).count(), others.count());
    assert!(whole * 20 > all * 17, "{whole} of {all} scenes stay the same to their end");
}

/// Checks whether a decision depends on round-off: on a change of the coefficients by a few thousand rounding errors of
/// the largest, or on whether a coefficient is dropped.
#[derive(Default)]
struct Doubt {
    any: bool,
    hits: u32,
}

impl Observer for Doubt {
    fn begin_step(&mut self, _step: u32) {
        self.any = false;
    }
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if let Decision::Hit { normal, .. } = detection.decision {
            self.hits += 1;
            // Without a direction, the response is not a number (collisions.md 7).
            self.any |= !(length(normal) > 1e-9);
        }
        self.any |= is_doubtful(detection.polynomials);
    }
}

fn is_doubtful(polynomials: &[Polynomial]) -> bool {
    let lists: Vec<Vec<BoundedValue>> = polynomials
        .iter()
        .map(|polynomial| {
            let greatest = polynomial.coefficients().iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            polynomial.coefficients().iter().map(|&value| BoundedValue { value, bound: greatest }).collect()
        })
        .collect();
    let slices: Vec<&[BoundedValue]> = lists.iter().map(|list| &list[..]).collect();
    let certified = decide(&slices, 4096.0);
    // The time of a grazing contact changes by the square root of a rounding error.
    let is_loose = certified.time.is_some_and(|[from, to]| to - from > 1e-9);
    let is_alone = |list: &Vec<BoundedValue>| list.len() < 2 || list[1..].iter().all(|c| c.value == 0.0);
    certified.certainty == HitCertainty::Borderline
        || is_loose
        || certified.certainty == HitCertainty::Hits && lists.iter().any(is_alone)
}

/// One way to write the same scene.
struct Rewriting {
    name: &'static str,
    scene: fn(&Scene) -> Scene,
    state: fn(&State) -> State,
}

const SHIFT: Map = Map { shift: [3.7, -11.3], ..Map::NONE };

fn turn() -> Map {
    Map::turn(0.7)
}

fn turned_and_shifted_mirror() -> Map {
    let [a, b] = turn().rows;
    Map { rows: [[-a[0], -a[1]], b], ..SHIFT }
}

const REWRITINGS: [Rewriting; 5] = [
    Rewriting { name: "shifted", scene: |scene| SHIFT.scene(scene), state: |state| SHIFT.state(state) },
    Rewriting { name: "turned", scene: |scene| turn().scene(scene), state: |state| turn().state(state) },
    Rewriting {
        name: "mirrored, turned and shifted",
        scene: |scene| turned_and_shifted_mirror().scene(scene),
        state: |state| turned_and_shifted_mirror().state(state),
    },
    Rewriting { name: "edges' ends exchanged", scene: with_ends_exchanged, state: State::clone },
    Rewriting { name: "particles in opposite order", scene: with_particles_reversed, state: reversed },
];

/// Compares every step of the scene with that of the rewritten one, both from the same state and with the right
/// approach polynomial. Returns the number of compared steps. In one pass of `continuous-time` the order of the
/// particles matters, and `simple` decides without polynomials, so doubtful decisions are not noticed there.
fn compare(scene: &Scene, rewriting: &Rewriting) -> Result<(u32, u32), String> {
    let is_ordered = matches!(scene.collision, Collision::ContinuousTime { .. });
    if is_ordered && rewriting.name.starts_with("particles") || matches!(scene.collision, Collision::Simple { .. }) {
        return Ok((0, 0));
    }
    let image = (rewriting.scene)(scene);
    let mut one = Simulation::new(scene, RootSearch::OnDemand);
    let mut two = Simulation::new(&image, RootSearch::OnDemand);
    let mut observer = Mended { scene, inner: Doubt::default() };
    let mut compared = 0;
    for step in 1..=scene.step_count() {
        *two.state_mut() = (rewriting.state)(one.state());
        observer.inner.any = false;
        let left = one.step(&mut observer);
        let right = two.step(&mut Mended { scene: &image, inner: () });
        if left.is_err() && right.is_err() {
            break;
        }
        if observer.inner.any {
            if left.is_err() || right.is_err() {
                break;
            }
            continue;
        }
        if let Err(error) = left.and(right) {
            return Err(format!("{}: in one of both {error}", rewriting.name));
        }
        compared += 1;
        let expected = (rewriting.state)(one.state());
        for (expected, actual) in
            [(&expected.positions, &two.state().positions), (&expected.velocities, &two.state().velocities)]
        {
            let size = expected.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
            let off = expected.iter().zip(actual).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            if !(off <= 1e-8 * size) {
                return Err(format!("{} step {step}: off by {off}", rewriting.name));
            }
        }
    }
    Ok((compared, observer.inner.hits))
}

#[test]
fn built_in_scenes_do_not_depend_on_their_notation() {
    let results: Vec<Result<(u32, u32), String>> = built_in()
        .par_iter()
        .filter(|(_, scene)| !has_layers_in_boxes(scene))
        .flat_map_iter(|(name, scene)| {
            REWRITINGS.iter().map(move |one| compare(scene, one).map_err(|fault| format!("{name} {fault}")))
        })
        .collect();
    let faults: Vec<&String> = results.iter().filter_map(|result| result.as_ref().err()).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    let compared: u32 = results.iter().flatten().map(|result| result.0).sum();
    assert!(compared > 10_000, "{compared} steps compared");
}

#[test]
fn random_scenes_do_not_depend_on_their_notation() {
    let (compared, hits) = (Cell::new(0), Cell::new(0));
    for collision in [hybrid(0.5, 3), hybrid(1.0, 0), Collision::ContinuousTime { restitution: 0.5 }] {
        search(500, &crowd(Wanted { collision, fixed: true, half_planes: true, steps: 2 }), |scene| {
            for rewriting in &REWRITINGS {
                let (steps, met) = compare(&scene, rewriting).map_err(TestCaseError::fail)?;
                compared.set(compared.get() + steps);
                hits.set(hits.get() + met);
            }
            Ok(())
        });
    }
    assert!(compared.get() > 3000 && hits.get() > 3000, "{} steps, {} hits", compared.get(), hits.get());
}
