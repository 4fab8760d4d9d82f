//! Probe scenes of the milestones that log states: they show what the scenes of their suites leave open.
use fosssim_model::assignments::Assignment;

/// Names and texts of those of a milestone.
pub(in crate::assignments) const fn of(milestone: Assignment) -> &'static [(&'static str, &'static str)] {
    match milestone {
        Assignment::T1M3 => &[("linear-with-drag", include_str!("probes/linear-with-drag.xml"))],
        Assignment::T2M1 => &[
            ("exact-touches", include_str!("probes/exact-touches.xml")),
            ("layers-of-half-planes", include_str!("probes/layers-of-half-planes.xml")),
        ],
        Assignment::T2M3 => &[("contest-of-corners", include_str!("probes/contest-of-corners.xml"))],
        _ => &[],
    }
}
