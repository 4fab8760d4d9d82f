//! Finds known words that are similar to a word that a user typed.

pub use fosssim_model::scene::find_closest;
use strsim::jaro_winkler;

/// The maximum number of letters and digits that are compared.
const MAX_COMPARED_LETTERS: usize = 60;

/// Returns the end of a message about an unknown word. If a known word is similar, the text suggests it.
pub fn suggest<'c>(word: &str, candidates: impl Iterator<Item = &'c str>) -> String {
    find_closest(word, candidates).map(|name| format!("; did you mean {name}?")).unwrap_or_default()
}

/// Returns the names that are most similar to a typed word, the most similar first, and at most `max_names`. Both the
/// whole name and its last part are compared, because the group may be mistyped or missing.
pub fn find_nearest<'c>(word: &str, names: impl Iterator<Item = &'c str>, max_names: usize) -> Vec<&'c str> {
    let last = |name: &str| normalize_word(name.rsplit('/').next().unwrap_or_default());
    let (typed, typed_last) = (normalize_word(word), last(word));
    let likeness = |name: &str| jaro_winkler(&typed, &normalize_word(name)).max(jaro_winkler(&typed_last, &last(name)));
    let mut scored_names: Vec<(f64, &str)> = names.map(|name| (likeness(name), name)).collect();
    // The sort is stable, so names that are equally similar keep their order.
    scored_names.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    scored_names.into_iter().take(max_names).map(|(_, name)| name).collect()
}

/// Returns the letters and digits of a text, in lower case.
fn normalize_word(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).take(MAX_COMPARED_LETTERS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 5] = [
        "ContinuousTimeTests/barely-closing",
        "GeometricTests/ball-between-walls",
        "GeometricTests/chain",
        "ImpulsesTests/ball",
        "ImpulsesTests/rope-bridge",
    ];

    #[test]
    fn slips_of_the_pen_find_the_name_that_was_meant() {
        for (typed, meant) in [
            ("GeometricTests/chian", "GeometricTests/chain"),
            ("chain", "GeometricTests/chain"),
            ("ImpulseTests/rope-brigde", "ImpulsesTests/rope-bridge"),
            ("GeometricTests/rope-bridge", "ImpulsesTests/rope-bridge"),
            ("bridge", "ImpulsesTests/rope-bridge"),
            ("ball-betwen-walls", "GeometricTests/ball-between-walls"),
            ("ball-bewteen", "GeometricTests/ball-between-walls"),
            ("ContinousTimeTests/barley", "ContinuousTimeTests/barely-closing"),
        ] {
            assert_eq!(find_nearest(typed, NAMES.into_iter(), 1), [meant], "{typed}");
        }
        assert_eq!(find_nearest("ImpulsesTests/bal", NAMES.into_iter(), 2).len(), 2);
    }
}
