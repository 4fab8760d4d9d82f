//! What the letters of a formula mean, said where the formula stands.

/// The sentence that explains the short names of differences that occur in these lines; `None` where none does.
pub(super) fn of(lines: &[String]) -> Option<String> {
    let example = lines.iter().find_map(|line| difference(line))?;
    let ends = if lines.iter().any(|line| line.contains('3')) {
        "1 is the particle, 2 and 3 are the edge's ends"
    } else {
        "1 is the first particle, 2 the second"
    };
    let (kind, one, two) = example;
    let (start, shift) = (format!("x{one}{two}"), format!("d{one}{two}"));
    let told = if kind == 'x' { start } else { shift };
    let prefix = if kind == 'x' { "x" } else { "dx" };
    Some(format!(
        "Here {told} is {prefix}{one} - {prefix}{two}, and so on; x is a position at the start of the step, dx a displacement; {ends}."
    ))
}

/// The first name such as `x21` or `d32` in a line: its letter and its two numbers.
fn difference(line: &str) -> Option<(char, char, char)> {
    let letters: Vec<char> = line.chars().collect();
    letters.windows(3).enumerate().find_map(|(index, window)| {
        let [kind, one, two] = window else { return None };
        let begins = index == 0 || !letters[index - 1].is_alphanumeric();
        let ends = letters.get(index + 3).is_none_or(|next| !next.is_alphanumeric());
        let is_number = |letter: &char| ('1'..='3').contains(letter);
        (begins && ends && matches!(kind, 'x' | 'd') && is_number(one) && is_number(two)).then_some((*kind, *one, *two))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(line: &str) -> Option<String> {
        of(&[line.to_owned()])
    }

    #[test]
    fn short_names_are_explained() {
        let text = told("t^2 lacks -4 e h, with e = d21.x21 and h = d32.x32.").expect("it has short names");
        assert!(text.starts_with("Here d21 is dx2 - dx1, and so on;") && text.contains("edge's ends"), "{text}");
        let text = told("t: -x21.d21 stands where -2 x21.d21 belongs.").expect("it has short names");
        assert!(text.starts_with("Here x21 is x2 - x1,") && text.contains("first particle"), "{text}");
    }

    #[test]
    fn nothing_is_explained_where_nothing_needs_it() {
        assert_eq!(told("-(dx.n) t + ((p-x).n) lacks the factor (dx.n)."), None);
        assert_eq!(told("dx2 stands where dx3 belongs."), None);
    }
}
