//! Where to look, by the area of a mistake.
use crate::student::Area;

/// One sentence that says where in the program the mistake is made, without the right formula.
pub(super) fn remedy(area: Area) -> &'static str {
    match area {
        Area::ParticleParticle => "Look at the coefficients that the particle-particle detection computes.",
        Area::ParticleEdge => "Look at the coefficients that the particle-edge detection computes.",
        Area::ParticleHalfPlane => "Look at the coefficients that the particle-half-plane detection computes.",
        Area::Handover => {
            "Look at how the coefficients are put into the polynomials for the root finder: order, sign, type."
        }
        Area::ContactVector => "Look at what the detection returns once the time of impact is known.",
        Area::Decision => {
            "Look at which pairs are tested, and at what is done with the time that the root finder returns."
        }
        Area::Response => "Look at how one contact changes velocities and positions.",
        Area::ContinuousTime => "Look at the loop over the pairs in the single pass of continuous-time.",
        Area::ImpulseLoop => "Look at the loop over the impulse rounds: its start, its end, and what it carries over.",
        Area::ImpactZones => "Look at how impact zones are made, merged and compared, and when their loop ends.",
        Area::Failsafe => "Look at how one zone is moved as a rigid body, and when it stops instead.",
        Area::Trace => "Look at what is written to the trace, and when; the simulation itself may be right.",
        Area::Process => "Look at how the program starts and ends.",
    }
}
