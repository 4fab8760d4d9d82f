//! Simpler features that replace those of a scene.
use fosssim_model::{
    assignments::Assignment,
    scene::{Collision, Integrator, Scene},
};

/// Returns the scene with one feature plainer, the greatest relief first; nothing that the assignment's library does
/// not know.
pub(crate) fn plainer(scene: &Scene, assignment: Assignment) -> Vec<Scene> {
    let with = |collision: Collision| Scene { collision, ..scene.clone() };
    let mut all = Vec::new();
    if let Collision::Hybrid { restitution, stiffness, thickness, max_iterations } = scene.collision {
        all.push(with(Collision::ContinuousTime { restitution }));
        let fewer = [0, 1].into_iter().filter(|fewer| *fewer < max_iterations);
        all.extend(
            fewer.map(|max_iterations| with(Collision::Hybrid { restitution, stiffness, thickness, max_iterations })),
        );
    }
    all.push(with(Collision::None));
    let plain = [Integrator::ExplicitEuler, Integrator::SymplecticEuler, Integrator::LinearizedImplicitEuler];
    let library = &assignment.definition().library;
    let known = plain.into_iter().filter(|one| *one != scene.integrator && library.integrators.contains(one));
    all.extend(known.map(|integrator| Scene { integrator, ..scene.clone() }));
    for index in 0..scene.particles.len() {
        let mut free = scene.clone();
        free.particles[index].fixed = false;
        all.push(free);
    }
    all
}
