//! Draws a detection call as a picture, like the assignment's figure 2, with the numbers of the pair.
use crate::plot::{PlotTarget, PlottedPolynomial, PolynomialPlot};
use fosssim_judge::study::Study;

/// Returns a picture of a call's polynomials on the step, the intervals in which each and all are positive, and the
/// time of impact. If the mathematically right approach polynomial differs from the logged one, it is not shown,
/// because the decision does not depend on it.
pub fn render_picture(study: &Study, title: &str, embedding: PlotTarget) -> String {
    let curves = study.curves.iter().map(|curve| PlottedPolynomial {
        name: curve.role.to_string(),
        coefficients: curve.logged.coefficients(),
        zeros: curve.real_zeros(),
        positive: &curve.positive_intervals,
    });
    let curves: Vec<PlottedPolynomial<'_>> = curves.collect();
    let impact = study.answer.decision.collides().then(|| study.answer.decision.time());
    PolynomialPlot { title, curves: &curves, common: Some(&study.answer.positive_intervals), impact }.svg(embedding)
}
