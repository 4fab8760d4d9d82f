//! A sheet of SVG on which a plot is drawn.
use super::{PlotTarget, STYLE};
use crate::{number::format_pixel, svg::escape};
use std::fmt::Write;

/// The width of all sheets.
pub const WIDTH: f64 = 640.0;

/// The positions of the first and the last step in plots over the steps.
pub const LEFT: f64 = 64.0;
pub const RIGHT: f64 = WIDTH - 16.0;

/// The ends of the axis, which other code needs to draw on it.
pub const STEPS_AXIS: [f64; 2] = [LEFT, RIGHT];

/// The ink of a mark. It is a class in the style sheet, or a color without a style sheet.
#[derive(Debug, Clone, Copy)]
pub enum Ink {
    /// The ink draws axes.
    Axis,
    /// The ink draws grid lines.
    Grid,
    /// The ink draws wrong values, limits and impacts.
    Mark,
    /// The ink draws a series, numbered from 0. After four series the styles repeat.
    Series(usize),
}

/// The colors of series.
const SERIES_COLORS: [&str; 4] = ["#0063a6", "#a34e00", "#00694a", "#84367c"];

impl Ink {
    /// Returns the class of a line (`s`) or an area (`f`), and the color. Axes and grids are never filled.
    fn class_and_color(self, kind: char) -> (String, &'static str) {
        match self {
            Self::Axis => ("ax".to_owned(), "#1b1f24"),
            Self::Grid => ("gr".to_owned(), "#dfe3e8"),
            Self::Mark => (format!("b{kind}"), "#b3261e"),
            Self::Series(number) => (format!("{kind}{}", number % 4 + 1), SERIES_COLORS[number % 4]),
        }
    }

    /// Returns the dashes of the line of a series.
    const fn dash(self) -> &'static str {
        match self {
            Self::Series(number) => match number % 4 {
                0 => "",
                1 => " stroke-dasharray=\"7 3\"",
                2 => " stroke-dasharray=\"2 3\"",
                _ => " stroke-dasharray=\"8 3 2 3\"",
            },
            Self::Mark => " stroke-dasharray=\"4 3\"",
            Self::Axis | Self::Grid => "",
        }
    }
}

/// The alignment of a text at its position.
#[derive(Debug, Clone, Copy)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// The color of a text.
#[derive(Debug, Clone, Copy)]
pub enum TextColor {
    Plain,
    Faint,
    Mark,
}

/// A sheet of SVG with its content.
#[derive(Debug)]
pub struct Sheet {
    svg: String,
    /// Whether the page's style sheet contains all styles, so that the markup does not need them.
    is_styled: bool,
}

impl Sheet {
    /// Creates a sheet with a given height.
    pub fn new(height: f64, title: &str, description: &str, embedding: PlotTarget) -> Self {
        let (title, description) = (escape(title), escape(description));
        let (width, height) = (format_pixel(WIDTH), format_pixel(height));
        let is_styled = embedding == PlotTarget::Page;
        let (space, font) = match is_styled {
            true => ("", ""),
            false => (" xmlns=\"http://www.w3.org/2000/svg\"", " font-family=\"sans-serif\" font-size=\"12\""),
        };
        let label = if is_styled { String::new() } else { format!(" aria-label=\"{title}\"") };
        let mut svg = format!(
            "<svg{space} class=\"fp\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
             role=\"img\"{label}{font}><title>{title}</title><desc>{description}</desc>\n"
        );
        if embedding == PlotTarget::File {
            let _ = writeln!(svg, "<style>{STYLE}</style>");
            let _ = writeln!(svg, "<rect class=\"pp\" width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>");
        }
        Self { svg, is_styled }
    }

    /// Returns the finished SVG.
    pub fn finish(mut self) -> String {
        self.svg += "</svg>\n";
        self.svg
    }

    /// Returns an attribute for the style, unless a style sheet has it.
    fn attribute_unless_styled(&self, attribute: &str, value: &str) -> String {
        if self.is_styled { String::new() } else { format!(" {attribute}=\"{value}\"") }
    }

    /// Returns the attributes of a stroked path.
    fn stroke_attributes(&self, ink: Ink) -> String {
        let (class, color) = ink.class_and_color('s');
        format!(
            " class=\"{class}\"{}{}",
            self.attribute_unless_styled("stroke", color),
            self.attribute_unless_styled("fill", "none")
        )
    }

    /// Returns the attributes of a filled shape.
    fn fill_attributes(&self, ink: Ink) -> String {
        let (class, color) = ink.class_and_color('f');
        format!(" class=\"{class}\"{}", self.attribute_unless_styled("fill", color))
    }

    /// Draws a thin straight line, which has no dashes.
    pub fn draw_rule(&mut self, ink: Ink, from: [f64; 2], to: [f64; 2]) {
        self.draw_rules(ink, &[(from, to)]);
    }

    /// Draws thin straight lines without dashes.
    pub fn draw_rules(&mut self, ink: Ink, lines: &[([f64; 2], [f64; 2])]) {
        let ink = self.stroke_attributes(ink);
        let piece = |&([x1, y1], [x2, y2]): &([f64; 2], [f64; 2])| {
            let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(format_pixel);
            format!("M{x1} {y1}L{x2} {y2}")
        };
        let list: String = lines.iter().map(piece).collect();
        let _ = writeln!(self.svg, "<path{ink} stroke-width=\"1\" d=\"{list}\"/>");
    }

    /// Draws a line with the ink's dashes.
    pub fn draw_line(&mut self, ink: Ink, width: f64, points: &[[f64; 2]]) {
        if points.len() < 2 {
            return;
        }
        let list = points
            .iter()
            .map(|&[x, y]| format!("{} {}", format_pixel(x), format_pixel(y)))
            .collect::<Vec<_>>()
            .join("L");
        self.draw_path(ink, width, &list);
    }

    /// Draws a line of cubic curves: the start, and for each piece two control points and its end.
    pub fn draw_curve(&mut self, ink: Ink, width: f64, points: &[[f64; 2]]) {
        let Some((&[x, y], rest)) = points.split_first().filter(|(_, rest)| !rest.is_empty()) else { return };
        let list =
            rest.iter().map(|&[x, y]| format!("{} {}", format_pixel(x), format_pixel(y))).collect::<Vec<_>>().join(" ");
        self.draw_path(ink, width, &format!("{} {}C{list}", format_pixel(x), format_pixel(y)));
    }

    fn draw_path(&mut self, ink: Ink, width: f64, list: &str) {
        let _ = writeln!(
            self.svg,
            "<path{}{}{}{} d=\"M{list}\"/>",
            self.stroke_attributes(ink),
            // The lines of the style sheet have this width.
            if self.is_styled && width == 2.0 {
                String::new()
            } else {
                format!(" stroke-width=\"{}\"", format_pixel(width))
            },
            self.attribute_unless_styled("stroke-linejoin", "round"),
            ink.dash()
        );
    }

    /// Draws a filled rectangle.
    pub fn draw_bar(&mut self, ink: Ink, [left, top]: [f64; 2], [width, height]: [f64; 2], opacity: f64) {
        let ink = self.fill_attributes(ink);
        let [left, top, width, height] = [left, top, width.max(0.5), height].map(format_pixel);
        let _ = writeln!(
            self.svg,
            "<rect{ink} fill-opacity=\"{}\" x=\"{left}\" y=\"{top}\" width=\"{width}\" \
             height=\"{height}\"/>",
            format_pixel(opacity)
        );
    }

    /// Draws a marker. The series have different shapes: disc, square, triangle and diamond. A wrong value is drawn as
    /// a cross.
    pub fn draw_marker(&mut self, ink: Ink, [x, y]: [f64; 2]) {
        let path = match ink {
            Ink::Series(number) => match number % 4 {
                0 => format!("M{} {}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0z", format_pixel(x - 3.0), format_pixel(y)),
                1 => format!("M{} {}h5.4v5.4h-5.4z", format_pixel(x - 2.7), format_pixel(y - 2.7)),
                2 => format!("M{} {}l3.6 6.2h-7.2z", format_pixel(x), format_pixel(y - 4.0)),
                _ => format!("M{} {}l4 4l-4 4l-4 -4z", format_pixel(x), format_pixel(y - 4.0)),
            },
            Ink::Axis | Ink::Grid | Ink::Mark => {
                let ink = self.stroke_attributes(ink);
                let (x, y) = (format_pixel(x - 3.5), format_pixel(y - 3.5));
                let _ = writeln!(self.svg, "<path{ink} stroke-width=\"2\" d=\"M{x} {y}l7 7m0 -7l-7 7\"/>");
                return;
            }
        };
        let ink = self.fill_attributes(ink);
        let _ = writeln!(self.svg, "<path{ink} d=\"{path}\"/>");
    }

    /// Draws a line of text. The position `[x, y]` is on its base line.
    pub fn draw_text(&mut self, [x, y]: [f64; 2], anchor: Anchor, color: TextColor, text: &str) {
        // A text starts at its position unless another alignment is set.
        let anchor = match anchor {
            Anchor::Start if self.is_styled => "",
            Anchor::Start => " text-anchor=\"start\"",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (class, color) = match color {
            TextColor::Plain => ("", "#1b1f24"),
            TextColor::Faint => (" class=\"ft\"", "#5f6871"),
            TextColor::Mark => (" class=\"bt\"", "#b3261e"),
        };
        let (x, y) = (format_pixel(x), format_pixel(y));
        let _ = writeln!(
            self.svg,
            "<text{class} x=\"{x}\" y=\"{y}\"{anchor}{}>{}</text>",
            self.attribute_unless_styled("fill", color),
            escape(text)
        );
    }

    /// Draws the axis of the steps, with numbers on one line and its name on another.
    pub fn draw_steps(&mut self, columns: &Columns, numbers: f64, name: f64) {
        for tick in ticks(columns.steps) {
            self.draw_text([columns.x(tick - 1), numbers], Anchor::Middle, TextColor::Faint, &tick.to_string());
        }
        self.draw_text([RIGHT, name], Anchor::End, TextColor::Faint, "step");
    }

    /// Draws the line of series `number` of `series_count`, with its markers between those of the others.
    pub fn draw_series(&mut self, ink: Ink, points: &[[f64; 2]], number: usize, series_count: usize) {
        self.draw_line(ink, 1.5, points);
        let every = (points.len() / 12).max(1);
        points
            .iter()
            .skip(every * number / series_count)
            .step_by(every)
            .for_each(|&point| self.draw_marker(ink, point));
    }

    /// Draws a legend in a row, with the line, marker and name of each series.
    pub fn draw_legend(&mut self, [left, base]: [f64; 2], names: &[(Ink, &str)]) {
        let mut x = left;
        for &(ink, name) in names {
            self.draw_line(ink, 2.0, &[[x, base - 4.0], [x + 26.0, base - 4.0]]);
            if !matches!(ink, Ink::Mark) {
                self.draw_marker(ink, [x + 13.0, base - 4.0]);
            }
            self.draw_text([x + 32.0, base], Anchor::Start, TextColor::Plain, name);
            #[expect(clippy::cast_precision_loss, reason = "names are short")]
            let wide = name.chars().count() as f64;
            // Small screens show larger letters.
            x += 48.0 + 9.0 * wide;
        }
    }
}

/// The columns of the steps. Plots of long runs show the worst of the steps that share a column.
#[derive(Debug, Clone, Copy)]
pub struct Columns {
    pub steps: usize,
    pub columns: usize,
}

/// The maximum number of columns of a plot.
const MAX_COLUMNS: usize = 540;

impl Columns {
    pub fn for_steps(steps: usize) -> Self {
        Self { steps, columns: steps.clamp(1, MAX_COLUMNS) }
    }

    /// Returns the indices of the steps in a column.
    pub fn range(&self, column: usize) -> std::ops::Range<usize> {
        let at = |column: usize| {
            let index = column as u128 * self.steps as u128 / self.columns as u128;
            usize::try_from(index).unwrap_or(self.steps)
        };
        at(column)..at(column + 1)
    }

    /// Returns the horizontal position of a step, given its index.
    #[expect(clippy::cast_precision_loss, reason = "steps fit into 32 bits")]
    pub fn x(&self, index: usize) -> f64 {
        let steps = (self.steps.max(2) - 1) as f64;
        LEFT + (RIGHT - LEFT) * index as f64 / steps
    }
}

/// Returns at most six round steps for the labels of an axis from 1 to `last`.
pub fn ticks(last: usize) -> Vec<usize> {
    // The units are 1, 2, 5, 10, 20, 50 and so on.
    let units = (0..18).flat_map(|power| [1, 2, 5].map(|digit| digit * 10_usize.pow(power)));
    let unit = { units }.find(|unit| last / unit <= 5).unwrap_or(last.max(1));
    let mut ticks: Vec<usize> = (1..).map(|k| k * unit).take_while(|&tick| tick <= last).collect();
    if ticks.first() != Some(&1) && last >= 1 {
        ticks.insert(0, 1);
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_share_all_steps_out() {
        for steps in [1, 2, 7, 540, 541, 5000] {
            let columns = Columns::for_steps(steps);
            let all: Vec<usize> = (0..columns.columns).flat_map(|column| columns.range(column)).collect();
            assert_eq!(all, (0..steps).collect::<Vec<_>>(), "{steps}");
        }
    }

    #[test]
    fn ticks_are_few_and_round() {
        assert_eq!(ticks(3), [1, 2, 3]);
        assert_eq!(ticks(200), [1, 50, 100, 150, 200]);
        assert_eq!(ticks(800), [1, 200, 400, 600, 800]);
        assert!(ticks(0).is_empty() && ticks(4_000_000_000).len() <= 6);
    }
}
