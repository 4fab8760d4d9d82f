//! Shows a report as a part of its submission's page. The report contains output of untrusted programs, which is
//! escaped. As a second line of defense, only this server's script can run, and a report with elements that send or
//! load something is not shown.
use crate::{domain::Member, problem::Problem, task::OutputFile};

/// The maximum size in bytes of a report that is shown on a page. The grader's reports have at most three megabytes.
const MAX_REPORT_BYTES: u64 = 4 << 20;

/// The elements that a report never has, because they send or load something.
const FORBIDDEN_ELEMENTS: [&str; 7] = ["form", "iframe", "base", "meta", "link", "object", "embed"];

/// Returns a report without its head; `None` if it is too large, or if it has a form that this version does not know.
pub(super) async fn read_report(member: &Member, file: &OutputFile) -> Result<Option<String>, Problem> {
    if file.artifact.size > MAX_REPORT_BYTES {
        return Ok(None);
    }
    let bytes = member.read_beginning(&file.artifact, MAX_REPORT_BYTES as usize).await?;
    Ok(strip_head(&String::from_utf8_lossy(&bytes)).map(str::to_owned))
}

fn strip_head(report: &str) -> Option<&str> {
    let (_, rest) = report.split_once("<main id=\"content\">\n")?;
    let (body, foot) = rest.rsplit_once("</main>\n<footer>")?;
    let (_, body) = body.split_once("</h1>\n")?;
    let is_own = foot.contains(concat!("Written by fosssim-oracle ", env!("CARGO_PKG_VERSION"), ". "));
    let is_foreign = |tag: &str| {
        let is_prefix = |name: &&str| tag.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
        FORBIDDEN_ELEMENTS.iter().any(is_prefix)
    };
    (is_own && !body.split('<').any(is_foreign)).then_some(body)
}

#[cfg(test)]
mod tests {
    use super::strip_head;

    #[test]
    fn a_report_of_this_version_is_part_of_a_page() {
        let report = |body: &str, version: &str| {
            format!(
                "<head></head><main id=\"content\">\n<h1>FOSSSim: wrong answer</h1>\n{body}</main>\n\
                 <footer><p>Written by fosssim-oracle {version}. In metres.</p></footer>\n<script>1</script>"
            )
        };
        let this_version = env!("CARGO_PKG_VERSION");
        assert_eq!(strip_head(&report("<p>Likely</p>\n", this_version)), Some("<p>Likely</p>\n"));
        assert_eq!(strip_head(&report("<p>Likely</p>\n", "0.0.1")), None);
        assert_eq!(strip_head(&report("<FORM action=\"/account\">", this_version)), None);
        assert_eq!(strip_head("everything"), None);
    }
}
