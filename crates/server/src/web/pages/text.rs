//! Values as people read them.
use crate::access::RegradeState;

/// A moment in UTC: `2026-11-22 08:45`.
pub(super) fn moment(milliseconds: &i64) -> String {
    let minutes = milliseconds.div_euclid(60_000);
    let (days, minute) = (minutes.div_euclid(1440), minutes.rem_euclid(1440));
    // Civil dates from days, after Hinnant, "chrono-Compatible Low-Level Date Algorithms".
    let shifted = days + 719_468;
    let era = shifted.div_euclid(146_097);
    let day_of_era = shifted.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}", minute / 60, minute % 60)
}

/// Points of the most that could be had; a dash where there are none.
pub(super) fn points(points: &Option<String>, most: &Option<String>) -> String {
    match (points, most) {
        (Some(points), Some(most)) => format!("{points} / {most}"),
        (Some(points), None) => points.clone(),
        _ => "\u{2013}".to_owned(),
    }
}

/// Points alone.
pub(super) fn bare_points(points: &Option<String>) -> &str {
    points.as_deref().unwrap_or_default()
}

/// Where a regrade is, in words.
pub(super) fn regrade(state: &RegradeState) -> &'static str {
    match state {
        RegradeState::Open => "open",
        RegradeState::Applied => "applied",
        RegradeState::Discarded => "discarded",
    }
}

/// What was decided on a suspicion, in words.
pub(super) fn suspicion(state: &str) -> &'static str {
    match state {
        "dismissed" => "the reference is right",
        "told" => "students know that it is looked into",
        _ => "nobody has decided yet",
    }
}

/// The beginning of a digest.
pub(super) fn short(digest: &str) -> &str {
    digest.get(..12).unwrap_or(digest)
}

/// What becomes of a submission, in words.
pub(super) fn state(state: &str) -> &'static str {
    match state {
        "waiting" => "waiting",
        "running" => "being graded",
        "done" => "graded",
        "buried" => "the grader failed: nobody's fault here, and staff knows",
        _ => "taken out of the queue",
    }
}

#[cfg(test)]
mod tests {
    use super::moment;

    #[test]
    fn moments_are_dates() {
        for (milliseconds, text) in [
            (0, "1970-01-01 00:00"),
            (951_782_400_000, "2000-02-29 00:00"),
            (1_795_336_859_999, "2026-11-22 08:40"),
            (4_107_542_399_999, "2100-02-28 23:59"),
            (4_107_542_400_000, "2100-03-01 00:00"),
            (-1, "1969-12-31 23:59"),
        ] {
            assert_eq!(moment(&milliseconds), text);
        }
    }
}
