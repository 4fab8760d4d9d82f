//! Describes points for speed.
use super::format_points;
use crate::number::format_count;
use fosssim_findings::speed::{SpeedGrade, SpeedMarking, SpeedRatio, SpeedSource};

/// Describes a group's points for speed, and how they were computed.
pub fn describe_speed(speed: &SpeedGrade) -> String {
    let SpeedGrade { marking, points: reached, source } = speed;
    let max_points = format!("of {} points for speed", format_points(marking.points));
    let reached = reached.map_or_else(|| "none yet".to_owned(), format_points);
    match source {
        SpeedSource::Measured(measured) => format!("{reached} {max_points}: {}", describe_ratio(marking, measured)),
        SpeedSource::NotAccepted => {
            format!("{reached} {max_points}: counted only if all scenes of the group are accepted")
        }
        SpeedSource::Failed { scene, verdict } => {
            format!(
                "{reached} {max_points}: a timed run of {scene} had a different verdict ({verdict}) than the graded run"
            )
        }
        SpeedSource::Unmeasured => {
            format!("{reached} {max_points}: the time could not be measured, which is not the submission's fault")
        }
        SpeedSource::Withheld => format!("{reached} {max_points}"),
    }
}

/// Describes the measured ratio, its spread, and how the spread affects the points.
fn describe_ratio(marking: &SpeedMarking, measured: &SpeedRatio) -> String {
    let SpeedRatio { ratio, least, most, runs } = *measured;
    let (high, low) = (format_points(marking.points_at(least)), format_points(marking.points_at(most)));
    let sure = if high == low {
        "which does not change the points".to_owned()
    } else {
        format!("which is {low} to {high} points")
    };
    let rounds = format_count(runs.into(), "round");
    let line = format!(
        "full points up to {} times, none from {} times the reference's time",
        marking.full_at, marking.none_at
    );
    let spread = format!("{rounds} gave {least:.2} to {most:.2}, {sure}");
    format!("{ratio:.2} times the reference's processor time; {spread} ({line})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_findings::Verdict;

    #[test]
    fn the_spread_is_reported_with_its_meaning() {
        let marking = SpeedMarking { points: 40.0, full_at: 2.0, none_at: 10.0, runs: 5 };
        let said = |points, source| describe_speed(&SpeedGrade { marking, points, source });
        let measured = |ratio, least, most| SpeedSource::Measured(SpeedRatio { ratio, least, most, runs: 5 });
        assert_eq!(
            said(Some(35.0), measured(3.0, 2.9, 3.4)),
            "35 of 40 points for speed: 3.00 times the reference's processor time; 5 rounds gave 2.90 to 3.40, \
             which is 33 to 35.5 points (full points up to 2 times, none from 10 times the \
             reference's time)"
        );
        assert!(said(Some(40.0), measured(1.0, 0.9, 1.4)).contains("which does not change the points"));
        let failed = SpeedSource::Failed { scene: "a/b".to_owned(), verdict: Verdict::WrongAnswer };
        assert_eq!(
            said(Some(0.0), failed),
            "0 of 40 points for speed: a timed run of a/b had a different verdict (wrong answer) than the graded run"
        );
        assert!(said(None, SpeedSource::Unmeasured).starts_with("none yet of 40 points"));
        assert_eq!(said(Some(7.5), SpeedSource::Withheld), "7.5 of 40 points for speed");
    }
}
