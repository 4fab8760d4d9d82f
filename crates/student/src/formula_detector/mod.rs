//! Checks whether a sentence uses only plain words, or contains a formula.
//!
//! The hint level `what` describes the fault to students and does not reveal the formula. Its sentences are written by
//! hand in many places; this check enforces the rule.

/// Names of polynomials in the assignment, which do not count as formulas.
const POLYNOMIAL_NAMES: [&str; 2] = ["alpha > 0", "alpha < 1"];

/// Returns the first part of a formula in a sentence. It is a number, an operator, a product with a dot, a function's
/// argument, or a letter of a quantity. Returns `None` if there are only words. The names `alpha > 0` and `alpha < 1`
/// do not count as formulas.
pub fn find_formula(sentence: &str) -> Option<String> {
    let text = POLYNOMIAL_NAMES.iter().fold(sentence.to_owned(), |text, name| text.replace(name, "alpha"));
    let letters: Vec<char> = text.chars().collect();
    let at = |index: Option<usize>| index.and_then(|index| letters.get(index)).copied().unwrap_or(' ');
    for (index, &letter) in letters.iter().enumerate() {
        let (before, after) = (at(index.checked_sub(1)), at(Some(index + 1)));
        let is_formula = match letter {
            '^' | '*' | '/' | '=' | '<' | '>' | '+' | '|' | '\u{b7}' | '\u{d7}' | '\u{b2}' => true,
            // A hyphen joins words.
            '-' => !(before.is_alphabetic() && after.is_alphabetic()),
            '.' => before.is_alphanumeric() && after.is_alphanumeric(),
            '(' => before.is_alphanumeric(),
            _ => letter.is_ascii_digit() && !belongs_to_step_number(&letters[..index]),
        };
        if is_formula {
            return Some(format!("{before}{letter}{after}"));
        }
    }
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '\'';
    text.split(|letter| !is_word(letter))
        .find(|word| word.chars().count() == 1 && !word.starts_with(is_plain_letter))
        .map(str::to_owned)
}

/// Returns whether a word of only this letter does not name a quantity. Digits are handled first.
const fn is_plain_letter(letter: char) -> bool {
    matches!(letter, 'a' | 'A' | '\'' | '0'..='9')
}

/// Returns whether a digit that follows these letters belongs to the number of a step, which is not a formula.
fn belongs_to_step_number(before: &[char]) -> bool {
    let number = before.iter().rev().take_while(|letter| letter.is_ascii_digit()).count();
    before[..before.len() - number].ends_with(&[' ', 's', 't', 'e', 'p', ' '])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_recognized() {
        for text in [
            "The t^2 coefficient lacks it.",
            "It has b c for it.",
            "A factor 2 is missing.",
            "r1 is missing.",
            "The n.n is missing.",
            "It is half of x * y.",
            "The sum a + b.",
            "The linear coefficient lacks -d.",
            "alpha > 1 is tested.",
            "0 <= alpha.",
            "The root of x.",
            "1/2 is taken.",
            "From step 60 on 2 is missing.",
            "A step of 2 is taken.",
            "x(t) is taken.",
        ] {
            assert!(find_formula(text).is_some(), "{text}");
        }
    }

    #[test]
    fn words_and_names_are_none() {
        for text in [
            "The alpha > 0 polynomial is wrong, as a half-plane's is.",
            "A particle-edge pair (or another one) is left out.",
            "Particle-edge: A product is missing.",
            "From step 60 on it is wrong.",
        ] {
            assert_eq!(find_formula(text), None, "{text}");
        }
    }
}
