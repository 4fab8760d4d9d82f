//! The original's command line (oracle-behavior.md 1): the parsed arguments, or the message and exit code of an error.
//!
//! Arguments are bytes, so file names need not be UTF-8. The rules are those of the original's argument library. A flag
//! and its value are separate arguments, the first invalid argument ends the program, and `--help` and `--version` take
//! effect in order.
use crate::{
    flags::{FLAGS, Flag},
    usage,
};
use std::{ffi::OsString, os::unix::ffi::OsStringExt};

/// The parsed arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Arguments {
    pub(crate) scene: OsString,
    pub(crate) output: Option<OsString>,
    pub(crate) input: Option<OsString>,
    pub(crate) display: bool,
    pub(crate) generate: bool,
    pub(crate) movie: Option<OsString>,
}

/// The output and the exit code of a command line that ends the program without a run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct EarlyExit {
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: Vec<u8>,
    pub(crate) exit_code: u8,
}

/// Parses the arguments after the program's name.
///
/// # Errors
/// Fails with a text to print and an exit code: help, version, or a parse error.
pub(crate) fn parse(program: &[u8], arguments: &[Vec<u8>]) -> Result<Arguments, EarlyExit> {
    let mut values: [Option<&[u8]>; FLAGS.len()] = [None; FLAGS.len()];
    let mut arguments = arguments.iter().map(Vec::as_slice);
    while let Some(argument) = arguments.next() {
        match argument {
            b"--" | b"--ignore_rest" => break,
            b"-h" | b"--help" => return Err(EarlyExit { stdout: usage::help_text(program), ..EarlyExit::default() }),
            b"--version" => return Err(EarlyExit { stdout: usage::version_text(program), ..EarlyExit::default() }),
            // The library treats these arguments as bundles of flags without any flag left.
            b"" | b"-" => continue,
            _ => {}
        }
        let Some(index) = FLAGS.iter().position(|flag| matches_flag(flag, argument)) else {
            return Err(wrong_argument_exit(program, argument, b"Couldn't find match for argument"));
        };
        let flag = &FLAGS[index];
        let title = format!("-{} (--{})", flag.letter, flag.name);
        if values[index].is_some() {
            return Err(wrong_argument_exit(program, title.as_bytes(), b"Argument already set!"));
        }
        let Some(value) = arguments.next() else {
            return Err(wrong_argument_exit(program, title.as_bytes(), b"Missing a value for this argument!"));
        };
        if flag.boolean
            && let Err(text) = parse_boolean(value)
        {
            return Err(wrong_argument_exit(program, title.as_bytes(), &text));
        }
        values[index] = Some(value);
    }
    let value = |letter: &str| FLAGS.iter().position(|flag| flag.letter == letter).and_then(|index| values[index]);
    let text = |letter: &str| value(letter).map(|bytes| OsString::from_vec(bytes.to_vec()));
    let switch = |letter: &str, default: Option<bool>| {
        value(letter).and_then(|bytes| parse_boolean(bytes).ok().flatten()).or(default).unwrap_or(false)
    };
    let Some(scene) = text("s") else {
        return Err(failure_exit(program, b" ", b"Required argument missing: scene"));
    };
    Ok(Arguments {
        scene,
        output: text("o"),
        input: text("i"),
        display: switch("d", Some(true)),
        generate: switch("g", None),
        movie: text("m"),
    })
}

fn matches_flag(flag: &Flag, argument: &[u8]) -> bool {
    match argument.strip_prefix(b"--") {
        Some(name) => name == flag.name.as_bytes(),
        None => argument.strip_prefix(b"-") == Some(flag.letter.as_bytes()),
    }
}

/// Returns a boolean as a C++ stream reads it: one integer that is 0 or 1. An empty value keeps the default.
fn parse_boolean(value: &[u8]) -> Result<Option<bool>, Vec<u8>> {
    let is_space = |byte: &u8| byte.is_ascii_whitespace() || *byte == 0x0b;
    let mut rest = value;
    let mut found = None;
    while !rest.is_empty() {
        let start = rest.iter().position(|byte| !is_space(byte)).unwrap_or(rest.len());
        let (negative, digits) = match &rest[start..] {
            [b'-', digits @ ..] => (true, digits),
            [b'+', digits @ ..] => (false, digits),
            digits => (false, digits),
        };
        let length = digits.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let significant = digits[..length].iter().skip_while(|&&byte| byte == b'0').collect::<Vec<_>>();
        let one = match significant[..] {
            [] => false,
            [b'1'] if !negative => true,
            _ => return Err(describe_unreadable(value)),
        };
        if length == 0 {
            return Err(describe_unreadable(value));
        }
        if found.is_some() {
            return Err([b"More than one valid value parsed from string '", value, b"'"].concat());
        }
        found = Some(one);
        rest = &digits[length..];
    }
    Ok(found)
}

fn describe_unreadable(value: &[u8]) -> Vec<u8> {
    [b"Couldn't read argument value from string '", value, b"'"].concat()
}

fn wrong_argument_exit(program: &[u8], argument: &[u8], text: &[u8]) -> EarlyExit {
    failure_exit(program, &[b"Argument: ", argument].concat(), text)
}

fn failure_exit(program: &[u8], argument: &[u8], text: &[u8]) -> EarlyExit {
    EarlyExit { stderr: usage::failure(program, argument, text), exit_code: 1, ..EarlyExit::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(arguments: &[&str]) -> Result<Arguments, EarlyExit> {
        let arguments: Vec<Vec<u8>> = arguments.iter().map(|argument| argument.as_bytes().to_vec()).collect();
        parse(b"./FOSSSimOracle", &arguments)
    }

    fn error(arguments: &[&str]) -> String {
        let ending = run(arguments).unwrap_err();
        assert_eq!((ending.exit_code, ending.stdout.is_empty()), (1, true));
        let text = String::from_utf8(ending.stderr).unwrap();
        assert!(text.ends_with("For complete USAGE and HELP type: \n   ./FOSSSimOracle --help\n\n"));
        text[..text.find("\n\nBrief USAGE: \n").unwrap()].to_owned()
    }

    #[test]
    fn flags_may_come_in_any_order_and_by_either_name() {
        let arguments = run(&["--inputfile", "t", "-d", "0", "--scene", "x.xml", "-p", " 01"]).unwrap();
        assert_eq!(arguments.scene, "x.xml");
        assert_eq!(arguments.input, Some("t".into()));
        assert_eq!((arguments.display, arguments.generate, arguments.output), (false, false, None));
        assert!(run(&["-s", "-d"]).unwrap().display, "a value may look like a flag, and the window is the default");
    }

    #[test]
    fn arguments_after_the_double_hyphen_are_ignored() {
        assert_eq!(run(&["-s", "a", "--", "-s", "nonsense"]).unwrap().scene, "a");
        assert!(error(&["--ignore_rest", "-s", "a"]).contains("Required argument missing: scene"));
    }

    #[test]
    fn parse_errors_have_the_originals_texts() {
        assert_eq!(error(&[]), "PARSE ERROR:  \n             Required argument missing: scene");
        assert_eq!(error(&["-sx"]), "PARSE ERROR: Argument: -sx\n             Couldn't find match for argument");
        assert_eq!(
            error(&["--scene=x"]),
            "PARSE ERROR: Argument: --scene=x\n             Couldn't find match for argument"
        );
        assert_eq!(
            error(&["-s"]),
            "PARSE ERROR: Argument: -s (--scene)\n             Missing a value for this argument!"
        );
        assert_eq!(
            error(&["--scene", "a", "-s", "b"]),
            "PARSE ERROR: Argument: -s (--scene)\n             Argument already set!"
        );
        for value in ["2", "-1", "true", "1x", " "] {
            assert_eq!(
                error(&["-d", value]),
                format!(
                    "PARSE ERROR: Argument: -d (--display)\n             \
                     Couldn't read argument value from string '{value}'"
                )
            );
        }
        assert!(error(&["-g", "1 0"]).ends_with("More than one valid value parsed from string '1 0'"));
    }

    #[test]
    fn help_and_version_win_only_over_what_follows() {
        let ending = run(&["--version", "nonsense"]).unwrap_err();
        assert_eq!(ending.stdout, b"\n./FOSSSimOracle  version: none\n\n");
        assert_eq!(ending.exit_code, 0);
        assert!(error(&["nonsense", "-h"]).contains("Couldn't find match"));
    }

    #[test]
    fn an_empty_boolean_leaves_the_default() {
        assert!(run(&["-s", "a", "-d", ""]).unwrap().display);
        assert!(!run(&["-s", "a", "-g", ""]).unwrap().generate);
    }
}
