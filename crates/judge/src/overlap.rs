//! One decision of `simple` handling in detail: overlap and approach at the end of the step (collisions.md 6).
//!
//! This check judges nothing. A decision is certain if it is the same in runs from states that differ by a few rounding
//! errors, as in the fair rules.
use crate::fair::{PERTURBED_RUNS, perturb};
use fosssim_model::{
    scene::Scene,
    sim::{Detection, Observer, Pair, PairMotion, PointMotion, RootSearch, Simulation, State, StepError},
};
use fosssim_num::vector::{Vec2, length, vector_at};

/// A pair, and the reference's decision on its overlap, at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct OverlapCheck {
    /// The pair, with its motion within the step.
    pub motion: PairMotion,
    /// The velocities of its bodies at the check, after the responses to earlier pairs. The first is that of the
    /// particle, and the second is that of the second particle or of the nearest point of the edge. The velocity of a
    /// half-plane is zero.
    pub velocities: [Vec2; 2],
    /// The position of the nearest point on an edge, from 0 at its first end to 1 at its second.
    pub alpha: Option<f64>,
    /// The vector from the first object to the nearest point of the second, not normalized.
    pub normal: Vec2,
    /// The distance at which the objects touch: the sum of their radii.
    pub reach: f64,
    /// Whether the reference responds to the overlap.
    pub collides: bool,
    /// Whether round-off cannot change the decision.
    pub is_certain: bool,
}

impl OverlapCheck {
    /// Returns the check of a pair in a step that starts from `before`, or `None` if the step does not check the pair.
    ///
    /// # Errors
    /// Fails with a [`StepError`] if the step has no result.
    pub fn for_pair(scene: &Scene, step: u32, before: &State, pair: Pair) -> Result<Option<Self>, StepError> {
        let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
        let mut run = |seed| {
            let mut watch = OverlapObserver { scene, pair, found: None };
            simulation.state_mut().clone_from(before);
            perturb(simulation.state_mut(), seed);
            simulation.set_steps_done(step - 1);
            simulation.step(&mut watch)?;
            Ok(watch.found)
        };
        let Some(mut study) = run(0)? else { return Ok(None) };
        for seed in 1..=PERTURBED_RUNS {
            study.is_certain &= run(seed)?.is_some_and(|other: Self| other.collides == study.collides);
        }
        Ok(Some(study))
    }

    /// Returns the distance between the objects.
    pub fn distance(&self) -> f64 {
        length(self.normal)
    }

    /// Returns the approach speed of the objects times their distance. The product is positive if they approach each
    /// other.
    pub fn approach(&self) -> f64 {
        (self.velocities[0] - self.velocities[1]).dot(&self.normal)
    }
}

/// An observer that records a pair when it is checked.
struct OverlapObserver<'a> {
    scene: &'a Scene,
    pair: Pair,
    found: Option<OverlapCheck>,
}

impl Observer for OverlapObserver<'_> {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let &Detection { pair, q_start, q_end, velocities, decision, .. } = detection;
        if pair != self.pair {
            return;
        }
        let motion = PairMotion::from_positions(self.scene, pair, q_start, q_end);
        let (first, second) = (pair.first as usize, pair.second as usize);
        let end = |point: PointMotion| point.start + point.shift;
        let (alpha, normal, reach, other) = match motion {
            PairMotion::Particles { centers, radii } => {
                (None, end(centers[1]) - end(centers[0]), radii[0] + radii[1], vector_at(velocities, second))
            }
            PairMotion::Edge { center, ends, radii } => {
                let [x1, x2, x3] = [center, ends[0], ends[1]].map(end);
                let edge_vector = x3 - x2;
                let alpha = ((x1 - x2).dot(&edge_vector) / edge_vector.dot(&edge_vector)).clamp(0.0, 1.0);
                let edge = &self.scene.edges[second];
                let [v2, v3] = [edge.first, edge.second].map(|particle| vector_at(velocities, particle));
                (Some(alpha), x2 + alpha * edge_vector - x1, radii[0] + radii[1], v2 + alpha * (v3 - v2))
            }
            PairMotion::HalfPlane { center, radius, point, normal } => {
                let direction = (1.0 / length(normal)) * normal;
                (None, (point - end(center)).dot(&direction) * direction, radius, Vec2::zeros())
            }
        };
        let velocities = [vector_at(velocities, first), other];
        let collides = decision.collides();
        self.found = Some(OverlapCheck { motion, velocities, alpha, normal, reach, collides, is_certain: true });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::scene;
    use fosssim_model::sim::PairKind;

    /// Returns the check of an edge and a ball above it, which falls by `way` within a step.
    fn study(way: f64) -> OverlapCheck {
        let scene = scene(&format!(
            r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="1"/><collision type="simple" COR="1"/>
            <particle m="1" px="-1" py="0" vx="0" vy="0" fixed="1"/>
            <particle m="1" px="3" py="0" vx="0" vy="0" fixed="1"/>
            <particle m="1" px="0.1" py="0.7" vx="0" vy="-{way}" fixed="0" radius="0.2"/>
            <edge i="0" j="1" radius="0.1"/></scene>"#
        ));
        let pair = Pair { kind: PairKind::ParticleEdge, first: 2, second: 0 };
        OverlapCheck::for_pair(&scene, 1, &State::for_scene(&scene), pair).expect("a step").expect("asked")
    }

    #[test]
    fn a_ball_that_falls_into_an_edge_overlaps_and_approaches() {
        let deep = study(0.5);
        assert!((deep.alpha.expect("an edge") - 0.275).abs() < 1e-15, "{deep:?}");
        assert!((deep.distance() - 0.2).abs() < 1e-15 && deep.reach > 0.29 && deep.approach() > 0.0, "{deep:?}");
        assert!(deep.collides && deep.is_certain);
        let high = study(0.3);
        assert!(!high.collides && high.is_certain && high.distance() > high.reach, "{high:?}");
    }

    #[test]
    fn steps_that_end_at_a_touch_depend_on_round_off() {
        assert!(!study(0.4).is_certain);
    }
}
