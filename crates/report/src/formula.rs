//! Mathematical signs in formulas: `t^2: -x21.d21` becomes `t²: −x₂₁·Δx₂₁`. Sentences around formulas do
//! not change.

/// Returns a line whose formulas are written with Unicode's mathematical signs.
///
/// ```
/// let line = "t^2: -4 e h, with e = d21.x21.";
/// assert_eq!(fosssim_report::formula::to_mathematical_signs(line), "t²: −4 e h, with e = Δx₂₁·x₂₁.");
/// ```
pub fn to_mathematical_signs(line: &str) -> String {
    let mut text = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let done = &line[..line.len() - rest.len()];
        let word_end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
        let (sign, length) = match first {
            _ if word_end > 0 => (format_symbol(&rest[..word_end], &rest[word_end..]), word_end),
            '^' => parse_power(&rest[1..]).map_or(('^'.to_string(), 1), |(sign, length)| (sign, length + 1)),
            '<' | '>' if rest[1..].starts_with('=') => (if first == '<' { '≤' } else { '≥' }.to_string(), 2),
            '.' if is_between_factors(done, &rest[1..]) => ("·".to_owned(), 1),
            '-' if is_minus(done, &rest[1..]) => ("−".to_owned(), 1),
            other => (other.to_string(), other.len_utf8()),
        };
        text += &sign;
        rest = &rest[length..];
    }
    text
}

/// Writes a name in a formula with subscript digits and Greek letters.
fn format_symbol(name: &str, after: &str) -> String {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = &name[letters.len()..];
    let is_index = (1..=2).contains(&number.len());
    match letters {
        "alpha" if number.is_empty() => "α".to_owned(),
        "sqrt" if after.starts_with('(') => "√".to_owned(),
        "sum" if after.starts_with('(') => "Σ".to_owned(),
        "re" if number.is_empty() => "rₑ".to_owned(),
        "d" if number.len() == 2 => format!("Δx{}", shift_digits(number, '₀')),
        "dx" if number.is_empty() || is_index => format!("Δx{}", shift_digits(number, '₀')),
        _ if name.starts_with("dx_") => format!("Δ{}", &name[1..]),
        _ if letters.len() == 1 && letters != "_" && is_index => format!("{letters}{}", shift_digits(number, '₀')),
        _ => name.to_owned(),
    }
}

/// Replaces decimal digits by other digits of Unicode, of which `zero` is the first.
fn shift_digits(digits: &str, zero: char) -> String {
    digits.bytes().filter_map(|digit| char::from_u32(u32::from(zero) + u32::from(digit - b'0'))).collect()
}

/// Returns the superscript of the digits, or of the `T`, that follow a `^`, and the number of its characters. Returns
/// `None` if none follow.
fn parse_power(rest: &str) -> Option<(String, usize)> {
    let raise = |c| "⁰¹²³⁴⁵⁶⁷⁸⁹ᵀ".chars().nth("0123456789T".find(c)?);
    let raised: String = rest.chars().map_while(raise).collect();
    let length = raised.chars().count();
    (length > 0).then_some((raised, length))
}

/// Returns whether a sign is between two factors: the text before it ends with a short name or a parenthesis, and the
/// text after it begins with one. Names of functions or files and English words do not count.
fn is_between_factors(before: &str, behind: &str) -> bool {
    let is_name = |word: &str| word.len() <= 3 && word.starts_with(|c: char| c.is_ascii_alphabetic());
    let start = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
    let end = behind.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(behind.len());
    let is_called = end > 0 && behind[end..].starts_with('(');
    (before.ends_with(')') || is_name(&before[start..]))
        && (behind.starts_with('(') || is_name(&behind[..end]) && !is_called)
}

/// Returns whether a `-` between two texts is a minus sign, and not a hyphen.
fn is_minus(before: &str, behind: &str) -> bool {
    let is_first = before.is_empty() || before.ends_with([' ', '(', '=', '|']);
    let is_before_term = behind.starts_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '(' | '|'));
    is_first && (is_before_term || behind.starts_with(' ') && !before.is_empty()) || is_between_factors(before, behind)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_student::CATALOG;

    #[test]
    fn formulas_get_signs_and_sentences_stay() {
        for (line, expected) in [
            ("It is -x21.d21, not -2 x21.d21.", "It is −x₂₁·Δx₂₁, not −2 x₂₁·Δx₂₁."),
            ("r1^2 + re^2 is used instead of (r1 + re)^2.", "r₁² + rₑ² is used instead of (r₁ + rₑ)²."),
            ("b = (x1-x2).d32 + (dx1-dx2).x32", "b = (x₁−x₂)·Δx₃₂ + (Δx₁−Δx₂)·x₃₂"),
            ("0.05 <= alpha(t) <= 0.95 besides time <= 1.", "0.05 ≤ α(t) ≤ 0.95 besides time ≤ 1."),
            ("(I - n n^T) / sqrt(n.n)", "(I − n nᵀ) / √(n·n)"),
            ("1 + 1e-9: the particle-edge pair", "1 + 1e-9: the particle-edge pair"),
            ("collisions.empty() ends the loop.", "collisions.empty() ends the loop."),
            ("dx_cm / dt; dx = qe - qs", "Δx_cm / dt; Δx = qe − qs"),
        ] {
            assert_eq!(to_mathematical_signs(line), expected);
        }
    }

    /// Words of the assignment can still be found: only symbols change.
    #[test]
    fn every_exact_form_of_the_catalog_keeps_its_words() {
        let words = |line: &str| -> Vec<String> {
            let is_word = |word: &&str| word.len() > 3 && *word != "alpha" && *word != "sqrt";
            line.split(|c: char| !c.is_ascii_alphabetic()).filter(is_word).map(str::to_owned).collect()
        };
        for row in CATALOG {
            assert_eq!(words(&to_mathematical_signs(row.term)), words(row.term), "{}", row.id);
            assert!(!to_mathematical_signs(row.term).contains("^2"), "{}", row.id);
        }
    }
}
