//! A shard is a part of a grading that runs on several machines. It grades its own submissions, and stores the results
//! for `merge`.
use crate::{
    cli::{
        arguments::grade::{GradeArguments as Arguments, MAX_SHARDS, ShardArgument},
        console, output,
    },
    files::{FileError, FilePlace},
    suite::{Grade, SkippedEntry, Submission, plan::Plan, running_build, score},
};
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use std::{
    io::{BufReader, Read},
    path::{Path, PathBuf},
};

/// The name of the file that shows that a shard is complete. It contains the results of the shard.
const SHARD_FILE: &str = "shard.json";

/// The maximum size of the file, in bytes. It is twice the size for ten thousand submissions of 85 scenes that are all
/// wrong.
const MAX_BYTES: u64 = 4 << 30;

/// The version of the schema of the shard's file.
const SCHEMA: u32 = 1;

/// The inputs that must be the same for all shards of a grading.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct SharedInputs {
    schema: u32,
    /// The version of the grader.
    version: String,
    /// The digest of the grader's program, because two builds of the same version may judge differently.
    grader: String,
    /// The total number of shards.
    #[serde(rename = "of")]
    pub(super) total: usize,
    /// The name of the suite.
    pub(super) suite: String,
    /// The digest of everything that results depend on, except for the programs.
    plan: String,
    /// The names of all submissions, in the order of a grading without shards.
    pub(super) submissions: Vec<String>,
}

impl SharedInputs {
    /// Describes the first difference between the inputs of two gradings; `None` if they are equal.
    pub(super) fn describe_difference(&self, other: &Self) -> Option<&'static str> {
        [
            (self.schema == other.schema && self.version == other.version, "the grader's version differs"),
            (self.grader == other.grader, "the build of the grader differs"),
            (self.total == other.total, "the number of shards differs"),
            (
                self.suite == other.suite && self.plan == other.plan,
                "the suite, or an option that results depend on, differs",
            ),
            (self.submissions == other.submissions, "the submissions differ"),
        ]
        .into_iter()
        .find_map(|(same, what)| (!same).then_some(what))
    }
}

/// The results of a shard.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ShardResult {
    pub(super) common: SharedInputs,
    /// The number of the shard, from 1.
    pub(super) number: usize,
    /// The grades of the shard's submissions, in order.
    pub(super) grades: Vec<Grade>,
    /// The skipped entries of the class, which are not submissions.
    #[serde(rename = "passed_over", default)]
    pub(super) skipped_entries: Vec<SkippedEntry>,
}

impl ShardResult {
    /// Reads the results of a shard from a folder; `None` if the folder contains none, or if the shard is not complete.
    ///
    /// # Errors
    ///
    /// Fails if the file can't be read, or was written by a different version.
    pub(super) fn read(folder: &Path) -> Result<Option<Self>> {
        let file = folder.join(SHARD_FILE);
        let opened = match FilePlace::new(folder, SHARD_FILE).open_file(MAX_BYTES) {
            Ok((opened, length)) => opened.take(length),
            Err(FileError::Missing { .. }) => return Ok(None),
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", file.display())),
        };
        // The file is parsed while it is read. If a long file is not JSON, it is rejected at its first byte.
        let part: Self = serde_json::from_reader(BufReader::new(opened))
            .with_context(|| format!("{} is damaged, or of another version; grade this shard again", file.display()))?;
        part.check().with_context(|| format!("{} has invalid content; grade this shard again", file.display()))?;
        Ok(Some(part))
    }

    /// Checks that the shard has grades for its own submissions, and that the points follow from the verdicts.
    fn check(&self) -> Result<()> {
        let common = &self.common;
        if common.schema != SCHEMA {
            bail!("the file has schema {}, but this program reads {SCHEMA}", common.schema);
        }
        if !(1..=MAX_SHARDS).contains(&common.total) || !(1..=common.total).contains(&self.number) {
            bail!("there is no shard {} of {}; there are at most {MAX_SHARDS}", self.number, common.total);
        }
        let own = select_own(self.number, common.total, &common.submissions);
        if !own.eq(self.grades.iter().map(|grade| &grade.submission)) {
            bail!("the shard has grades of other submissions");
        }
        for grade in &self.grades {
            if let Some(what) = score::find_contradiction(grade) {
                bail!("the grade of {}: {what}", grade.submission);
            }
        }
        Ok(())
    }
}

/// Returns the entries of a list that belong to a shard. Each shard gets every N-th entry, because adjacent entries may
/// be equally slow.
fn select_own<T>(number: usize, shards: usize, all: &[T]) -> impl Iterator<Item = &T> {
    all.iter().skip(number.wrapping_sub(1)).step_by(shards.max(1))
}

/// A grading that grades only one shard.
pub(super) struct Sharding {
    shard: ShardArgument,
    common: SharedInputs,
    /// The folder in which the shard's results are stored.
    pub(super) folder: PathBuf,
    /// The path of the shard's file. No link on it is followed.
    shard_file: FilePlace,
}

impl Sharding {
    /// Creates the shard, from all submissions of the grading.
    pub(super) fn new(
        shard: ShardArgument,
        plan: &Plan,
        arguments: &Arguments,
        all: &[Submission],
        output: &Path,
    ) -> Self {
        let common = SharedInputs {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            grader: running_build().to_owned(),
            total: shard.total,
            suite: plan.name.clone(),
            plan: plan_digest(plan, arguments),
            submissions: all.iter().map(|submission| submission.name.clone()).collect(),
        };
        let place = FilePlace::new(output, format!("shard-{}-of-{}", shard.number, shard.total));
        Self { shard, common, folder: place.path(), shard_file: place }
    }

    /// Returns the submissions that belong to the shard.
    pub(super) fn select_submissions(&self, all: Vec<Submission>) -> Vec<Submission> {
        select_own(self.shard.number, self.shard.total, &all).cloned().collect()
    }

    /// Creates the folder of the shard. Removes the file by which an earlier grading marked the shard as complete.
    ///
    /// # Errors
    ///
    /// Fails if the folder can't be created.
    pub(super) fn begin(&self) -> Result<()> {
        self.shard_file.make_folder().with_context(|| format!("cannot create the folder {}", self.folder.display()))?;
        let place = FilePlace::new(&self.folder, SHARD_FILE);
        place.remove().with_context(|| format!("cannot remove {}", place.path().display()))
    }

    /// Writes the grades into the shard's file, which `merge` reads.
    ///
    /// # Errors
    ///
    /// Fails if the file can't be written.
    pub(super) fn end(&self, grades: &[Grade], skipped_entries: &[SkippedEntry]) -> Result<()> {
        let (common, number, skipped_entries) = (self.common.clone(), self.shard.number, skipped_entries.to_vec());
        let part = ShardResult { common, number, grades: grades.to_vec(), skipped_entries };
        output::write_below(&FilePlace::new(&self.folder, SHARD_FILE), &serde_json::to_vec(&part)?)?;
        let (own, submission_count) = (grades.len(), self.common.submissions.len());
        console::print_remark(format!(
            "shard {} of {}: {own} of {submission_count} submissions\n",
            self.shard.number, self.shard.total
        ));
        Ok(())
    }
}

/// Returns the digest of everything that results depend on, except for the programs.
fn plan_digest(plan: &Plan, arguments: &Arguments) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    let settings = format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} {} {}",
        plan.command,
        plan.rules,
        plan.staff_hints,
        plan.show_output,
        plan.build,
        plan.limits,
        plan.skip_limits,
        arguments.recorded,
        arguments.fail_fast
    );
    add(settings.as_bytes());
    for group in &plan.groups {
        add(group.name.as_bytes());
        add(format!("{:?}", group.marking).as_bytes());
        for scene in &group.scenes {
            add(scene.name.as_bytes());
            add(&scene.xml);
        }
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_submission_belongs_to_one_shard() {
        let all: Vec<usize> = (0..23).collect();
        for of in 1..30 {
            let mut shared: Vec<usize> = (1..=of).flat_map(|number| select_own(number, of, &all).copied()).collect();
            shared.sort_unstable();
            assert_eq!(shared, all, "{of}");
        }
    }

    #[test]
    fn a_shard_is_one_of_so_many() {
        assert_eq!("2/8".parse(), Ok(ShardArgument { number: 2, total: 8 }));
        for word in ["0/8", "9/8", "2", "2/", "/8", "-1/8", "2/0", "a/b", "1/2/3"] {
            assert!(word.parse::<ShardArgument>().is_err(), "{word}");
        }
    }
}
