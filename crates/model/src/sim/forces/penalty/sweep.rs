//! The contest's search for nearby pairs, and the order in which it finds them (simulation.md 3.1).
//!
//! Each body has a box of its radius without the layer; boxes that overlap on x and on y are near. If the scene has at
//! least one edge per hundred particles, boxes must overlap on x + y and x - y as well. The search visits bodies in the
//! order of their lower ends on x. It continues from the order of the previous search, so bodies with equal lower ends
//! keep their order; the first order is that of the C++ library's sort.
use super::introsort;
use crate::scene::Scene;
use fosssim_num::vector::{Vec2, vector_at};
use std::f64::consts::SQRT_2;

/// The maximum number of particles per edge in scenes whose boxes have four axes.
const PARTICLES_PER_EDGE: usize = 100;

/// The number of boxes that are compared on y at a time.
const BLOCK_BOXES: usize = 8;

/// The order of bodies after the previous search.
///
/// The order is part of a state, because a force depends on it if bodies have the same lower end.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SweepOrder {
    particles: Vec<u32>,
    edges: Vec<u32>,
}

/// The search for nearby pairs, with its memory.
#[derive(Debug, Clone)]
pub(super) struct Sweep {
    has_four_axes: bool,
    radii: Vec<f64>,
    edges: Vec<([usize; 2], f64)>,
    particle_boxes: Vec<BodyExtent>,
    edge_boxes: Vec<BodyExtent>,
    /// The lower and upper ends of the particles' boxes on y, in arrays for many comparisons at a time.
    heights: [Vec<f64>; 2],
    /// The memory for sorting boxes.
    sort_buffers: (Vec<u128>, Vec<BodyExtent>),
    /// For each edge, the largest upper end on x of this edge and the edges before it.
    furthest: Vec<f64>,
}

/// A body's extent on x, y, x + y and x - y.
#[derive(Debug, Clone, Copy, Default)]
struct BodyExtent {
    body: u32,
    low: [f64; 4],
    high: [f64; 4],
}

impl Sweep {
    /// Creates the search among the particles and edges of a scene.
    pub fn new(scene: &Scene) -> Self {
        let edges = scene.edges.len();
        Self {
            has_four_axes: edges > 0 && scene.particles.len() / PARTICLES_PER_EDGE <= edges,
            radii: scene.particles.iter().map(|particle| particle.radius).collect(),
            edges: scene.edges.iter().map(|edge| ([edge.first, edge.second], edge.radius)).collect(),
            particle_boxes: Vec::with_capacity(scene.particles.len()),
            edge_boxes: Vec::with_capacity(edges),
            heights: Default::default(),
            sort_buffers: Default::default(),
            furthest: Vec::with_capacity(edges),
        }
    }

    /// Copies the order of the last search, which is empty before the first search.
    pub fn copy_order(&self, order: &mut SweepOrder) {
        for (list, boxes) in [(&mut order.particles, &self.particle_boxes), (&mut order.edges, &self.edge_boxes)] {
            list.clear();
            list.extend(boxes.iter().map(|one| one.body));
        }
    }

    /// Continues from `order`.
    pub fn set_order(&mut self, order: &SweepOrder) {
        for (list, boxes) in [(&order.particles, &mut self.particle_boxes), (&order.edges, &mut self.edge_boxes)] {
            boxes.clear();
            boxes.extend(list.iter().map(|&body| BodyExtent { body, ..BodyExtent::default() }));
        }
    }

    /// Sorts the bodies for positions `x` (2N).
    pub fn update(&mut self, x: &[f64]) {
        let Self { has_four_axes, radii, edges, particle_boxes, edge_boxes, heights, sort_buffers: sorting, furthest } =
            self;
        let particle = |body: u32| {
            let place = vector_at(x, body as usize);
            BodyExtent::from_points(body, [place; 2], radii[body as usize], *has_four_axes)
        };
        let edge = |body: u32| {
            let (ends, radius) = edges[body as usize];
            BodyExtent::from_points(body, ends.map(|end| vector_at(x, end)), radius, *has_four_axes)
        };
        sort(particle_boxes, radii.len(), sorting, particle);
        sort(edge_boxes, edges.len(), sorting, edge);
        heights.iter_mut().for_each(Vec::clear);
        heights[0].extend(particle_boxes.iter().map(|one| one.low[1]));
        heights[1].extend(particle_boxes.iter().map(|one| one.high[1]));
        furthest.clear();
        furthest.extend(edge_boxes.iter().scan(f64::NEG_INFINITY, |furthest, one| {
            *furthest = furthest.max(one.high[0]);
            Some(*furthest)
        }));
    }

    /// Calls `visit` for all nearby pairs of particles, with the smaller number first.
    pub fn visit_particles(&self, mut visit: impl FnMut(usize, usize)) {
        let boxes = &self.particle_boxes[..];
        let mut hear_if_near = |one: &BodyExtent, other: &BodyExtent| {
            if one.overlaps(other) {
                let (one, other) = (one.body as usize, other.body as usize);
                visit(one.min(other), one.max(other));
            }
        };
        let begins_behind = |other: &BodyExtent, one: &BodyExtent| other.low[0] > one.high[0];
        // A box whose lower end is NaN splits the order into parts.
        let is_one_order = boxes.iter().all(|one| !one.low[0].is_nan());
        let mut end = 0;
        for (index, one) in boxes.iter().enumerate() {
            if !is_one_order {
                let near = boxes[index + 1..].iter().take_while(|other| !begins_behind(other, one));
                near.for_each(|other| hear_if_near(one, other));
                continue;
            }
            // Boxes of similar sizes end in a similar order, so the end of the near boxes moves little.
            end = end.max(index + 1);
            while end < boxes.len() && !begins_behind(&boxes[end], one) {
                end += 1;
            }
            while end > index + 1 && begins_behind(&boxes[end - 1], one) {
                end -= 1;
            }
            let (lows, more_lows) = self.heights[0][index + 1..end].as_chunks::<BLOCK_BOXES>();
            let (highs, _) = self.heights[1][index + 1..end].as_chunks::<BLOCK_BOXES>();
            for (block, (lows, highs)) in lows.iter().zip(highs).enumerate() {
                // Keys are as wide as the floating-point numbers, so that several are compared at a time.
                let mut far = [0_u64; BLOCK_BOXES];
                for ((far, low), high) in far.iter_mut().zip(lows).zip(highs) {
                    *far = u64::from(one.low[1] > *high) | u64::from(*low > one.high[1]);
                }
                if far.iter().sum::<u64>() < BLOCK_BOXES as u64 {
                    let first = index + 1 + block * BLOCK_BOXES;
                    let found = boxes[first..].iter().zip(far).filter(|(_, far)| *far == 0);
                    found.for_each(|(other, _)| hear_if_near(one, other));
                }
            }
            boxes[end - more_lows.len()..end].iter().for_each(|other| hear_if_near(one, other));
        }
    }

    /// Calls `visit` for all particles with their near edges, except edges that end in them.
    pub fn visit_edges(&self, mut visit: impl FnMut(usize, usize)) {
        for one in &self.particle_boxes {
            let first = self.furthest.partition_point(|furthest| *furthest < one.low[0]);
            for other in self.edge_boxes[first..].iter().take_while(|other| !(other.low[0] > one.high[0])) {
                let (particle, edge) = (one.body as usize, other.body as usize);
                if one.overlaps(other) && !self.edges[edge].0.contains(&particle) {
                    visit(particle, edge);
                }
            }
        }
    }
}

/// Creates the boxes of `count` bodies, and sorts them by lower ends on x, from the previous order if there is one. In
/// that case the original sorts by insertion, so no body passes a body whose lower end is NaN.
#[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
fn sort(
    boxes: &mut Vec<BodyExtent>,
    count: usize,
    (keys, sorted): &mut (Vec<u128>, Vec<BodyExtent>),
    make: impl Fn(u32) -> BodyExtent,
) {
    if boxes.is_empty() {
        boxes.extend((0..count as u32).map(make));
        return introsort::sort(boxes, |one| one.low[0]);
    }
    boxes.iter_mut().for_each(|one| *one = make(one.body));
    // Keys are integers in the order of the position on x, then of the previous search, so that each body is moved only
    // once.
    keys.clear();
    keys.extend(boxes.iter().zip(0_u32..).map(|(one, rank)| u128::from(sort_key(one.low[0])) << 32 | u128::from(rank)));
    for part in keys.split_mut(|key| boxes[*key as u32 as usize].low[0].is_nan()) {
        part.sort_unstable();
    }
    sorted.clear();
    sorted.extend(keys.iter().map(|key| boxes[*key as u32 as usize]));
    std::mem::swap(boxes, sorted);
}

/// Returns an integer that increases with `number`. Both zeros give the same integer.
const fn sort_key(number: f64) -> u64 {
    // Adding zero turns -0 into 0.
    let bits = (number + 0.0).to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

impl BodyExtent {
    /// Returns the extent around everything between two points, widened by `radius`.
    fn from_points(body: u32, [one, other]: [Vec2; 2], radius: f64, has_four_axes: bool) -> Self {
        let mut own = Self { body, ..Self::default() };
        let mut extend = |axis: usize, one: f64, other: f64, radius: f64| {
            // If two numbers cannot be compared, the second is used, as in the processor's instructions.
            own.low[axis] = if one < other { one } else { other } - radius;
            own.high[axis] = if one > other { one } else { other } + radius;
        };
        extend(0, one.x, other.x, radius);
        extend(1, one.y, other.y, radius);
        if has_four_axes {
            extend(2, one.x + one.y, other.x + other.y, radius * SQRT_2);
            extend(3, one.x - one.y, other.x - other.y, radius * SQRT_2);
        }
        own
    }

    /// Returns whether boxes overlap or touch on all axes; x is tested last, because the search has found them near on
    /// x.
    fn overlaps(&self, other: &Self) -> bool {
        [1, 2, 3, 0]
            .into_iter()
            .all(|axis| !(self.low[axis] > other.high[axis]) && !(other.low[axis] > self.high[axis]))
    }
}
