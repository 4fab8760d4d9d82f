//! How much room the original's rules leave in a scene: at which size they fail the reference's own trace.
//!
//! The original compares coefficients at an absolute bound, after a rescaling that rounds. So an exact copy of its own
//! polynomials fails as soon as one unit in the last place of a coefficient exceeds the bound (numerics.md 1.4). The
//! scene is made larger by powers of two, which changes no bit but exponents, and the reference's trace is judged by
//! parity at each size. This says nothing against a submission, and all about whether the scene can be graded fairly.
use super::recording::{self, CannotRecord};
use fosssim_judge::{
    Overall,
    replay::{self, Options},
};
use fosssim_model::{
    scene::Scene,
    sim::{Detection, Observer, RootSearch, Simulation},
    trace::Layout,
};

pub use fosssim_findings::headroom::{FAIR_DOUBLINGS, FAIR_ROOM, FirstFailure, Headroom, MOST_DOUBLINGS};

/// Measures the headroom of a scene.
///
/// # Errors
/// When the scene can't be simulated at some size.
pub fn headroom(scene: &Scene) -> Result<Headroom, CannotRecord> {
    if !Layout::of(scene).polynomials {
        return Ok(Headroom { largest: None, failure: None });
    }
    let mut largest = Largest(0.0);
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    for _ in 0..scene.steps() {
        simulation.step(&mut largest)?;
    }
    let options = Options { threads: 1, ..Options::default() };
    let mut failure = None;
    for doublings in 0..=MOST_DOUBLINGS {
        let scaled = scene.scaled(doublings.cast_signed());
        let trace = recording::trace(&scaled)?;
        let outcome = replay::judge(&scaled, &trace[..], &options, &mut ());
        if outcome.parity.overall != Overall::Passed {
            let (findings, first) = (outcome.parity.findings.counts.total(), outcome.parity.findings.first_divergence);
            failure = Some(FirstFailure { doublings, findings, first });
            break;
        }
    }
    Ok(Headroom { largest: Some(largest.0), failure })
}

/// The largest modulus of a coefficient so far.
struct Largest(f64);

impl Observer for Largest {
    fn detection(&mut self, detection: &Detection<'_>) {
        let all = detection.polynomials.iter().flat_map(|polynomial| polynomial.coefficients());
        self.0 = all.fold(self.0, |largest, c| largest.max(c.abs()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_judge::FindingKind;
    use fosssim_model::scene;

    const FORCES: &str = r#"<scene>
      <duration time="1"/><integrator type="symplectic-euler" dt="0.1"/>
      <collision type="hybrid" COR="0.5" maxiters="3" k="7" thickness="0.01"/>
      <simplegravity fx="0.1" fy="-1"/>
      <particle m="1" px="-1" py="0.3" vx="0.2" vy="0" fixed="0" radius="0.1"/>
      <particle m="2" px="1" py="0.1" vx="0" vy="0.4" fixed="0" radius="0.2"/>
      <particle m="2" px="0.1" py="1.1" vx="0" vy="-4" fixed="0" radius="0.2"/>
      <edge i="0" j="1" radius="0.05"/>
      <springforce edge="0" k="3" l0="1.7" b="0.2"/>
      <gravitationalforce i="0" j="1" G="0.3"/>
      <vortexforce i="0" j="2" kbs="0.3" kvc="0.7"/>
      <dragdamping b="0.1"/>
      <halfplane px="0" py="-1" nx="0.3" ny="1"/>
    </scene>"#;

    /// Forces of every kind, collisions of every kind: the scaled scene's motion is the scene's, scaled.
    #[test]
    fn the_motion_scales_bit_for_bit() {
        let scene = scene::read("scene", FORCES.as_bytes()).expect("a scene").scene;
        let end = |scene: &Scene| {
            let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
            for _ in 0..scene.steps() {
                simulation.step(&mut ()).expect("a step");
            }
            simulation.state().positions.clone()
        };
        let (own, scaled) = (end(&scene), end(&scene.scaled(5)));
        assert!(own.iter().zip(&scaled).all(|(own, scaled)| (32.0 * own).to_bits() == scaled.to_bits()), "{scaled:?}");
    }

    /// Large numbers that are not round: the size of the coefficients is what counts.
    fn scene(collision: &str, size: f64) -> Scene {
        let text = format!(
            r#"<scene><duration time="0.5"/><integrator type="explicit-euler" dt="0.1"/><collision type="{collision}"/>
            <particle m="1" px="{}" py="{}" vx="{}" vy="{}" fixed="0" radius="0.1"/>
            <particle m="1" px="0.37" py="0.71" vx="-0.3" vy="0.7" fixed="0" radius="0.2"/></scene>"#,
            1.3 * size,
            0.7 * size,
            -1.7 * size,
            -0.9 * size,
        );
        scene::read("scene", text.as_bytes()).expect("a scene").scene
    }

    #[test]
    fn larger_scenes_have_less_room() {
        let room = |size| headroom(&scene("continuous-time", size)).expect("a run");
        let (small, large) = (room(1.0), room(64.0));
        let doublings = |room: Headroom| room.failure.expect("a failure").doublings;
        assert!(doublings(small) > doublings(large) && small.room() > large.room(), "{small:?} {large:?}");
        assert_eq!(small.failure.expect("a failure").first.expect("a finding").kind(), FindingKind::Coefficient);
        assert!(small.is_fair() && !room(4096.0).is_fair());
    }

    #[test]
    fn without_polynomials_nothing_can_fail() {
        let drift = headroom(&scene("none", 1.0)).expect("a run");
        assert_eq!(drift, Headroom { largest: None, failure: None });
        assert!(drift.is_fair());
    }
}
