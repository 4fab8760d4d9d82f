//! A strip that shows every step as right, wrong by itself, or wrong as a consequence. The three kinds have different
//! heights, so that they can be distinguished without color.
use fosssim_evidence::{Step, StepClass};
use std::fmt::Write;

/// The width of the strip, in units of the drawing.
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 26.0;
/// The maximum number of columns. If there are more steps, several share a column, and the column shows the worst of
/// them.
const MAX_COLUMNS: usize = 480;

/// Renders the strip, and a text with the number of steps of each kind.
pub(super) fn render_strip(steps: &[Step]) -> String {
    let count = |class: StepClass| steps.iter().filter(|step| step.class == class).count();
    let summary = format!(
        "{} right, {} wrong by themselves, {} right but starting from a wrong state{}",
        count(StepClass::Right),
        count(StepClass::Wrong),
        count(StepClass::Inherited),
        match count(StepClass::Unknown) {
            0 => String::new(),
            unknown => format!(", {unknown} not judged"),
        }
    );
    let mut out = format!(
        "<p>{summary}.</p>\n<svg class=\"steps\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"All steps: \
         {summary}\" preserveAspectRatio=\"none\">"
    );
    let columns = steps.len().min(MAX_COLUMNS);
    let worst = |column: usize| {
        let range = column * steps.len() / columns..(column + 1) * steps.len() / columns;
        steps[range].iter().map(|step| step.class).max_by_key(|class| severity(*class)).unwrap_or(StepClass::Unknown)
    };
    let mut column = 0;
    while column < columns {
        let class = worst(column);
        let end = (column + 1..columns).find(|&next| worst(next) != class).unwrap_or(columns);
        let height = [3.0, 8.0, 14.0, 22.0][severity(class)];
        #[expect(clippy::cast_precision_loss, reason = "some columns")]
        let (left, width) = (WIDTH * column as f64 / columns as f64, WIDTH * (end - column) as f64 / columns as f64);
        let top = HEIGHT - 2.0 - height;
        let _ = write!(
            out,
            "<rect class=\"is-{}\" x=\"{left:.2}\" y=\"{top}\" width=\"{width:.2}\" height=\"{height}\"/>",
            class.letter()
        );
        column = end;
    }
    out + "</svg>\n"
}

const fn severity(class: StepClass) -> usize {
    match class {
        StepClass::Unknown => 0,
        StepClass::Right => 1,
        StepClass::Inherited => 2,
        StepClass::Wrong => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_shows_every_wrong_step_however_long_it_is() {
        let step = |class| Step { class, position: 0.0, velocity: 0.0, expected_passes: 1, actual_passes: Some(1) };
        let mut steps = vec![step(StepClass::Right); 100_000];
        steps[77_777] = step(StepClass::Wrong);
        let html = render_strip(&steps);
        assert!(html.len() < 1500 && html.matches("is-w").count() == 1, "{html}");
        assert!(html.contains("99999 right, 1 wrong by themselves, 0 right but"), "{html}");
        assert!(super::render_strip(&[]).contains("0 right"));
    }
}
