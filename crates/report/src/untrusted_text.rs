//! Cleans untrusted text, such as names and programs' output. Control characters become visible, and invisible
//! characters are replaced. Each format then escapes the characters that have a meaning in its syntax.
use fosssim_findings::is_visible_ascii;
use std::borrow::Cow;

/// Removes the terminal codes for colors, cursors and titles, which every line of FOSSSim's log contains. Only complete
/// codes are removed, so that incomplete ones become visible.
pub(crate) fn remove_escape_codes(text: &str) -> Cow<'_, str> {
    const ESCAPE: char = '\u{1b}';
    if !text.contains(ESCAPE) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(ESCAPE) {
        out.push_str(&rest[..at]);
        let code = &rest[at + 1..];
        match escape_code_length(code) {
            Some(length) => rest = &code[length..],
            None => {
                out.push(ESCAPE);
                rest = code;
            }
        }
    }
    Cow::Owned(out + rest)
}

/// Returns the length in bytes of the code that follows an escape character, such as `[32;1m`, or `]0;title` and its
/// end (ECMA-48, 5.4 and 5.6). Returns `None` if the code is incomplete or of another kind.
fn escape_code_length(code: &str) -> Option<usize> {
    let bytes = code.as_bytes();
    match bytes.first()? {
        b'[' => {
            let end = 1 + bytes[1..].iter().position(|byte| !(0x20..=0x3f).contains(byte))?;
            (0x40..=0x7e).contains(&bytes[end]).then_some(end + 1)
        }
        b']' => {
            let end = 1 + bytes[1..].iter().position(|byte| *byte < 0x20)?;
            match &bytes[end..] {
                [0x07, ..] => Some(end + 1),
                [0x1b, b'\\', ..] => Some(end + 2),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Returns a program's output without terminal codes and without other control characters, as
/// [`strip_control_characters`] does. In names, codes are not removed, because two names could then look the same.
pub fn clean_output(text: &str) -> String {
    strip_control_characters(&remove_escape_codes(text))
}

/// Quotes an argument for a shell, if necessary.
pub fn quote(argument: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=,-".contains(c);
    match !argument.is_empty() && argument.chars().all(is_plain) {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    }
}

/// Returns whether a character is invisible: a direction mark, which could reorder a report, or a character without
/// width, which could make two names look alike.
pub(crate) const fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Returns untrusted text without control characters. Escape codes, bells and NULs are replaced by visible characters,
/// and so are invisible characters and characters that XML 1.0 forbids. Line breaks and tabs are kept.
pub fn strip_control_characters(text: &str) -> String {
    // Most texts are clean, and a class has tens of thousands of them.
    if is_visible_ascii(text) {
        return text.to_owned();
    }
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => plain.push(c),
            '\r' => {}
            '\u{fffe}' | '\u{ffff}' => plain.push('\u{fffd}'),
            c if is_invisible(c) => plain.push('\u{fffd}'),
            c if c.is_control() => plain.push_str(&format!("\\x{:02x}", u32::from(c))),
            c => plain.push(c),
        }
    }
    plain
}

/// Returns the text of [`strip_control_characters`] as a single line.
pub fn to_one_line(text: &str) -> String {
    strip_control_characters(text).replace(['\n', '\t'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_become_visible() {
        assert_eq!(
            strip_control_characters("a\u{1b}[31mb\0\u{7}\r\nc\td\u{202e}e"),
            "a\\x1b[31mb\\x00\\x07\nc\td\u{fffd}e"
        );
        let log = "\u{1b}[32;1mOverall success: \u{1b}[31;1mFailed.\u{1b}[m";
        assert_eq!(clean_output(log), "Overall success: Failed.");
        assert_eq!(clean_output("\u{1b}]0;title\u{7}a\u{1b}]8;;x\u{1b}\\b"), "ab");
        assert_eq!(clean_output("a\u{1b}[31\u{1b}c\u{1b}"), "a\\x1b[31\\x1bc\\x1b", "what is no whole code is seen");
        for hidden in "\u{61c}\u{2069}\u{200b}\u{feff}\u{2028}\u{ad}\u{e0041}".chars() {
            assert_eq!(strip_control_characters(&format!("a{hidden}b")), "a\u{fffd}b", "{hidden:?}");
        }
        assert_eq!(to_one_line("a\nb"), "a b");
        for c in (0..128_u8).map(char::from) {
            assert_eq!(
                strip_control_characters(&format!("a{c}b")) + "\u{e9}",
                strip_control_characters(&format!("a{c}b\u{e9}")),
                "{c:?}"
            );
        }
    }

    #[test]
    fn arguments_with_blanks_and_quotes_stay_one_argument() {
        assert_eq!(quote("scenes/test00.xml"), "scenes/test00.xml");
        assert_eq!(quote("asset:Group/name"), "asset:Group/name");
        assert_eq!(quote("my scene.xml"), "'my scene.xml'");
        assert_eq!(quote("it's; rm"), "'it'\\''s; rm'");
        assert_eq!(quote(""), "''");
    }
}
