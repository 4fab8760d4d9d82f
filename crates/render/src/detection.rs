//! A detection call as a picture: the assignment's figure 2 with the numbers of the pair.
use crate::plot::{Embedding, PlottedPolynomial, PolynomialPlot};
use fosssim_judge::study::Study;

/// Returns the polynomials of a call on the step, the intervals in which each and all are positive, and the time of
/// impact. If the mathematically right approach polynomial differs, it has no part in the decision and is not shown.
#[must_use]
pub fn picture(study: &Study, title: &str, embedding: Embedding) -> String {
    let curves = study.curves.iter().map(|curve| PlottedPolynomial {
        name: curve.role.to_string(),
        coefficients: curve.logged.coefficients(),
        zeros: curve.real_zeros(),
        positive: &curve.positive,
    });
    let curves: Vec<PlottedPolynomial<'_>> = curves.collect();
    let impact = study.answer.decision.collides().then(|| study.answer.decision.time());
    PolynomialPlot { title, curves: &curves, common: Some(&study.answer.positive), impact }.svg(embedding)
}
