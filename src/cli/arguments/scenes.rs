//! Arguments of the commands about scenes, as typed.
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
#[command(after_help = "\
Example:
  fosssim-oracle scene show GeometricTests/ball-on-a-fixed-edge > scene.xml")]
pub(in crate::cli) enum SceneCommand {
    List(SceneListArguments),
    Show(SceneShowArguments),
    Export(SceneExportArguments),
}

/// Lists the scenes that come with the program, with a line on each.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene list
  fosssim-oracle scene list 'Geometric*'")]
pub(in crate::cli) struct SceneListArguments {
    /// Only scenes of these names, such as 'GeometricTests/*'.
    #[arg(value_name = "GLOB")]
    pub(in crate::cli) patterns: Vec<String>,
    /// Names only.
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
}

/// Prints a scene's XML.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene show GeometricTests/ball-on-a-fixed-edge > scene.xml")]
pub(in crate::cli) struct SceneShowArguments {
    /// The scene, Group/name or asset:Group/name.
    #[arg(value_name = "SCENE")]
    pub(in crate::cli) name: String,
}

/// Writes scenes as FOLDER/Group/name.xml.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene export --output scenes
  fosssim-oracle scene export 'HolisticTests/*' --output scenes

A file that holds something else is left alone and named, unless --force is given.")]
pub(in crate::cli) struct SceneExportArguments {
    /// Only scenes of these names, such as 'GeometricTests/*'. Without any, all of them.
    #[arg(value_name = "GLOB")]
    pub(in crate::cli) patterns: Vec<String>,
    /// The folder; it is made when there is none.
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: PathBuf,
    /// Replace files that hold something else.
    #[arg(long)]
    pub(in crate::cli) force: bool,
    /// Print errors only.
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
}
