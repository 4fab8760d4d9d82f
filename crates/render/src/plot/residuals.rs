//! Plots residuals over the steps, on a logarithmic scale, with the tolerance as a line.
use super::{
    PlotTarget,
    sheet::{Anchor, Columns, Ink, LEFT, RIGHT, Sheet, TextColor, WIDTH},
};
use crate::number::{decade_range, format_short};

/// A residual of every step, beginning with the first step.
#[derive(Debug, Clone, Copy)]
pub struct Series<'a> {
    /// The name of the series, one or two words long.
    pub name: &'a str,
    /// One value per step.
    pub values: &'a [f64],
}

/// The contents of a plot of residuals.
#[derive(Debug, Clone, Copy)]
pub struct ResidualPlot<'a> {
    /// The plot's title.
    pub title: &'a str,
    /// The series of residuals, one to four.
    pub series: &'a [Series<'a>],
    /// The tolerance of the residuals.
    pub tolerance: f64,
    /// A marked step, from 1, and the reason for the mark.
    pub mark: Option<(u32, &'a str)>,
}

const TOP: f64 = 48.0;
const BOTTOM: f64 = 220.0;
/// The height of the lanes below the scale for zeros and above it for NaN.
const LANE_HEIGHT: f64 = 14.0;
const HEIGHT: f64 = 284.0;

impl ResidualPlot<'_> {
    /// Renders the plot as an `svg` element.
    pub fn svg(&self, embedding: PlotTarget) -> String {
        let steps = self.series.iter().map(|series| series.values.len()).max().unwrap_or(0);
        let mut sheet = Sheet::new(HEIGHT, self.title, &self.description(), embedding);
        sheet.draw_text([LEFT, 18.0], Anchor::Start, TextColor::Plain, self.title);
        let scale = Scale::from_plot(self);
        scale.draw(&mut sheet);
        let columns = Columns::for_steps(steps);
        sheet.draw_steps(&columns, BOTTOM + LANE_HEIGHT + 16.0, HEIGHT - 6.0);
        if let Some((step, label)) = self.mark
            && (1..=steps).contains(&(step as usize))
        {
            let x = columns.x(step as usize - 1);
            sheet.draw_line(Ink::Mark, 1.0, &[[x, TOP - LANE_HEIGHT], [x, BOTTOM + LANE_HEIGHT]]);
            let (label_x, anchor) = if x < 0.6 * WIDTH { (x + 4.0, Anchor::Start) } else { (x - 4.0, Anchor::End) };
            sheet.draw_text(
                [label_x, TOP - LANE_HEIGHT + 8.0],
                anchor,
                TextColor::Mark,
                &format!("step {step}: {label}"),
            );
        }
        let y = scale.y(self.tolerance);
        sheet.draw_line(Ink::Mark, 1.5, &[[LEFT, y], [RIGHT, y]]);
        let tolerance = format!("tolerance {}", format_short(self.tolerance));
        sheet.draw_text([RIGHT, y - 4.0], Anchor::End, TextColor::Mark, &tolerance);
        for (number, series) in self.series.iter().enumerate() {
            let ink = Ink::Series(number);
            let points: Vec<[f64; 2]> = (0..columns.columns)
                .filter_map(|column| {
                    let range = columns.range(column);
                    let (index, value) = find_worst(series.values, range)?;
                    Some([columns.x(index), scale.y(value)])
                })
                .collect();
            sheet.draw_series(ink, &points, number, 4);
        }
        let names: Vec<_> = self.series.iter().enumerate().map(|(k, series)| (Ink::Series(k), series.name)).collect();
        sheet.draw_legend([LEFT, HEIGHT - 6.0], &names);
        sheet.finish()
    }

    /// Returns a description of the plot for readers who do not see it.
    fn description(&self) -> String {
        let describe_series = |Series { name, values }: &Series<'_>| {
            let (index, value) = find_worst(values, 0..values.len())?;
            // A NaN is not below the tolerance.
            let above = values.iter().filter(|&&value| !(value < self.tolerance)).count();
            let (largest, steps, tolerance) = (format_short(value), values.len(), format_short(self.tolerance));
            Some(format!(
                "{name}: largest {largest} in step {}, {above} of {steps} steps not below the tolerance {tolerance}",
                index + 1
            ))
        };
        self.series.iter().filter_map(describe_series).collect::<Vec<_>>().join("; ")
    }
}

/// Returns the worst value in a range, and its index. A NaN is worse than any number.
fn find_worst(values: &[f64], range: std::ops::Range<usize>) -> Option<(usize, f64)> {
    let rank = |value: f64| if value.is_nan() { f64::INFINITY } else { value.abs() };
    let indices = range.start.min(values.len())..range.end.min(values.len());
    indices
        .map(|index| (index, values[index]))
        .reduce(|worst, next| if rank(next.1) > rank(worst.1) { next } else { worst })
}

/// The logarithmic scale of the plot.
struct Scale {
    low: i32,
    high: i32,
}

impl Scale {
    fn from_plot(plot: &ResidualPlot<'_>) -> Self {
        let values = plot.series.iter().flat_map(|series| series.values).copied().chain([plot.tolerance]);
        let magnitudes = values.map(f64::abs).filter(|value| *value > 0.0 && value.is_finite());
        let (minimum, maximum) = magnitudes
            .fold((f64::INFINITY, 0.0_f64), |(minimum, maximum), value| (minimum.min(value), maximum.max(value)));
        let (low, high) = if maximum > 0.0 { decade_range(minimum, maximum) } else { (-16, 0) };
        Self { low, high }
    }

    fn y(&self, value: f64) -> f64 {
        if !value.is_finite() {
            return TOP - LANE_HEIGHT;
        }
        if value == 0.0 {
            return BOTTOM + LANE_HEIGHT;
        }
        let share = (value.abs().log10() - f64::from(self.low)) / f64::from(self.high - self.low);
        BOTTOM - share.clamp(0.0, 1.0) * (BOTTOM - TOP)
    }

    fn draw(&self, sheet: &mut Sheet) {
        let every = ((self.high - self.low) / 6 + 1).max(1);
        for power in (self.low..=self.high).filter(|power| (power - self.low) % every == 0) {
            let share = f64::from(power - self.low) / f64::from(self.high - self.low);
            let y = BOTTOM - share * (BOTTOM - TOP);
            sheet.draw_rule(Ink::Grid, [LEFT, y], [RIGHT, y]);
            sheet.draw_text([LEFT - 8.0, y + 4.0], Anchor::End, TextColor::Faint, &format!("1e{power}"));
        }
        sheet.draw_rule(Ink::Axis, [LEFT, BOTTOM + LANE_HEIGHT], [RIGHT, BOTTOM + LANE_HEIGHT]);
        sheet.draw_text([LEFT - 8.0, BOTTOM + LANE_HEIGHT + 4.0], Anchor::End, TextColor::Faint, "0");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(values: &[f64]) -> String {
        let series = [Series { name: "position", values }];
        let plot = ResidualPlot { title: "Residuals", series: &series, tolerance: 1e-10, mark: Some((3, "first")) };
        plot.svg(PlotTarget::Page)
    }

    #[test]
    fn the_words_say_what_the_picture_shows() {
        let svg = plot(&[0.0, 1e-12, 3e-4, f64::NAN]);
        assert!(
            svg.contains("<desc>position: largest nan in step 4, 2 of 4 steps not below the tolerance 1e-10</desc>"),
            "{svg}"
        );
        assert!(svg.contains(">tolerance 1e-10</text>") && svg.contains(">step 3: first</text>"));
    }

    #[test]
    fn nothing_to_show_is_no_failure() {
        for values in [&[][..], &[0.0], &[f64::NAN, f64::INFINITY], &[5e-324, f64::MAX]] {
            let svg = plot(values);
            assert!(!svg.contains("NaN") && !svg.contains("inf "), "{values:?}: {svg}");
        }
    }

    #[test]
    fn long_runs_show_their_worst_steps() {
        let mut values = vec![1e-13; 20_000];
        values[12_345] = 1e-3;
        let svg = plot(&values);
        assert!(svg.len() < 30_000, "{}", svg.len());
        let series = [Series { name: "position", values: &values }];
        let scale = Scale::from_plot(&ResidualPlot { title: "", series: &series, tolerance: 1e-10, mark: None });
        let top = crate::number::format_pixel(scale.y(1e-3));
        assert!(svg.contains(&format!(" {top}L")), "the peak is drawn");
    }
}
