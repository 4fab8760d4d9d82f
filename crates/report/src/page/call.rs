//! A detection call on a page: curves, intervals, coefficients.
use super::{case::number, data::key, markup::text};
use crate::detect::Detect;
use fosssim_evidence::Call;
use fosssim_judge::{PairWords, PassWords, study::Study};
use fosssim_num::{first_time::positive_set, interval::Interval};
use fosssim_render::{
    detection,
    plot::{Curve, Curves, Embedding},
};
use std::fmt::Write;

/// Coefficients agree where they differ by less than this part of the polynomial's largest one.
const SAME: f64 = 1e-9;

pub(super) fn html(step: u32, call: &Call, depth: usize) -> String {
    let mut out = format!(
        "<section>\n<h{depth}>Step {step}: {} <span class=\"hint\">({}, {})</span></h{depth}>\n",
        text(&PairWords(call.pair).to_string()),
        text(&PassWords(call.pass).to_string()),
        key(call.pair)
    );
    let study = match &call.study {
        Ok(study) => study,
        Err(error) => {
            let _ = writeln!(out, "<p>{}</p></section>", text(&error.to_string()));
            return out;
        }
    };
    let _ = writeln!(out, "<p>{}</p>", text(&Detect { study, place: None }.decision()));
    let title = format!("Expected in step {step}: {}", PairWords(call.pair));
    let _ = writeln!(out, "<figure>{}</figure>", detection::picture(study, &title, Embedding::Inline));
    out += &coefficients(study, &call.logged);
    for (curve, logged) in study.curves.iter().zip(&call.logged) {
        if marks(curve.logged.coefficients(), logged).iter().any(|&differs| differs) {
            out += &both(step, &curve.role.to_string(), curve.logged.coefficients(), &curve.positive, logged);
        }
    }
    out + "</section>\n"
}

/// Expected and actual curve of one polynomial.
fn both(step: u32, role: &str, expected: &[f64], positive: &[Interval], logged: &[f64]) -> String {
    // A polynomial whose zeros can't be found has no intervals to show.
    let own = if logged.len() <= 6 && logged.iter().all(|c| c.is_finite()) {
        positive_set(logged).map(|set| set.as_slice().to_vec()).unwrap_or_default()
    } else {
        Vec::new()
    };
    let (yours, right) = (format!("{role}, yours"), format!("{role}, expected"));
    let curves = [
        Curve { name: &right, coefficients: expected, zeros: &[], positive },
        Curve { name: &yours, coefficients: logged, zeros: &[], positive: &own },
    ];
    let title = format!("Step {step}: {role}, expected and yours");
    let svg = Curves { title: &title, curves: &curves, common: None, impact: None }.svg(Embedding::Inline);
    format!("<figure>{svg}</figure>\n")
}

/// All coefficients side by side; those that differ after the factor that fits most are marked.
fn coefficients(study: &Study, logged: &[Vec<f64>]) -> String {
    let mut out = String::from(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Coefficients\"><table>\
         <caption>Coefficients; what differs by more than a common factor is marked</caption><thead><tr>\
         <th scope=\"col\">polynomial</th><th scope=\"col\">power</th><th scope=\"col\">expected</th>\
         <th scope=\"col\">yours</th><th scope=\"col\"></th></tr></thead><tbody>\n",
    );
    for (place, curve) in study.curves.iter().enumerate() {
        let expected = curve.logged.coefficients();
        let own = logged.get(place).map_or(&[][..], Vec::as_slice);
        let marks = marks(expected, own);
        let powers = expected.len().max(own.len()).min(12);
        for power in (0..powers).rev() {
            let at = |list: &[f64]| (power < list.len()).then(|| list[list.len() - 1 - power]);
            let cell = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), number);
            let differs = !own.is_empty() && marks.get(power).copied().unwrap_or(true);
            let (class, word) = if differs { (" class=\"off\"", "differs") } else { ("", "") };
            let _ = writeln!(
                out,
                "<tr{class}><th scope=\"row\">{}</th><td>t^{power}</td><td class=\"num\">{}</td><td class=\"num\">{}</td>\
                 <td>{word}</td></tr>",
                text(&curve.role.to_string()),
                cell(at(expected)),
                if logged.is_empty() { "not known".to_owned() } else { cell(at(own)) },
            );
        }
    }
    out + "</tbody></table></div>\n"
}

/// For each power whether the coefficients differ once one is multiplied by the factor that makes most of them agree.
fn marks(expected: &[f64], own: &[f64]) -> Vec<bool> {
    let powers = expected.len().max(own.len());
    let at = |list: &[f64], power: usize| if power < list.len() { list[list.len() - 1 - power] } else { 0.0 };
    let scale = expected.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let compare = |factor: f64| -> Vec<bool> {
        let room = SAME * (factor * scale).abs();
        (0..powers).map(|power| !((at(own, power) - factor * at(expected, power)).abs() <= room)).collect()
    };
    let factors = (0..powers).map(|power| at(own, power) / at(expected, power)).filter(|f| f.is_finite() && *f > 0.0);
    let differing = |marks: &Vec<bool>| marks.iter().filter(|&&differs| differs).count();
    // The factor 1 first: it needs no explanation.
    std::iter::once(1.0).chain(factors).map(compare).min_by_key(differing).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_after_the_best_factor_is_marked() {
        // t^1 is wrong, and all is scaled.
        assert_eq!(marks(&[1.0, 2.0, 3.0], &[10.0, 25.0, 30.0]), [false, true, false]);
        assert_eq!(marks(&[1.0, 2.0], &[2.0, 4.0]), [false, false]);
        assert_eq!(marks(&[1.0, 2.0], &[-1.0, -2.0]), [true, true]);
        assert_eq!(marks(&[1.0, 2.0], &[1.0]).iter().filter(|&&mark| mark).count(), 1);
        assert_eq!(marks(&[1.0], &[f64::NAN]), [true]);
    }
}
