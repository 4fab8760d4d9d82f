//! Plots detection polynomials on the step, with the intervals in which each is positive and those in which all are,
//! like the assignment's figure 2.
use super::{
    PlotTarget,
    sheet::{Anchor, Ink, Sheet, TextColor, WIDTH},
};
use crate::number::format_short;
use fosssim_num::{interval::Interval, polynomial::evaluate};

/// A polynomial in the plot.
#[derive(Debug, Clone)]
pub struct PlottedPolynomial<'a> {
    /// The polynomial's name, a few words long.
    pub name: String,
    /// The polynomial's coefficients, highest power first.
    pub coefficients: &'a [f64],
    /// The polynomial's real zeros.
    pub zeros: Vec<f64>,
    /// The intervals in which the polynomial is positive.
    pub positive: &'a [Interval],
}

/// The contents of a plot of polynomials.
#[derive(Debug, Clone, Copy)]
pub struct PolynomialPlot<'a> {
    /// The plot's title.
    pub title: &'a str,
    /// The polynomials, in one of four styles each.
    pub curves: &'a [PlottedPolynomial<'a>],
    /// The intervals in which all are positive. The value is `None` if they are not shown, as for an expected and an
    /// actual polynomial.
    pub common: Option<&'a [Interval]>,
    /// The time of impact.
    pub impact: Option<f64>,
}

const LEFT: f64 = 140.0;
const RIGHT: f64 = WIDTH - 20.0;
const TOP: f64 = 34.0;
const MIDDLE: f64 = 134.0;
const BOTTOM: f64 = 234.0;
const ROW_HEIGHT: f64 = 22.0;
const SAMPLES: u32 = 128;
/// The number of samples between the ends of a piece of a curve.
const PIECE_SAMPLES: usize = 8;

impl PolynomialPlot<'_> {
    /// Renders the plot as an `svg` element.
    pub fn svg(&self, embedding: PlotTarget) -> String {
        let rows = self.curves.len() + usize::from(self.common.is_some());
        #[expect(clippy::cast_precision_loss, reason = "a handful")]
        let row_top = |row: usize| BOTTOM + 30.0 + ROW_HEIGHT * row as f64;
        let height = row_top(rows) + 12.0;
        let mut sheet = Sheet::new(height, self.title, &self.description(), embedding);
        sheet.draw_text([16.0, 18.0], Anchor::Start, TextColor::Plain, self.title);
        let ticks = [0.0, 0.25, 0.5, 0.75, 1.0];
        sheet.draw_rules(Ink::Grid, &ticks.map(|tick| ([x(tick), TOP], [x(tick), row_top(rows)])));
        for tick in ticks {
            sheet.draw_text([x(tick), BOTTOM + 16.0], Anchor::Middle, TextColor::Faint, &format_short(tick));
        }
        sheet.draw_text([RIGHT, BOTTOM + 16.0 - 18.0], Anchor::End, TextColor::Faint, "t");
        sheet.draw_rule(Ink::Axis, [LEFT, MIDDLE], [RIGHT, MIDDLE]);
        sheet.draw_text([LEFT - 8.0, TOP + 10.0], Anchor::End, TextColor::Faint, "positive");
        sheet.draw_text([LEFT - 8.0, MIDDLE + 4.0], Anchor::End, TextColor::Faint, "0");
        sheet.draw_text([LEFT - 8.0, BOTTOM - 2.0], Anchor::End, TextColor::Faint, "negative");
        for (number, curve) in self.curves.iter().enumerate() {
            let ink = Ink::Series(number);
            draw(curve, ink, number, &mut sheet);
            let top = row_top(number);
            sheet.draw_line(ink, 2.0, &[[8.0, top + 8.0], [30.0, top + 8.0]]);
            sheet.draw_marker(ink, [19.0, top + 8.0]);
            sheet.draw_text([36.0, top + 12.0], Anchor::Start, TextColor::Plain, &curve.name);
            draw_sets(curve.positive, ink, top, 0.75, &mut sheet);
        }
        if let Some(common) = self.common {
            let top = row_top(rows - 1);
            sheet.draw_rule(Ink::Axis, [LEFT, top - 2.0], [RIGHT, top - 2.0]);
            sheet.draw_text([36.0, top + 12.0], Anchor::Start, TextColor::Mark, "all positive");
            draw_sets(common, Ink::Mark, top, 1.0, &mut sheet);
        }
        if let Some(time) = self.impact.filter(|time| (0.0..=1.0).contains(time)) {
            sheet.draw_line(Ink::Mark, 1.5, &[[x(time), TOP - 4.0], [x(time), row_top(rows)]]);
            let (label_x, anchor) =
                if time < 0.6 { (x(time) + 5.0, Anchor::Start) } else { (x(time) - 5.0, Anchor::End) };
            sheet.draw_text(
                [label_x, TOP + 4.0],
                anchor,
                TextColor::Mark,
                &format!("impact at {}", format_short(time)),
            );
        }
        sheet.finish()
    }

    /// Returns a description of the plot for readers who do not see it.
    fn description(&self) -> String {
        let mut parts: Vec<String> = self
            .curves
            .iter()
            .map(|curve| format!("{} is positive {}", curve.name, clip_to_step(curve.positive)))
            .collect();
        if let Some(common) = self.common {
            parts.push(format!("all polynomials are positive {}", clip_to_step(common)));
        }
        if let Some(time) = self.impact {
            parts.push(format!("the time of impact is {}", format_short(time)));
        }
        parts.join("; ") + ". Each curve is scaled to its own largest value on the step."
    }
}

fn x(time: f64) -> f64 {
    LEFT + time * (RIGHT - LEFT)
}

/// Draws a curve on `[0, 1]`, scaled to its largest absolute value. Scaling does not move the zeros.
fn draw(curve: &PlottedPolynomial<'_>, ink: Ink, number: usize, sheet: &mut Sheet) {
    let times: Vec<f64> = (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES)).collect();
    let values: Vec<f64> = times.iter().map(|&time| evaluate(curve.coefficients, time)).collect();
    let slopes = derivative(curve.coefficients);
    let maximum =
        values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |maximum, value| maximum.max(value.abs()));
    let y = |value: f64| if maximum > 0.0 { MIDDLE - value / maximum * (MIDDLE - TOP - 8.0) } else { MIDDLE };
    // A cubic through the values and slopes at both ends of a piece: exact up to degree 3, and with an error below a
    // thousandth of a pixel for a quintic.
    let mut path: Vec<[f64; 2]> = Vec::new();
    for k in (0..SAMPLES as usize).step_by(PIECE_SAMPLES) {
        let (start, end) = (times[k], times[k + PIECE_SAMPLES]);
        let third = (end - start) / 3.0;
        let rise = |time: f64| third * evaluate(&slopes, time);
        let (low, high) = (values[k], values[k + PIECE_SAMPLES]);
        let heights = [low, low + rise(start), high - rise(end), high];
        if heights.iter().any(|height| !height.is_finite()) {
            sheet.draw_curve(ink, 2.0, &std::mem::take(&mut path));
            continue;
        }
        if path.is_empty() {
            path.push([x(start), y(low)]);
        }
        path.extend([[x(start + third), y(heights[1])], [x(end - third), y(heights[2])], [x(end), y(high)]]);
    }
    sheet.draw_curve(ink, 2.0, &path);
    // Markers of different curves are at different times, so that none hides another.
    for k in (8 + 8 * (number % 4)..=SAMPLES as usize).step_by(32) {
        if values[k].is_finite() {
            sheet.draw_marker(ink, [x(times[k]), y(values[k])]);
        }
    }
    for &zero in curve.zeros.iter().filter(|zero| (0.0..=1.0).contains(*zero)) {
        sheet.draw_rule(ink, [x(zero), MIDDLE - 6.0], [x(zero), MIDDLE + 6.0]);
    }
}

/// Returns the coefficients of the derivative, highest power first.
fn derivative(coefficients: &[f64]) -> Vec<f64> {
    let powers = (1_u32..).take(coefficients.len().saturating_sub(1)).map(f64::from);
    let mut slopes: Vec<f64> =
        coefficients.iter().rev().skip(1).zip(powers).map(|(coefficient, power)| coefficient * power).collect();
    slopes.reverse();
    slopes
}

/// Draws a row of bars for the parts of intervals within the step. A single time is drawn as a marker.
fn draw_sets(list: &[Interval], ink: Ink, top: f64, opacity: f64, sheet: &mut Sheet) {
    for interval in list {
        let (lo, hi) = (interval.lo.max(0.0), interval.hi.min(1.0));
        if lo < hi {
            sheet.draw_bar(ink, [x(lo), top + 2.0], [x(hi) - x(lo), ROW_HEIGHT - 10.0], opacity);
        } else if lo == hi {
            sheet.draw_marker(ink, [x(lo), top + 8.0]);
        }
    }
}

/// Describes the parts of intervals within the step.
fn clip_to_step(list: &[Interval]) -> String {
    let parts: Vec<String> = list
        .iter()
        .filter_map(|interval| {
            let (lo, hi) = (interval.lo.max(0.0), interval.hi.min(1.0));
            match (lo < hi, lo == hi) {
                (true, _) => Some(format!("from {} to {}", format_short(lo), format_short(hi))),
                (_, true) => Some(format!("only at {}", format_short(lo))),
                _ => None,
            }
        })
        .collect();
    if parts.is_empty() { "nowhere in the step".to_owned() } else { parts.join(" and ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_say_what_the_picture_shows() {
        let set = |lo, hi| Interval { lo, hi };
        let (one, both) = ([set(0.5, 1.5)], [set(0.5, 1.0)]);
        let curves = [
            PlottedPolynomial {
                name: "overlap".to_owned(),
                coefficients: &[-0.25, 0.5, -0.1875],
                zeros: vec![0.5, 1.5],
                positive: &one,
            },
            PlottedPolynomial {
                name: "approach".to_owned(),
                coefficients: &[-0.25, 0.25],
                zeros: vec![1.0],
                positive: &[set(f64::NEG_INFINITY, 1.0)],
            },
        ];
        let plot = PolynomialPlot { title: "A ball", curves: &curves, common: Some(&both), impact: Some(0.5) };
        let svg = plot.svg(PlotTarget::File);
        assert!(svg.contains(
            "<desc>overlap is positive from 0.5 to 1; approach is positive from 0 to 1; all polynomials are positive \
                from 0.5 to \
             1; the time of impact is 0.5. Each curve is scaled to its own largest value on the step.</desc>"
        ), "{svg}");
        insta::assert_snapshot!("curves", svg);
    }

    #[test]
    fn nothing_to_show_is_no_failure() {
        let curve = |coefficients, zeros| PlottedPolynomial { name: String::new(), coefficients, zeros, positive: &[] };
        let (nothing, endless) = (curve(&[], Vec::new()), curve(&[f64::INFINITY, 1.0], vec![f64::NAN]));
        let svg = PolynomialPlot { title: "", curves: &[nothing, endless], common: None, impact: Some(f64::INFINITY) }
            .svg(PlotTarget::Page);
        assert!(!svg.contains("NaN") && !svg.contains("style"), "{svg}");
    }
}
