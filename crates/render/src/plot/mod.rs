//! Plots as SVG: residuals over the steps, detection passes per step, detection polynomials on the step.
//!
//! Every plot has a title and a description in words, needs no script, and prints. Series differ by dash and marker,
//! not by color alone; the colors follow the reader's light or dark scheme by CSS variables (`--plot-ink`, `--plot-1`
//! and so on override them), with plain attributes as fallback where there is no CSS.
mod curves;
mod passes;
mod residuals;
mod sheet;

pub use curves::{PlottedPolynomial, PolynomialPlot};
pub use passes::PassPlot;
pub use residuals::{ResidualPlot, Series};
pub use sheet::STEPS_AXIS;

/// The document that a plot is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Embedding {
    /// A file of its own, which brings its style along.
    Alone,
    /// Into an HTML page that has [`STYLE`] in its own style sheet, once for all plots; so the page's policy need not
    /// allow styles in the markup.
    Inline,
}

/// The style sheet of all plots.
pub const STYLE: &str = include!("style.in");
