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

/// Where a plot goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Embedding {
    /// A file of its own, which brings its style along.
    Alone,
    /// Into an HTML page that has [`STYLE`] in its own style sheet, once for all plots; so the page's policy need not
    /// allow styles in the markup.
    Inline,
}

/// The style sheet of all plots.
pub const STYLE: &str = "\
.fp{--i:#1b1f24;--f:#5f6871;--g:#dfe3e8;--p:#fff;--b:#b3261e;--s1:#0063a6;--s2:#a34e00;--s3:#00694a;--s4:#84367c;\
font:12px system-ui,sans-serif;stroke-width:2}\
@media (prefers-color-scheme:dark){.fp{--i:#e6edf3;--f:#9aa4ae;--g:#30363d;--p:#0d1117;--b:#ff8a80;--s1:#66b8ff;\
--s2:#ffa657;--s3:#56d4a0;--s4:#e29bda}}\
@media print{.fp{--i:#000;--f:#444;--g:#ccc;--p:#fff;--b:#a00;--s1:#0063a6;--s2:#a34e00;--s3:#00694a;--s4:#84367c}}\
.fp path{fill:none;stroke-linejoin:round}.fp .pp{fill:var(--plot-paper,var(--p))}\
.fp text{fill:var(--plot-ink,var(--i))}.fp .ft{fill:var(--plot-faint,var(--f))}.fp .bt{fill:var(--plot-bad,var(--b))}\
.fp .ax{stroke:var(--plot-ink,var(--i))}.fp .gr{stroke:var(--plot-grid,var(--g))}\
.fp .bs{stroke:var(--plot-bad,var(--b))}.fp .bf{fill:var(--plot-bad,var(--b))}\
.fp .s1{stroke:var(--plot-1,var(--s1))}.fp .s2{stroke:var(--plot-2,var(--s2))}\
.fp .s3{stroke:var(--plot-3,var(--s3))}.fp .s4{stroke:var(--plot-4,var(--s4))}\
.fp .f1{fill:var(--plot-1,var(--s1))}.fp .f2{fill:var(--plot-2,var(--s2))}\
.fp .f3{fill:var(--plot-3,var(--s3))}.fp .f4{fill:var(--plot-4,var(--s4))}";
