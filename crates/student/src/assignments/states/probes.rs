//! Probe scenes of the milestones that log states. They show mistakes that the scenes of the suites do not.
use fosssim_model::assignments::Assignment;

macro_rules! probes {
    ($($name:literal),*) => { &[$(($name, include_str!(concat!("probes/", $name, ".xml")))),*] };
}

/// Returns the names and texts of the probe scenes of a milestone.
pub(in crate::assignments) const fn probes_for(milestone: Assignment) -> &'static [(&'static str, &'static str)] {
    match milestone {
        Assignment::T1M1 => probes!["two-fields-and-a-fixed-particle"],
        Assignment::T1M2 => probes!["springs-share-a-particle", "drag-and-pull-of-unequal-masses", "drag-alone"],
        Assignment::T1M3 => probes!["linear-with-drag", "newton-with-all-forces"],
        Assignment::T2M1 => probes![
            "balls-meet",
            "balls-meet-edges",
            "balls-meet-half-planes",
            "exact-touches",
            "layers-of-balls-and-edges",
            "layers-of-half-planes"
        ],
        Assignment::T2M3 => probes!["contest-of-corners"],
        Assignment::T2M2 => &[],
    }
}
