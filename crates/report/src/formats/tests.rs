//! Checks every format against its schema, and as a readable snapshot.
use super::Format;
use crate::grade::{add_warnings, csv_of_submissions, json_lines, samples};
use crate::page::{Audience, GradePage};
use fosssim_grading::{
    Grade, Reason, SkippedEntry, Verdict,
    config::Visibility,
    failure_cause::{FailureKind, LocatedFailure, SceneFeature},
    result::{ProgramProgress, RunEnd, WrongTrace},
};
use fosssim_judge::{FindingKind, fair::Cause};
use fosssim_mistakes::diagnose::{Explanation, ExplanationTopic};
use fosssim_mistakes::together::reconcile_explanations;
use fosssim_testing::{Need, skip};
use std::{path::Path, slice, time::Duration};

fn all() -> [Grade; 3] {
    [samples::accepted_grade(), samples::failing_grade(), samples::failed_grade()]
}

fn schema(name: &str) -> serde_json::Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).expect("a schema")).expect("JSON")
}

fn assert_valid(name: &str, document: &str) {
    let document: serde_json::Value = serde_json::from_str(document).expect("JSON");
    if let Err(error) = jsonschema::validate(&schema(name), &document) {
        panic!("{name}: {error}\n{document:#}");
    }
}

/// Checks that reports contain no control characters except line breaks and tabs, for all outputs and names.
fn assert_harmless(document: &str) {
    let bad: Vec<char> = document.chars().filter(|c| c.is_control() && !matches!(c, '\n' | '\t' | '\r')).collect();
    assert!(bad.is_empty(), "{bad:?} in\n{document}");
    assert!(!document.contains('\u{202e}'));
}

#[test]
fn the_page_about_formats_names_every_one() {
    let page = include_str!("../../../../docs/formats.md");
    for format in Format::ALL {
        let row = page.lines().find(|line| line.starts_with(&format!("| `{}` |", format.name()))).expect("a row");
        assert_eq!(row.ends_with("| yes |"), format.takes_several(), "{row}");
    }
}

#[test]
fn nothing_hostile_gets_through_any_format() {
    for (format, name) in Format::ALL.iter().map(|format| (format, format.name())) {
        for grade in all() {
            let document = format.render(std::slice::from_ref(&grade));
            assert_harmless(&document);
            assert!(!document.is_empty() || name == "github", "{name}");
        }
    }
    assert_harmless(&csv_of_submissions(&all(), &[]));
    let annotations = Format::Github.render(&[samples::failing_grade()]);
    assert!(annotations.lines().all(|line| line.starts_with("::error ") || line.starts_with("::warning ")));
    let csv = Format::Csv.render(&all());
    assert!(!csv.contains(",=") && !csv.contains("\n="), "{csv}");
}

#[test]
fn json_follows_its_schema() {
    assert_valid("grade.schema.json", &Format::Json.render(&all()));
    insta::assert_snapshot!("grade_json", Format::Json.render(&all()).replace(env!("CARGO_PKG_VERSION"), "VERSION"));
    assert_eq!(json_lines(&[samples::accepted_grade()], &[]).lines().count(), 1);
}

#[test]
fn every_format_lists_skipped_entries_once() {
    let entry = |name: &str, why: &str| SkippedEntry { name: name.to_owned(), reason: why.to_owned() };
    let skipped_entries = [entry(".hidden", "its name begins with a dot"), entry("=a|b,<c>::d", "it is a link")];
    for format in Format::ALL.iter().filter(|format| format.takes_several()) {
        let document = format.render_class(&all(), &skipped_entries);
        assert_harmless(&document);
        assert_eq!(document.matches(".hidden").count(), 1, "{}", format.name());
        assert!(
            !document.contains("<c>") || matches!(format, Format::Csv | Format::Text | Format::Github | Format::Json)
        );
        assert_eq!(format.render_class(&all(), &[]), format.render(&all()));
    }
    assert_valid("grade.schema.json", &Format::Json.render_class(&all(), &skipped_entries));
    // All submissions of a class are graded with the same suite, so they have the same groups.
    let csv = csv_of_submissions(&[samples::accepted_grade(), samples::accepted_grade()], &skipped_entries);
    let mut rows = csv::Reader::from_reader(csv.as_bytes());
    let names: Vec<String> = rows.records().map(|row| row.expect("rows of one length")[0].to_owned()).collect();
    assert_eq!(names[2..], [".hidden", "'=a|b,<c>::d"]);
    assert_eq!(json_lines(&all(), &skipped_entries).lines().count(), 5);
    let mut one = [samples::accepted_grade()];
    add_warnings(&mut one, &skipped_entries);
    for format in Format::ALL.iter().filter(|format| **format != Format::Csv) {
        assert!(format.render(&one).contains(".hidden"), "{}", format.name());
    }
}

#[test]
fn gradescope_follows_its_schema() {
    for grade in all() {
        assert_valid("gradescope.schema.json", &Format::Gradescope.render(&[grade]));
    }
    let document: serde_json::Value =
        serde_json::from_str(&Format::Gradescope.render(&[samples::failed_grade()])).expect("JSON");
    assert!(document.get("score").is_none(), "a fault of ours is nobody's zero");
    insta::assert_snapshot!(
        "grade_gradescope",
        Format::Gradescope.render(&[samples::failing_grade()]).replace(env!("CARGO_PKG_VERSION"), "VERSION")
    );
}

#[test]
fn prairielearn_follows_its_schema() {
    for grade in all() {
        assert_valid("prairielearn.schema.json", &Format::Prairielearn.render(&[grade]));
    }
    let document: serde_json::Value =
        serde_json::from_str(&Format::Prairielearn.render(&[samples::failed_grade()])).expect("JSON");
    assert_eq!(document["gradable"], false);
    insta::assert_snapshot!("grade_prairielearn", Format::Prairielearn.render(&[samples::failing_grade()]));
}

/// If a submission gets only half of the score and the word "accepted" is shown next to it, the text must give the
/// reason.
#[test]
fn prairielearn_says_that_groups_which_are_not_shown_count() {
    let mut grade = samples::accepted_grade();
    grade.groups.retain(|group| group.visibility == Visibility::Visible);
    assert!(Format::Prairielearn.render(&[grade.clone()]).contains(r#""message": "accepted""#));
    let hidden = fosssim_grading::GroupGrade {
        name: "Veiled".to_owned(),
        visibility: Visibility::Hidden,
        points: Some(0.0),
        verdict: Verdict::WrongAnswer,
        ..grade.groups[0].clone()
    };
    grade.max_points += hidden.max_points;
    (grade.verdict, grade.groups) = (Verdict::WrongAnswer, [grade.groups, vec![hidden]].concat());
    let document = Format::Prairielearn.render(&[grade]);
    assert!(document.contains("\"message\": \"accepted on the tests shown here (") && !document.contains("Veiled"));
    assert!(document.contains("other tests are hidden") && !document.contains("points points"), "{document}");
}

/// A fact about the upload is stated once, at the top, and not for each scene.
#[test]
fn faults_of_the_submission_itself_are_stated_once() {
    let sentence = "the upload has no program called FOSSSim; it contains main.cpp, fosssim-sample";
    for format in
        [Format::Text, Format::Junit, Format::Gradescope, Format::Prairielearn, Format::Github, Format::Markdown]
    {
        let document = format.render(&[samples::unusable_grade()]).replace('\\', "");
        assert_eq!(document.matches(sentence).count(), 1, "{format:?}: {document}");
        assert!(document.contains("unusable submission") && !document.contains("run-time"), "{format:?}: {document}");
    }
    let gradescope: serde_json::Value =
        serde_json::from_str(&Format::Gradescope.render(&[samples::unusable_grade()])).expect("JSON");
    assert_eq!((&gradescope["score"], gradescope["tests"].as_array().map(Vec::len)), (&0.0.into(), Some(3)));
    assert!(gradescope["output"].as_str().is_some_and(|output| output.contains(sentence)), "{gradescope:#}");
    assert_valid("gradescope.schema.json", &gradescope.to_string());
    assert_valid("grade.schema.json", &Format::Json.render(&[samples::unusable_grade()]));
    let csv = csv_of_submissions(&[samples::unusable_grade()], &[]);
    assert!(csv.contains("dan,unusable submission,0,20,0,3,"), "{csv}");
    insta::assert_snapshot!("grade_unfit_text", Format::Text.render(&[samples::unusable_grade()]));
}

#[test]
fn an_unchanged_template_is_reported_in_ten_lines() {
    let grades = [samples::unwritten_grade()];
    let text = Format::Text.render(&grades);
    assert!(text.lines().count() <= 10, "{text}");
    insta::assert_snapshot!("grade_unwritten_text", text);
    for format in
        [Format::Junit, Format::Gradescope, Format::Prairielearn, Format::Github, Format::Markdown, Format::Html]
    {
        let document = format.render(&grades).replace('\\', "");
        assert_eq!(document.matches("Not written yet: ").count(), 1, "{format:?}: {document}");
        assert!(document.to_lowercase().contains("nothing written"), "{format:?}: {document}");
    }
    assert_valid("grade.schema.json", &Format::Json.render(&grades));
    assert!(
        csv_of_submissions(&grades, &[]).contains("template,nothing written,0,20,"),
        "{}",
        csv_of_submissions(&grades, &[])
    );
}

/// On one scene, a loop that runs one round too few can't be distinguished from an empty loop. No format shows an
/// explanation that the other scenes contradict.
#[test]
fn every_format_uses_the_explanation_of_all_scenes() {
    let mut grade = samples::accepted_grade();
    let named = |key: &str, same_as: &[&str]| Explanation {
        key: key.to_owned(),
        same_as: same_as.iter().map(|&key| key.to_owned()).collect(),
        topic: ExplanationTopic::Mistake,
        reproduced: 4,
        samples: 4,
        ..crate::explain::tests::explanations().swap_remove(1)
    };
    let short = named("loop-one-fewer", &[]);
    let alone = named("loop-empty", &["loop-one-fewer"]);
    let explanations = [alone, short.clone(), short];
    let scenes = grade.groups.iter_mut().flat_map(|group| &mut group.scenes);
    for (scene, explanation) in scenes.zip(explanations) {
        scene.result.verdict = Verdict::WrongAnswer;
        scene.result.explanations = vec![explanation];
    }
    grade.groups.iter_mut().for_each(|group| group.visibility = Visibility::Visible);
    grade.verdict = Verdict::WrongAnswer;
    reconcile_explanations(&mut grade);
    for format in Format::ALL {
        let document = format.render(std::slice::from_ref(&grade));
        let said = if *format == Format::Csv { "loop-one-fewer" } else { "one round fewer" };
        // At a terminal and in Markdown the mistake is described once for all scenes, and in the result.
        let (least, most) = if matches!(format, Format::Text | Format::Markdown) { (2, 2) } else { (3, usize::MAX) };
        assert!((least..=most).contains(&document.matches(said).count()), "{format:?}: {document}");
        assert!(!document.contains("left empty") && !document.contains("loop-empty"), "{format:?}: {document}");
    }
    let text = Format::Text.render(&[grade]);
    assert!(text.contains("the same in 2 more scenes: Detection/b, Impulses/a"), "{text}");
    assert_eq!(text.matches("1 scene like Detection/a").count(), 2, "{text}");
}

/// Every format shows the place of a crash at the top.
#[test]
fn every_format_reports_the_common_features_of_failing_scenes() {
    let mut grade = samples::accepted_grade();
    grade.groups[0].scenes[0].result.verdict = Verdict::RuntimeError;
    grade.groups[1].visibility = Visibility::Visible;
    grade.verdict = Verdict::RuntimeError;
    grade.located_failure = Some(LocatedFailure {
        failure: FailureKind::Crash,
        features: vec![SceneFeature { family: "the failsafe moves a zone".into(), value: None }],
        failed_scenes: 24,
        scenes_with_features: 24,
        scenes_without_features: 61,
        first_scene: "Detection/a".to_owned(),
        step: 14,
    });
    let sentence = "All 24 scenes in which the failsafe moves a zone crash, and none of the 61 others.";
    for format in Format::ALL.iter().filter(|format| **format != Format::Csv) {
        let document = format.render(std::slice::from_ref(&grade));
        assert!(document.contains(sentence), "{format:?}: {document}");
    }
    assert!(csv_of_submissions(std::slice::from_ref(&grade), &[]).contains(sentence));
    assert_valid("grade.schema.json", &Format::Json.render(&[grade]));
}

#[test]
fn a_stopped_grading_has_points_in_no_format() {
    let grades = [samples::stopped_grade()];
    let json = |format: Format| -> serde_json::Value { serde_json::from_str(&format.render(&grades)).expect("JSON") };
    let own = json(Format::Json);
    assert_valid("grade.schema.json", &own.to_string());
    let grade = &own["grades"][0];
    assert_eq!((&grade["points"], &grade["groups"][0]["points"]), (&serde_json::Value::Null, &serde_json::Value::Null));
    let scene = |number: usize| &grade["groups"][0]["scenes"][number]["points"];
    assert!(scene(0).is_number() && scene(1).is_null() && scene(2).is_null(), "{grade:#}");
    // Gradescope would add up the points of the tests.
    let gradescope = json(Format::Gradescope);
    assert_valid("gradescope.schema.json", &gradescope.to_string());
    assert!(!gradescope.to_string().contains("\"score\""), "{gradescope:#}");
    let output = gradescope["output"].as_str().expect("words");
    assert!(
        output.contains("2 of 3 scenes have no result") && output.contains("14.0 s of it in scene Detection/b"),
        "{output}"
    );
    let prairielearn = json(Format::Prairielearn);
    assert_valid("prairielearn.schema.json", &prairielearn.to_string());
    assert_eq!((&prairielearn["gradable"], prairielearn.get("score")), (&serde_json::json!(false), None));
    let csv = csv_of_submissions(&grades, &[]);
    assert!(csv.lines().nth(1).expect("a row").starts_with("kim,not run,,10,1,3,"), "{csv}");
    assert!(csv.ends_with(",\n"), "nor has the group points: {csv}");
    let scenes = Format::Csv.render(&grades);
    assert!(scenes.contains("Detection/b,--,,3.33,") && scenes.contains("Detection/a,AC,3.33,3.33,"), "{scenes}");
    for format in [Format::Text, Format::Markdown] {
        let text = format.render(&grades);
        assert!(text.contains("no points yet: 2 of 3 scenes not run"), "{text}");
        // The text names the scene that was running, and counts those that were not started.
        let lines = ["  --  Detection/b", "  --  1 scene, grading was stopped\n"];
        assert!(lines.iter().all(|line| text.contains(line) == (format == Format::Text)), "{text}");
    }
}

#[test]
fn junit_follows_its_schema() {
    let document = Format::Junit.render(&all());
    insta::assert_snapshot!("grade_junit", document);
    let folder = tempfile::tempdir().expect("folder");
    let file = folder.path().join("junit.xml");
    std::fs::write(&file, &document).expect("written");
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas/junit.xsd");
    match std::process::Command::new("xmllint").arg("--noout").arg("--schema").arg(schema).arg(&file).output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => skip(Need::Xmllint, format_args!("xmllint is not here ({error})")),
    }
}

#[test]
fn text_csv_and_github_read_well() {
    insta::assert_snapshot!("grade_text", Format::Text.render(&all()));
    insta::assert_snapshot!("grade_csv", Format::Csv.render(&all()));
    insta::assert_snapshot!(
        "grade_submissions_csv",
        csv_of_submissions(&[samples::accepted_grade(), samples::accepted_grade()], &[])
    );
    insta::assert_snapshot!("grade_github", Format::Github.render(&all()));
    insta::assert_snapshot!("grade_markdown", Format::Markdown.render(&all()));
}

/// A program that has run on a hidden scene can leak it by the way in which it fails on a visible one. Students may
/// therefore see only the verdict.
#[test]
fn with_hidden_groups_students_see_nothing_that_a_program_chose() {
    let failing = |choice: u32| {
        let mut grade = samples::accepted_grade();
        let visible = &mut grade.groups[0].scenes;
        visible[0].result.verdict = Verdict::WrongAnswer;
        let kind = if choice == 1 { FindingKind::Position } else { FindingKind::Coefficient };
        visible[0].result.reason = Reason::Wrong(WrongTrace::Steps { wrong: choice.into(), first: choice, kind });
        visible[1].result.verdict = Verdict::RuntimeError;
        visible[1].result.reason = Reason::Program(ProgramProgress { limit: None, steps: choice });
        for scene in visible {
            let result = &mut scene.result;
            result.ended = Some(RunEnd::Exited(choice.cast_signed()));
            result.difference_cause = (choice == 1).then_some(Cause::AbsoluteCoefficients);
            result.right_steps = choice;
            (result.measured.cpu, result.measured.wall) =
                (Duration::from_secs(choice.into()), Duration::from_secs(choice.into()));
            result.measured.memory = Some(u64::from(choice) << 20);
            (result.stdout, result.stderr) = (format!("choice {choice}"), format!("choice {choice}"));
            result.card = Some(format!("choice {choice}"));
            scene.corrected_explanations = crate::explain::tests::explanations();
            scene.corrected_explanations.truncate(choice as usize);
        }
        grade.verdict = Verdict::RuntimeError;
        (grade.groups[0].verdict, grade.wall) = (Verdict::RuntimeError, Duration::from_secs(choice.into()));
        grade
    };
    let told = |grade: &Grade| {
        let card = |name: Option<&str>| {
            assert!(name.is_none() || grade.shows_output, "a picture");
            None
        };
        let page = GradePage { grade, card: &card, class: None, reader: Audience::Student }.html();
        let platforms = [Format::Gradescope, Format::Prairielearn].map(|format| format.render(slice::from_ref(grade)));
        [&[page], &platforms[..]].concat()
    };
    for (one, other) in told(&failing(1)).iter().zip(&told(&failing(2))) {
        assert_eq!(one, other);
        assert!(one.to_lowercase().contains("run-time error"), "{one}");
    }
    let open = |choice| Grade { shows_output: true, ..failing(choice) };
    for (one, other) in told(&open(1)).iter().zip(&told(&open(2))) {
        assert_ne!(one, other, "the suite may say so");
    }
}
