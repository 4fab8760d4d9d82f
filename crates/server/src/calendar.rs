//! Moments as people and other programs write them, in UTC.
use chrono::DateTime;
use std::ops::RangeInclusive;

/// Year, month and day of a moment in milliseconds since 1970, and the milliseconds of the day.
fn civil(milliseconds: i64) -> (i64, i64, i64, i64) {
    const DAY: i64 = 24 * 3600 * 1000;
    // Civil dates from days, after Hinnant, "chrono-Compatible Low-Level Date Algorithms".
    let shifted = milliseconds.div_euclid(DAY) + 719_468;
    let era = shifted.div_euclid(146_097);
    let day_of_era = shifted.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    (year, month, day, milliseconds.rem_euclid(DAY))
}

/// For people: `2026-11-22 08:45`.
#[must_use]
pub fn minute(milliseconds: i64) -> String {
    let (year, month, day, rest) = civil(milliseconds);
    let minutes = rest / 60_000;
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}", minutes / 60, minutes % 60)
}

/// For other programs (ISO 8601): `2026-11-22T08:45:12.345+00:00`.
#[must_use]
pub fn exact(milliseconds: i64) -> String {
    let (year, month, day, rest) = civil(milliseconds);
    let (seconds, fraction) = (rest / 1000, rest % 1000);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{fraction:03}+00:00")
}

/// Moments in milliseconds: between these, numbers are seconds that somebody took for milliseconds.
pub const PLAUSIBLE: [RangeInclusive<i64>; 2] = [0..=99_999_999, 100_000_000_000..=253_402_300_799_999];

/// Whether a number is a moment in milliseconds.
#[must_use]
pub fn is_plausible(milliseconds: i64) -> bool {
    PLAUSIBLE.iter().any(|range| range.contains(&milliseconds))
}

/// A moment that somebody wrote (ISO 8601): `2026-12-01T23:59:00+01:00`, also without seconds, and with `Z`. Without a
/// time zone it is none.
#[must_use]
pub fn read(text: &str) -> Option<i64> {
    let text = text.trim().replace(' ', "T");
    let text = match text.strip_suffix(['Z', 'z']) {
        Some(utc) => format!("{utc}+00:00"),
        None => text,
    };
    let read = |form| DateTime::parse_from_str(&text, form).ok();
    let moment = read("%Y-%m-%dT%H:%M:%S%.f%z").or_else(|| read("%Y-%m-%dT%H:%M%z"))?;
    Some(moment.timestamp_millis())
}

/// A moment as a form's field says it, `2026-12-01T23:59`, so many minutes east of UTC.
#[must_use]
pub fn read_field(text: &str, east: i64) -> Option<i64> {
    let seconds = if text.len() == 16 { ":00Z" } else { "Z" };
    Some(read(&format!("{text}{seconds}"))? - east * 60_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_read_with_their_zones() {
        for text in
            ["2026-11-22T08:40:00Z", "2026-11-22T09:40+01:00", "2026-11-22 03:10:00.000-0530", " 2026-11-22T08:40Z"]
        {
            assert_eq!(read(text), Some(1_795_336_800_000), "{text}");
        }
        for text in ["2026-11-22T08:40:00", "2026-11-22", "tomorrow", "2026-13-22T08:40:00Z", "1795336859"] {
            assert_eq!(read(text), None, "{text}");
        }
        assert_eq!(read_field("2026-11-22T09:40", 60), Some(1_795_336_800_000));
        assert_eq!(read_field("", 60), None);
    }

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
            assert_eq!(minute(milliseconds), text);
        }
        assert_eq!(exact(1_795_336_859_999), "2026-11-22T08:40:59.999+00:00");
        assert_eq!(exact(-1), "1969-12-31T23:59:59.999+00:00");
    }
}
