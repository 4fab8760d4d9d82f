//! Vectors of the numeric core are nalgebra's, and code must not divide them: the original multiplies by the
//! reciprocal, which gives other bits. A lint can forbid the library's methods, but not an operator.
use crate::tree::{is_of_tests, name, root, sources, text};
use std::collections::BTreeSet;

/// The crates whose results must keep the same bits.
const CRATES: [&str; 4] = ["crates/num/", "crates/model/", "crates/judge/", "crates/student/src/"];

/// The one file that divides vectors.
const DIVIDES: &str = "crates/num/src/vector.rs";

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Returns the last word of a text.
fn last_word(text: &str) -> &str {
    let text = text.trim_end();
    &text[text.rfind(|c| !is_of_word(c)).map_or(0, |at| at + 1)..]
}

/// Returns the names of vectors in a source: parameters and fields of that type, and results of functions that return
/// vectors.
fn vectors(source: &str) -> BTreeSet<&str> {
    let typed = source.match_indices(": Vec2").map(|(at, _)| last_word(&source[..at]));
    let makes = |line: &&str| {
        let made = ["at(", "over(", "unit(", "Vec2::new(", ".normal("].iter().any(|maker| line.contains(maker));
        made && ![".dot(", "length(", ").x", ").y"].iter().any(|scalar| line.contains(scalar))
    };
    let bound = source.lines().filter(makes).filter_map(|line| line.split_once(" = ")).map(|(name, _)| last_word(name));
    typed.chain(bound).filter(|name| !name.is_empty()).collect()
}

/// Returns the lines that divide a vector.
fn divisions(source: &str) -> Vec<&str> {
    let vectors = vectors(source);
    let divides = |line: &&str| {
        let code = line.split("//").next().unwrap_or_default();
        let mut quotients = code.match_indices(" /").map(|(at, _)| code[..at].trim_end_matches(')'));
        quotients
            .any(|left| vectors.contains(last_word(left)) && !left.ends_with([')', ']']) && !left.contains(".dot("))
    };
    source.lines().filter(divides).collect()
}

#[test]
fn a_vector_that_is_divided_is_found() {
    let made = "fn f(v: Vec2, s: f64) {\n let d = at(q, 1) - at(q, 0);\n let l = length(d);\n";
    let source = format!("{made} v / s;\n (d - v) / s;\n l / s; // v / s\n d.x / s;\n}}");
    assert_eq!(divisions(&source), [" v / s;", " (d - v) / s;"]);
}

#[test]
fn nobody_divides_a_vector() {
    let mut seen = 0;
    for path in sources() {
        let name = name(&path);
        if CRATES.iter().any(|room| name.starts_with(room)) && !is_of_tests(name) && name != DIVIDES {
            let source = text(&path);
            let product = source.split("#[cfg(test)]").next().unwrap_or_default();
            seen += vectors(product).len();
            assert_eq!(divisions(product), Vec::<&str>::new(), "{name}: use `over` or `unit` of num::vector");
        }
    }
    assert!(seen > 100, "{seen} names of vectors below {}", root().display());
}
