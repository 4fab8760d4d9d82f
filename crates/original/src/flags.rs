//! The flags of the original.

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

/// The flags in the order in which the usage lists them.
pub(crate) const FLAGS: [Flag; 7] = [
    flag("m", "moviedir", false, "Folder for one SVG picture per step"),
    flag("i", "inputfile", false, "Binary trace to grade"),
    flag("o", "outputfile", false, "Binary trace to record"),
    flag("g", "generate", true, "1 to write a PNG picture per step, 0 not to"),
    flag("d", "display", true, "1 to simulate in a window, 0 without one"),
    flag("p", "paused", true, "1 to start paused, 0 to start running"),
    Flag { required: true, ..flag("s", "scene", false, "XML scene file to simulate") },
];
