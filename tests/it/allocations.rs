//! After its first steps, an explicit integrator allocates no memory, with any collision handling.
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

use fosssim_oracle::{
    num::vector::Vec2,
    scene::{Collision, CollisionDetection, Display, Edge, Force, HalfPlane, Integrator, Particle, Scene},
    sim::{Detection, Observer, RootSearch, Simulation, Zone},
};

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, which also counts the allocations of each thread.
struct Counting;

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Counts the events that it receives, so that a test can check that something happened.
#[derive(Default)]
struct Heard {
    detections: usize,
    zones: usize,
}

impl Observer for Heard {
    fn observe_detection(&mut self, _detection: &Detection<'_>) {
        self.detections += 1;
    }
    fn observe_zones(&mut self, _round: u32, zones: &[Zone<'_>]) {
        self.zones += zones.len();
    }
}

/// Returns a scene with two balls and a board that rest on the ground and are pulled down in every step.
fn resting(collision: Collision) -> Scene {
    let particle = |x: f64| Particle {
        position: Vec2::new(x, 0.1),
        velocity: Vec2::zeros(),
        mass: 1.0,
        fixed: false,
        radius: 0.1,
        tag: None,
    };
    Scene {
        duration: 1.0,
        time_step: 0.01,
        integrator: Integrator::SymplecticEuler,
        collision,
        particles: [0.0, 1.0, 2.0, 3.0].map(particle).to_vec(),
        edges: vec![Edge { first: 2, second: 3, radius: 0.05 }],
        half_planes: vec![HalfPlane { point: Vec2::zeros(), normal: Vec2::new(0.0, 1.0) }],
        forces: vec![
            Force::Spring { edge: 0, stiffness: 1.0, rest_length: 1.0, damping: 0.1 },
            Force::SimpleGravity { acceleration: Vec2::new(0.0, -10.0) },
        ],
        description: None,
        display: Display::default(),
    }
}

#[test]
fn a_warm_step_allocates_nothing() {
    let hybrid =
        |max_iterations| Collision::Hybrid { restitution: 0.0, max_iterations, stiffness: 1.0, thickness: 0.1 };
    for collision in [
        Collision::None,
        Collision::Simple { restitution: 1.0 },
        Collision::Penalty { stiffness: 10.0, thickness: 0.1, detection: CollisionDetection::AllPairs },
        Collision::Penalty { stiffness: 10.0, thickness: 0.1, detection: CollisionDetection::Contest },
        Collision::ContinuousTime { restitution: 0.0 },
        hybrid(10),
        hybrid(0),
    ] {
        let mut simulation = Simulation::new(&resting(collision), RootSearch::default());
        let mut heard = Heard::default();
        let mut steps = |count: usize, heard: &mut Heard| {
            for _ in 0..count {
                simulation.step(heard).expect("an ordinary step");
            }
        };
        steps(20, &mut heard);
        let before = ALLOCATIONS.get();
        steps(80, &mut heard);
        assert_eq!(ALLOCATIONS.get() - before, 0, "{collision:?}");
        let handled = !matches!(collision, Collision::None | Collision::Penalty { .. });
        assert_eq!(heard.detections > 0, handled, "{collision:?}");
        if let Collision::Hybrid { max_iterations: 0, .. } = collision {
            assert!(heard.zones > 80, "every step moves zones");
        }
    }
}
