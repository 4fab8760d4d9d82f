//! Explains the letters of a formula, for lines that contain the formula.
use fosssim_model::sim::PairKind;

/// Returns a sentence that explains the names in `lines`: those of differences, of the sum of the radii, and of a
/// zone's motion. Returns `None` if the lines contain no such name. `R` is the sum of the radii in lines about
/// polynomials, and the rotation in lines about zones. `kinds` are the kinds of pairs that the lines are about, if they
/// are known.
pub(crate) fn explain_letters(lines: &[String], kinds: &[PairKind]) -> Option<String> {
    let example = lines.iter().find_map(|line| find_difference(line, |_| true));
    let all = |kind| !kinds.is_empty() && kinds.iter().all(|member| *member == kind);
    let is_edge = all(PairKind::ParticleEdge)
        || lines.iter().any(|line| find_difference(line, |number| number == '3').is_some() || line.contains("re^2"));
    let has_turn = lines.iter().any(|line| line.contains("x_cm"));
    let reach = !has_turn && lines.iter().any(|line| split_words(line).any(|word| word == "R"));
    let mut parts = Vec::new();
    if has_turn {
        parts.push("x_cm is the center of mass at the start of the step, dx_cm its displacement".to_owned());
        if lines.iter().any(|line| split_words(line).any(|word| word == "R")) {
            parts.push("R turns a vector by the zone's angle".to_owned());
        }
    }
    if let Some((kind, one, two)) = example {
        let (start, shift) = (format!("x{one}{two}"), format!("d{one}{two}"));
        let difference = if kind == 'x' { start } else { shift };
        let prefix = if kind == 'x' { "x" } else { "dx" };
        parts.push(format!("{difference} is {prefix}{one} - {prefix}{two}, and so on"));
        parts.push("x is a position at the start of the step, dx a displacement".to_owned());
    }
    if reach {
        parts.push(if all(PairKind::ParticleHalfPlane) {
            "R is the particle's radius".to_owned()
        } else if kinds.len() > 1 && !is_edge {
            let exception =
                if kinds.contains(&PairKind::ParticleHalfPlane) { ", with a half-plane r1 alone" } else { "" };
            format!("R is the sum of the radii, r1 + r2{exception}")
        } else {
            format!("R is r1 + {}", if is_edge { "re, the particle's and the edge's radius" } else { "r2" })
        });
    }
    if example.is_some() {
        let numbers = if is_edge {
            "1 is the particle, 2 and 3 are the edge's ends"
        } else {
            "1 is the first particle, 2 the second"
        };
        parts.push(numbers.to_owned());
    } else if lines.iter().any(|line| line.contains("(p-x)") || line.contains("dx.n")) {
        parts.push("x is the particle's position at the start of the step, dx its displacement".to_owned());
        parts.push("p and n are the half-plane's point and normal".to_owned());
    }
    (!parts.is_empty()).then(|| format!("Here {}.", parts.join("; ")))
}

/// Returns a line in which two radii have the names that fit the kind of pair: the radius of an edge is `re`.
pub(super) fn name_radii(line: &str, has_only_edge_pairs: bool) -> String {
    if has_only_edge_pairs { line.replace("r2", "re") } else { line.to_owned() }
}

/// Splits a line into words of letters and digits.
fn split_words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|letter: char| !letter.is_alphanumeric())
}

/// Returns the first name in a line such as `x21` or `d32`, of whose two digits one satisfies `has`. The result is the
/// letter and the two digits.
fn find_difference(line: &str, has: impl Fn(char) -> bool) -> Option<(char, char, char)> {
    split_words(line).find_map(|word| {
        let mut letters = word.chars();
        let name = (letters.next()?, letters.next()?, letters.next()?);
        let (kind, one, two) = name;
        let is_number = |letter: char| ('1'..='3').contains(&letter);
        let is_name = matches!(kind, 'x' | 'd') && is_number(one) && is_number(two) && letters.next().is_none();
        (is_name && (has(one) || has(two))).then_some(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explain_line(line: &str) -> Option<String> {
        explain_letters(&[line.to_owned()], &[])
    }

    #[test]
    fn radii_have_the_names_of_their_pair() {
        let line = "r1^2 + r2^2 is used instead of R^2 = (r1 + r2)^2";
        let of_kinds = |kinds: &[PairKind]| {
            let line = name_radii(line, kinds == [PairKind::ParticleEdge]);
            let told = explain_letters(std::slice::from_ref(&line), kinds).expect("it has short names");
            (line, told)
        };
        let (edge, told) = of_kinds(&[PairKind::ParticleEdge]);
        assert_eq!(edge, "r1^2 + re^2 is used instead of R^2 = (r1 + re)^2");
        assert!(told.contains("R is r1 + re"), "{told}");
        let (both, told) = of_kinds(&[PairKind::ParticleParticle, PairKind::ParticleEdge]);
        assert_eq!(both, line);
        assert!(told.contains("the sum of the radii"), "{told}");
        let (_, told) = of_kinds(&[PairKind::ParticleHalfPlane]);
        assert!(told.contains("R is the particle's radius"), "{told}");
    }

    #[test]
    fn short_names_are_explained() {
        let text = explain_line("-4 e h is missing, with e = d21.x21 and h = d32.x32.").expect("it has short names");
        assert!(text.starts_with("Here d21 is dx2 - dx1, and so on;") && text.contains("edge's ends"), "{text}");
        let text = explain_line("The coefficient of t is -x21.d21 instead of -2 x21.d21.").expect("it has short names");
        assert!(text.starts_with("Here x21 is x2 - x1,") && text.contains("first particle"), "{text}");
        let text = explain_line("R^2 i has the factor 2 instead of 1 (i = d32.d32)").expect("it has short names");
        assert!(text.contains("R is r1 + re") && text.contains("edge's ends"), "{text}");
        let text = explain_line("R^2 has the factor 1 instead of 0").expect("it has short names");
        assert_eq!(text, "Here R is r1 + r2.");
    }

    #[test]
    fn the_letter_r_is_the_rotation_where_zones_move() {
        let text = explain_line("dx_cm is missing in x_cm + dx_cm + R (xs - x_cm).").expect("it has short names");
        assert!(text.contains("R turns a vector by the zone's angle") && !text.contains("r1"), "{text}");
        let text = explain_line("sum(xs) / N is used instead of x_cm.").expect("it has short names");
        assert!(!text.contains("R "), "{text}");
        let failsafe = fosssim_student::CATALOG.iter().filter(|row| row.id.starts_with("failsafe-"));
        let false_ones: Vec<&str> = failsafe
            .filter(|row| explain_line(row.term).is_some_and(|text| text.contains("r1")))
            .map(|row| row.id)
            .collect();
        assert!(false_ones.is_empty(), "{false_ones:?}");
    }

    #[test]
    fn nothing_is_explained_where_nothing_needs_it() {
        assert_eq!(explain_line("dx2 is used instead of dx3."), None);
    }
}
