//! The names that a scene may use, and suggestions for misspelt ones (scene-format.md 4, 5).
use super::{forces, rule::Rule};

const fn new_rule(name: &'static str, attributes: &'static [&'static str]) -> Rule {
    Rule { name, attributes }
}

/// Every element that a scene may have, except those of forces.
static ELEMENT_RULES: [Rule; 19] = [
    new_rule("simtype", &["type"]),
    new_rule("duration", &["time"]),
    new_rule("maxsimfreq", &["max"]),
    new_rule("viewport", &["cx", "cy", "size"]),
    new_rule("backgroundcolor", &["r", "g", "b"]),
    new_rule("description", &["text"]),
    new_rule("scenetag", &["tag"]),
    new_rule("integrator", &["type", "dt"]),
    new_rule("collision", &["type", "COR", "maxiters", "k", "thickness"]),
    new_rule("collisiondetection", &["type"]),
    new_rule("particle", &["px", "py", "vx", "vy", "m", "fixed", "radius", "tag"]),
    new_rule("edge", &["i", "j", "radius"]),
    new_rule("halfplane", &["px", "py", "nx", "ny"]),
    new_rule("particlecolor", &["i", "r", "g", "b"]),
    new_rule("edgecolor", &["i", "r", "g", "b"]),
    new_rule("halfplanecolor", &["i", "r", "g", "b"]),
    new_rule("particlepath", &["i", "duration", "r", "g", "b"]),
    // These elements are known only so that the rigid-body stub is rejected with a specific message.
    new_rule("rigidbody", &["p", "r"]),
    new_rule("rigidbodyvertex", &["x", "y", "m"]),
];

fn rules() -> impl Iterator<Item = &'static Rule> {
    ELEMENT_RULES.iter().chain(forces::RULES)
}

/// Returns the rule for the element `name`.
pub(super) fn rule(name: &str) -> Option<&'static Rule> {
    rules().find(|rule| rule.name == name)
}

/// Returns the known element whose name is most similar to `name`, or `None` if none is similar.
pub(super) fn similar_element(name: &str) -> Option<&'static str> {
    find_closest(name, rules().map(|rule| rule.name))
}

/// Names that many people write instead of a name of the format.
const COMMON_MISSPELLINGS: [(&str, &str); 8] = [
    ("mass", "m"),
    ("x", "px"),
    ("y", "py"),
    ("force", "constantforce"),
    ("gravity", "simplegravity"),
    ("spring", "springforce"),
    ("drag", "dragdamping"),
    ("vortex", "vortexforce"),
];

/// Returns the candidate that `word` probably means. It equals the word except for case and punctuation, is meant by a
/// common alternative name, begins with the word, or differs by a few typos (a third of the letters, at most two).
/// Returns `None` if no candidate does.
pub fn find_closest<'c>(word: &str, candidates: impl Iterator<Item = &'c str>) -> Option<&'c str> {
    const MAX_LETTERS: usize = 40;
    if word.len() > MAX_LETTERS {
        return None;
    }
    let plain = normalize_word(word);
    let habit = COMMON_MISSPELLINGS.iter().find(|(habit, _)| *habit == plain).map(|(_, name)| *name);
    candidates
        .filter(|candidate| candidate.len() <= MAX_LETTERS)
        .filter_map(|candidate| {
            let other = self::normalize_word(candidate);
            // The beginning of a name is as good as a name with one typo.
            let is_beginning = plain.len() >= 3 && other.starts_with(&plain);
            let distance = match habit {
                Some(name) if name == candidate => 0,
                _ if is_beginning && plain != other => 1,
                _ => strsim::osa_distance(&plain, &other),
            };
            let allowed = (plain.len().max(other.len()) / 3).min(2);
            (distance <= allowed).then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Returns the letters, in lower case, and the digits of a word.
fn normalize_word(word: &str) -> String {
    word.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_case_and_punctuation_are_seen_through() {
        for (written, meant) in [
            ("partcile", Some("particle")),
            ("Particle", Some("particle")),
            ("half-plane", Some("halfplane")),
            ("springForce", Some("springforce")),
            ("spring", Some("springforce")),
            ("durration", Some("duration")),
            ("pxarticle", Some("particle")),
            ("explicit", None),
            ("wall", None),
            ("", None),
        ] {
            assert_eq!(similar_element(written), meant, "{written}");
        }
    }

    #[test]
    fn short_names_are_not_guessed_wildly() {
        let particle = rule("particle").expect("known").attributes;
        let meant = |word| find_closest(word, particle.iter().copied());
        assert_eq!(meant("mass"), Some("m"));
        assert_eq!(meant("pX"), Some("px"));
        assert_eq!(meant("fx"), None);
        assert_eq!(meant("z"), None);
        assert_eq!(meant("raduis"), Some("radius"));
        assert_eq!(meant("rad"), Some("radius"));
    }
}
