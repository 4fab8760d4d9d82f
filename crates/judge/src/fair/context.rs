//! The data for judging a step: the scene, and the trace's records.
use super::ordinary_range::OrdinaryRange;
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Decision, Pair, PairKind, PairKindMap, Pass, State, pairs},
    trace::{Layout, LenientFrame},
};

/// The values that all steps share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    /// The scene that is judged.
    pub scene: &'a Scene,
    /// The number of polynomials of one detection pass over all pairs (trace-format.md 2).
    pub polynomials_per_pass: usize,
    /// The number of pairs of one detection pass.
    pub pair_count: usize,
    /// The number of calls of each kind in a pass.
    pub calls_by_kind: PairKindMap<u64>,
    /// The number of records of one step.
    pub records_per_step: u32,
    /// The range of states that need no comparison with the reference's own run.
    pub ordinary_range: OrdinaryRange,
    /// Whether bounds are computed for every polynomial, including those that are right by a wide margin.
    pub computes_all_bounds: bool,
}

impl<'a> Context<'a> {
    /// Creates the context of judging a scene.
    pub fn new(scene: &'a Scene) -> Self {
        let pairs = pairs(scene);
        let counts = pairs.counts();
        let calls_by_kind = PairKindMap::from_fn(|kind| counts[kind] as u64);
        let (per_pass, pairs) = (pairs.polynomial_count(), pairs.count());
        let records_per_step = Layout::for_scene(scene).records_per_step();
        Self {
            scene,
            polynomials_per_pass: per_pass,
            pair_count: pairs,
            calls_by_kind,
            records_per_step,
            ordinary_range: OrdinaryRange::for_scene(scene),
            computes_all_bounds: false,
        }
    }

    /// Returns the particles of a pair. There are one, two, or, with an edge, three.
    pub(super) fn particles(&self, pair: Pair) -> [Option<usize>; 3] {
        let (first, second) = (pair.first as usize, pair.second as usize);
        match pair.kind {
            PairKind::ParticleParticle => [Some(first), Some(second), None],
            PairKind::ParticleEdge => {
                let edge = &self.scene.edges[second];
                [Some(first), Some(edge.first), Some(edge.second)]
            }
            PairKind::ParticleHalfPlane => [Some(first), None, None],
        }
    }
}

impl Records<'_> {
    /// Returns whether the step starts from ordinary states. The geometric part of a hybrid step starts from the mid
    /// record, so this must be ordinary as well.
    pub fn starts_from_ordinary_states(&self, context: &Context<'_>) -> bool {
        let is_hybrid = matches!(context.scene.collision, Collision::Hybrid { .. });
        let mid = self.mid.filter(|_| is_hybrid);
        context.ordinary_range.contains(self.before)
            && mid.is_none_or(|mid| context.ordinary_range.contains(&mid.state))
    }

    /// Returns the start, mid and end states of the step.
    pub fn states(&self) -> impl Iterator<Item = &State> {
        [self.before, &self.end.state].into_iter().chain(self.mid.map(|mid| &mid.state))
    }
}

/// One step of the trace.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Records<'a> {
    /// The step's number, from 1.
    pub step: u32,
    /// The number of its end record, from 0.
    pub frame: u64,
    /// The trace's own state at the start of the step.
    pub before: &'a State,
    /// The mid record, if the layout has one.
    pub mid: Option<&'a LenientFrame>,
    /// The record of the state at the end of the step.
    pub end: &'a LenientFrame,
}

/// A decision with which the step was continued.
#[derive(Debug, Clone, Copy)]
pub(super) struct FollowedDecision {
    pub pair: Pair,
    pub pass: Pass,
    pub decision: Decision,
}
