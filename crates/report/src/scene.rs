//! The list of scenes, one line for each.
use super::{
    line_width,
    number::format_count,
    style::{Style, TextStyle},
};
use crate::untrusted_text::to_one_line;
use fosssim_model::scene::Scene;

/// Returns one line per scene: its name with `asset:`, its size, and the first sentence of its description.
pub fn list_scenes(scenes: &[(&str, Scene)], style: Style) -> String {
    let width = scenes.iter().map(|(name, _)| line_width::count_columns(name)).max().unwrap_or(0);
    let line = |(name, scene): &(&str, Scene)| {
        let blanks = " ".repeat(width - line_width::count_columns(name));
        let size = style.paint(TextStyle::Faint, &format!("({})", describe_size(scene)));
        let description =
            scene.description.as_deref().map(|text| to_one_line(first_sentence(text)) + " ").unwrap_or_default();
        format!("asset:{name}{blanks}  {description}{size}\n")
    };
    scenes.iter().map(line).collect()
}

/// Describes the size of a scene, such as `3 particles, 1 edge, 20 steps, for T1M2, T1M3`. Kinds of objects that the
/// scene does not contain are left out. The milestones are those whose programs can run the scene.
fn describe_size(scene: &Scene) -> String {
    let parts = [
        (scene.particles.len() as u64, "particle"),
        (scene.edges.len() as u64, "edge"),
        (scene.half_planes.len() as u64, "half-plane"),
        (scene.step_count().into(), "step"),
    ];
    let counts = parts.iter().filter(|(many, _)| *many > 0).map(|(many, noun)| format_count(*many, noun));
    let milestones = scene.assignments().map(|assignment| assignment.key().to_uppercase());
    let milestones = milestones.reduce(|list, milestone| list + ", " + &milestone).map(|all| format!("for {all}"));
    counts.chain(milestones).collect::<Vec<_>>().join(", ")
}

/// Returns the first sentence of a text.
fn first_sentence(text: &str) -> &str {
    let text = text.trim();
    text.match_indices(['.', ';', ':'])
        .find(|(at, _)| text[at + 1..].starts_with(' '))
        .map_or(text, |(at, _)| if text[at..].starts_with('.') { &text[..=at] } else { &text[..at] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sentence_ends_at_a_stop_before_a_blank() {
        assert_eq!(first_sentence("Two balls meet at t = 0.5. A wrong program misses."), "Two balls meet at t = 0.5.");
        assert_eq!(first_sentence("A cue ball breaks; cushions on four sides."), "A cue ball breaks");
        assert_eq!(first_sentence("one"), "one");
    }
}
