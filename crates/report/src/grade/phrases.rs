//! The sentences about a grade that several formats have in common.
use crate::{number::counted, words};
use fosssim_findings::{Grade, GroupGrade, SceneGrade, Verdict};
use fosssim_mistakes::diagnose::Explanation;
pub use fosssim_mistakes::together::likely_mistakes;
use std::borrow::Cow;

/// A terminal's codes for colours, cursors and titles are left out, as a log of FOSSSim's own holds them in every line:
/// whole ones only, so that what is left of a broken one becomes visible.
#[must_use]
pub(crate) fn without_codes(text: &str) -> Cow<'_, str> {
    const ESCAPE: char = '\u{1b}';
    if !text.contains(ESCAPE) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(ESCAPE) {
        out.push_str(&rest[..at]);
        let code = &rest[at + 1..];
        match length_of_code(code) {
            Some(length) => rest = &code[length..],
            None => {
                out.push(ESCAPE);
                rest = code;
            }
        }
    }
    Cow::Owned(out + rest)
}

/// The bytes of the code that begins behind an escape character: `[32;1m`, or `]0;title` with its end. ECMA-48, 5.4 and
/// 5.6.
fn length_of_code(code: &str) -> Option<usize> {
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

/// The output of a program, [`plain`] and without a terminal's codes. Names keep them, or two could look alike.
#[must_use]
pub fn printed(text: &str) -> String {
    plain(&without_codes(text))
}

/// Marks that change the direction of the text could show a report's words in another order, and what has no width makes
/// two names look alike.
pub(crate) const fn is_unseen(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Somebody else's words without control characters: escape codes, bells and NULs become visible, line breaks and
/// tabs stay, characters that XML 1.0 forbids and those that nobody sees are replaced.
#[must_use]
pub fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => plain.push(c),
            '\r' => {}
            '\u{fffe}' | '\u{ffff}' => plain.push('\u{fffd}'),
            c if is_unseen(c) => plain.push('\u{fffd}'),
            c if c.is_control() => plain.push_str(&format!("\\x{:02x}", u32::from(c))),
            c => plain.push(c),
        }
    }
    plain
}

/// The text in place of a verdict where an entry is no submission.
pub(super) const NOT_GRADED: &str = "not graded";

/// The lines above all scenes in a report for one reader: what is wrong with the submission itself, or where it
/// fails and what its likely mistakes are.
#[must_use]
pub fn head_lines(grade: &Grade) -> Vec<String> {
    if let Some(unfit) = words::unfit(grade) {
        return vec![unfit];
    }
    let wrong = wrong_scenes(grade);
    let mut rank = "most likely mistake";
    let line = |(mistake, explained): (Explanation, usize)| {
        let what = words::explanation::what_or(&mistake);
        if mistake.is_not_finite() {
            return format!("{what} (in {explained} of {wrong})");
        }
        format!("{}: {what} (explains {explained} of {wrong})", std::mem::replace(&mut rank, "also likely"))
    };
    let located = grade.located.as_ref().map(words::located);
    located.into_iter().chain(likely_mistakes(grade).into_iter().map(line)).collect()
}

/// The number of scenes for which an explanation is looked for, with their noun.
pub(crate) fn wrong_scenes(grade: &Grade) -> String {
    let wrong = grade.scenes().filter(|scene| scene.verdict.is_wrong_trace());
    counted(wrong.count() as u64, "wrong scene")
}

/// The text for a scene whose reason is that of the whole submission.
pub(super) const fn see_above(scene: &SceneGrade) -> &'static str {
    match scene.result.verdict {
        Verdict::Unwritten => "see above",
        _ => "not run, see above",
    }
}

/// The scenes of some groups, those that are not accepted first.
pub(super) fn wrong_first<'a>(groups: impl Iterator<Item = &'a GroupGrade>) -> Vec<&'a SceneGrade> {
    let mut scenes: Vec<&SceneGrade> = groups.flat_map(|group| &group.scenes).collect();
    scenes.sort_by_key(|scene| scene.verdict.is_accepted());
    scenes
}

/// The sentence about a scene that the two rule books judge differently.
#[must_use]
pub fn difference(scene: &SceneGrade) -> Option<String> {
    scene.differs.map(|cause| {
        let verdicts = if cause.original_fails() {
            "the original fails it, the fair rules accept it"
        } else {
            "the original passes it, the fair rules reject it"
        };
        format!("the rule books differ: {verdicts}: {cause}")
    })
}

/// [`plain`] on one line.
#[must_use]
pub fn one_line(text: &str) -> String {
    plain(text).replace(['\n', '\t'], " ")
}

/// Points without needless digits: `12.5`, `10`.
#[must_use]
pub fn points(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Points that may be missing: where the grader failed or was stopped nobody has a zero.
#[must_use]
pub fn reached(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), points)
}

/// Why a grade has no points.
#[must_use]
pub fn no_points(grade: &Grade) -> Option<String> {
    if grade.points.is_some() {
        None
    } else if grade.is_our_fault() {
        Some("no points: the grader failed, which is not the submission's fault".to_owned())
    } else {
        let (missing, all) = (grade.count(Verdict::NotRun), grade.scenes().count());
        if missing == 0 {
            return Some("no points yet: the time of the program could not be measured".to_owned());
        }
        Some(format!("no points yet: {missing} of {} not run", counted(all as u64, "scene")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_become_visible() {
        assert_eq!(plain("a\u{1b}[31mb\0\u{7}\r\nc\td\u{202e}e"), "a\\x1b[31mb\\x00\\x07\nc\td\u{fffd}e");
        let log = "\u{1b}[32;1mOverall success: \u{1b}[31;1mFailed.\u{1b}[m";
        assert_eq!(printed(log), "Overall success: Failed.");
        assert_eq!(printed("\u{1b}]0;title\u{7}a\u{1b}]8;;x\u{1b}\\b"), "ab");
        assert_eq!(printed("a\u{1b}[31\u{1b}c\u{1b}"), "a\\x1b[31\\x1bc\\x1b", "what is no whole code is seen");
        for hidden in "\u{61c}\u{2069}\u{200b}\u{feff}\u{2028}\u{ad}\u{e0041}".chars() {
            assert_eq!(plain(&format!("a{hidden}b")), "a\u{fffd}b", "{hidden:?}");
        }
        assert_eq!(one_line("a\nb"), "a b");
        assert_eq!((points(10.0), points(2.5), points(0.0)), ("10".into(), "2.5".into(), "0".into()));
    }
}
