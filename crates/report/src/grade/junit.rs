//! JUnit XML, with one suite per group and one case per scene. Wrong results are failures, and faults of the grader are
//! errors.
use super::{describe_difference, head_lines, phrases::NOT_GRADED, scene_lines};
use crate::untrusted_text::{clean_output, strip_control_characters};
use crate::{style::Style, words};
use fosssim_findings::{Grade, SceneGrade, SkippedEntry, Verdict};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// Renders all grades as one document.
pub(crate) fn render(grades: &[Grade], skipped_entries: &[SkippedEntry]) -> String {
    let mut report = Report::new("fosssim-oracle");
    for grade in grades {
        if let Some(unfit) = words::describe_unfit(grade) {
            report.add_test_suite(fault_suite(grade, &unfit));
        }
        for group in &grade.groups {
            let mut suite = TestSuite::new(format!(
                "{}: {}",
                strip_control_characters(&grade.submission),
                strip_control_characters(&group.name)
            ));
            for (number, warning) in grade.warnings.iter().enumerate() {
                suite.add_property(quick_junit::Property::new(
                    format!("warning.{number}"),
                    strip_control_characters(warning),
                ));
            }
            for (number, line) in head_lines(grade).iter().enumerate().filter(|_| grade.submission_fault().is_none()) {
                suite.add_property(quick_junit::Property::new(
                    format!("likely_mistake.{number}"),
                    strip_control_characters(line),
                ));
            }
            for scene in &group.scenes {
                // A JUnit test case has room only for its result and the program's output.
                if let Some(difference) = describe_difference(scene) {
                    let name = format!("rules_differ.{}", strip_control_characters(&scene.scene));
                    suite.add_property(quick_junit::Property::new(name, difference));
                }
                suite.add_test_case(test_case(grade, scene));
            }
            report.add_test_suite(suite);
        }
    }
    if !skipped_entries.is_empty() {
        let mut suite = TestSuite::new(NOT_GRADED);
        for SkippedEntry { name, reason: why } in skipped_entries {
            let mut status = TestCaseStatus::skipped();
            status.set_message(strip_control_characters(why));
            suite.add_test_case(TestCase::new(strip_control_characters(name), status));
        }
        report.add_test_suite(suite);
    }
    report.to_string().unwrap_or_default()
}

/// Returns a suite with a single case, for a submission that could not be graded as usual.
fn fault_suite(grade: &Grade, unfit: &str) -> TestSuite {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type(grade.verdict.name());
    status.set_message(strip_control_characters(unfit));
    if let Some(build) = &grade.build {
        status.set_description(clean_output(&build.output));
    }
    let mut case = TestCase::new("submission", status);
    case.set_classname(strip_control_characters(&grade.submission));
    let mut suite = TestSuite::new(format!("{}: submission", strip_control_characters(&grade.submission)));
    suite.add_test_case(case);
    suite
}

fn test_case(grade: &Grade, scene: &SceneGrade) -> TestCase {
    let status = match scene.verdict {
        Verdict::Accepted => TestCaseStatus::success(),
        Verdict::NotRun => TestCaseStatus::skipped(),
        _ if grade.submission_fault().is_some() => TestCaseStatus::skipped(),
        verdict => {
            let kind = if verdict == Verdict::JudgeError { NonSuccessKind::Error } else { NonSuccessKind::Failure };
            let mut status = TestCaseStatus::non_success(kind);
            status.set_type(verdict.name());
            status.set_message(strip_control_characters(&words::summarize(scene)));
            let mut description = words::list_details(scene);
            description.extend(scene_lines(scene, Style::Plain));
            if let Some(build) = grade.failed_build() {
                description.extend([words::build(&build.end), clean_output(&build.output)]);
            }
            if !description.is_empty() {
                status.set_description(strip_control_characters(&description.join("\n")));
            }
            status
        }
    };
    let mut case = TestCase::new(strip_control_characters(&scene.scene), status);
    case.set_classname(strip_control_characters(&grade.submission));
    case.set_time(scene.measured.wall);
    if !scene.stdout.is_empty() {
        case.set_system_out(clean_output(&scene.stdout));
    }
    if !scene.stderr.is_empty() {
        case.set_system_err(clean_output(&scene.stderr));
    }
    case
}
