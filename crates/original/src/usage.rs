//! Writes the original's usage, version and parse-error texts, with the line breaks of its argument library.
use crate::flags::{Flag, list_flags};

const WIDTH: usize = 75;
const TITLE: &str = "Forty One Sixty Seven Sim";

/// Returns the output of `--version`.
pub(crate) fn version_text(program: &[u8]) -> Vec<u8> {
    [b"\n", program, b"  version: none\n\n"].concat()
}

/// Returns the output of `--help`.
pub(crate) fn help_text(program: &[u8]) -> Vec<u8> {
    let mut text = b"\nUSAGE: \n\n".to_vec();
    text.extend(brief_usage(program));
    text.extend(b"\n\nWhere: \n\n");
    let mut entry = |names: &str, help: &str| {
        text.extend(wrap(names.as_bytes(), 3, 3));
        text.extend(wrap(help.as_bytes(), 5, 0));
        text.push(b'\n');
    };
    for flag in list_flags(program) {
        let value = format!(" <{}>", value_kind(flag));
        let required = if flag.required { "(required)  " } else { "" };
        entry(&format!("-{}{value},  --{}{value}", flag.letter, flag.name), &format!("{required}{}", flag.help));
    }
    entry("--,  --ignore_rest", "Ignores everything that follows.");
    entry("--version", "Displays version information and exits.");
    entry("-h,  --help", "Displays usage information and exits.");
    text.push(b'\n');
    text.extend(wrap(TITLE.as_bytes(), 3, 0));
    text.push(b'\n');
    text
}

/// Returns the output of a parse error. `argument` is a space if the error does not belong to an argument.
pub(crate) fn failure(program: &[u8], argument: &[u8], message: &[u8]) -> Vec<u8> {
    let mut text = [b"PARSE ERROR: ", argument, b"\n             ", message, b"\n\nBrief USAGE: \n"].concat();
    text.extend(brief_usage(program));
    text.extend([b"\nFor complete USAGE and HELP type: \n   ", program, b" --help\n\n"].concat());
    text
}

/// Returns the flags in one wrapped paragraph.
fn brief_usage(program: &[u8]) -> Vec<u8> {
    let mut line = [program, b" "].concat();
    for flag in list_flags(program) {
        let entry = format!("-{} <{}>", flag.letter, value_kind(flag));
        let entry = if flag.required { format!(" {entry}") } else { format!(" [{entry}]") };
        line.extend(entry.as_bytes());
    }
    line.extend(b" [--] [--version] [-h]");
    // Long program names do not push the following lines beyond the page.
    wrap(&line, 3, (program.len() + 2).min(WIDTH / 2))
}

const fn value_kind(flag: &Flag) -> &'static str {
    if flag.boolean { "boolean" } else { "string" }
}

/// Returns a text with breaks at spaces, commas and bars, so that lines have at most [`WIDTH`] columns. The first line
/// has `indent` leading spaces, the others `further` more. Words that do not fit are split at the end of the line.
fn wrap(text: &[u8], indent: usize, further: usize) -> Vec<u8> {
    let mut lines = Vec::new();
    let mut indent = indent;
    let mut allowed = WIDTH - indent;
    let mut rest = text;
    if rest.len() <= allowed {
        lines.extend(std::iter::repeat_n(b' ', indent));
        lines.extend([rest, b"\n"].concat());
        return lines;
    }
    let mut first = true;
    while !rest.is_empty() {
        let mut length = rest.len().min(allowed);
        if length == allowed {
            // The byte after the line counts as well, because a break there needs no shorter line. After the end there
            // is a NUL.
            let breaks = |at: usize| matches!(rest.get(at), Some(b' ' | b',' | b'|'));
            length = (0..=allowed).rev().find(|&at| breaks(at)).unwrap_or(0);
            if length == 0 {
                length = allowed;
            }
        }
        if let Some(newline) = rest[..length].iter().position(|&byte| byte == b'\n') {
            length = newline + 1;
        }
        lines.extend(std::iter::repeat_n(b' ', indent));
        lines.extend([&rest[..length], b"\n"].concat());
        if std::mem::take(&mut first) {
            indent += further;
            allowed -= further;
        }
        rest = &rest[length..];
        // No line starts with a space.
        let space_count = rest.iter().take_while(|&&byte| byte == b' ').count();
        rest = &rest[space_count..];
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> &str {
        std::str::from_utf8(bytes).unwrap()
    }

    #[test]
    fn the_brief_usage_hangs_below_the_programs_name() {
        let expected = "   ./FOSSSimOracle  [-m <string>] [-i <string>] [-o <string>] [-d\n\
            \x20                   <boolean>] [-g <boolean>] [-p <boolean>] -s <string>\n\
            \x20                   [--] [--version] [-h]\n";
        assert_eq!(text(&brief_usage(b"./FOSSSimOracle")), expected);
        assert!(
            text(&brief_usage(b"./FOSSSimOracleT1M2"))
                .starts_with("   ./FOSSSimOracleT1M2  [-g <boolean>] [-m <string>]")
        );
    }

    #[test]
    fn a_long_program_name_takes_half_the_width_at_most() {
        let program = b"/opt/course/with/a/long/path/to/the/program/FOSSSimOracleT2M2-linux-x86_64-release";
        let usage = brief_usage(program);
        let mut lines = text(&usage).lines();
        assert_eq!(lines.next().unwrap().len(), WIDTH);
        for line in lines {
            assert!(line.starts_with(&" ".repeat(3 + WIDTH / 2)) && line.len() <= WIDTH, "{line:?}");
        }
    }

    #[test]
    fn help_names_every_flag_and_closes_with_the_title() {
        let help = help_text(b"p");
        let help = text(&help);
        assert!(help.starts_with("\nUSAGE: \n\n   p  [-m <string>]"));
        assert!(help.contains("\n   -s <string>,  --scene <string>\n     (required)  XML scene file to simulate\n\n"));
        assert!(help.ends_with(
            "\n   -h,  --help\n     Displays usage information and exits.\n\n\n   Forty One Sixty Seven Sim\n\n"
        ));
        for flag in list_flags(b"p") {
            assert!(help.contains(&format!("--{} <", flag.name)), "{}", flag.name);
        }
    }
}
