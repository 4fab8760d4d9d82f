//! Formats and parses times, in UTC.
use chrono::DateTime;
use std::ops::RangeInclusive;

/// Formats a time, given in milliseconds since 1970. Returns an empty text if the time is outside the calendar's range.
fn format_time(milliseconds: i64, pattern: &str) -> String {
    DateTime::from_timestamp_millis(milliseconds).map(|moment| moment.format(pattern).to_string()).unwrap_or_default()
}

/// Formats a time to the minute, such as `2026-11-22 08:45`.
pub fn format_minute(milliseconds: i64) -> String {
    format_time(milliseconds, "%Y-%m-%d %H:%M")
}

/// Formats a time in ISO 8601, such as `2026-11-22T08:45:12.345+00:00`.
pub fn format_iso(milliseconds: i64) -> String {
    format_time(milliseconds, "%Y-%m-%dT%H:%M:%S%.3f+00:00")
}

/// The ranges of plausible times, in milliseconds since 1970. A number between the two ranges is probably in seconds.
pub const MILLISECOND_RANGES: [RangeInclusive<i64>; 2] = [0..=99_999_999, 100_000_000_000..=253_402_300_799_999];

/// Returns whether a number is a plausible time in milliseconds.
pub fn is_plausible(milliseconds: i64) -> bool {
    MILLISECOND_RANGES.iter().any(|range| range.contains(&milliseconds))
}

/// Parses a time in ISO 8601, such as `2026-12-01T23:59:00+01:00`; seconds may be missing, and `Z` is allowed. The time
/// zone is required. Returns milliseconds since 1970; `None` if the text is no such time.
pub fn parse(text: &str) -> Option<i64> {
    let text = text.trim().replace(' ', "T");
    let text = match text.strip_suffix(['Z', 'z']) {
        Some(utc) => format!("{utc}+00:00"),
        None => text,
    };
    let parse = |form| DateTime::parse_from_str(&text, form).ok();
    let time = parse("%Y-%m-%dT%H:%M:%S%.f%z").or_else(|| parse("%Y-%m-%dT%H:%M%z"))?;
    Some(time.timestamp_millis())
}

/// Parses the value of a form's time field, such as `2026-12-01T23:59`. Its time zone is `east` minutes east of UTC.
/// Returns milliseconds since 1970, or `None` if the text is not a time.
pub fn parse_field(text: &str, east: i64) -> Option<i64> {
    let seconds = if text.len() == 16 { ":00Z" } else { "Z" };
    Some(parse(&format!("{text}{seconds}"))? - east * 60_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_read_with_their_zones() {
        for text in
            ["2026-11-22T08:40:00Z", "2026-11-22T09:40+01:00", "2026-11-22 03:10:00.000-0530", " 2026-11-22T08:40Z"]
        {
            assert_eq!(parse(text), Some(1_795_336_800_000), "{text}");
        }
        for text in ["2026-11-22T08:40:00", "2026-11-22", "tomorrow", "2026-13-22T08:40:00Z", "1795336859"] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert_eq!(parse_field("2026-11-22T09:40", 60), Some(1_795_336_800_000));
        assert_eq!(parse_field("", 60), None);
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
            assert_eq!(format_minute(milliseconds), text);
        }
        assert_eq!(format_iso(1_795_336_859_999), "2026-11-22T08:40:59.999+00:00");
        assert_eq!(format_iso(-1), "1969-12-31T23:59:59.999+00:00");
    }
}
