//! `hybrid` handling: rounds of simultaneous impulses, then the geometric part, which moves impact zones as rigid
//! bodies (collisions.md 5). Its penalty force is part of the integration.
use super::{
    super::{
        bodies::Bodies,
        observer::{Impulse, Observer, Pass, ResumeState, Stage, Zone, pass_on_synchronization},
        state::State,
        step_error::StepError,
    },
    continuous_time::respond,
    failsafe,
    pass::{Detector, Reaction},
    response::{ResponseConstants, ResponseInput},
    zones::{ZoneBuilder, Zones},
};

/// Memory that the handler reuses from step to step: O(particles + hits).
#[derive(Debug, Clone, Default)]
pub(super) struct HybridScratch {
    hits: Vec<Impulse>,
    round_start: Vec<f64>,
    /// The state of the geometric part so far.
    state: State,
    builder: ZoneBuilder,
    zones: Zones,
    merged_zones: Zones,
    zone_views: Vec<Zone<'static>>,
}

/// Handles the impacts of a step. The synchronization point is after the impulses.
///
/// # Errors
/// Fails with [`StepError::RootSearch`] if a root search would never end, and with [`StepError::Work`] if the allowed
/// work is exceeded.
#[expect(clippy::too_many_arguments, reason = "the parts of Handler, borrowed one by one")]
pub(super) fn handle<O: Observer>(
    bodies: &Bodies,
    law: &ResponseConstants,
    max_iterations: i32,
    detector: &mut Detector,
    scratch: &mut HybridScratch,
    q_start: &[f64],
    state: &mut State,
    observer: &mut O,
) -> Result<(), StepError> {
    let mut round = 0;
    let mut is_settled = false;
    while i64::from(round) < i64::from(max_iterations) && !is_settled {
        detect(
            bodies,
            detector,
            Stage::Impulses { round },
            q_start,
            &mut state.positions,
            &mut scratch.hits,
            observer,
        )?;
        if scratch.hits.is_empty() {
            is_settled = true;
        } else {
            // All responses of a round are computed from the positions at its start.
            scratch.round_start.clone_from(&state.positions);
            let input = ResponseInput { bodies, law, q_start, q_end: &scratch.round_start };
            for impulse in &scratch.hits {
                respond(&input, impulse).apply(&mut state.positions, &mut state.velocities);
                observer.observe_impulse(impulse);
            }
            round += 1;
        }
    }
    if is_settled {
        pass_on_synchronization(observer, state);
        return Ok(());
    }
    // The geometric part continues with these values, unless a caller sets others.
    scratch.state.clone_from(state);
    if pass_on_synchronization(observer, state) == ResumeState::Synchronized {
        scratch.state.clone_from(state);
    }
    move_zones(bodies, law, detector, scratch, q_start, observer)?;
    state.clone_from(&scratch.state);
    Ok(())
}

/// Moves impact zones rigidly until no zone grows in a detection pass. Every round joins zones, or adds particles or a
/// half-plane to a zone, so there are at most about 3N rounds.
fn move_zones<O: Observer>(
    bodies: &Bodies,
    law: &ResponseConstants,
    detector: &mut Detector,
    scratch: &mut HybridScratch,
    q_start: &[f64],
    observer: &mut O,
) -> Result<(), StepError> {
    let HybridScratch { hits, state, builder, zones, merged_zones: merged, zone_views: shown, .. } = scratch;
    let mut round = 0;
    detect(bodies, detector, Stage::Geometric { round }, q_start, &mut state.positions, hits, observer)?;
    builder.begin(bodies.particle_count());
    builder.add_hits(bodies, hits);
    builder.finish(zones);
    zones.visit_all(shown, |zones| observer.observe_zones(round, zones));
    loop {
        round += 1;
        for zone in zones.iter() {
            observer.observe_failsafe(round, &zone);
            failsafe::move_zone(bodies, law.time_step, zone, q_start, &mut state.positions, &mut state.velocities);
        }
        detect(bodies, detector, Stage::Geometric { round }, q_start, &mut state.positions, hits, observer)?;
        builder.begin(bodies.particle_count());
        builder.add_zones(zones);
        builder.add_hits(bodies, hits);
        builder.finish(merged);
        merged.visit_all(shown, |zones| observer.observe_zones(round, zones));
        if zones == merged {
            return Ok(());
        }
        std::mem::swap(zones, merged);
    }
}

/// Makes one pass that collects its hits without responses.
fn detect<O: Observer>(
    bodies: &Bodies,
    detector: &mut Detector,
    stage: Stage,
    q_start: &[f64],
    q_end: &mut [f64],
    hits: &mut Vec<Impulse>,
    observer: &mut O,
) -> Result<(), StepError> {
    hits.clear();
    let pass = Pass { stage, index: detector.pass_count() };
    detector.run(bodies, pass, q_start, q_end, observer, |_, impulse, _| {
        hits.push(*impulse);
        Reaction::Kept
    })
}

#[cfg(test)]
mod tests {
    use crate::{
        scene::original,
        sim::{Observer, RootSearch, Simulation, Zone},
    };

    /// Records the zones of each geometric round of each step.
    #[derive(Default)]
    struct Rounds(Vec<Vec<Vec<Vec<u32>>>>);

    impl Observer for Rounds {
        fn begin_step(&mut self, _: u32) {
            self.0.push(Vec::new());
        }

        fn observe_zones(&mut self, _: u32, zones: &[Zone<'_>]) {
            let zones = zones.iter().map(|zone| zone.particles.to_vec()).collect();
            self.0.last_mut().expect("a step").push(zones);
        }
    }

    /// A fast disc pushes rows of discs together: each round moves a zone against the next disc.
    #[test]
    fn rounds_go_on_until_no_zone_grows() {
        let xml = include_bytes!("../../../../../assets/t2m2/GeometricTests/rows-collected-over-many-rounds.xml");
        let scene = original::read(xml).expect("a scene").scene;
        let mut rounds = Rounds::default();
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        (0..scene.step_count()).for_each(|_| simulation.step(&mut rounds).expect("a step"));
        let longest = rounds.0.iter().max_by_key(|step| step.len()).expect("a step");
        assert!(longest.len() > 4, "{longest:?}");
        let [.., before, last] = &longest[..] else { panic!("{longest:?}") };
        assert_eq!(before, last);
        let merged: Vec<_> = longest[..longest.len() - 1].windows(2).filter(|pair| pair[0] == pair[1]).collect();
        assert!(merged.is_empty(), "only the last round changes no zone: {merged:?}");
    }
}
