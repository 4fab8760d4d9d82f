//! The command-line flags of the original.

/// A flag with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flag {
    pub(crate) letter: &'static str,
    pub(crate) name: &'static str,
    pub(crate) boolean: bool,
    pub(crate) required: bool,
    pub(crate) help: &'static str,
}

const fn flag(letter: &'static str, name: &'static str, boolean: bool, help: &'static str) -> Flag {
    Flag { letter, name, boolean, required: false, help }
}

/// The flags in the order of Theme 2's usage text.
pub(crate) const FLAGS: [Flag; 7] = [
    flag("m", "moviedir", false, "Folder for one SVG picture per step"),
    flag("i", "inputfile", false, "Binary trace to grade"),
    flag("o", "outputfile", false, "Binary trace to record"),
    flag("d", "display", true, "1 to simulate in a window, 0 without one"),
    flag("g", "generate", true, "1 to write a PNG picture per step, 0 not to"),
    flag("p", "paused", true, "1 to start paused, 0 to start running"),
    Flag { required: true, ..flag("s", "scene", false, "XML scene file to simulate") },
];

/// The indices of the flags in the order of Theme 1's usage text.
const THEME_1: [usize; FLAGS.len()] = [4, 0, 1, 2, 3, 5, 6];

/// Returns the flags in the order of the usage text of a program named `program`.
pub(crate) fn list_flags(program: &[u8]) -> impl Iterator<Item = &'static Flag> {
    let is_theme_1 = program.windows(NAME_1.len()).any(|part| part == NAME_1);
    (0..FLAGS.len()).map(move |index| &FLAGS[if is_theme_1 { THEME_1[index] } else { index }])
}

/// The prefix of the names of Theme 1's programs.
const NAME_1: &[u8] = b"FOSSSimOracleT1";
