//! Finds the decisions of the reference's own run that depend on round-off. A scene with such a decision demands more
//! of programs than round-off allows.
//!
//! This needs only the scene, and no trace. Collision handling `simple` decides without polynomials and is not checked.
use super::{contact, formulas::BoundedPairMotion};
use fosssim_findings::fair::Borderline;
use fosssim_model::{
    scene::Scene,
    sim::{Detection, Observer, RootSearch, Simulation, StepError},
};

/// Returns all decisions of the reference that rounding errors of [`FAIR_UNITS`](fosssim_num::tolerances::FAIR_UNITS)
/// units can change, in order. `collides` is the reference's decision. Decisions with exact arithmetic are never
/// included.
///
/// # Errors
/// Fails if a step has no result.
pub fn find_borderline(scene: &Scene) -> Result<Vec<Borderline>, StepError> {
    let mut observer = BorderlineObserver { scene, step: 0, found: Vec::new() };
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    for _ in 0..scene.step_count() {
        simulation.step(&mut observer)?;
    }
    Ok(observer.found)
}

struct BorderlineObserver<'a> {
    scene: &'a Scene,
    step: u32,
    found: Vec<Borderline>,
}

impl Observer for BorderlineObserver<'_> {
    fn begin_step(&mut self, step: u32) {
        self.step = step;
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if detection.polynomials.is_empty() {
            return;
        }
        let motion = BoundedPairMotion::for_pair(self.scene, detection.pair, detection.q_start, detection.q_end);
        if contact::is_borderline(&motion, &motion.polynomials()) {
            let collides = detection.decision.collides();
            let (step, &Detection { pass, pair, .. }) = (self.step, detection);
            self.found.push(Borderline { step, pass, pair, collides });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_model::scene;

    fn found(ball: &str) -> Vec<Borderline> {
        let text = format!(
            r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.5"/>
            <collision type="continuous-time" COR="1"/>{ball}<halfplane px="0" py="0" nx="0.3" ny="0.4"/></scene>"#
        );
        find_borderline(&scene::read("scene", text.as_bytes()).expect("a scene").scene).expect("a run")
    }

    #[test]
    fn a_ball_that_ends_its_step_in_touch_is_borderline() {
        // The ball starts at a distance of 1 with a speed of 1.8. After the first step its distance is its radius, 0.1,
        // except for a rounding error.
        let ball = r#"<particle m="1" px="0.6" py="0.8" vx="-1.08" vy="-1.44" fixed="0" radius="0.1"/>"#;
        let found = found(ball);
        assert!(found.iter().any(|decision| decision.step == 1), "{found:?}");
    }

    #[test]
    fn a_ball_that_is_clearly_late_or_early_is_not() {
        for speed in ["-0.3\" vy=\"-0.4", "-2.16\" vy=\"-2.88"] {
            let ball = format!(r#"<particle m="1" px="0.6" py="0.8" vx="{speed}" fixed="0" radius="0.1"/>"#);
            assert_eq!(found(&ball), []);
        }
    }
}
