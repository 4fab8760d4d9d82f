//! Plots the number of detection passes of each step, as expected and as logged.
use super::{
    PlotTarget,
    sheet::{Anchor, Columns, Ink, LEFT, RIGHT, Sheet, TextColor},
};

/// The contents of a plot of passes.
#[derive(Debug, Clone, Copy)]
pub struct PassPlot<'a> {
    /// The plot's title.
    pub title: &'a str,
    /// The reference's number of detection passes of each step, from the first step on.
    pub expected: &'a [u32],
    /// The trace's numbers of passes, or `None` if the polynomials do not fill a whole number of passes.
    pub actual: &'a [Option<u32>],
}

const TOP: f64 = 44.0;
const BOTTOM: f64 = 150.0;
const HEIGHT: f64 = 192.0;

impl PassPlot<'_> {
    /// Renders the plot as an `svg` element.
    pub fn svg(&self, embedding: PlotTarget) -> String {
        let mut sheet = Sheet::new(HEIGHT, self.title, &self.description(), embedding);
        sheet.draw_text([LEFT, 18.0], Anchor::Start, TextColor::Plain, self.title);
        let steps = self.expected.len().max(self.actual.len());
        let columns = Columns::for_steps(steps);
        let max_count =
            self.expected.iter().copied().chain(self.actual.iter().copied().flatten()).max().unwrap_or(0).max(1);
        let y = |count: u32| BOTTOM - f64::from(count) / f64::from(max_count) * (BOTTOM - TOP);
        let every = (max_count / 4).max(1);
        for count in (0..=max_count).step_by(every as usize) {
            sheet.draw_rule(if count == 0 { Ink::Axis } else { Ink::Grid }, [LEFT, y(count)], [RIGHT, y(count)]);
            sheet.draw_text([LEFT - 8.0, y(count) + 4.0], Anchor::End, TextColor::Faint, &count.to_string());
        }
        sheet.draw_steps(&columns, BOTTOM + 16.0, HEIGHT - 6.0);
        let (mut expected, mut actual, mut differing) = (Vec::new(), Vec::new(), Vec::new());
        for column in 0..columns.columns {
            let range = columns.range(column);
            if range.is_empty() {
                continue;
            }
            let x = columns.x(range.start);
            // A step with a difference represents its column.
            let index = range.clone().find(|&index| self.has_difference(index));
            if index.is_some() {
                differing.push(x);
            }
            let index = index.unwrap_or(range.start);
            if let Some(&count) = self.expected.get(index) {
                expected.push([x, y(count)]);
            }
            if let Some(Some(count)) = self.actual.get(index) {
                actual.push([x, y(*count)]);
            }
        }
        for &x in &differing {
            sheet.draw_bar(Ink::Mark, [x - 1.5, TOP], [3.0, BOTTOM - TOP], 0.25);
            sheet.draw_marker(Ink::Mark, [x, TOP - 8.0]);
        }
        for (number, points) in [expected, actual].iter().enumerate() {
            sheet.draw_series(Ink::Series(number), points, number, 2);
        }
        sheet.draw_legend([LEFT, HEIGHT - 6.0], &[(Ink::Series(0), "expected"), (Ink::Series(1), "actual")]);
        sheet.finish()
    }

    fn has_difference(&self, index: usize) -> bool {
        match (self.expected.get(index), self.actual.get(index)) {
            (Some(expected), Some(actual)) => Some(*expected) != *actual,
            _ => false,
        }
    }

    /// Returns a description of the plot for readers who do not see it.
    fn description(&self) -> String {
        let compared = self.expected.len().min(self.actual.len());
        let differing_count = (0..compared).filter(|&index| self.has_difference(index)).count();
        let first = (0..compared).find(|&index| self.has_difference(index));
        let first = first.map_or_else(String::new, |index| {
            let actual = self.actual[index].map_or_else(|| "no whole number".to_owned(), |count| count.to_string());
            format!("; the first is step {} with {actual}, expected {}", index + 1, self.expected[index])
        });
        format!("{differing_count} of {compared} steps have a different number of detection passes{first}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differing_steps_are_marked_and_listed() {
        let plot = PassPlot { title: "Passes", expected: &[1, 2, 2, 1], actual: &[Some(1), Some(2), Some(3), None] };
        let svg = plot.svg(PlotTarget::Page);
        let words = "2 of 4 steps have a different number of detection passes; the first is step 3 with 3, expected 2";
        assert!(svg.contains(&format!("<desc>{words}</desc>")), "{svg}");
        assert_eq!(svg.matches("m0 -7l-7 7").count(), 2);
    }

    #[test]
    fn a_single_differing_step_of_a_long_run_is_seen() {
        let expected = vec![1; 100_000];
        let mut actual: Vec<_> = expected.iter().copied().map(Some).collect();
        actual[77_777] = Some(9);
        let svg = PassPlot { title: "Passes", expected: &expected, actual: &actual }.svg(PlotTarget::Page);
        assert_eq!(svg.matches("m0 -7l-7 7").count(), 1);
        assert!(svg.len() < 40_000);
        let _ = PassPlot { title: "", expected: &[], actual: &[] }.svg(PlotTarget::File);
    }
}
