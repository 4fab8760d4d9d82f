//! The parts of the assignment that mistakes belong to.
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// The part of the assignment that a mistake belongs to. Its name appears in JSON.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Area {
        /// The forces that act on particles.
        Forces = "Forces", "Look at what each force adds to the gradient, for each of its particles.";
        /// The derivatives of forces with respect to positions and velocities, which implicit integrators need.
        Jacobians = "Derivatives of forces", "Look at what each force adds to the second derivatives, block by block.";
        /// The update of velocities by forces, and of positions by velocities.
        Integrator = "Integrator",
            "Look at the order in which a step changes velocities and positions, and at the values that it uses.";
        /// The repulsive force between bodies that are close to each other.
        Penalty = "Penalty force", "Look at what the penalty force adds to the gradient, for each kind of pair.";
        /// The search for nearby pairs, on which the penalty force acts.
        NearPairs = "Search for nearby pairs", "Look at which pairs the search for nearby pairs finds, and how often.";
        /// The polynomials of two particles.
        ParticleParticle = "Particle-particle",
            "Look at the coefficients that the particle-particle detection computes.";
        /// The polynomials of a particle and an edge.
        ParticleEdge = "Particle-edge", "Look at the coefficients that the particle-edge detection computes.";
        /// The polynomials of a particle and a half-plane.
        ParticleHalfPlane = "Particle-half-plane",
            "Look at the coefficients that the particle-half-plane detection computes.";
        /// The part that all three detections share: it passes polynomials to the root finder.
        Handover = "Hand-over to the root finder",
            "Look at how the coefficients are put into the polynomials for the root finder: order, sign, type.";
        /// The contact vector between the objects at the time of impact.
        ContactVector = "Contact vector", "Look at the vector that the detection returns for the time of impact.";
        /// The choice of the pairs that are checked, and of valid times of impact.
        Decision = "Detection",
            "Look at which pairs are tested, and at how the time from the root finder is used.";
        /// The test whether bodies collide that overlap at the end of a step, and their contact vector.
        SimpleDetection = "Detection",
            "Look at when the detection of this kind of pair finds a collision, and at the vector that it returns.";
        /// The impulse of one contact.
        Response = "Collision response", "Look at how one contact changes velocities and positions.";
        /// The single pass of `continuous-time`.
        ContinuousTime = "Continuous-time pass",
            "Look at the loop over the pairs in the single pass of continuous-time.";
        /// The impulse rounds of `hybrid`.
        ImpulseLoop = "Impulse loop",
            "Look at the loop over the impulse rounds: its start, its end, and the values that it passes on.";
        /// The impact zones and their growth.
        ImpactZones = "Impact zones",
            "Look at how impact zones are made, merged and compared, and when their loop ends.";
        /// The rigid motion of one impact zone.
        Failsafe = "Rigid failsafe", "Look at how one zone is moved as a rigid body, and when it stops instead.";
        /// The part of the program that writes the trace.
        Trace = "Trace", "Look at when the trace is written, and with which values; the simulation may be right.";
    }
    /// Returns a sentence about where in the program to look. It does not reveal the right formula.
    advice
}
