//! Explains students whose overlap is right except for the radii.
use super::*;

#[test]
fn wrong_radii_are_reported_with_their_values() {
    let is_reach = |detail: &PolynomialDetail| matches!(detail, PolynomialDetail::Reach { .. });
    only(PairKind::ParticleEdge, "other-radius", is_reach, |motion| {
        let PairMotion::Edge { radii: [one, two], .. } = *motion else { panic!("no edge") };
        let mut lists = edge_lists(motion);
        lists[0] = quartic(&Letters { s: one.max(two) * one.max(two), ..letters(motion) });
        lists
    });
}

/// Explains a student whose overlap of two particles with the radii 0.25 and 0.5 has another constant.
fn explain_constant(constant: impl Fn(&PairMotion) -> f64) -> Vec<Explanation> {
    let mut samples = samples(PairKind::ParticleParticle, 8, particle_lists);
    for sample in &mut samples {
        let PairMotion::Particles { radii, .. } = &mut sample.motion else { panic!("no particles") };
        *radii = [0.25, 0.5];
        sample.polynomials = particle_lists(&sample.motion);
        *sample.polynomials[0].last_mut().expect("a constant") += constant(&sample.motion);
    }
    explain_polynomials(&samples)
}

#[test]
fn the_constant_alone_shows_wrong_radii_only_if_it_does_not_depend_on_positions() {
    let [one] = &explain_constant(|_| 0.6 * 0.6 - 0.75 * 0.75)[..] else { panic!("one explanation") };
    let reach = PolynomialDetail::Reach { kind: PairKind::ParticleParticle, used: 0.6, expected: 0.75 };
    assert_eq!((one.key.as_str(), one.reproduced), ("other-radius", 8));
    assert_eq!(one.details, [Detail::Polynomial(reach)]);

    let moving = |motion: &PairMotion| match motion {
        PairMotion::Particles { centers: [one, _], .. } => 0.01 * one.start.x.abs().sqrt(),
        _ => 0.0,
    };
    assert!(explain_constant(moving).iter().all(|one| one.key != "other-radius"));
}
