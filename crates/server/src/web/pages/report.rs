//! A report as a part of its submission's page. What a stranger's program printed is text in it; and should it ever be
//! more, no script runs but this server's own, and nothing that could send something is taken in.
use crate::{domain::Member, problem::Problem, task::OutputFile};

/// The size of the largest report that is part of a page; a grader's have at most three megabytes.
const LARGEST: u64 = 4 << 20;

/// Elements that no report has: by them a page sends something, or takes something in.
const FOREIGN: [&str; 7] = ["form", "iframe", "base", "meta", "link", "object", "embed"];

/// Returns a report without its head, which the page has; `None` for one of another version's grader, or a report that
/// is too large.
pub(super) async fn read(member: &Member, file: &OutputFile) -> Result<Option<String>, Problem> {
    if file.artifact.size > LARGEST {
        return Ok(None);
    }
    let bytes = member.beginning(&file.artifact, LARGEST as usize).await?;
    Ok(inner(&String::from_utf8_lossy(&bytes)).map(str::to_owned))
}

fn inner(report: &str) -> Option<&str> {
    let (_, rest) = report.split_once("<main id=\"content\">\n")?;
    let (body, foot) = rest.rsplit_once("</main>\n<footer>")?;
    let (_, body) = body.split_once("</h1>\n")?;
    let is_own = foot.contains(concat!("Written by fosssim-oracle ", env!("CARGO_PKG_VERSION"), ". "));
    let is_foreign = |tag: &str| {
        let begins = |name: &&str| tag.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
        FOREIGN.iter().any(begins)
    };
    (is_own && !body.split('<').any(is_foreign)).then_some(body)
}

#[cfg(test)]
mod tests {
    use super::inner;

    #[test]
    fn a_report_of_this_version_is_part_of_a_page() {
        let report = |body: &str, version: &str| {
            format!(
                "<head></head><main id=\"content\">\n<h1>FOSSSim: wrong answer</h1>\n{body}</main>\n\
                 <footer><p>Written by fosssim-oracle {version}. In metres.</p></footer>\n<script>1</script>"
            )
        };
        let own = env!("CARGO_PKG_VERSION");
        assert_eq!(inner(&report("<p>Likely</p>\n", own)), Some("<p>Likely</p>\n"));
        assert_eq!(inner(&report("<p>Likely</p>\n", "0.0.1")), None);
        assert_eq!(inner(&report("<FORM action=\"/account\">", own)), None);
        assert_eq!(inner("everything"), None);
    }
}
