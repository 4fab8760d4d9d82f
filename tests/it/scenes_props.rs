//! Rules for every scene and every sequence of bytes, by random search.
use fosssim_oracle::num::vector::Vec2;
use fosssim_oracle::scene::{
    self, Collision, CollisionDetection, Color, Display, Edge, Force, HalfPlane, Integrator, Particle, ParticlePath,
    Scene, Viewport, original,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

/// Returns any finite number.
fn number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn vector() -> impl Strategy<Value = Vec2> {
    (number(), number()).prop_map(|(x, y)| Vec2::new(x, y))
}

/// Returns any text without NUL.
fn text() -> impl Strategy<Value = String> {
    let c =
        prop_oneof![any::<char>(), prop::sample::select(vec!['&', '<', '>', '"', '\'', '\n', '\r', '\t', ' ', ';'])];
    vec(c.prop_filter("not NUL", |&c| c != '\0'), 0..12).prop_map(String::from_iter)
}

fn color() -> impl Strategy<Value = Color> {
    let part = || 0.0..=1.0_f64;
    (part(), part(), part()).prop_map(|(red, green, blue)| Color { red, green, blue })
}

fn detection() -> impl Strategy<Value = CollisionDetection> {
    prop::sample::select(vec![CollisionDetection::AllPairs, CollisionDetection::Contest])
}

fn collision() -> impl Strategy<Value = Collision> {
    let positive = || 1e-6..1e6_f64;
    prop_oneof![
        Just(Collision::None),
        number().prop_map(|restitution| Collision::Simple { restitution }),
        number().prop_map(|restitution| Collision::ContinuousTime { restitution }),
        (positive(), positive(), detection()).prop_map(|(stiffness, thickness, detection)| Collision::Penalty {
            stiffness,
            thickness,
            detection
        }),
        (number(), any::<i32>(), positive(), positive()).prop_map(
            |(restitution, max_iterations, stiffness, thickness)| Collision::Hybrid {
                restitution,
                max_iterations,
                stiffness,
                thickness
            }
        ),
    ]
}

/// Returns particles in a row, so that no two are at the same place.
fn particles() -> impl Strategy<Value = Vec<Particle>> {
    let particle =
        (0.0..1.0_f64, -5.0..5.0_f64, vector(), 1e-300..1e300_f64, any::<bool>(), 0.0..1e300_f64, option::of(text()));
    vec(particle, 2..8).prop_map(|all| {
        let row = all.into_iter().zip(0_u8..);
        row.map(|((x, y, velocity, mass, fixed, radius, tag), place)| Particle {
            position: Vec2::new(10.0 * f64::from(place) + x, y),
            velocity,
            mass,
            fixed,
            radius,
            tag,
        })
        .collect()
    })
}

/// Returns two different numbers below `count`.
fn pair(count: usize) -> impl Strategy<Value = (usize, usize)> {
    (0..count, 1..count).prop_map(move |(first, ahead)| (first, (first + ahead) % count))
}

fn edges(particles: usize) -> impl Strategy<Value = Vec<Edge>> {
    let edge = (pair(particles), 0.0..1e300_f64);
    vec(edge.prop_map(|((first, second), radius)| Edge { first, second, radius }), 1..5)
}

/// Returns forces in the order in which they act.
fn forces(particles: usize, edges: usize, vortices: usize) -> impl Strategy<Value = Vec<Force>> {
    let spring = (0..edges, number(), number(), number())
        .prop_map(|(edge, stiffness, rest_length, damping)| Force::Spring { edge, stiffness, rest_length, damping });
    let gravity = vector().prop_map(|acceleration| Force::SimpleGravity { acceleration });
    let gravitation = (pair(particles), number()).prop_map(|((first, second), constant)| Force::Gravitation {
        first,
        second,
        constant,
    });
    let constant = vector().prop_map(|force| Force::Constant { force });
    let drag = number().prop_map(|coefficient| Force::Drag { coefficient });
    let vortex = (pair(particles), number(), number())
        .prop_map(|((first, second), strength, coupling)| Force::Vortex { first, second, strength, coupling });
    (
        vec(spring, 0..3),
        vec(gravity, 0..3),
        vec(gravitation, 0..3),
        vec(constant, 0..3),
        vec(drag, 0..3),
        vec(vortex, 0..=vortices),
    )
        .prop_map(|(a, b, c, d, e, f)| [a, b, c, d, e, f].concat())
}

fn display(particles: usize, edges: usize) -> impl Strategy<Value = Display> {
    let path = (0..particles, 0.0..1e300_f64, color()).prop_map(|(particle, duration, color)| ParticlePath {
        particle,
        duration,
        color,
    });
    let viewport = (vector(), number()).prop_map(|(center, size)| Viewport { center, size });
    (
        option::of(number()),
        option::of(viewport),
        option::of(color()),
        option::of(text()),
        vec((0..particles, color()), 0..3),
        vec((0..edges, color()), 0..3),
        vec((0..1_usize, color()), 0..3),
        vec(path, 0..3),
    )
        .prop_map(
            |(max_frequency, viewport, background, tag, particle_colors, edge_colors, half_plane_colors, paths)| {
                Display {
                    max_frequency,
                    viewport,
                    background,
                    tag,
                    particle_colors,
                    edge_colors,
                    half_plane_colors,
                    paths,
                }
            },
        )
}

/// Returns any scene without errors.
fn scene() -> impl Strategy<Value = Scene> {
    let integrator = prop::sample::select(vec![
        Integrator::ExplicitEuler,
        Integrator::ForwardBackwardEuler,
        Integrator::SymplecticEuler,
        Integrator::ImplicitEuler,
        Integrator::LinearizedImplicitEuler,
    ]);
    (particles(), integrator)
        .prop_flat_map(|(particles, integrator)| {
            let count = particles.len();
            (Just(particles), Just(integrator), edges(count))
        })
        .prop_flat_map(|(particles, integrator, edges)| {
            let (particle_count, edge_count) = (particles.len(), edges.len());
            let implicit = matches!(integrator, Integrator::ImplicitEuler | Integrator::LinearizedImplicitEuler);
            let normal = (0.1..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y)| Vec2::new(x, y));
            // The half-plane is far to the left, so that no particle is on it.
            let plane =
                (-1e6..-1e3_f64, normal).prop_map(|(x, normal)| HalfPlane { point: Vec2::new(x, -0.0), normal });
            (
                Just((particles, integrator, edges)),
                (0.0..1e3_f64, 1e-3..1e3_f64),
                collision(),
                vec(plane, 1..3),
                forces(particle_count, edge_count, if implicit { 0 } else { 2 }),
                option::of(text()),
                display(particle_count, edge_count),
            )
        })
        .prop_map(|((particles, integrator, edges), times, collision, half_planes, forces, description, display)| {
            Scene {
                duration: times.0,
                time_step: times.1,
                integrator,
                collision,
                particles,
                edges,
                half_planes,
                forces,
                description,
                display,
            }
        })
}

/// Returns the positions to change in a text, and the replacements.
fn edits() -> impl Strategy<Value = Vec<(prop::sample::Index, usize, Vec<u8>)>> {
    let markup = prop::sample::select(b"<>/='\"&;#x! ?-[]\n\r\t0159.eabpi\0\xc3\xff".to_vec());
    vec((any::<prop::sample::Index>(), 0..4_usize, vec(markup, 0..4)), 1..6)
}

fn edited(text: &str, edits: Vec<(prop::sample::Index, usize, Vec<u8>)>) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (place, removed, added) in edits {
        let at = place.index(bytes.len().max(1)).min(bytes.len());
        let end = (at + removed).min(bytes.len());
        bytes.splice(at..end, added);
    }
    bytes
}

/// Checks that no reader panics, and that the strict reader accepts only scenes that the original reads in the same
/// way, and gives reasons otherwise.
fn judge(bytes: &[u8]) -> Result<(), TestCaseError> {
    let original = original::read(bytes);
    match scene::read("scene", bytes) {
        Ok(loaded) => {
            let original = original.map_err(|refusal| TestCaseError::fail(refusal.to_string()))?;
            prop_assert_eq!(format!("{:?}", original.scene), format!("{:?}", loaded.scene));
        }
        Err(problems) => {
            prop_assert!(problems.list.iter().any(|problem| problem.severity == scene::Severity::Error));
            for problem in &problems.list {
                prop_assert!(problem.span.start <= problem.span.end && problem.span.end <= bytes.len());
                prop_assert_ne!(problem.message.as_str(), "the scene is incomplete");
            }
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn a_written_scene_reads_back_to_the_same_bits(before in scene()) {
        let written = scene::to_xml(&before);
        let strict = scene::read("written", written.as_bytes());
        let strict = strict.map_err(|problems| TestCaseError::fail(format!("{written}\n{problems}")))?;
        let lenient = original::read(written.as_bytes());
        let lenient = lenient.map_err(|refusal| TestCaseError::fail(format!("{written}\n{refusal}")))?;
        // The debug form also distinguishes the two zeros.
        prop_assert_eq!(format!("{:?}", strict.scene), format!("{before:?}"));
        prop_assert_eq!(format!("{:?}", lenient.scene), format!("{before:?}"));
        let banner = before.description.unwrap_or_else(|| "No description specified.".to_owned());
        prop_assert_eq!(lenient.description, banner.into_bytes());
    }

    #[test]
    fn any_bytes_are_judged(bytes in vec(any::<u8>(), 0..300)) {
        judge(&bytes)?;
    }

    #[test]
    fn any_markup_is_judged(places in edits(), more in edits()) {
        let plain = "<scene><duration time='1'/><integrator type='explicit-euler' dt='1'/></scene>";
        judge(&edited(plain, places.into_iter().chain(more).collect()))?;
    }

    #[test]
    fn a_scene_with_slips_is_judged(before in scene(), places in edits()) {
        judge(&edited(&scene::to_xml(&before), places))?;
    }
}
