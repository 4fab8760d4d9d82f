//! A detection call on a page, with its curves, intervals and coefficients.
use super::{
    markup::{mark_difference, render_number},
    render_template,
};
use crate::{describe::pair_key, detect::DetectReport, number::format_g};
use askama::Template;
use fosssim_evidence::{CallLog, InspectedCall};
use fosssim_judge::{
    PairText, PassText, find_differing_powers, find_factor,
    study::{self, Study},
};
use fosssim_num::{first_time::positive_set, interval::Interval};
use fosssim_render::{
    detection,
    plot::{PlotTarget, PlottedPolynomial, PolynomialPlot},
};

/// Renders a detection call below its name. It is unfolded if `open`.
pub(super) fn render_call(step: u32, call: &InspectedCall, depth: usize, open: bool) -> String {
    let (pair, pass) = (PairText(call.pair), PassText(call.pass));
    render_template(&CallContent { step, call, depth, open, pair, pass, key: pair_key(call.pair) })
}

/// A detection call and its name, as the template reads them.
#[derive(Template)]
#[template(path = "call.html")]
struct CallContent<'a> {
    step: u32,
    call: &'a InspectedCall,
    depth: usize,
    open: bool,
    pair: PairText,
    pass: PassText,
    key: String,
}

/// A coefficient of the reference and of the trace, as HTML.
struct Row {
    role: String,
    power: usize,
    expected: String,
    own: String,
    /// A word for the fault of the coefficient; empty if the coefficient is right.
    word: &'static str,
}

impl CallContent<'_> {
    /// Returns the polynomials that the trace logs.
    fn logged_polynomials(&self) -> &[Vec<f64>] {
        match &self.call.logged {
            CallLog::Polynomials(logged) => logged,
            CallLog::Nothing | CallLog::Unknown => &[],
        }
    }

    fn is_missing(&self) -> bool {
        self.call.logged == CallLog::Nothing
    }

    /// Draws the curves of the expected polynomials.
    fn draw_expected(&self, study: &Study) -> String {
        detection::render_picture(study, &format!("Expected in step {}: {}", self.step, self.pair), PlotTarget::Page)
    }

    /// Renders the decision that follows from the trace's own polynomials, and their curves. Returns an empty text if
    /// all of them are right.
    fn draw_own(&self, study: &Study, logged: &[Vec<f64>]) -> String {
        let mut wrong = study.curves.iter().zip(logged).filter(|(curve, own)| {
            !own.is_empty() && mark_differences(curve.logged.coefficients(), own).contains(&true)
        });
        let curves = match (wrong.next(), wrong.next()) {
            (None, _) => return String::new(),
            (Some((curve, own)), None) => draw_both(
                self.step,
                &curve.role.to_string(),
                curve.logged.coefficients(),
                &curve.positive_intervals,
                own,
            ),
            _ => draw_own_curves(self.step, self.call, study, logged),
        };
        own_decision(logged) + &curves
    }
}

/// Describes the decision that follows from the expected polynomials.
fn describe_decision(study: &Study) -> String {
    DetectReport { study, place: None }.describe_decision(format_g)
}

/// Returns whether a curve has a zero within the step. Without a zero, a plot shows only the signs, which one sentence
/// can state.
fn changes_sign(study: &Study) -> bool {
    study.curves.iter().any(|curve| curve.real_zeros().iter().any(|zero| (0.0..=1.0).contains(zero)))
}

/// Describes the polynomials whose signs do not change within the step.
fn describe_signs(study: &Study) -> String {
    let list_roles = |is_wanted: bool| {
        let is_positive =
            |curve: &study::StudiedPolynomial| curve.positive_intervals.iter().any(|set| set.lo < 0.5 && set.hi > 0.5);
        let names = study.curves.iter().filter(|curve| is_positive(curve) == is_wanted);
        names.map(|curve| curve.role.to_string()).collect::<Vec<_>>().join(", ")
    };
    let parts = [("positive", list_roles(true)), ("not positive", list_roles(false))];
    let parts = parts.iter().filter(|(_, names)| !names.is_empty());
    let parts: Vec<String> = parts.map(|(sign, names)| format!("{sign}: {names}")).collect();
    format!("No expected polynomial changes its sign in the step. {}.", parts.join("; "))
}

/// Returns whether a set of times neither begins nor ends within the step.
fn has_no_end_in_step(set: &[Interval]) -> bool {
    !list_interval_ends(set).iter().any(|end| (0.0..=1.0).contains(end))
}

/// Returns the curves of the trace's polynomials, drawn like the expected ones.
fn draw_own_curves(step: u32, call: &InspectedCall, study: &Study, logged: &[Vec<f64>]) -> String {
    let sets: Vec<Vec<Interval>> = logged.iter().map(|own| positive_intervals(own)).collect();
    let own = study.curves.iter().zip(logged).zip(&sets);
    let curves: Vec<PlottedPolynomial<'_>> =
        own.map(|((curve, own), set)| plot_polynomial(curve.role.to_string(), own, set)).collect();
    if sets.iter().all(|set| has_no_end_in_step(set)) {
        return String::new();
    }
    let common = common_intervals(logged);
    let impact = common.iter().map(|set| set.lo).reduce(f64::min);
    let title = format!("Yours in step {step}: {}", PairText(call.pair));
    let svg = PolynomialPlot { title: &title, curves: &curves, common: Some(&common), impact }.svg(PlotTarget::Page);
    format!("<figure tabindex=\"0\">{svg}</figure>\n")
}

/// Returns the curve of a polynomial that is positive at the times in `positive`.
fn plot_polynomial<'a>(name: String, coefficients: &'a [f64], positive: &'a [Interval]) -> PlottedPolynomial<'a> {
    PlottedPolynomial { name, coefficients, zeros: list_interval_ends(positive), positive }
}

/// Returns the ends of the intervals in which a polynomial is positive. The finite ends are zeros of the polynomial.
fn list_interval_ends(set: &[Interval]) -> Vec<f64> {
    set.iter().flat_map(|interval| [interval.lo, interval.hi]).collect()
}

/// Returns the intervals in which a polynomial of the trace is positive; empty if its zeros can't be found.
fn positive_intervals(own: &[f64]) -> Vec<Interval> {
    match own.len() <= 6 && own.iter().all(|c| c.is_finite()) {
        true => positive_set(own).map(|set| set.as_slice().to_vec()).unwrap_or_default(),
        false => Vec::new(),
    }
}

/// Returns the intervals within the step in which all polynomials of the trace are positive.
fn common_intervals(logged: &[Vec<f64>]) -> Vec<Interval> {
    let mut common = vec![Interval { lo: 0.0, hi: 1.0 }];
    for own in logged.iter().map(|own| positive_intervals(own)) {
        let intersect =
            |one: &Interval, other: &Interval| Interval { lo: one.lo.max(other.lo), hi: one.hi.min(other.hi) };
        common = common.iter().flat_map(|interval| own.iter().map(move |other| intersect(interval, other))).collect();
        common.retain(|set| set.lo <= set.hi);
    }
    common
}

/// Describes the decision that follows from the trace's own polynomials.
fn own_decision(logged: &[Vec<f64>]) -> String {
    let decision = match common_intervals(logged).iter().map(|set| set.lo).reduce(f64::min) {
        Some(time) => format!("all polynomials are positive from time {} on: a collision", render_number(time)),
        None => "at no time in the step are all polynomials positive: no collision".to_owned(),
    };
    format!("<p>According to your polynomials, {decision}.</p>\n")
}

/// Draws the expected and the actual curve of one polynomial in the same plot.
fn draw_both(step: u32, role: &str, expected: &[f64], set: &[Interval], logged: &[f64]) -> String {
    let own = positive_intervals(logged);
    if has_no_end_in_step(set) && has_no_end_in_step(&own) {
        return String::new();
    }
    // The names must be short, because they are left of the bars. The title names the polynomial.
    let curves =
        [plot_polynomial("expected".to_owned(), expected, set), plot_polynomial("yours".to_owned(), logged, &own)];
    let title = format!("Step {step}: {role}, expected and yours");
    let svg = PolynomialPlot { title: &title, curves: &curves, common: None, impact: None }.svg(PlotTarget::Page);
    format!("<figure tabindex=\"0\">{svg}</figure>\n")
}

/// Returns all coefficients side by side. Those that differ after division by the common factor are marked.
fn list_coefficients(study: &Study, logged: &[Vec<f64>], nothing: bool) -> Vec<Row> {
    let mut rows = Vec::new();
    for (index, curve) in study.curves.iter().enumerate() {
        let expected = curve.logged.coefficients();
        let own = logged.get(index).map_or(&[][..], Vec::as_slice);
        let (marks, factor) = (mark_differences(expected, own), find_factor(expected, own));
        for power in (0..expected.len().max(own.len()).min(12)).rev() {
            let at = |list: &[f64]| (power < list.len()).then(|| list[list.len() - 1 - power]);
            let cell = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), render_number);
            let missing = nothing || own.is_empty() && !logged.is_empty();
            let is_different = missing || !own.is_empty() && marks.get(power).copied().unwrap_or(true);
            let (right, yours) = match (at(expected), at(own)) {
                (Some(expected), Some(own)) => mark_difference(factor * expected, own, is_different),
                (expected, _) if logged.is_empty() && !nothing => (cell(expected), "not known".to_owned()),
                (expected, own) => (cell(expected), cell(own)),
            };
            let word = if missing { "missing" } else { ["", "differs"][usize::from(is_different)] };
            rows.push(Row { role: curve.role.to_string(), power, expected: right, own: yours, word });
        }
    }
    rows
}

/// Returns for each power of t whether its coefficients differ after division by the common factor.
fn mark_differences(expected: &[f64], own: &[f64]) -> Vec<bool> {
    let differing = find_differing_powers(expected, own, find_factor(expected, own));
    (0..expected.len().max(own.len())).map(|power| differing.contains(&power)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_after_the_best_factor_are_marked() {
        // The coefficient of t^1 is wrong, and all coefficients are scaled.
        assert_eq!(mark_differences(&[1.0, 2.0, 3.0], &[10.0, 25.0, 30.0]), [false, true, false]);
        assert_eq!(mark_differences(&[1.0, 2.0], &[2.0, 4.0]), [false, false]);
        assert_eq!(mark_differences(&[1.0, 2.0], &[-1.0, -2.0]), [true, true]);
        assert_eq!(mark_differences(&[1.0, 2.0], &[2.0]).iter().filter(|&&mark| mark).count(), 1);
        assert_eq!(mark_differences(&[1.0], &[f64::NAN]), [true]);
    }
}
