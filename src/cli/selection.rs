//! Selects scenes by name, for `grade --scene` and `scene list`.
use crate::suite::{library, suggestions};
use anyhow::{Context, Result, bail};
use glob::Pattern;

/// Patterns for the names of scenes. An empty list selects all scenes.
#[derive(Debug, Default)]
pub(super) struct Selection {
    patterns: Vec<Pattern>,
}

impl Selection {
    /// Creates a selection of some of these names.
    ///
    /// # Errors
    ///
    /// Fails if a pattern is invalid or matches no name.
    pub(super) fn new(texts: &[String], names: &[&str]) -> Result<Self> {
        let mut patterns = Vec::new();
        for text in texts {
            let bare = text.strip_prefix("asset:").unwrap_or(text);
            let bare = bare.strip_suffix(".xml").unwrap_or(bare);
            let pattern = Pattern::new(bare).with_context(|| format!("the pattern {text}"))?;
            if !names.iter().any(|name| matches_pattern(&pattern, name)) {
                bail!("{text} matches no scene; the scenes are {}", nearest_names(bare, names));
            }
            patterns.push(pattern);
        }
        Ok(Self { patterns })
    }

    /// Returns whether a scene is selected.
    pub(super) fn selects(&self, name: &str) -> bool {
        self.patterns.is_empty() || self.patterns.iter().any(|pattern| matches_pattern(pattern, name))
    }
}

/// Returns whether a pattern matches a name. It is compared with the full name (as in [`library::matches_pattern`]),
/// and with the name without its group.
fn matches_pattern(pattern: &Pattern, name: &str) -> bool {
    library::matches_pattern(pattern, name) || name.rsplit('/').next().is_some_and(|last| pattern.matches(last))
}

/// The maximum number of names that a message gives as examples.
const MAX_EXAMPLES: usize = 3;

/// Returns a list, for a message, of the names that are most similar to a typed one.
fn nearest_names(typed: &str, names: &[&str]) -> String {
    let examples = suggestions::find_nearest(typed, names.iter().copied(), MAX_EXAMPLES).join(", ");
    if names.len() > MAX_EXAMPLES { format!("{examples} and {} more", names.len() - MAX_EXAMPLES) } else { examples }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 4] = ["Geometric/ball-on-edge", "Geometric/chain", "Impulses/ball", "Impulses/rope-bridge"];

    fn selected(texts: &[&str]) -> Vec<&'static str> {
        let texts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
        let selection = Selection::new(&texts, &NAMES).expect("a selection");
        NAMES.into_iter().filter(|name| selection.selects(name)).collect()
    }

    #[test]
    fn names_are_matched_whole_or_behind_their_group() {
        assert_eq!(selected(&[]), NAMES);
        assert_eq!(selected(&["Geometric/*"]), NAMES[..2]);
        assert_eq!(selected(&["Geo*"]), NAMES[..2]);
        assert_eq!(selected(&["ball*", "chain"]), NAMES[..3]);
        assert_eq!(selected(&["asset:Impulses/ball"]), ["Impulses/ball"]);
        assert_eq!(selected(&["rope-bridge.xml"]), ["Impulses/rope-bridge"]);
    }

    #[test]
    fn a_pattern_without_a_scene_is_an_error_that_helps() {
        let error = |word: &str| Selection::new(&[word.to_owned()], &NAMES).expect_err("none").to_string();
        assert_eq!(
            error("Impulses/rope"),
            "Impulses/rope matches no scene; the scenes are \
             Impulses/rope-bridge, Impulses/ball, Geometric/ball-on-edge and 1 \
             more"
        );
        assert!(error("[").contains("pattern"), "{}", error("["));
    }
}
