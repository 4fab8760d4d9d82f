//! Defines the original's messages on standard error, and its colors, which are part of the text even in files and
//! pipes.

/// The escape sequence that ends every color.
pub(crate) const RESET: &str = "\x1b[m";
pub(crate) const RED: &str = "\x1b[31;1m";
pub(crate) const GREEN: &str = "\x1b[32;1m";
pub(crate) const BLUE: &str = "\x1b[34;1m";
pub(crate) const PINK: &str = "\x1b[35;1m";

/// Returns the line on standard error for a file, the `input` or the `output`, that cannot be opened
/// (oracle-behavior.md 2).
pub(crate) fn open_failure(which: &str, name: &[u8]) -> Vec<u8> {
    let start = format!("{RED}ERROR IN INITIALIZATION: {RESET}Failed to open binary {which} file:  `");
    [start.as_bytes(), name, b"`   Exiting.\n"].concat()
}

/// The line on standard error for a vortex force with an implicit integrator (scene-format.md 6).
pub(crate) const NO_VORTEX_HESSIAN: &str =
    "\x1b[31;1mERROR IN VORTEXFORCE: \x1b[mNo addHessXToTotal defined for VortexForce.\n";

/// The line on standard error for a missing folder for pictures (oracle-behavior.md 1).
pub const NO_PICTURE_FOLDER: &str = "Failure writing SVG file!\n";

/// The line on standard error for a run that would grade and record a trace (oracle-behavior.md 1).
pub(crate) const INPUT_AND_OUTPUT: &str = "error: arguments i and o -- arguments i and o specified simultaneously\n";
