//! Plots as SVG: residuals over the steps, detection passes per step, and detection polynomials on the step.
//!
//! Every plot has a title and a description, needs no script, and can be printed. Series differ by dash and marker as
//! well as by color. The colors follow the reader's light or dark scheme by CSS variables (`--plot-ink`, `--plot-1` and
//! so on override them), with plain attributes as a fallback without CSS.
mod curves;
mod passes;
mod residuals;
mod sheet;

pub use curves::{PlottedPolynomial, PolynomialPlot};
pub use passes::PassPlot;
pub use residuals::{ResidualPlot, Series};
pub use sheet::STEPS_AXIS;

/// The document for which a plot is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotTarget {
    /// A separate file, which contains its style.
    File,
    /// An HTML page that has [`STYLE`] in its own style sheet, once for all plots, so the page's policy need not allow
    /// styles in the markup.
    Page,
}

/// The style sheet of all plots.
pub const STYLE: &str = include!("style.in");
