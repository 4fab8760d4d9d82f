//! The summands of the penalty force, pair by pair and in their order.
use super::*;
use crate::sim::samples::{edge, half_plane, particle, scene};

fn by(detection: CollisionDetection, scene: &Scene, x: &[f64]) -> Vec<f64> {
    let mut gradient = vec![0.0; x.len()];
    Penalty::new(scene, 10.0, 0.1, detection).add_gradient(&Bodies::new(scene), x, &mut gradient);
    gradient
}

fn gradient(scene: &Scene, x: &[f64]) -> Vec<f64> {
    by(CollisionDetection::AllPairs, scene, x)
}

#[test]
fn bodies_within_the_thickness_repel_and_others_do_not() {
    let x = [0.0, 0.0, 0.25, 0.0, 0.0, 5.0];
    let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    scene.half_planes.push(half_plane((0.0, 4.85), (0.0, 2.0)));
    let g = gradient(&scene, &x);
    // Gap 0.05 under a thickness of 0.1: a force of 10 * 0.05, away from the other (the gradient towards it).
    assert!((g[0] - 0.5).abs() < 1e-14 && (g[2] + 0.5).abs() < 1e-14, "{g:?}");
    assert!((g[5] + 0.5).abs() < 1e-14, "{g:?}");
    assert_eq!([g[1], g[3], g[4]], [0.0; 3]);
}

#[test]
fn an_edge_shares_the_force_among_its_ends() {
    let x = [0.25, 0.2, 0.0, 0.0, 1.0, 0.0];
    let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    scene.edges.push(edge(1, 2, 0.05));
    let g = gradient(&scene, &x);
    assert!((g[1] + 0.5).abs() < 1e-14 && (g[3] - 0.375).abs() < 1e-14 && (g[5] - 0.125).abs() < 1e-14, "{g:?}");
}

#[test]
fn coincident_particles_give_nan() {
    let x = [1.0, 1.0, 1.0, 1.0];
    let scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    assert!(gradient(&scene, &x).iter().all(|g| g.is_nan()));
}

#[test]
fn in_the_contest_coincident_particles_leave_each_other_alone() {
    let x = [1.0, 1.0, 1.0, 1.0];
    let scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    assert_eq!(by(CollisionDetection::Contest, &scene, &x), [0.0; 4]);
}

/// Three bodies touch a fourth one, with forces whose sum depends on the order.
#[test]
fn the_contest_sums_in_the_order_of_a_sweep() {
    let x = [0.02, 0.15, 0.05, -0.13, -0.11, 0.08, 0.0, 0.0, -0.5, -0.1, 0.5, -0.1];
    let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    scene.edges.push(edge(4, 5, 0.01));
    let sums: Vec<Vec<f64>> = [[0, 1, 2], [2, 0, 1]]
        .map(|order| {
            let is_contest = order[0] == 2;
            let mut sum = vec![0.0; x.len()];
            let law = PenaltyParameters { stiffness: 10.0, thickness: 0.1, is_contest };
            let bodies = Bodies::new(&scene);
            order.into_iter().for_each(|i| law.particle_particle(&bodies, i, 3, &x, &mut sum));
            law.particle_edge(&bodies, 3, 0, &x, &mut sum);
            sum
        })
        .into();
    let [all_pairs, contest] = [CollisionDetection::AllPairs, CollisionDetection::Contest].map(|d| by(d, &scene, &x));
    assert_ne!(sums[0][6..8], sums[1][6..8], "the order shows");
    assert_eq!((&all_pairs[6..8], &contest[6..8]), (&sums[0][6..8], &sums[1][6..8]));
}

/// The original's boxes have the bare radii; half-planes have no boxes.
#[test]
fn in_the_contest_only_bodies_whose_boxes_overlap_repel() {
    let x = [0.0, 0.0, 0.25, 0.0, 0.0, 5.0];
    let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    scene.half_planes.push(half_plane((0.0, 4.85), (0.0, 2.0)));
    let g = by(CollisionDetection::Contest, &scene, &x);
    assert_eq!(g[..4], [0.0; 4], "the gap is 0.05, the thickness 0.1");
    assert!((g[5] + 0.5).abs() < 1e-14, "{g:?}");
    let near = [0.0, 0.0, 0.19, 0.0, 0.0, 5.0];
    assert!(by(CollisionDetection::Contest, &scene, &near)[0] > 1.0);
}

/// Returns the pairs of a contest's search in several steps.
fn searched(scene: &Scene, steps: &[&[f64]]) -> Vec<[u32; 2]> {
    let mut pairs = PenaltyPairs::new(scene, 0.0, CollisionDetection::Contest);
    let mut found = Vec::new();
    for x in steps {
        found.clear();
        pairs.visit_pairs(x, |pair| found.push([pair.first, pair.second]));
    }
    found
}

#[test]
fn bodies_that_begin_at_the_same_place_keep_the_order_of_the_search_before() {
    let (first, then) = ([0.0, 0.0, -0.05, 0.0, 0.05, 0.0], [0.0; 6]);
    let scene = scene(first.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    assert_eq!(searched(&scene, &[&then]), [[0, 1], [0, 2], [1, 2]]);
    assert_eq!(searched(&scene, &[&first, &then]), [[0, 1], [1, 2], [0, 2]]);
    // A simulation that continues from a copied order gives the same result.
    let mut pairs = PenaltyPairs::new(&scene, 0.0, CollisionDetection::Contest);
    let mut order = SweepOrder::default();
    pairs.visit_pairs(&first, |_| {});
    assert!(pairs.copy_order(&mut order));
    let mut other = PenaltyPairs::new(&scene, 0.0, CollisionDetection::Contest);
    other.set_order(&order);
    let mut found = Vec::new();
    other.visit_pairs(&then, |pair| found.push([pair.first, pair.second]));
    assert_eq!(found, searched(&scene, &[&first, &then]));
}

/// Two boxes overlap along x and y, but not on the diagonals, which count only in scenes with edges.
#[test]
fn with_edges_boxes_have_four_axes() {
    let x = [0.0, 0.0, 0.18, 0.18, 5.0, 0.0, 6.0, 0.0];
    let mut scene = scene(x.chunks(2).map(|c| particle((c[0], c[1]), (0.0, 0.0), 1.0, 0.1)).collect());
    assert_eq!(searched(&scene, &[&x]), [[0, 1]]);
    scene.edges.push(edge(2, 3, 0.1));
    assert!(searched(&scene, &[&x]).is_empty());
}

/// Boxes have different sizes, and some begin at NaN: in every step the search finds exactly the boxes that overlap.
#[test]
fn the_search_finds_what_overlaps_and_nothing_else() {
    // With and without rows.
    [150, 300].into_iter().for_each(check_search);
}

fn check_search(count: usize) {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    // Some boxes are much larger than most.
    let radii: Vec<f64> = (0..count).map(|_| 0.02 + 0.8 * std::iter::repeat_n(random(), 8).product::<f64>()).collect();
    let scene = scene(radii.iter().map(|&radius| particle((0.0, 0.0), (0.0, 0.0), 1.0, radius)).collect());
    let mut pairs = PenaltyPairs::new(&scene, 0.0, CollisionDetection::Contest);
    for step in 0..6 {
        let mut x: Vec<f64> = (0..2 * count).map(|_| 2.0 * random() - 1.0).collect();
        // Far away, where all others are in one row; then nowhere, where there are no rows.
        if step > 1 {
            (x[1], x[3]) = (1e9, -1e300);
        }
        if step > 2 {
            x[5] = f64::INFINITY;
        }
        if step > 3 {
            x[40] = f64::NAN;
        }
        let mut found = Vec::new();
        pairs.visit_pairs(&x, |pair| found.push([pair.first, pair.second]));
        let overlap = |i: usize, j: usize| {
            (0..2).all(|axis| {
                let [one, other] = [i, j].map(|body| [-radii[body], radii[body]].map(|r| x[2 * body + axis] + r));
                !(one[0] > other[1]) && !(other[0] > one[1])
            })
        };
        let is_placed = |body: usize| !x[2 * body].is_nan();
        let mut order: Vec<usize> = (0..count).filter(|&body| is_placed(body)).collect();
        order.sort_by(|&i, &j| (x[2 * i] - radii[i]).total_cmp(&(x[2 * j] - radii[j])));
        let later = |rank: usize, i: usize| order[rank + 1..].iter().map(move |&j| [i.min(j), i.max(j)]);
        let expected: Vec<[u32; 2]> = (order.iter().enumerate())
            .flat_map(|(rank, &i)| later(rank, i))
            .filter(|&[i, j]| overlap(i, j))
            .map(|bodies| bodies.map(|body| body as u32))
            .collect();
        assert!(expected.len() > 100);
        if step > 3 {
            // If a box begins at NaN, some overlapping boxes are not found, as in the original.
            found.retain(|pair| pair.iter().all(|&body| is_placed(body as usize)));
            assert!(found.iter().all(|pair| expected.contains(pair)) && 2 * found.len() > expected.len());
        } else {
            assert_eq!(found, expected);
        }
    }
}
