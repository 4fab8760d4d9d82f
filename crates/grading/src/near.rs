//! Finds known words that are similar to a typed word.

/// The number of letters of a word that are compared.
const LONGEST: usize = 60;

/// Returns the word that was probably meant: at most a few slips away, or the same except for case and punctuation.
#[must_use]
pub fn closest<'c>(word: &str, candidates: impl Iterator<Item = &'c str>) -> Option<&'c str> {
    let typed = to_plain(word);
    let near = candidates.filter_map(|candidate| {
        let known = to_plain(candidate);
        let begins = typed.len() >= 3 && (known.starts_with(&typed) || typed.starts_with(&known));
        let swapped = sort_letters(&typed) == sort_letters(&known);
        let slips = if (begins || swapped) && known != typed { 1 } else { distance(&typed, &known) };
        (slips <= (typed.len().max(known.len()) / 3).min(2)).then_some((slips, candidate))
    });
    near.min_by_key(|(slips, _)| *slips).map(|(_, candidate)| candidate)
}

/// Returns the end of a message about a word that is not known: the known one that was probably meant, if one is near.
#[must_use]
pub fn meant<'c>(word: &str, candidates: impl Iterator<Item = &'c str>) -> String {
    closest(word, candidates).map(|name| format!("; did you mean {name}?")).unwrap_or_default()
}

/// Returns the names nearest to a typed word, at most `most` of them, the nearest first. A name is compared as a whole
/// and by its last part, because its group may be mistyped or left out.
#[must_use]
pub fn nearest<'c>(word: &str, names: impl Iterator<Item = &'c str>, most: usize) -> Vec<&'c str> {
    let last = |name: &str| to_plain(name.rsplit('/').next().unwrap_or_default());
    let (typed, typed_last) = (to_plain(word), last(word));
    let slips = |name: &str| {
        let (known, known_last) = (to_plain(name), last(name));
        // A name that holds the whole of it is as near as one slip.
        let holds = typed.len() >= 3 && known.windows(typed.len()).any(|part| part == typed);
        let of_last = or_beginning(&typed_last, &known_last);
        (if holds { 1 } else { of_last.min(or_beginning(&typed, &known)) }, of_last)
    };
    let mut near: Vec<_> = names.map(|name| (slips(name), name)).collect();
    // Stable: names that are as near stay in their order.
    near.sort_by_key(|(slips, _)| *slips);
    near.into_iter().take(most).map(|(_, name)| name).collect()
}

/// Returns the letters and digits of a word in lower case.
fn to_plain(text: &str) -> Vec<char> {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).take(LONGEST).collect()
}

fn sort_letters(letters: &[char]) -> Vec<char> {
    let mut letters = letters.to_vec();
    letters.sort_unstable();
    letters
}

/// Letters to insert, remove or replace.
fn distance(one: &[char], other: &[char]) -> usize {
    distances(one, other)[other.len()]
}

/// Returns the distance, or one more than the distance to a beginning of the other: long names are seldom typed to
/// their end.
fn or_beginning(one: &[char], other: &[char]) -> usize {
    let distances = distances(one, other);
    let of_beginnings = distances.iter().min().map_or(0, |least| least + 1);
    of_beginnings.min(distances[other.len()])
}

/// Letters to insert, remove or replace for each beginning of the other, from the empty one on.
fn distances(one: &[char], other: &[char]) -> Vec<usize> {
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (number, letter) in one.iter().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], number + 1);
        for (place, theirs) in other.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != theirs);
            diagonal = row[place + 1];
            row[place + 1] = replaced.min(diagonal + 1).min(row[place] + 1);
        }
    }
    row
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
            assert_eq!(nearest(typed, NAMES.into_iter(), 1), [meant], "{typed}");
        }
        assert_eq!(nearest("ImpulsesTests/bal", NAMES.into_iter(), 2).len(), 2);
    }
}
