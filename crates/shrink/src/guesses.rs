//! Scenes of the same parts with other numbers: small round numbers, drawn from a fixed sequence.
use crate::{
    clear::{next, run},
    numbers::drawn,
    size::SceneSize,
};
use fosssim_model::scene::Scene;

/// Scenes that are drawn, and of those that are like the one at hand the smallest that are tried.
const DRAWN: u64 = 1_500;
const TRIED: usize = 24;

/// Draws scenes that are smaller than this one and similar to it, the smallest first. Scenes with the same colliding
/// pairs come before others.
pub(crate) fn guesses(scene: &Scene, size: SceneSize, is_like: impl Fn(&Scene) -> bool) -> Vec<Scene> {
    let decisions = run(scene).map(|(decisions, _)| decisions);
    let mut found: Vec<(bool, SceneSize, Scene)> = (1..=DRAWN)
        .map(|seed| {
            let mut bits = next(seed);
            drawn(scene, || {
                bits = next(bits);
                bits
            })
        })
        .map(|scene| (SceneSize::from_scene(&scene), scene))
        .filter(|(drawn, scene)| *drawn < size && is_like(scene))
        .map(|(size, scene)| (run(&scene).map(|(decisions, _)| decisions) != decisions, size, scene))
        .collect();
    found.sort_by_key(|(is_other, size, _)| (*is_other, *size));
    found.into_iter().map(|(.., scene)| scene).take(TRIED).collect()
}
