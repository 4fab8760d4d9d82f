//! Computes a pair's time of impact, if it is needed.
use super::super::{
    observer::ImpactTime,
    pair::Pair,
    search::{RootSearch, SearchCounts},
    step_error::StepError,
};
use fosssim_num::{certificate::excludes_unit_interval, first_time::first_time_with_steps, polynomial::Polynomial};

/// Returns the time of impact, or [`ImpactTime::Excluded`] if times are needed only on demand and a certificate
/// excludes an impact within the step.
///
/// # Errors
/// Fails with [`StepError::RootSearch`] if a root search would never end.
#[inline]
pub(super) fn time_of_impact(
    search: RootSearch,
    counts: &mut SearchCounts,
    step: u32,
    pair: Pair,
    polynomials: &[Polynomial],
) -> Result<ImpactTime, StepError> {
    counts.calls += 1;
    let excluded = search != RootSearch::Always && excludes_unit_interval(polynomials);
    if excluded && search == RootSearch::OnDemand {
        return Ok(ImpactTime::Excluded);
    }
    counts.searched += 1;
    let time =
        first_time_with_steps(polynomials, &mut counts.steps).map_err(|_| StepError::RootSearch { step, pair })?;
    if excluded && time <= 1.0 {
        counts.disagreements += 1;
    }
    Ok(ImpactTime::Found(time))
}
