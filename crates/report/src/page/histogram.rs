//! The histogram of a class's points. Pages of the server contain the same histogram.
use std::fmt::Write;

/// The number of bars in the histogram.
const BAR_COUNT: usize = 10;

/// The height of the highest bar, in pixels.
const MAX_BAR_HEIGHT: usize = 108;

/// Renders a histogram of the shares of points, which are between 0 and 1. Without shares, the result is empty.
pub(super) fn render_histogram(shares: impl Iterator<Item = f64>) -> String {
    let mut counts = [0_usize; BAR_COUNT];
    for share in shares.filter(|share| share.is_finite()) {
        // A share belongs to the last bar that begins at or below it, and a share of 1 to the last bar.
        let bar = (1..BAR_COUNT).filter(|&bar| share * BAR_COUNT as f64 >= bar as f64).count();
        counts[bar] += 1;
    }
    let largest_count = counts.into_iter().max().unwrap_or(0);
    if largest_count == 0 {
        return String::new();
    }
    let words = |(bar, count): (usize, &usize)| format!("{} to {} %: {count}", 10 * bar, 10 * (bar + 1));
    let words: Vec<String> = counts.iter().enumerate().map(words).collect();
    let mut svg = format!(
        "<svg class=\"fp\" viewBox=\"0 0 340 180\" width=\"340\" height=\"180\" role=\"img\" aria-label=\"Points of \
         the class: {}\"><title>Points of the class</title>\n<text class=\"ft\" x=\"10\" y=\"14\">those that ran, by \
         percent of all points</text>\n",
        words.join(", ")
    );
    for (bar, count) in counts.into_iter().enumerate() {
        let (left, height) = (10 + 31 * bar, MAX_BAR_HEIGHT * count / largest_count);
        if count > 0 {
            let _ = write!(
                svg,
                "<rect class=\"f1\" x=\"{}\" y=\"{}\" width=\"27\" height=\"{height}\"/><text x=\"{}\" y=\"{}\" \
                 text-anchor=\"middle\">{count}</text>",
                left + 2,
                152 - height,
                left + 15,
                147 - height
            );
        }
        let _ = writeln!(svg, "<text class=\"ft\" x=\"{left}\" y=\"170\" text-anchor=\"middle\">{}</text>", 10 * bar);
    }
    svg + "<text class=\"ft\" x=\"320\" y=\"170\" text-anchor=\"middle\">100</text><line class=\"ax\" x1=\"10\" \
           y1=\"152\" x2=\"320\" y2=\"152\"/></svg>"
}
