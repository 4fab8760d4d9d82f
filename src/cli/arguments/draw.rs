//! The arguments of the commands that draw something or show details.
use super::values::parse_positive;
use crate::render::Size;
use clap::{Args, ValueEnum};
use std::{num::NonZeroU32, path::PathBuf};

/// The format of the pictures or the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum RenderFormat {
    /// SVG pictures: a folder of them, or one picture with --step.
    Svg,
    /// PNG pictures: a folder of them, or one picture with --step.
    Png,
    /// An animated GIF.
    Gif,
    /// A movie, if ffmpeg is installed.
    Mp4,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle render asset:HolisticTests/hourglass --output hourglass.gif
  fosssim-oracle render scenes/test00.xml --overlay submission.bin --output both.gif
  fosssim-oracle render scenes/test00.xml submission.bin --step 14 --output step14.svg
  fosssim-oracle render scenes/creative.xml --format png --output pngs --size 1280x720

Without a trace the reference's own run is drawn. Bodies have the scene's colors, and the scene's viewport is shown; \
without one the view shows the whole motion. A folder gets frame00001.png and so on, as the original's -g 1 writes \
them, or SVG files as its -m does. Films of more than 1500 pictures skip steps unless --every is given.")]
pub(in crate::cli) struct RenderArguments {
    /// The scene, a file or asset:Group/name.
    pub(in crate::cli) scene: PathBuf,
    /// The trace to draw, a file, - for standard input, or asset:Group/name.
    pub(in crate::cli) trace: Option<PathBuf>,
    /// A second trace, drawn on top in dashed outlines.
    #[arg(long, value_name = "TRACE")]
    pub(in crate::cli) overlay: Option<PathBuf>,
    /// The file or folder to write; the extension of a file's name selects the format.
    #[arg(short, long, value_name = "FILE or DIR")]
    pub(in crate::cli) output: PathBuf,
    /// The format of the output, if its name does not show it.
    #[arg(long, value_enum)]
    pub(in crate::cli) format: Option<RenderFormat>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "640x480")]
    pub(in crate::cli) size: Size,
    /// Pictures per second of a film.
    #[arg(long, value_name = "N", default_value_t = 25)]
    pub(in crate::cli) fps: u16,
    /// Draw only every Nth step.
    #[arg(long, value_name = "N", value_parser = parse_positive::<NonZeroU32>)]
    pub(in crate::cli) every: Option<NonZeroU32>,
    /// Draw one picture: the state after this step; 0 is the start.
    #[arg(long, value_name = "N", conflicts_with = "every")]
    pub(in crate::cli) step: Option<u32>,
    /// Leave out the step and the time in the lower left corner.
    #[arg(long)]
    pub(in crate::cli) no_label: bool,
}

/// The format of the report on a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum DetectFormat {
    /// Readable text.
    Text,
    /// One JSON object.
    Json,
    /// A plot as in figure 2 of the assignment: the polynomials, and the intervals in which one or all of them are
    /// positive.
    Svg,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle detect pe:3,1+4,1:5,9+2,6:5,3+5,8 --radii 1,1
  fosssim-oracle detect pe:1,4+1,4:2,1+3,5:6,2+3,7 --radii 1,2
  fosssim-oracle detect --scene scenes/test00.xml --step 14 --pair pe:3,1
  fosssim-oracle detect --scene scenes/test00.xml --trace submission.bin --step 14 --pair pe:3,1 --pass 2
  fosssim-oracle detect pe:3,1+4,1:5,9+2,6:5,3+5,8 --radii 1,1 --format svg --output figure.svg

The first two are the assignment's worked examples. Their overlap polynomials are

  -361 t^4 - 304 t^3 - 468 t^2 - 288 t
  -16 t^4 - 68 t^2 + 36 t - 16

A pair is one word: pp, pe or ph (particle with particle, edge, half-plane) and its points after colons: the \
particles' centers, the particle and the edge's two ends, or the particle, a point on the boundary and the normal. A \
moving point is X,Y+DX,DY (start and displacement) or X,Y..X,Y (start and end).")]
pub(in crate::cli) struct DetectArguments {
    /// The kind of pair (pp, pe, ph) and its points.
    #[arg(value_name = "KIND:POINTS")]
    pub(in crate::cli) word: Option<String>,
    /// The radii of the two objects; of a particle and a half-plane, the particle's.
    #[arg(long, value_name = "R,R", allow_hyphen_values = true)]
    pub(in crate::cli) radii: Option<String>,
    /// Use a pair of this scene instead.
    #[arg(long, value_name = "SCENE", requires = "step", requires = "pair", conflicts_with_all = ["word", "radii"])]
    pub(in crate::cli) scene: Option<PathBuf>,
    /// The trace with the states; by default the reference's run.
    #[arg(long, value_name = "TRACE", requires = "scene")]
    pub(in crate::cli) trace: Option<PathBuf>,
    /// The step, from 1.
    #[arg(long, value_name = "N", requires = "scene")]
    pub(in crate::cli) step: Option<u32>,
    /// The pair: pp:I,J, pe:I,J or ph:I,J with the indices of the scene.
    #[arg(long, value_name = "KIND:I,J", requires = "scene")]
    pub(in crate::cli) pair: Option<String>,
    /// The detection pass of the step, from 1.
    #[arg(long, value_name = "N", requires = "scene", default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) pass: u32,
    /// The format of the report.
    #[arg(long, value_enum, default_value_t = DetectFormat::Text)]
    pub(in crate::cli) format: DetectFormat,
    /// The file for the report, instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: Option<PathBuf>,
}
