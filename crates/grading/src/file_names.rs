//! Converts file names to text that hides nothing. Different names look different, and no name changes the text around
//! it.
use std::{ffi::OsStr, os::unix::ffi::OsStrExt};
use unicode_normalization::UnicodeNormalization;
use unicode_properties::{GeneralCategory, UnicodeGeneralCategory};

/// The maximum number of combining marks on one letter that are kept. More marks would cover the surrounding text.
const MAX_MARKS: usize = 4;

/// Returns a file's name as text. Letters with marks have their usual form (NFC). Escapes replace what is invisible or
/// ambiguous: bytes that are not text (`\xff`), control and format characters (`\r`, `\u{200b}`), blanks other than
/// single ones between letters, and the backslash itself. Names with different bytes therefore look different, except
/// for letters with marks that are written in two ways ([`to_exact`]).
pub fn to_printable(name: &OsStr) -> String {
    map_chunks(name, |valid| escape(&valid.nfc().collect::<String>(), |_| false))
}

/// Returns a file's name as [`to_printable`] does, but with escapes instead of combining marks. The results for
/// different names then always differ.
pub fn to_exact(name: &OsStr) -> String {
    // Marks, parts of syllables, and characters that NFC would replace are escaped, so no two names become equal.
    map_chunks(name, |valid| escape(valid, |c| is_mark(c) || continues_syllable(c) || !c.nfc().eq([c])))
}

fn map_chunks(name: &OsStr, text: impl Fn(&str) -> String) -> String {
    let mut printable = String::new();
    for chunk in name.as_bytes().utf8_chunks() {
        printable += &text(chunk.valid());
        for byte in chunk.invalid() {
            printable.push_str(&format!("\\x{byte:02x}"));
        }
    }
    printable
}

fn escape(text: &str, besides: impl Fn(char) -> bool) -> String {
    let mut escaped = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    let (mut before, mut marks) = (None, 0);
    while let Some(c) = rest.next() {
        marks = if is_mark(c) { marks + 1 } else { 0 };
        let blank = c == ' ' && (matches!(before, None | Some(' ')) || rest.peek().is_none());
        let stray = is_mark(c) && (before.is_none() || marks > MAX_MARKS);
        match c {
            '\\' => escaped.push_str("\\\\"),
            '\n' | '\r' | '\t' => escaped.extend(c.escape_debug()),
            c if blank || stray || is_hidden(c) || besides(c) => escaped.extend(c.escape_unicode()),
            c => escaped.push(c),
        }
        before = Some(c);
    }
    escaped
}

fn is_mark(c: char) -> bool {
    matches!(c.general_category(), GeneralCategory::NonspacingMark | GeneralCategory::EnclosingMark)
}

/// Returns whether a Hangul letter is joined to the letter before it.
const fn continues_syllable(c: char) -> bool {
    matches!(c, '\u{1161}'..='\u{11ff}')
}

/// Returns whether a character is invisible, or looks different on each machine.
fn is_hidden(c: char) -> bool {
    use GeneralCategory::{
        Control, Format, LineSeparator, ParagraphSeparator, PrivateUse, SpaceSeparator, Surrogate, Unassigned,
    };
    let category = c.general_category();
    let is_nothing =
        matches!(category, Control | Format | LineSeparator | ParagraphSeparator | PrivateUse | Surrogate | Unassigned);
    is_nothing
        || (category == SpaceSeparator && c != ' ')
        // Some letters, marks and symbols are practically invisible: fillers, variation selectors, and the empty
        // Braille cell.
        || matches!(
            c,
            '\u{34f}'
                | '\u{115f}'
                | '\u{1160}'
                | '\u{17b4}'
                | '\u{17b5}'
                | '\u{180b}'..='\u{180f}'
                | '\u{2800}'
                | '\u{3164}'
                | '\u{fe00}'..='\u{fe0f}'
                | '\u{ffa0}'
                | '\u{e0100}'..='\u{e01ef}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn names_of_people_are_unchanged() {
        let names = ["Zoë", "Nguyễn Văn A", "שלמה", "محمد", "कुमार", "山田太郎", "ﾀﾛｳ"];
        for name in names.into_iter().chain(["alice", "O'Brien-Łoś", "a,b", "=cmd"]) {
            assert_eq!(to_printable(OsStr::new(name)), name);
        }
        assert_eq!(to_printable(OsStr::new("Zoe\u{308}")), "Zo\u{eb}");
    }

    #[test]
    fn no_two_names_look_the_same() {
        let names: [&[u8]; 44] = [
            b"alice",
            b"alice\r",
            b"alice\\r",
            b"alice ",
            b" alice",
            b"alice\t",
            b"alice\\t",
            b"al ice",
            b"al  ice",
            b"al\tice",
            b"al\nice",
            b"alice\x00",
            b"alice\xff",
            b"alice\xfe",
            b"alice\\xff",
            b"alice\x1b[31m",
            b"alice\\u{200b}",
            b"\\",
            b"\\\\",
            b"..",
            b"con",
            b"con.",
            "alice\u{200b}".as_bytes(),
            "alice\u{202e}".as_bytes(),
            "alice\u{3164}".as_bytes(),
            "alice\u{fe0f}".as_bytes(),
            "alice\u{e0100}".as_bytes(),
            "alice\u{2800}".as_bytes(),
            "al\u{a0}ice".as_bytes(),
            "al\u{3000}ice".as_bytes(),
            "al\u{2009}ice".as_bytes(),
            "al\u{200d}ice".as_bytes(),
            "alice\u{ad}".as_bytes(),
            "alice\u{feff}".as_bytes(),
            "alice\u{e0041}".as_bytes(),
            "alice\u{e000}".as_bytes(),
            "alice\u{378}".as_bytes(),
            "\u{301}alice".as_bytes(),
            "alice\u{115f}".as_bytes(),
            "alice\u{61c}".as_bytes(),
            "alice\u{2028}".as_bytes(),
            "alice\u{85}".as_bytes(),
            "alice\u{2066}".as_bytes(),
            "alice\u{7f}".as_bytes(),
        ];
        let mut seen = BTreeMap::new();
        for name in names {
            let text = to_printable(OsStr::from_bytes(name));
            assert!(!text.chars().any(|c| is_hidden(c) || c.is_control()), "{text:?}");
            assert!(!text.starts_with(' ') && !text.ends_with(' ') && !text.contains("  "), "{text:?}");
            if let Some(other) = seen.insert(text.clone(), name) {
                panic!("{name:?} and {other:?} are both {text}");
            }
        }
        assert_eq!(to_printable(OsStr::new("alice\r")), "alice\\r");
        assert_eq!(to_printable(OsStr::new("bob\u{200b}")), "bob\\u{200b}");
    }

    #[test]
    fn two_ways_to_write_a_letter_have_two_exact_names() {
        let of = |text: &str| (to_printable(OsStr::new(text)), to_exact(OsStr::new(text)));
        let (one, two, sign) = (of("\u{e5}"), of("a\u{30a}"), of("\u{212b}"));
        assert_eq!((&one.0, &two.0, sign.0.as_str()), (&"å".to_owned(), &"å".to_owned(), "Å"));
        assert_eq!((one.1.as_str(), two.1.as_str(), sign.1.as_str()), ("å", "a\\u{30a}", "\\u{212b}"));
    }

    #[test]
    fn a_heap_of_marks_covers_nothing() {
        let heap = to_printable(OsStr::new(&format!("a{}", "\u{316}".repeat(100))));
        assert_eq!(heap.chars().filter(|c| is_mark(*c)).count(), MAX_MARKS);
    }
}
