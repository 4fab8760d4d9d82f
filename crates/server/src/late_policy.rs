//! The deduction of points for a submission that arrived after its due date.
use crate::db::{DbError, Row};
use chrono::{DateTime, Days};
use chrono_tz::Tz;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The number of milliseconds of a day.
const DAY_MILLIS: i64 = 86_400_000;

/// The settings of an assignment that apply to late submissions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(default)]
pub(crate) struct LatePolicy {
    pub(crate) due_at: Option<i64>,
    pub(crate) late_days: u32,
    pub(crate) late_percent: u32,
    pub(crate) time_zone: Option<Tz>,
}

/// The delay of a submission, and the share of the points that it loses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
pub struct Lateness {
    /// The number of days after the due date. A day that has begun counts in full.
    pub days: i64,
    /// The percentage of the grader's points that the submission loses.
    pub percent: i64,
}

impl LatePolicy {
    /// Returns the last time at which uploads are accepted from a student whose due date is `due`.
    pub(crate) fn closes_at(&self, due: i64) -> i64 {
        self.days_after(due, self.late_days.into())
    }

    /// Returns the same time of day, `days` later in the course's calendar, where a day may have 23 or 25 hours.
    fn days_after(&self, due: i64, days: i64) -> i64 {
        let calendar_time = self.time_zone.and_then(|zone| {
            let due = DateTime::from_timestamp_millis(due)?.with_timezone(&zone);
            Some(due.checked_add_days(Days::new(u64::try_from(days).ok()?))?.timestamp_millis())
        });
        // The course has no time zone, or the clocks of its zone skip that time.
        calendar_time.unwrap_or_else(|| due.saturating_add(days.saturating_mul(DAY_MILLIS)))
    }

    /// Returns the delay of a submission that arrived at `arrived_at`. The student's own due date applies if there is
    /// one. `None` means that the submission is in time, or that the assignment has no rule for late submissions.
    pub(crate) fn lateness(&self, own_due: Option<i64>, arrived_at: i64) -> Option<Lateness> {
        let due = self.due_at.map(|due| due.max(own_due.unwrap_or(due)))?;
        // The delay is at most the allowed number of late days, even if an extension was withdrawn. Earlier late
        // uploads keep their deduction even if late uploads are no longer accepted.
        let max_days = if self.late_days == 0 { i64::MAX } else { self.late_days.into() };
        let mut days = ((arrived_at - due) / DAY_MILLIS - 1).max(0);
        while self.days_after(due, days) < arrived_at {
            days += 1;
        }
        let days = days.min(max_days);
        let percent = days.saturating_mul(self.late_percent.into()).min(100);
        (days > 0 && (self.late_days > 0 || percent > 0)).then_some(Lateness { days, percent })
    }
}

impl Lateness {
    /// Returns the delay of the submission in a row. The row contains `created_at`, the assignment's `settings`, and
    /// the owner's own due date `own_due`.
    pub(crate) fn from_row(row: &Row) -> Result<Option<Self>, DbError> {
        let policy: LatePolicy = serde_json::from_str(&row.text("settings")?).unwrap_or_default();
        Ok(policy.lateness(row.maybe_int("own_due")?, row.int("created_at")?))
    }

    /// Returns the points that are left after the deduction from the grader's points.
    pub(crate) fn points_left(self, points: &str) -> String {
        let reduce = |points: f64| (points * (100 - self.percent) as f64 / 100.0).to_string();
        points.parse().map_or_else(|_| points.to_owned(), reduce)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_day_that_has_begun_costs_the_same() {
        let due = 1_700_000_000_000;
        let policy = LatePolicy { due_at: Some(due), late_days: 3, late_percent: 40, time_zone: None };
        let late = |after| policy.lateness(None, due + after).map(|late| (late.days, late.percent));
        assert_eq!([late(-DAY_MILLIS), late(0), late(1)], [None, None, Some((1, 40))]);
        assert_eq!([late(DAY_MILLIS), late(DAY_MILLIS + 1)], [Some((1, 40)), Some((2, 80))]);
        assert_eq!([late(3 * DAY_MILLIS), late(9 * DAY_MILLIS)], [Some((3, 100)); 2], "it never costs more than all");
        assert_eq!(policy.lateness(Some(due + DAY_MILLIS), due + DAY_MILLIS), None, "an extension moves the due date");
        assert_eq!(policy.closes_at(due), due + 3 * DAY_MILLIS);
        assert_eq!(policy.lateness(Some(due - DAY_MILLIS), due), None, "and never forwards");
        let closed = LatePolicy { late_days: 0, ..policy };
        assert_eq!(closed.lateness(None, due + 1).map(|late| late.percent), Some(40), "closing later forgives nothing");
        let never = LatePolicy { late_percent: 0, ..closed };
        assert_eq!(never.lateness(None, due + 1), None, "where nothing is said of late work, nothing is late");
        assert_eq!(Lateness { days: 1, percent: 10 }.points_left("85.5"), "76.95");
    }

    #[test]
    fn a_day_ends_at_the_same_time_of_the_day_when_the_clocks_change() {
        // The evening before the clocks go back in Berlin: the day has 25 hours.
        let due = crate::calendar::parse("2026-10-24T23:59+02:00").expect("a moment");
        let zone = Some(Tz::Europe__Berlin);
        let policy = LatePolicy { due_at: Some(due), late_days: 2, late_percent: 10, time_zone: zone };
        let days = |arrived_at: &str| {
            let arrived_at = crate::calendar::parse(arrived_at).expect("a moment");
            policy.lateness(None, arrived_at).map(|late| late.days)
        };
        assert_eq!(days("2026-10-25T23:59+01:00"), Some(1));
        assert_eq!(days("2026-10-26T00:00+01:00"), Some(2));
        assert_eq!(policy.closes_at(due), crate::calendar::parse("2026-10-26T23:59+01:00").expect("a moment"));
        assert_eq!(LatePolicy { time_zone: None, ..policy }.closes_at(due), due + 2 * DAY_MILLIS);
    }
}
