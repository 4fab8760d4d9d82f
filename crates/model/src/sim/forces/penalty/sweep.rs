//! The contest's search for nearby pairs, and the order in which it finds them (simulation.md 3.1).
//!
//! Each body has a box of its radius without the layer; boxes that overlap along x and along y are near. If the scene
//! has at least one edge per hundred particles, boxes must overlap along x + y and x - y as well. The search visits
//! bodies in the order of their lower ends along x. It continues from the order of the previous search, so bodies with
//! equal lower ends keep their order; the first order is that of the C++ library's sort.
use super::{extent::BodyExtent, introsort, rows::Rows};
use crate::{scene::Scene, sim::nearby::sort_nearly_sorted};
use fosssim_num::vector::vector_at;

/// The maximum number of particles per edge in scenes whose boxes have four axes.
const PARTICLES_PER_EDGE: usize = 100;

/// The maximum number of particles whose boxes are compared without rows.
const MAX_WITHOUT_ROWS: usize = 256;

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
    /// The rows of the particles' boxes.
    rows: Rows,
    /// Whether rows are used. They need many boxes, whose ends along x and y are finite and in order.
    has_rows: bool,
    /// The memory for sorting boxes.
    sort_buffers: (Vec<u128>, Vec<BodyExtent>),
    /// For each edge, the largest upper end along x of this edge and the edges before it.
    max_upper_ends: Vec<f64>,
}

impl Sweep {
    /// Creates the search among the particles and edges of a scene.
    pub fn new(scene: &Scene) -> Self {
        let edge_count = scene.edges.len();
        Self {
            has_four_axes: edge_count > 0 && scene.particles.len() / PARTICLES_PER_EDGE <= edge_count,
            radii: scene.particles.iter().map(|particle| particle.radius).collect(),
            edges: scene.edges.iter().map(|edge| ([edge.first, edge.second], edge.radius)).collect(),
            particle_boxes: Vec::with_capacity(scene.particles.len()),
            edge_boxes: Vec::with_capacity(edge_count),
            rows: Rows::default(),
            has_rows: false,
            sort_buffers: Default::default(),
            max_upper_ends: Vec::with_capacity(edge_count),
        }
    }

    /// Copies the order of the last search, which is empty before the first search.
    pub fn copy_order(&self, order: &mut SweepOrder) {
        for (list, boxes) in [(&mut order.particles, &self.particle_boxes), (&mut order.edges, &self.edge_boxes)] {
            list.clear();
            list.extend(boxes.iter().map(|bounds| bounds.body));
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
        let Self { has_four_axes, radii, edges, particle_boxes, edge_boxes, sort_buffers, max_upper_ends, .. } = self;
        let particle = |body: u32| {
            let position = vector_at(x, body as usize);
            BodyExtent::from_points(body, [position; 2], radii[body as usize], *has_four_axes)
        };
        let edge = |body: u32| {
            let (ends, radius) = edges[body as usize];
            BodyExtent::from_points(body, ends.map(|end| vector_at(x, end)), radius, *has_four_axes)
        };
        sort(particle_boxes, radii.len(), sort_buffers, particle);
        sort(edge_boxes, edges.len(), sort_buffers, edge);
        self.has_rows = particle_boxes.len() > MAX_WITHOUT_ROWS && particle_boxes.iter().all(BodyExtent::is_finite);
        if self.has_rows {
            self.rows.assign(particle_boxes);
        }
        max_upper_ends.clear();
        max_upper_ends.extend(edge_boxes.iter().scan(f64::NEG_INFINITY, |max_end, extent| {
            *max_end = max_end.max(extent.high[0]);
            Some(*max_end)
        }));
    }

    /// Calls `visit` for all nearby pairs of particles, with the smaller number first.
    pub fn visit_particles(&mut self, mut visit: impl FnMut(usize, usize)) {
        let boxes = &self.particle_boxes[..];
        let mut visit_boxes = |one: &BodyExtent, other: &BodyExtent| {
            let (one, other) = (one.body as usize, other.body as usize);
            visit(one.min(other), one.max(other));
        };
        if self.has_rows {
            return self.rows.visit_overlaps(boxes, visit_boxes);
        }
        for (index, one) in boxes.iter().enumerate() {
            let candidates = boxes[index + 1..].iter().take_while(|other| !other.begins_behind(one));
            candidates.filter(|other| one.overlaps(other)).for_each(|other| visit_boxes(one, other));
        }
    }

    /// Calls `visit` for all particles with their near edges, except edges that end in them.
    pub fn visit_edges(&self, mut visit: impl FnMut(usize, usize)) {
        for one in &self.particle_boxes {
            let first = self.max_upper_ends.partition_point(|end| *end < one.low[0]);
            for other in self.edge_boxes[first..].iter().take_while(|other| !other.begins_behind(one)) {
                let (particle, edge) = (one.body as usize, other.body as usize);
                if one.overlaps(other) && !self.edges[edge].0.contains(&particle) {
                    visit(particle, edge);
                }
            }
        }
    }
}

/// Creates the boxes of `count` bodies, and sorts them by lower ends along x, from the previous order if there is one.
/// In that case the original sorts by insertion, so no body passes a body whose lower end is NaN.
#[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
fn sort(
    boxes: &mut Vec<BodyExtent>,
    count: usize,
    (keys, sorted): &mut (Vec<u128>, Vec<BodyExtent>),
    make: impl Fn(u32) -> BodyExtent,
) {
    if boxes.is_empty() {
        boxes.extend((0..count as u32).map(make));
        return introsort::sort(boxes, |bounds| bounds.low[0]);
    }
    boxes.iter_mut().for_each(|bounds| *bounds = make(bounds.body));
    // Keys are integers in the order of the position along x, then of the previous search, so that each body is moved
    // only once.
    keys.clear();
    keys.extend(
        boxes.iter().zip(0_u32..).map(|(extent, rank)| u128::from(sort_key(extent.low[0])) << 32 | u128::from(rank)),
    );
    for part in keys.split_mut(|key| boxes[*key as u32 as usize].low[0].is_nan()) {
        sort_nearly_sorted(part, u128::cmp);
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
