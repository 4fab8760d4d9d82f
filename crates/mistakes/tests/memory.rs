//! The memory that explaining a small trace of a large scene needs.
use fosssim_mistakes::diagnose::explain;
use fosssim_model::scene::{Collision, CollisionDetection, Display, Edge, Integrator, Particle, Scene};
use fosssim_num::vector::Vec2;
use fosssim_student::{self as student, Student};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, which also counts the bytes in use and their maximum.
struct Counting;

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(now, Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Returns a scene with balls in a row, far apart, with an edge from each to the next.
fn row(balls: u32, collision: Collision) -> Scene {
    let particle = |number: u32| Particle {
        position: Vec2::new(f64::from(number), 0.0),
        velocity: Vec2::new(0.0, 1.0),
        mass: 1.0,
        fixed: false,
        radius: 0.1,
        tag: None,
    };
    let edge = |number: u32| Edge { first: number as usize, second: number as usize + 1, radius: 0.05 };
    Scene {
        duration: 0.02,
        time_step: 0.01,
        integrator: Integrator::SymplecticEuler,
        collision,
        particles: (0..balls).map(particle).collect(),
        edges: (1..balls).map(|number| edge(number - 1)).collect(),
        half_planes: Vec::new(),
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    }
}

/// Returns the additional memory for explaining a trace that is wrong in every step.
fn peak_of(scene: &Scene) -> usize {
    let mut trace = student::record_trace(scene, Student::default()).unwrap_or_else(|(bytes, _)| bytes);
    // The first particle has another position in each record except the first.
    let record = 32 * scene.particles.len();
    for start in (record..trace.len()).step_by(record) {
        trace[start..start + 8].copy_from_slice(&0.5_f64.to_le_bytes());
    }
    let before = NOW.load(Relaxed);
    PEAK.store(before, Relaxed);
    let _explanations = explain(scene, &trace);
    PEAK.load(Relaxed) - before
}

/// No program of the catalog needs a list of the scene's pairs, so memory grows with the scene and not with the
/// number of pairs.
#[test]
fn memory_grows_with_the_scene_and_not_with_its_pairs() {
    let of = |balls: u32| {
        peak_of(&row(
            balls,
            Collision::Penalty { stiffness: 100.0, thickness: 0.01, detection: CollisionDetection::AllPairs },
        ))
    };
    let (small, large) = (of(100), of(400));
    println!("{small} {large}");
    assert!(small < 1 << 20 && large < 4 << 20, "{small} and {large} bytes");
    assert!(large < 6 * small, "{small} and {large} bytes");
}
