//! Checks for errors that involve several elements of a scene (scene-format.md 6, collisions.md 7).
//!
//! Coincidence is exact. Two points coincide if their coordinates compare equal (`-0` equals `0`). A particle is on an
//! edge or a half-plane if the formula of simulation.md 3 gives the zero vector. Only the start is checked; the
//! simulator finds what happens later.
use super::document::Document;
use super::model::{Collision, CollisionDetection, Edge, Force, HalfPlane, Particle};
use super::problem::{Problem, Report};
use super::tag::Tag;
use super::xml::{ParsedElement, SceneParts};
use crate::assignments::Integrator;
use fosssim_num::vector::Vec2;

/// The maximum number of particles with an implicit integrator. Its dense matrix of (2N)² numbers then takes half a
/// gibibyte, and solving it takes minutes per step.
pub const MAX_IMPLICIT_PARTICLES: usize = 4096;

/// The maximum number of pairs of a particle and an obstacle that are checked for coincidence, so that the time of a
/// check does not grow with the square of the file's length. A scene with more pairs would take days to simulate.
const MAX_PAIRS: usize = 4_000_000;

/// Checks the scene as a whole.
pub(super) fn check(document: &Document<'_>, parts: &SceneParts<'_, '_>, report: &mut Report) {
    check_steps(parts, report);
    check_size(document, parts, report);
    check_methods(parts, report);
    check_normals(parts, report);
    check_moving_fixed_particles(parts, report);
    check_edge_lengths(parts, report);
    check_force_directions(parts, report);
    if let Some(rule) = ContactRule::from_parts(parts) {
        check_coincident_particles(parts, &rule, report);
        check_particles_on_edges(parts, &rule, report);
        check_particles_on_half_planes(parts, &rule, report);
    }
}

/// Returns an error or warning about an element.
fn problem_at(tag: &Tag<'_>, message: String, help: &str) -> Problem {
    Problem::from_element(tag.rule.name, &tag.span, message).with_help(help)
}

fn check_steps(parts: &SceneParts<'_, '_>, report: &mut Report) {
    let (Some(duration), Some(integrator)) = (&parts.duration, &parts.integrator) else { return };
    let (Some(time), Some((_, time_step))) = (duration.value, integrator.value) else { return };
    if time < 0.0 || time_step <= 0.0 {
        // Each error has been reported already.
        return;
    }
    let steps = (time / time_step).ceil();
    if time == 0.0 {
        report.add_warning(|| problem_at(duration.tag, "the duration is zero".into(), "there are no steps"));
    } else if steps > f64::from(i32::MAX) {
        let help = "at most 2147483647 steps are possible; the original would run none";
        report.add_error(|| {
            problem_at(duration.tag, format!("{time:?} seconds in steps of {time_step:?} are {steps:e} steps"), help)
        });
    }
}

fn check_size(document: &Document<'_>, parts: &SceneParts<'_, '_>, report: &mut Report) {
    let count = parts.particles.len();
    if count == 0 && !report.has_errors() {
        let span = document.scene.clone().unwrap_or(0..0);
        report.add_warning(|| {
            Problem::new(span, "the scene has no particles").with_help("its trace would contain no state")
        });
    }
    if let (Some(part), true) = (&parts.integrator, is_implicit(parts))
        && count > MAX_IMPLICIT_PARTICLES
    {
        report.add_error(|| {
            problem_at(
                part.tag,
                format!("{count} particles are too many for an implicit integrator"),
                "at most 4096: it solves a dense system of twice that size in every step",
            )
        });
    }
}

fn is_implicit(parts: &SceneParts<'_, '_>) -> bool {
    let integrator = parts.integrator.as_ref().and_then(|part| part.value);
    integrator.is_some_and(|(integrator, _)| integrator.is_implicit())
}

/// Checks for forces that the integrator cannot handle.
fn check_methods(parts: &SceneParts<'_, '_>, report: &mut Report) {
    let Some(integrator) = &parts.integrator else { return };
    if is_implicit(parts) {
        for part in parts.forces.iter().filter(|part| part.tag.rule.name == "vortexforce") {
            report.add_error(|| {
                let help = "it has no Hessian; the original stops at the first step";
                problem_at(part.tag, "a `vortexforce` with an implicit integrator".into(), help)
            });
        }
    }
    let penalty = matches!(parts.collision, Some(Collision::Penalty { .. } | Collision::Hybrid { .. }));
    if penalty && matches!(integrator.value, Some((Integrator::ImplicitEuler, _))) {
        report.add_warning(|| {
            let help = "its Hessian is missing, so Newton's method may never converge";
            problem_at(integrator.tag, "`implicit-euler` with a penalty force".into(), help)
        });
    }
}

fn check_normals(parts: &SceneParts<'_, '_>, report: &mut Report) {
    for (number, part) in parts.half_planes.iter().enumerate() {
        let Some(HalfPlane { normal, .. }) = part.value else { continue };
        if normal.dot(&normal) == 0.0 {
            report.add_error(|| {
                let help = "`nx` and `ny` must not both be zero or so small that their squares vanish";
                problem_at(part.tag, format!("the normal of halfplane {number} has no length"), help)
            });
        }
    }
}

/// Checks for fixed particles that move; half-planes reflect fixed particles as well.
fn check_moving_fixed_particles(parts: &SceneParts<'_, '_>, report: &mut Report) {
    let responds = matches!(
        parts.collision,
        Some(Collision::Simple { .. } | Collision::ContinuousTime { .. } | Collision::Hybrid { .. })
    );
    if !responds || parts.half_planes.is_empty() {
        return;
    }
    for (number, part) in parts.particles.iter().enumerate() {
        if part.value.as_ref().is_some_and(|particle| particle.fixed && particle.velocity != Vec2::zeros()) {
            report.add_warning(|| {
                let help = "the response to half-planes does not check whether a particle is fixed";
                problem_at(
                    part.tag,
                    format!("particle {number} is fixed but moves, and half-planes will reflect it"),
                    help,
                )
            });
        }
    }
}

/// Returns whether two particles start at the same position; false if one of the positions could not be read.
fn are_coincident(parts: &SceneParts<'_, '_>, first: usize, second: usize) -> bool {
    parts.start_position(first).zip(parts.start_position(second)).is_some_and(|(first, second)| first == second)
}

fn check_edge_lengths(parts: &SceneParts<'_, '_>, report: &mut Report) {
    for (number, part) in parts.edges.iter().enumerate() {
        let Some(Edge { first, second, .. }) = part.value else { continue };
        if are_coincident(parts, first, second) {
            report.add_error(|| {
                let help = "an edge without length has no direction; a spring on it is not a number";
                problem_at(
                    part.tag,
                    format!("edge {number} joins particles {first} and {second}, which start at one position"),
                    help,
                )
            });
        }
    }
}

fn check_force_directions(parts: &SceneParts<'_, '_>, report: &mut Report) {
    for part in &parts.forces {
        let Some(Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. }) = part.value else {
            continue;
        };
        if are_coincident(parts, first, second) {
            let name = part.tag.rule.name;
            report.add_error(|| {
                let message = format!("`{name}` between particles {first} and {second}, which start at one position");
                problem_at(part.tag, message, "at distance zero it is not a number")
            });
        }
    }
}

/// How severe a problem is if bodies start at exactly the same position.
struct ContactRule {
    /// Whether the penalty force acts between the bodies. Its direction is then NaN.
    has_penalty: bool,
    /// Whether half-planes move fixed particles.
    moves_fixed: bool,
    thickness: f64,
}

impl ContactRule {
    fn from_parts(parts: &SceneParts<'_, '_>) -> Option<Self> {
        match parts.collision? {
            // In the contest, bodies at the same position do not interact.
            Collision::None
            | Collision::Simple { .. }
            | Collision::Penalty { detection: CollisionDetection::Contest, .. } => None,
            Collision::Penalty { thickness, .. } => Some(Self { has_penalty: true, moves_fixed: false, thickness }),
            Collision::Hybrid { thickness, .. } => Some(Self { has_penalty: true, moves_fixed: true, thickness }),
            Collision::ContinuousTime { .. } => Some(Self { has_penalty: false, moves_fixed: true, thickness: 0.0 }),
        }
    }

    /// Returns whether objects at distance zero touch, if the sum of their radii is `radii`.
    fn touches(&self, radii: f64) -> bool {
        0.0 < radii + if self.has_penalty { self.thickness } else { 0.0 }
    }

    fn report(&self, tag: &Tag<'_>, report: &mut Report, message: impl FnOnce() -> String) {
        if self.has_penalty {
            let help = "the penalty force between them has no direction and is not a number; move one of them";
            report.add_error(|| problem_at(tag, message(), help));
        } else {
            let help = "a contact there has no direction and would not be a number";
            report.add_warning(|| problem_at(tag, message(), help));
        }
    }
}

fn check_coincident_particles(parts: &SceneParts<'_, '_>, rule: &ContactRule, report: &mut Report) {
    let mut particles: Vec<(usize, &Tag<'_>, &Particle)> = parts
        .particles
        .iter()
        .enumerate()
        .filter_map(|(number, part)| part.value.as_ref().map(|particle| (number, part.tag, particle)))
        .collect();
    // Adding zero makes -0 and 0 equal in the order as well.
    let key = |particle: &Particle| (particle.position.x + 0.0, particle.position.y + 0.0);
    particles.sort_by(|(m, _, a), (n, _, b)| {
        let ((ax, ay), (bx, by)) = (key(a), key(b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by)).then(m.cmp(n))
    });
    for group in particles.chunk_by(|(_, _, a), (_, _, b)| a.position == b.position) {
        let movable_index = group.iter().position(|(_, _, particle)| !particle.fixed);
        let Some(movable_index) = movable_index.filter(|_| group.len() > 1) else { continue };
        // Each other pair is reported once; two fixed particles at the same position are harmless.
        for (index, (number, tag, particle)) in group.iter().enumerate() {
            let partner = if particle.fixed { movable_index } else { 0 };
            let (other, _, with) = group[partner];
            if index > partner && rule.touches(particle.radius + with.radius) {
                rule.report(tag, report, || format!("particles {other} and {number} start at the same position"));
            }
        }
    }
}

fn check_particles_on_edges(parts: &SceneParts<'_, '_>, rule: &ContactRule, report: &mut Report) {
    let fixed = |particle: usize| {
        parts.particles.get(particle).and_then(|part| part.value.as_ref()).is_none_or(|particle| particle.fixed)
    };
    let pairs =
        parts.edges.iter().enumerate().flat_map(|edge| parts.particles.iter().enumerate().map(move |p| (edge, p)));
    for ((edge_number, edge), (number, particle)) in pairs.take(MAX_PAIRS) {
        let (Some(edge), ParsedElement { tag, value: Some(particle) }) = (edge.value, particle) else { continue };
        let Some((start, end)) = parts.start_position(edge.first).zip(parts.start_position(edge.second)) else {
            continue;
        };
        if number == edge.first || number == edge.second || start == end {
            continue;
        }
        let edge_vector = end - start;
        // The position on the edge is computed as in the penalty force, which limits it to the edge.
        let alpha = ((particle.position - start).dot(&edge_vector) / edge_vector.dot(&edge_vector)).clamp(0.0, 1.0);
        let is_on_edge = (start + alpha * edge_vector) - particle.position == Vec2::zeros();
        let is_at_end = particle.position == start || particle.position == end;
        let all_fixed = particle.fixed && fixed(edge.first) && fixed(edge.second);
        if is_on_edge && !is_at_end && !all_fixed && rule.touches(particle.radius + edge.radius) {
            rule.report(tag, report, || format!("particle {number} starts exactly on edge {edge_number}"));
        }
    }
}

fn check_particles_on_half_planes(parts: &SceneParts<'_, '_>, rule: &ContactRule, report: &mut Report) {
    let planes = parts.half_planes.iter().enumerate();
    let pairs = planes.flat_map(|plane| parts.particles.iter().enumerate().map(move |particle| (plane, particle)));
    for ((plane_number, plane), (number, particle)) in pairs.take(MAX_PAIRS) {
        let (Some(plane), ParsedElement { tag, value: Some(particle) }) = (plane.value, particle) else { continue };
        let (toward, normal) = (plane.point - particle.position, plane.normal);
        let scale = toward.dot(&normal) / normal.dot(&normal);
        let is_on_line = scale * normal == Vec2::zeros();
        let harmless = particle.fixed && !rule.moves_fixed;
        if is_on_line && !harmless && rule.touches(particle.radius) {
            rule.report(tag, report, || format!("particle {number} starts exactly on halfplane {plane_number}"));
        }
    }
}
