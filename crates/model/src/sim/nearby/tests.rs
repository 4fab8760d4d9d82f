//! No nearby pair is left out, few other pairs are tested, and memory is bounded.
use super::*;
use crate::scene::CollisionDetection;
use crate::sim::{
    forces::PenaltyPairs,
    pair::{Pair, PairKind, pair},
    pairs,
    samples::{NumberSource, edge, half_plane, particle, scene},
};
use fosssim_num::vector::length;

/// Omitting the square root never changes the result of the distance test, at and around equality.
#[test]
fn the_early_way_out_agrees_with_the_test_by_length() {
    let mut numbers = NumberSource(1);
    for _ in 0..20_000 {
        let (x, y) = numbers.next_pair();
        let scale = if numbers.next() < 0.0 { 1.0 } else { 1e-160 };
        let n = Vec2::new(x * scale, y * scale);
        let l = length(n);
        for reach in [l, l.next_up(), l.next_down(), -l, 0.0, f64::INFINITY, f64::NAN] {
            assert!(!(is_beyond(n, reach) && l < reach), "{n:?} {reach}");
        }
    }
}

/// Returns bodies of many sizes at all scales, some at the same places, some at NaN.
fn crowd(seed: u64) -> (Scene, f64) {
    let mut numbers = NumberSource(seed);
    let pick = |numbers: &mut NumberSource, count: f64| ((numbers.next() + 1.0) / 2.0 * count) as usize;
    let scale = [1.0, 1e-160, 1e12, 1e150, 1e-9][pick(&mut numbers, 5.0)];
    let origin = [0.0, 0.0, 1e6 * scale][pick(&mut numbers, 3.0)];
    let spread = [1.0, 5.0, 30.0][pick(&mut numbers, 3.0)];
    let mut particles = Vec::new();
    for _ in 0..40 {
        let (x, y) = numbers.next_pair();
        let radius = scale * [0.1, 0.1, 0.1, 0.02, 2.0, 0.0][pick(&mut numbers, 6.0)];
        let grid = |value: f64| if spread > 20.0 { (value * spread).round() * 0.2 } else { value * spread };
        let place = (origin + scale * grid(x), origin + scale * grid(y));
        particles.push(particle(place, (0.0, 0.0), 1.0, radius));
    }
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        if numbers.next() > 0.8 {
            let particle = pick(&mut numbers, 40.0);
            particles[particle].position.y = odd;
        }
    }
    let mut scene = scene(particles);
    for _ in 0..12 {
        let (one, other) = (pick(&mut numbers, 40.0), pick(&mut numbers, 40.0));
        scene.edges.push(edge(one, other, scale * 0.05));
    }
    scene.half_planes.push(half_plane((0.0, 0.0), (0.3, 1.0)));
    let margin = scale * [0.0, 0.1, -0.05, 1e-3, f64::INFINITY][pick(&mut numbers, 5.0)];
    (scene, margin)
}

fn positions(scene: &Scene) -> Vec<f64> {
    scene.particles.iter().flat_map(|particle| [particle.position.x, particle.position.y]).collect()
}

/// Returns whether two bodies are near enough for a force, by the operations of the force.
fn is_near(scene: &Scene, margin: f64, pair: Pair) -> bool {
    let place = |particle: usize| scene.particles[particle].position;
    let (first, second) = (pair.first as usize, pair.second as usize);
    let radius = scene.particles[first].radius;
    match pair.kind {
        PairKind::ParticleParticle => {
            length(place(second) - place(first)) < (radius + scene.particles[second].radius) + margin
        }
        PairKind::ParticleEdge => {
            let edge = scene.edges[second];
            let (x1, x2, x3) = (place(first), place(edge.first), place(edge.second));
            let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
            // A force keeps NaN, and a response uses 0 instead.
            [alpha, if alpha.is_nan() { 0.0 } else { alpha }]
                .iter()
                .any(|&alpha| length((x2 + alpha.clamp(0.0, 1.0) * (x3 - x2)) - x1) < (radius + edge.radius) + margin)
        }
        PairKind::ParticleHalfPlane => true,
    }
}

#[test]
fn every_pair_that_is_near_is_found_in_the_order_of_its_detection() {
    let mut near_pairs = 0;
    for seed in 0..600 {
        let (mut scene, margin) = crowd(seed);
        let mut nearby = NearbyPairs::new(&scene, margin);
        let mut numbers = NumberSource(seed);
        for _ in 0..3 {
            let x = positions(&scene);
            let near: Vec<Pair> = pairs::pairs(&scene).iter().filter(|&pair| is_near(&scene, margin, pair)).collect();
            near_pairs += near.len();
            if let Some(mut found) = nearby.find(&x) {
                let mut listed: Vec<Pair> = Vec::new();
                for i in 0..scene.particles.len() {
                    let [others, edges] = found.next(i);
                    listed.extend(others.map(|other| pair(PairKind::ParticleParticle, i, other)));
                    listed.extend(edges.map(|edge| pair(PairKind::ParticleEdge, i, edge)));
                }
                for pair in near.iter().filter(|pair| pair.kind != PairKind::ParticleHalfPlane) {
                    assert!(listed.contains(pair), "{seed}: {pair:?}");
                }
            }
            let mut visited = Vec::new();
            PenaltyPairs::new(&scene, margin, CollisionDetection::AllPairs).visit_pairs(&x, |pair| visited.push(pair));
            visited.retain(|&pair| is_near(&scene, margin, pair));
            assert_eq!(visited, near, "{seed}");
            for particle in &mut scene.particles {
                let (x, y) = numbers.next_pair();
                particle.position += 0.1 * Vec2::new(x * particle.radius, y * particle.radius);
            }
        }
    }
    assert!(near_pairs > 20_000, "{near_pairs}");
}

/// Returns a scene of balls of one size and density, a few large ones, and walls around them.
fn box_of(balls: u32) -> Scene {
    let mut numbers = NumberSource(u64::from(balls));
    let half = 0.5 * (f64::from(balls) / 150.0).sqrt();
    let corners = [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)];
    let mut particles = Vec::new();
    particles.extend(corners.map(|(x, y)| particle((x * (half + 0.5), y * (half + 0.5)), (0.0, 0.0), 1.0, 0.5)));
    for _ in 0..balls {
        let (x, y) = numbers.next_pair();
        particles.push(particle((x * half, y * half), (0.0, 0.0), 1.0, 0.02));
    }
    let mut scene = scene(particles);
    scene.edges.extend((0..4).map(|corner| edge(corner, (corner + 1) % 4, 0.5)));
    scene
}

#[test]
fn the_work_grows_with_the_number_of_balls() {
    let per_ball = |balls: u32| {
        let scene = box_of(balls);
        let mut nearby = NearbyPairs::new(&scene, 0.0);
        nearby.find(&positions(&scene)).expect("few are near");
        nearby.tested() / u64::from(balls)
    };
    let [few, many] = [1_000, 100_000].map(per_ball);
    assert!(few < 16 && many < 8, "{few} and {many} tests a ball");
}

/// In a long chain of edges, each edge tests the objects along its line, not all objects in its bounding rectangle.
#[test]
fn a_long_edge_looks_at_what_lies_along_it() {
    let mut scene = box_of(20_000);
    scene.edges = vec![edge(1, 3, 0.01)];
    let mut nearby = NearbyPairs::new(&scene, 0.0);
    let along = |scene: &Scene, nearby: &mut NearbyPairs| {
        let before = nearby.tested();
        nearby.find(&positions(scene)).expect("few are near");
        nearby.tested() - before
    };
    let with = along(&scene, &mut nearby);
    scene.edges.clear();
    let without = along(&scene, &mut NearbyPairs::new(&scene, 0.0));
    assert!(with - without < 5_000, "{} of 20,004 balls", with - without);
}

#[test]
fn objects_near_everything_are_not_listed() {
    let balls = 3000_usize;
    let scene = scene((0..balls).map(|_| particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.5)).collect());
    let mut nearby = NearbyPairs::new(&scene, 0.0);
    assert!(nearby.find(&positions(&scene)).is_none());
    assert!(nearby.tested() < 1_000_000, "the search ends early: {}", nearby.tested());
    let mut visited = 0;
    PenaltyPairs::new(&scene, 0.0, CollisionDetection::Contest).visit_pairs(&positions(&scene), |_| visited += 1);
    assert_eq!(visited, balls * (balls - 1) / 2);
}
