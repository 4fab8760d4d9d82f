//! Commands that show more of the first thing that is wrong.
use super::{Check, first};
use crate::describe::pair_key;

/// Returns the commands, ready to be typed. There are none if the trace is right, or came from standard input and can't
/// be read again.
pub(super) fn commands(check: &Check<'_>) -> Vec<String> {
    let Some(first) = first::first(check).filter(|_| check.trace != "-") else { return Vec::new() };
    let (scene, trace, step) = (quote(check.scene), quote(check.trace), first.step);
    let mut commands = Vec::new();
    if let (Some(pair), 1..) = (first.detail.pair().map(pair_key), step) {
        let pass = match first.detail.pass().map_or(0, |pass| pass.index) {
            0 => String::new(),
            index => format!(" --pass {}", index + 1),
        };
        commands
            .push(format!("fosssim-oracle detect --scene {scene} --trace {trace} --step {step} --pair {pair}{pass}"));
    }
    commands.push(format!("fosssim-oracle trace show {scene} {trace} --step {step}"));
    if step > 0 {
        commands.push(format!("fosssim-oracle render {scene} {trace} --step {step} --output step{step}.svg"));
    }
    commands
}

/// Returns a word as a shell takes it.
fn quote(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=,-".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quote;

    #[test]
    fn words_with_blanks_and_quotes_stay_one_word() {
        assert_eq!(quote("scenes/test00.xml"), "scenes/test00.xml");
        assert_eq!(quote("asset:Group/name"), "asset:Group/name");
        assert_eq!(quote("my scene.xml"), "'my scene.xml'");
        assert_eq!(quote("it's; rm"), "'it'\\''s; rm'");
        assert_eq!(quote(""), "''");
    }
}
