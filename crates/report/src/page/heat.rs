//! The scenes of a submission as a row of colored cells, for tables of a class. Pages of the server contain the same
//! rows.
use std::fmt::Write;

/// Renders a row of cells from one letter per scene, with `|` between groups. The letters are `r` for accepted, `w` for
/// wrong, `e` for a scene without a trace that can be judged, and `n` for a scene that was not run.
pub(super) fn render_cells(letters: &str) -> String {
    let scenes = letters.replace('|', "");
    let label = format!("{} of {} scenes accepted", scenes.matches('r').count(), scenes.len());
    let mut svg = format!(
        "<svg viewBox=\"0 0 {} 1\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{label}\">",
        scenes.len().max(1)
    );
    for kind in ["w", "e", "n"] {
        let mut path = String::new();
        let mut index = 0;
        for run in scenes.as_bytes().chunk_by(|one, other| one == other) {
            if run[0] == kind.as_bytes()[0] {
                let _ = write!(path, "M{index} .5h{}", run.len());
            }
            index += run.len();
        }
        draw_scenes(&mut svg, kind, &path);
    }
    let borders = letters.match_indices('|').enumerate().map(|(before, (at, _))| format!("M{} 0v1", at - before));
    draw_scenes(&mut svg, "g", &borders.collect::<String>());
    svg + "</svg>"
}

/// Draws all cells of one state, or all borders between groups.
fn draw_scenes(svg: &mut String, kind: &str, path: &str) {
    if !path.is_empty() {
        let _ = write!(svg, "<path class=\"h-{kind}\" d=\"{path}\"/>");
    }
}
