//! `replay`: grades once more by a past result's own task, and compares what the grade says, byte for byte.
use super::{arguments::ReplayArguments, folders::ServiceFolders, until_signalled, worker::grader};
use crate::{
    db::{self, Row, read_row},
    store::{Digest, Store},
    task::{JUDGE_ERROR, Suite, Task},
    values,
    worker::{Grader, Program, essence},
};
use anyhow::{Context, Result, anyhow, bail};
use serde_json::Value;
use tokio_util::sync::CancellationToken;

/// How many differences are shown.
const SHOWN: usize = 10;

/// A past result.
struct Past {
    number: i64,
    code: String,
    points: Option<String>,
    version: String,
    grader: String,
    essence: String,
    task: Task,
    /// Its report, where that is still kept.
    report: Option<Digest>,
}

impl Past {
    fn read(row: &Row) -> Result<Self> {
        Ok(read_row!(row => Self {
            number = "id", code, points, version, grader, essence;
            task: serde_json::from_str(&row.text("task")?).context("the task was written by another version")?,
            report: row.maybe_text("report")?.and_then(|digest| digest.parse().ok()),
        }))
    }
}

/// Whether all results are the same.
pub(super) async fn run(arguments: &ReplayArguments) -> Result<bool> {
    let stop = until_signalled()?;
    let folders = ServiceFolders::find(&arguments.place)?;
    let (database, address) = folders.open_database(&arguments.place).await?;
    if db::version(&database).await? != db::LATEST {
        bail!("the tables of {address} are not those of this version: start the server first");
    }
    let store = folders.store(&arguments.place)?;
    let program = Program::new(grader(arguments.work.grader.as_deref())?, arguments.work.threads.get());
    let mut transaction = database.read().await?;
    let statement =
        "SELECT result.id, result.code, result.points, result.version, result.grader, result.essence, result.task,
           result_file.digest AS report
        FROM result LEFT JOIN result_file ON result_file.result = result.id AND result_file.name = 'grade.json'
        WHERE result.submission = ? AND (result.id = ? OR ? = 1) AND result.code <> ? ORDER BY result.id";
    let rows = transaction
        .rows(statement, values![arguments.submission, arguments.result, arguments.result.is_none(), JUDGE_ERROR])
        .await?;
    let known = transaction.row("SELECT id FROM submission WHERE id = ?", values![arguments.submission]).await?;
    drop(transaction);
    if known.is_none() {
        bail!("there is no submission {}: its number stands in the address of its page", arguments.submission);
    }
    if rows.is_empty() {
        bail!("submission {} has no such result", arguments.submission);
    }
    let mut all_same = true;
    for row in &rows {
        let past = Past::read(row)?;
        all_same &= replay(&past, &store, &folders, &program, &stop).await?;
    }
    database.close().await;
    Ok(all_same)
}

async fn replay(
    past: &Past,
    store: &Store,
    folders: &ServiceFolders,
    program: &Program,
    stop: &CancellationToken,
) -> Result<bool> {
    let work = folders.work("replay");
    std::fs::create_dir_all(&work)?;
    let folder = tempfile::tempdir_in(work)?;
    let (submission, work) = (folder.path().join("submission"), folder.path().join("work"));
    let fetched = store.fetch(&past.task.submission.artefact.digest, &submission).await;
    fetched.context("the upload is not there any more")?;
    let suite = match &past.task.suite {
        Suite::Named(_) => None,
        Suite::Archive(digest) => {
            let file = folder.path().join("suite");
            store.fetch(digest, &file).await.context("the suite is not there any more")?;
            Some(file)
        }
    };
    std::fs::create_dir(&work)?;
    let graded = program.grade(&past.task, &submission, suite.as_deref(), &work, stop.clone()).await;
    let graded = graded.map_err(|fault| anyhow!("result {}: {fault}", past.number))?.outcome;
    let before = match &past.report {
        Some(digest) => Some(essence(&store.bytes(digest, 1 << 30).await.context("the report of then")?)?),
        None => None,
    };
    // Results of earlier versions have no digest of their own.
    let then = match (&before, past.essence.as_str()) {
        (Some(before), "") => Digest::of(before.as_bytes()).to_string(),
        (Some(before), essence) if Digest::of(before.as_bytes()).as_str() != essence => {
            bail!("result {}: the report in the store is not the one that was graded", past.number)
        }
        (None, "") => bail!("result {} has no digest and no report to compare with", past.number),
        (_, essence) => essence.to_owned(),
    };
    let same = then == graded.essence;
    let points = past.points.as_deref().unwrap_or("no");
    let by = match () {
        () if past.grader.is_empty() => format!("version {}", past.version),
        () if past.grader == graded.grader => format!("the same grader {}", short(&past.grader)),
        () => format!("grader {} of version {}, now {}", short(&past.grader), past.version, short(&graded.grader)),
    };
    let said = if same { "the same, byte for byte" } else { "ANOTHER GRADE" };
    println!(
        "result {}: {}, {points} points, {by}: {said} ({} then, {} now)",
        past.number,
        past.code,
        short(&then),
        short(&graded.essence)
    );
    if let (false, Some(before)) = (same, before) {
        let now = essence(&std::fs::read(work.join("grade.json"))?)?;
        let mut found = Vec::new();
        differences("", &serde_json::from_str(&before)?, &serde_json::from_str(&now)?, &mut found);
        for line in found.iter().take(SHOWN) {
            println!("  {line}");
        }
        if found.len() > SHOWN {
            println!("  and {} more", found.len() - SHOWN);
        }
    }
    Ok(same)
}

fn short(digest: &str) -> &str {
    digest.get(..12).unwrap_or("unknown")
}

/// Where two reports differ, with both values in short.
fn differences(place: &str, then: &Value, now: &Value, found: &mut Vec<String>) {
    match (then, now) {
        (Value::Object(then), Value::Object(now)) => {
            let names: std::collections::BTreeSet<&String> = then.keys().chain(now.keys()).collect();
            for name in names {
                let of = |fields: &serde_json::Map<String, Value>| fields.get(name).cloned().unwrap_or(Value::Null);
                differences(&format!("{place}/{name}"), &of(then), &of(now), found);
            }
        }
        (Value::Array(then), Value::Array(now)) if then.len() == now.len() => {
            for (number, (then, now)) in then.iter().zip(now).enumerate() {
                differences(&format!("{place}/{number}"), then, now, found);
            }
        }
        _ if then == now => {}
        _ => {
            let shown = |value: &Value| value.to_string().chars().take(80).collect::<String>();
            found.push(format!("{place}: {} then, {} now", shown(then), shown(now)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::differences;

    #[test]
    fn differences_are_told_with_their_place() {
        let value = |text: &str| serde_json::from_str(text).expect("JSON");
        let mut found = Vec::new();
        let (then, now) = (r#"{"a": [1, {"b": "x"}], "c": 1}"#, r#"{"a": [1, {"b": "y"}], "d": []}"#);
        differences("", &value(then), &value(now), &mut found);
        assert_eq!(found, ["/a/1/b: \"x\" then, \"y\" now", "/c: 1 then, null now", "/d: null then, [] now"]);
    }
}
