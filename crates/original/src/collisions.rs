//! The original's messages about collisions that do not match (oracle-behavior.md 6.1).
use fosssim_judge::replay::Remark;
use fosssim_model::trace::LoggedImpulse;
use fosssim_num::{number_format::format_g, vector::Vec2};

/// The line above the collisions of a step.
pub(crate) const HEADER: &str = "Collision Detection Error: \n";

/// Returns the line about one collision, or `None` if the remark is about polynomials.
pub(crate) fn describe_remark(remark: &Remark) -> Option<String> {
    match remark {
        Remark::Missed(expected) => {
            Some(format!("  Missed collision: {}\n", describe(&LoggedImpulse::from(*expected))))
        }
        Remark::Superfluous(actual) => Some(format!("  Superfluous collision: {}\n", describe(actual))),
        Remark::WrongNormal { actual, expected } => {
            let (actual, expected) = (describe(actual), describe(&LoggedImpulse::from(*expected)));
            Some(format!("  Collision with wrong normal: {actual} should be {expected}\n"))
        }
        Remark::Polynomials(..) => None,
    }
}

/// Returns `Particle A - Edge B with normal = X Y`, or an empty text for an unknown kind of pair.
fn describe(impulse: &LoggedImpulse) -> String {
    let Some(kind) = impulse.kind() else { return String::new() };
    let second = kind.original_second_name();
    let normal = format_direction(impulse.normal);
    format!("Particle {} - {second} {} with normal = {normal}", impulse.first, impulse.second)
}

/// Returns both components. The first is padded to the length of the second, but the second is never padded.
fn format_direction(normal: Vec2) -> String {
    let (x, y) = (format_g(normal.x), format_g(normal.y));
    format!("{x:>width$} {y}", width = y.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn logged(kind: i32, x: f64, y: f64) -> LoggedImpulse {
        LoggedImpulse { kind, first: 3, second: -7, normal: Vec2::new(x, y), time: 0.5 }
    }

    #[test]
    fn pairs_are_named_and_only_the_first_component_is_padded() {
        assert_eq!(describe(&logged(0, 0.4, 0.0)), "Particle 3 - Particle -7 with normal = 0.4 0");
        assert_eq!(describe(&logged(1, 0.25, -1e-7)), "Particle 3 - Edge -7 with normal =   0.25 -1e-07");
        assert_eq!(
            describe(&logged(2, -0.0, f64::NAN.copysign(-1.0))),
            "Particle 3 - Halfplane -7 with normal =   -0 -nan"
        );
    }

    #[test]
    fn an_unknown_kind_has_no_text() {
        let line = describe_remark(&Remark::Superfluous(logged(9, 1.0, 2.0))).unwrap();
        assert_eq!(line, "  Superfluous collision: \n");
    }
}
