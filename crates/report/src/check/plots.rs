//! Small plots for a terminal: residuals over the steps, and the polynomial that is wrong first.
//!
//! They accompany the text and say nothing that it does not say.
use fosssim_evidence::{Evidence, Logged};
use fosssim_judge::{PairWords, study::Curve};
use fosssim_num::tolerances::PARITY_MAXIMUM;
use fosssim_render::terminal;

/// The plots that fit into this number of columns; empty where there is nothing to see.
#[must_use]
pub fn plots(evidence: &Evidence, columns: usize) -> String {
    // In front stands the scale, behind it the tolerance.
    let columns = columns.saturating_sub(30);
    let mut text = String::new();
    let residuals: Vec<f64> = evidence
        .steps
        .iter()
        .map(|step| if step.position.is_nan() { f64::NAN } else { step.position.max(step.velocity) })
        .collect();
    if let Some(plot) = terminal::residuals(&residuals, PARITY_MAXIMUM, columns) {
        text += &format!("Residuals of the {} steps\n{plot}", residuals.len());
    }
    let calls = evidence.inspected.iter().flat_map(|up| up.calls.iter().map(move |call| (up.step, call)));
    let wrong = calls.filter_map(|(step, call)| {
        let (study, Logged::These(logged)) = (call.study.as_ref().ok()?, &call.logged) else { return None };
        let is_wrong = |(curve, own): &(&Curve, &Vec<f64>)| !own.is_empty() && differ(curve.logged.coefficients(), own);
        let curve = study.curves.iter().zip(logged).find(is_wrong)?;
        Some((step, call.pair, curve))
    });
    if let Some((step, pair, (curve, own))) = wrong.min_by_key(|(step, ..)| *step)
        && let Some(plot) = terminal::curves(&[curve.logged.coefficients(), own], columns)
    {
        let (role, pair) = (curve.role, PairWords(pair));
        text += &format!("Step {step}, {pair}, {role}: expected (solid) and yours (dotted)\n{plot}");
    }
    text
}

/// Whether two polynomials are visibly not the same up to a factor.
fn differ(expected: &[f64], own: &[f64]) -> bool {
    let scaled = |list: &[f64]| {
        let most = list.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        list.iter().map(|c| c / most).collect::<Vec<_>>()
    };
    let (expected, own) = (scaled(expected), scaled(own));
    expected.len() != own.len() || expected.iter().zip(&own).any(|(a, b)| !((a - b).abs() <= 1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_evidence::{BUDGET, Focus, StepRulings, gather};
    use fosssim_judge::replay;
    use fosssim_mistakes::student::{self, Student};
    use fosssim_model::scene::original;

    fn plots_of(id: Option<&str>) -> String {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2/ContinuousTimeTests");
        let bytes = std::fs::read(folder.join("spinning-edge-sweeps-balls.xml")).expect("a scene");
        let scene = original::read(&bytes).expect("a scene").scene;
        let mistake = id.map(|id| student::find(id).expect("a mistake").mistake);
        let trace = student::trace(&scene, Student::new(mistake)).unwrap_or_else(|(trace, _)| trace);
        let mut rulings = StepRulings::default();
        let options = replay::Options { fair: true, ..Default::default() };
        let outcome = replay::judge(&scene, &trace[..], &options, &mut rulings);
        let focus: Vec<Focus> = outcome.parity.findings.examples.iter().map(Focus::from).collect();
        plots(&gather(&scene, &mut &trace[..], &rulings.into_steps(&outcome), true, &focus, BUDGET), 80)
    }

    #[test]
    fn a_wrong_polynomial_and_the_residuals_are_drawn() {
        let text = plots_of(Some("pe-linear-one-ab"));
        assert!(text.contains(": expected (solid) and yours (dotted)\n") && text.contains("t = 0 to 1"), "{text}");
        assert!(text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert_eq!(plots_of(None), "");
    }
}
