//! How a class did, in numbers.
use crate::{domain::ShortStanding, task::rounded};
use std::collections::BTreeMap;

/// How a class did.
pub(super) struct Statistics {
    pub(super) students: usize,
    pub(super) accepted: usize,
    pub(super) mean: String,
    pub(super) median: String,
    /// Mistakes that several students are likely to have made, the most frequent first: their logins, and a submission
    /// that shows it.
    pub(super) mistakes: Vec<(String, Vec<String>, i64)>,
}

impl Statistics {
    /// Returns the statistics of those who have points; nothing where nobody has.
    pub(super) fn from_standings(standings: &[ShortStanding]) -> Option<Self> {
        let mut parts = Vec::new();
        let mut accepted = 0;
        let mut mistakes: BTreeMap<String, (Vec<String>, i64)> = BTreeMap::new();
        for standing in standings {
            let Some(counts) = &standing.counts else { continue };
            let Some(verdict) = &counts.verdict else { continue };
            accepted += usize::from(verdict == "accepted");
            let number = |text: &Option<String>| text.as_ref().and_then(|text| text.parse::<f64>().ok());
            if let (Some(points), Some(most)) = (number(&counts.points), number(&counts.max_points))
                && most > 0.0
            {
                parts.push((100.0 * points / most).clamp(0.0, 100.0));
            }
            if let Some((_, mistake)) = counts.summary.split_once("; ") {
                let (logins, _) = mistakes.entry(mistake.to_owned()).or_insert_with(|| (Vec::new(), counts.id));
                logins.push(standing.login.clone());
            }
        }
        parts.sort_by(f64::total_cmp);
        let students = parts.len();
        let median = (parts.get(students.checked_sub(1)? / 2)? + parts.get(students / 2)?) / 2.0;
        let mean = parts.iter().sum::<f64>() / students as f64;
        let shared = mistakes.into_iter().filter(|(_, (logins, _))| logins.len() > 1);
        let mut mistakes: Vec<_> = shared.map(|(mistake, (logins, first))| (mistake, logins, first)).collect();
        mistakes.sort_by_key(|(_, logins, _)| std::cmp::Reverse(logins.len()));
        Some(Self {
            students,
            accepted,
            mean: rounded(&mean.to_string()),
            median: rounded(&median.to_string()),
            mistakes,
        })
    }
}
