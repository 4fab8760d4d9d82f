//! The traits by which omitted or doubled pairs may differ from others, with one row for each.
use super::geometry::{BoundingBox, PlacedPair};
use fosssim_model::sim::{PairKind, State};
use fosssim_num::vector::{Vec2, length};

/// A row of the table of traits.
pub(super) struct TraitRow {
    /// The trait in plain words, which follow "in all of them". `{axis}` stands for "horizontally" or "vertically".
    description: &'static str,
    /// The trait as an exact condition. `{axis}` stands for x or y, and `{n}` for a number.
    exact_condition: &'static str,
    axes: &'static [TraitAxis],
    /// The numbers with which the trait is tried. The strictest is last.
    numbers: &'static [f64],
    holds: fn(&PlacedPair<'_>, usize, f64) -> bool,
}

impl TraitRow {
    pub const fn variant_count(&self) -> usize {
        self.axes.len() * self.numbers.len()
    }
}

fosssim_num::closed_set! {
    /// The axis that a trait is about.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    enum TraitAxis {
        X = "horizontally", "x";
        Y = "vertically", "y";
        EitherAxis = "horizontally or vertically", "x or y";
    }
    /// Returns the axis as a letter in formulas.
    letter
}

/// A trait of the table, applied to one axis and one number.
#[derive(Clone, Copy)]
pub(super) struct TraitVariant {
    pub row: &'static TraitRow,
    axis: TraitAxis,
    n: f64,
}

impl TraitVariant {
    pub fn holds(&self, pair: &PlacedPair<'_>) -> bool {
        let holds = |axis| (self.row.holds)(pair, axis, self.n);
        match self.axis {
            TraitAxis::X => holds(0),
            TraitAxis::Y => holds(1),
            TraitAxis::EitherAxis => holds(0) || holds(1),
        }
    }

    pub fn describe(&self) -> String {
        self.row.description.replace("{axis}", self.axis.name())
    }

    pub fn exact_condition(&self) -> String {
        self.row.exact_condition.replace("{axis}", self.axis.letter()).replace("{n}", &self.n.to_string())
    }
}

/// Returns all rows of the table, each with all its axes and numbers.
pub(super) fn variants() -> impl Iterator<Item = TraitVariant> {
    TRAIT_TABLE.iter().flat_map(|row| {
        row.axes.iter().flat_map(move |&axis| row.numbers.iter().map(move |&n| TraitVariant { row, axis, n }))
    })
}

/// The axes of traits that do not depend on an axis.
const NO_AXIS: &[TraitAxis] = &[TraitAxis::X];
const ONE_AXIS: &[TraitAxis] = &[TraitAxis::X, TraitAxis::Y];
const ANY_AXIS: &[TraitAxis] = &[TraitAxis::EitherAxis, TraitAxis::X, TraitAxis::Y];
const NO_NUMBER: &[f64] = &[1.0];
const TRAIT_COUNTS: &[f64] =
    &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 15.0, 16.0, 20.0, 32.0, 50.0, 64.0, 100.0, 128.0];
const TRAIT_FACTORS: &[f64] = &[0.5, 1.0, 2.0, 4.0, 8.0];
const TRAIT_SHARES: &[f64] = &[0.9, 0.75, 0.5, 0.25, 0.1];
/// The numbers of steps by which positions are traced back.
const TRAIT_STEPS: &[f64] = &[16.0, 8.0, 4.0, 2.0, 1.0];
const TRAIT_LENGTHS: &[f64] = &[0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 5.0, 8.0, 10.0];

macro_rules! trait_table {
    ($($axes:ident $numbers:ident $what:literal $exact:literal $holds:expr;)*) => {
        /// The table of traits. If rows distinguish pairs equally well, the first ones are reported.
        const TRAIT_TABLE: &[TraitRow] = &[$(TraitRow {
            description: $what, exact_condition: $exact, axes: $axes, numbers: $numbers, holds: $holds,
        },)*];
    };
}

trait_table! {
    NO_AXIS NO_NUMBER "the particle's center is behind the half-plane" "(x - p) . n is negative"
        |pair, _, _| pair.half_plane().is_some_and(|plane| (pair.center() - plane.point).dot(&plane.normal) < 0.0);
    NO_AXIS NO_NUMBER "the particle's center is in front of the half-plane" "(x - p) . n is not negative"
        |pair, _, _| pair.half_plane().is_some_and(|plane| (pair.center() - plane.point).dot(&plane.normal) >= 0.0);
    NO_AXIS NO_NUMBER
        "the half-plane's normal is long, but is used as a unit vector, so the particle seems out of reach"
        "|(x - p) . n| is greater than r" |pair, _, _| {
            let product = pair.half_plane().map(|plane| (pair.center() - plane.point).dot(&plane.normal));
            product.is_some_and(|product| product.abs() > pair.radius())
        };
    NO_AXIS NO_NUMBER "a particle is fixed" "fixed is 1"
        |pair, _, _| pair_particles(pair).any(|particle| pair.geometry.scene.particles[particle].fixed);
    NO_AXIS NO_NUMBER "the bodies move apart or rest, although only their positions matter"
        "(v1 - v2) . n is not positive" |pair, _, _| pair.is_separating();
    NO_AXIS NO_NUMBER "the bodies approach, although only their positions matter"
        "(v1 - v2) . n is positive" |pair, _, _| !pair.is_separating();
    NO_AXIS NO_NUMBER "the bodies were apart at the start of the scene, as if those positions were used"
        "The boxes at time 0 do not overlap" |pair, _, _| !pair.is_near(&pair.geometry.start_positions);
    NO_AXIS TRAIT_STEPS "the bodies were still apart shortly before, as if old positions were used"
        "The boxes about {n} steps earlier do not overlap" |pair, _, n| !pair.is_near(&extrapolate_back(pair, n));
    NO_AXIS NO_NUMBER "the pair with exchanged numbers of particle and edge is not near"
        "(edge, particle) is used instead of (particle, edge)" |pair, _, _| is_lost_when_exchanged(pair);
    NO_AXIS NO_NUMBER "the first body of its kind is involved" "i or j is 0" |pair, _, _| pair.indices().contains(&0);
    NO_AXIS NO_NUMBER "the last particle is involved" "i or j is the last number"
        |pair, _, _| body_particles(pair).any(|particle| particle + 1 == pair.geometry.scene.particles.len());
    NO_AXIS NO_NUMBER "the last edge or half-plane is involved" "Its number is the last one"
        |pair, _, _| match pair.pair.kind {
            PairKind::ParticleParticle => false,
            PairKind::ParticleEdge => pair.indices()[1] + 1 == pair.geometry.scene.edges.len(),
            PairKind::ParticleHalfPlane => pair.indices()[1] + 1 == pair.geometry.scene.half_planes.len(),
        };
    NO_AXIS NO_NUMBER "the edge or half-plane is not the first one" "Its number is greater than 0"
        |pair, _, _| pair.pair.kind != PairKind::ParticleParticle && pair.indices()[1] > 0;
    NO_AXIS TRAIT_COUNTS "the numbers of the particles are far apart" "|i - j| is greater than {n}"
        |pair, _, n| pair.pair.kind == PairKind::ParticleParticle && distance(pair.indices()) > n;
    ANY_AXIS NO_NUMBER "the bodies are on different sides of zero {axis}" "0 is between the bodies' {axis} values"
        |pair, axis, _| are_split(pair.points(), axis, f64::INFINITY, 0.0);
    ANY_AXIS TRAIT_LENGTHS "a multiple of a round number is between the bodies {axis}"
        "A multiple of {n} is between the bodies' {axis} values" |pair, axis, n| are_split(pair.points(), axis, n, 0.0);
    ANY_AXIS TRAIT_LENGTHS
        "a multiple of a round number except zero is between the bodies {axis}, as if decimals were cut off"
        "The whole parts of the bodies' {axis} / {n} differ" |pair, axis, n| {
            let [one, other] = pair.points().map(|point| (point[axis] / n).trunc());
            one != other
        };
    ANY_AXIS TRAIT_LENGTHS "the bodies begin in different cells of a grid with round borders {axis}"
        "A multiple of {n} is between the bodies' lowest {axis}" |pair, axis, n| are_split(corners(pair), axis, n, 0.0);
    ANY_AXIS TRAIT_FACTORS "a multiple of the largest diameter is between the bodies {axis}"
        "A multiple of {n} times the largest diameter is between the bodies' {axis} values"
        |pair, axis, n| are_split(pair.points(), axis, n * pair.geometry.largest_size, 0.0);
    ANY_AXIS TRAIT_FACTORS "the bodies begin in different cells of a grid of the largest diameter {axis}"
        "A multiple of {n} times the largest diameter is between the bodies' lowest {axis}"
        |pair, axis, n| are_split(corners(pair), axis, n * pair.geometry.largest_size, 0.0);
    ANY_AXIS TRAIT_FACTORS "the bodies begin in different cells of a grid from the lowest body on {axis}"
        "A multiple of {n} largest diameters, from the lowest {axis} of all, is between the bodies' lowest {axis}"
        |pair, axis, n| are_split(corners(pair), axis, n * pair.geometry.largest_size, pair.geometry.corner[axis]);
    ANY_AXIS TRAIT_LENGTHS "both bodies contain the same multiple of a round number {axis}"
        "Both contain a multiple of {n} on {axis}" |pair, axis, n| have_common_border(pair, axis, n);
    ANY_AXIS TRAIT_FACTORS "both bodies contain the same multiple of the largest diameter {axis}"
        "Both contain a multiple of {n} times the largest diameter on {axis}"
        |pair, axis, n| have_common_border(pair, axis, n * pair.geometry.largest_size);
    ANY_AXIS NO_NUMBER "a body extends to negative coordinates {axis}" "Its {axis} is less than 0"
        |pair, axis, _| pair.boxes().iter().any(|[low, _]| low[axis] < 0.0);
    ANY_AXIS TRAIT_LENGTHS "a body is far from the origin {axis}" "|{axis}| is greater than {n}"
        |pair, axis, n| pair.boxes().iter().any(|[low, high]| high[axis].max(-low[axis]) > n);
    ANY_AXIS TRAIT_FACTORS "neither body is among the first bodies of the scene {axis}"
        "Both are more than {n} times the largest diameter from the lowest {axis} of all"
        |pair, axis, n| {
            let start = pair.geometry.corner[axis];
            corners(pair).iter().all(|low| low[axis] - start > n * pair.geometry.largest_size)
        };
    ONE_AXIS NO_NUMBER
        "a body apart from the first one begins between the two {axis}, where a sweep may end"
        "One between them on {axis} does not overlap the first one on the other axis"
        |pair, axis, _| has_gap(pair, axis);
    ONE_AXIS TRAIT_COUNTS "many bodies begin between the two {axis}, as if a sweep ended early"
        "More than {n} begin between them on {axis}" |pair, axis, n| pair.boxes_between(axis).count() as f64 > n;
    ONE_AXIS NO_NUMBER "the particle begins after the other body {axis}" "Its smallest {axis} is greater"
        |pair, axis, _| corners(pair)[0][axis] > corners(pair)[1][axis];
    ONE_AXIS NO_NUMBER "the particle begins before the other body {axis}" "Its smallest {axis} is less"
        |pair, axis, _| corners(pair)[0][axis] < corners(pair)[1][axis];
    NO_AXIS NO_NUMBER "the particle's center is outside the other body's box" "The box lacks r1 on a side"
        |pair, _, _| {
            let (center, [_, [low, high]]) = (pair.center(), pair.boxes());
            center.inf(&low) != low || center.sup(&high) != high
        };
    ANY_AXIS TRAIT_SHARES "the bodies' boxes overlap little {axis}, as if boxes were too small"
        "They overlap on {axis} by less than {n} of the smaller one" |pair, axis, n| overlap(pair, axis) < n;
    NO_AXIS TRAIT_FACTORS
        "the particle is far from both ends of the edge" "Both distances are greater than {n} (r1 + r2)"
        |pair, _, n| distances_from_ends(pair).is_some_and(|ends| ends.iter().all(|end| *end > n));
    NO_AXIS TRAIT_FACTORS "the particle is far from the edge's first end" "The distance is greater than {n} (r1 + r2)"
        |pair, _, n| distances_from_ends(pair).is_some_and(|[first, _]| first > n);
    NO_AXIS TRAIT_FACTORS "the particle is far from the edge's second end" "The distance is greater than {n} (r1 + r2)"
        |pair, _, n| distances_from_ends(pair).is_some_and(|[_, second]| second > n);
    ONE_AXIS NO_NUMBER "the edge's first end has the larger coordinate {axis}" "The first end's {axis} is greater"
        |pair, axis, _| {
            pair.edge().is_some_and(|edge| pair.position(edge.first)[axis] > pair.position(edge.second)[axis])
        };
    NO_AXIS TRAIT_FACTORS "the bodies are of unequal sizes" "One radius is more than {n} times the other"
        |pair, _, n| {
            let [one, other] = [pair.radius(), pair.other_radius()];
            n >= 1.0 && pair.half_plane().is_none() && one.max(other) > n * one.min(other)
        };
    NO_AXIS NO_NUMBER "a particle is larger than the first one" "r is greater than r0" |pair, _, _| {
        let radius = |particle: usize| pair.geometry.scene.particles[particle].radius;
        body_particles(pair).any(|particle| radius(particle) > radius(0))
    };
}

/// Returns the particles that are themselves bodies of the pair.
fn body_particles(pair: &PlacedPair<'_>) -> impl Iterator<Item = usize> {
    let bodies = if pair.pair.kind == PairKind::ParticleParticle { 2 } else { 1 };
    pair.indices().into_iter().take(bodies)
}

/// Returns all particles of the pair, including the ends of an edge.
fn pair_particles(pair: &PlacedPair<'_>) -> impl Iterator<Item = usize> {
    body_particles(pair).chain(pair.edge().into_iter().flat_map(|edge| [edge.first, edge.second]))
}

/// Returns where the bodies would have been `steps` steps earlier if they had moved with their current velocities.
fn extrapolate_back(pair: &PlacedPair<'_>, steps: f64) -> Vec<f64> {
    let State { positions, velocities } = pair.geometry.before;
    let h = pair.geometry.scene.time_step;
    positions.iter().zip(velocities).map(|(x, v)| x - steps * h * v).collect()
}

fn is_lost_when_exchanged(pair: &PlacedPair<'_>) -> bool {
    let scene = pair.geometry.scene;
    let [particle, edge] = pair.indices();
    let mut other = *pair;
    (other.pair.first, other.pair.second) = (pair.pair.second, pair.pair.first);
    let is_there = edge < scene.particles.len() && particle < scene.edges.len();
    pair.edge().is_some() && !(is_there && other.is_near(&pair.geometry.before.positions))
}

fn distance([one, other]: [usize; 2]) -> f64 {
    one.abs_diff(other) as f64
}

/// Returns whether points are in different cells on an axis. Infinite cells separate the two sides of the start.
fn are_split([one, other]: [Vec2; 2], axis: usize, size: f64, start: f64) -> bool {
    ((one[axis] - start) / size).floor() != ((other[axis] - start) / size).floor()
}

fn corners(pair: &PlacedPair<'_>) -> [Vec2; 2] {
    pair.boxes().map(|[low, _]| low)
}

fn has_gap(pair: &PlacedPair<'_>, axis: usize) -> bool {
    let [one, other] = pair.boxes();
    let other_axis = 1 - axis;
    let lower = if one[0][axis] <= other[0][axis] { one } else { other };
    pair.boxes_between(axis)
        .any(|body| body[0][other_axis] > lower[1][other_axis] || lower[0][other_axis] > body[1][other_axis])
}

/// Returns the overlap of two boxes on an axis.
fn common_range([one, other]: [BoundingBox; 2], axis: usize) -> [f64; 2] {
    [one[0][axis].max(other[0][axis]), one[1][axis].min(other[1][axis])]
}

/// Returns the length of the boxes' overlap on an axis, as a fraction of the smaller box.
fn overlap(pair: &PlacedPair<'_>, axis: usize) -> f64 {
    let [from, to] = common_range(pair.boxes(), axis);
    let sides = pair.boxes().map(|[low, high]| high[axis] - low[axis]);
    (to - from) / sides[0].min(sides[1])
}

/// Returns the distances of the particle from the edge's ends, divided by the sum of the radii. Returns `None` if the
/// pair has no edge.
fn distances_from_ends(pair: &PlacedPair<'_>) -> Option<[f64; 2]> {
    let edge = pair.edge()?;
    let reach = pair.radius() + pair.other_radius();
    Some([edge.first, edge.second].map(|end| length(pair.position(end) - pair.center()) / reach))
}

fn have_common_border(pair: &PlacedPair<'_>, axis: usize, size: f64) -> bool {
    let [from, to] = common_range(pair.boxes(), axis);
    pair.half_plane().is_none() && (from / size).floor() != (to / size).floor()
}
