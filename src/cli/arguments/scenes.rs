//! The arguments of the commands about scenes.
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

/// Lists the built-in scenes, one per line.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene list
  fosssim-oracle scene list 'Geometric*'")]
pub(in crate::cli) struct SceneListArguments {
    /// List only scenes with these names, such as 'GeometricTests/*'.
    #[arg(value_name = "GLOB")]
    pub(in crate::cli) patterns: Vec<String>,
    /// Print only names.
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
}

/// Prints the XML of a scene.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene show GeometricTests/ball-on-a-fixed-edge > scene.xml")]
pub(in crate::cli) struct SceneShowArguments {
    /// The scene's name, Group/name or asset:Group/name.
    #[arg(value_name = "SCENE")]
    pub(in crate::cli) name: String,
}

/// Writes scenes into a folder, as FOLDER/Group/name.xml.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle scene export --output scenes
  fosssim-oracle scene export 'HolisticTests/*' --output scenes

Existing files that differ are reported; --force overwrites them.")]
pub(in crate::cli) struct SceneExportArguments {
    /// Write only scenes with these names, such as 'GeometricTests/*'. By default all are written.
    #[arg(value_name = "GLOB")]
    pub(in crate::cli) patterns: Vec<String>,
    /// The folder, which is created if it does not exist.
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: PathBuf,
    /// Overwrite existing files whose contents differ.
    #[arg(long)]
    pub(in crate::cli) force: bool,
    /// Print only errors.
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
}
