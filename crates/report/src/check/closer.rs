//! Commands that look closer at the first thing that is wrong.
use super::{super::view::FindingView, Check, first};
use fosssim_judge::FindingDetail;
use fosssim_model::sim::PairKind;

/// The commands, ready to be typed; none where nothing is wrong, or where the trace came from standard input and is
/// gone.
pub(super) fn commands(check: &Check<'_>) -> Vec<String> {
    let Some(first) = first::first(check).filter(|_| check.trace != "-") else { return Vec::new() };
    let (scene, trace, step) = (quoted(check.scene), quoted(check.trace), first.step);
    let mut commands = Vec::new();
    let view = FindingView::from(first);
    let kind = view.pair.and_then(|pair| PairKind::ALL.into_iter().find(|kind| kind.name() == pair.kind));
    if let (Some(pair), Some(kind), 1..) = (view.pair, kind, step) {
        let pass = match first.detail {
            FindingDetail::PassPositions { place }
            | FindingDetail::TrimmedDecision { place, .. }
            | FindingDetail::TrimmedTime { place, .. }
            | FindingDetail::MixedForms { place } => place.pass.index,
            _ => view.polynomial.map_or(0, |polynomial| polynomial.pass.index),
        };
        let pass = match pass {
            0 => String::new(),
            index => format!(" --pass {}", index + 1),
        };
        let pair = format!("{}:{},{}", kind.short(), pair.first, pair.second);
        commands
            .push(format!("fosssim-oracle detect --scene {scene} --trace {trace} --step {step} --pair {pair}{pass}"));
    }
    commands.push(format!("fosssim-oracle trace show {scene} {trace} --step {step}"));
    if step > 0 {
        commands.push(format!("fosssim-oracle render {scene} {trace} --step {step} --output step{step}.svg"));
    }
    commands
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=,-".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_with_blanks_and_quotes_stay_one_word() {
        assert_eq!(quoted("scenes/test00.xml"), "scenes/test00.xml");
        assert_eq!(quoted("asset:Group/name"), "asset:Group/name");
        assert_eq!(quoted("my scene.xml"), "'my scene.xml'");
        assert_eq!(quoted("it's; rm"), "'it'\\''s; rm'");
        assert_eq!(quoted(""), "''");
    }
}
