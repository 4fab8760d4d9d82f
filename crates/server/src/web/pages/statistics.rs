//! Statistics of a class's results, and the categories of students.
use crate::{
    domain::{CountedSubmission, ShortStanding},
    task::{NEVER_RAN, format_points},
};
use std::{cmp::Reverse, collections::BTreeMap};

/// The histogram of points. Reports of `grade` contain the same code.
#[path = "../../../../report/src/page/histogram.rs"]
mod histogram;

/// The categories of students from which staff can choose. Each has its name and its text.
pub(super) const SECTIONS: [(&str, &str); 6] = [
    ("accepted", "accepted"),
    ("wrong", "not accepted"),
    ("waiting", "not graded yet"),
    ("never-ran", "never ran"),
    ("late", "late"),
    ("missing", "no submission"),
];

/// Returns whether a student is in a category. All students are in the category with the empty name.
pub(super) fn is_in_section(standing: &ShortStanding, part: &str) -> bool {
    let counts = standing.counts.as_ref();
    let code = counts.and_then(|counts| counts.code.as_deref());
    match part {
        "accepted" => code == Some("AC"),
        "wrong" => code.is_some_and(|code| code != "AC" && !NEVER_RAN.contains(&code)),
        "waiting" => counts.is_some() && code.is_none(),
        "never-ran" => code.is_some_and(|code| NEVER_RAN.contains(&code)),
        "late" => counts.is_some_and(|counts| counts.is_late),
        "missing" => standing.submissions == 0,
        _ => true,
    }
}

/// Students with a common value, such as a mistake: the value, their logins and names, and the number of an example
/// among their submissions.
pub(super) type StudentCluster = (String, Vec<(String, String)>, i64);

/// The statistics of a class's results.
pub(super) struct Statistics {
    pub(super) students: usize,
    /// The number of students in each of the [`SECTIONS`], with the category's name and text.
    pub(super) section_counts: Vec<(&'static str, &'static str, usize)>,
    /// The mean and the median of the points in percent, over all submissions that were run; `None` if no submission
    /// was run.
    pub(super) mean_and_median: Option<(String, String)>,
    /// The histogram of points, as HTML.
    pub(super) histogram: String,
    /// The likely mistakes of students, the most frequent first.
    pub(super) mistakes: Vec<StudentCluster>,
    /// The files that several students submitted unchanged.
    pub(super) duplicates: Vec<StudentCluster>,
}

impl Statistics {
    pub(super) fn from_standings(standings: &[ShortStanding]) -> Self {
        let count = |part: &str| standings.iter().filter(|standing| is_in_section(standing, part)).count();
        let judged = standings.iter().filter(|standing| !is_in_section(standing, "never-ran"));
        let mut shares: Vec<f64> = judged.filter_map(|standing| points_share(standing.counts.as_ref()?)).collect();
        shares.sort_by(f64::total_cmp);
        let middle = |count: usize| (shares[(count - 1) / 2] + shares[count / 2]) / 2.0;
        let mean = |count: usize| shares.iter().sum::<f64>() / count as f64;
        let points = Some(shares.len()).filter(|count| *count > 0);
        Self {
            students: standings.len(),
            section_counts: SECTIONS.map(|(name, title)| (name, title, count(name))).to_vec(),
            mean_and_median: points.map(|count| (format_points(mean(count)), format_points(middle(count)))),
            histogram: histogram::render_histogram(shares.iter().map(|share| share / 100.0)),
            mistakes: find_clusters(standings, |row| &row.mistakes),
            duplicates: find_clusters(standings, |row| (!row.digest.is_empty()).then_some(&row.digest))
                .into_iter()
                .filter(|(_, students, _)| students.len() > 1)
                .collect(),
        }
    }

    /// Returns the number of students in a category such as `missing` or `accepted`.
    pub(super) fn count(&self, part: &str) -> usize {
        self.section_counts.iter().find(|(name, ..)| *name == part).map_or(0, |(.., count)| *count)
    }
}

/// Returns the points of a submission in percent of the maximum.
fn points_share(counts: &CountedSubmission) -> Option<f64> {
    let number = |text: &Option<String>| text.as_ref()?.parse::<f64>().ok();
    let (points, max_points) = (number(&counts.points)?, number(&counts.max_points)?);
    (max_points > 0.0).then(|| (100.0 * points / max_points).clamp(0.0, 100.0))
}

/// Groups students by the values that `keys` returns for their submissions. The largest groups are first.
fn find_clusters<'a, K: IntoIterator<Item = &'a String>>(
    standings: &'a [ShortStanding],
    keys: impl Fn(&'a CountedSubmission) -> K,
) -> Vec<StudentCluster> {
    let mut found: BTreeMap<&str, StudentCluster> = BTreeMap::new();
    for standing in standings {
        let Some(counts) = &standing.counts else { continue };
        for key in keys(counts) {
            let student = (standing.login.clone(), standing.name.clone());
            found.entry(key).or_insert_with(|| (key.clone(), Vec::new(), counts.id)).1.push(student);
        }
    }
    let mut found: Vec<StudentCluster> = found.into_values().collect();
    found.sort_by_key(|(_, students, _)| Reverse(students.len()));
    found
}
