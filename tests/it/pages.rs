//! HTML pages as teachers and students receive them.
use crate::{grading, workspace::Workspace};
use std::path::Path;

fn text(workspace: &Workspace, file: &str) -> String {
    String::from_utf8(workspace.read(file)).expect("text")
}

/// Returns the part of a page without the style sheet and the script, which are the same on all pages.
fn body(page: &str) -> &str {
    let body = page.split_once("</style>").expect("a style sheet").1;
    body.rsplit_once("<script>").map_or(body, |(body, _)| body)
}

#[test]
fn a_class_has_a_page_each_and_an_index_and_nothing_is_run_for_them_again() {
    let Some(workspace) = grading::workspace() else { return };
    let mut words = grading::submit(&workspace, &["", "pe-square-no-eh", "response-halved"]);
    words.splice(0..0, ["grade", "--suite", "suite.toml", "--output", "class"].map(str::to_owned));
    let first = workspace.run(&words);
    assert_eq!(first.code, Some(1), "{}", first.shown());
    assert!(first.err().contains("open in a browser: class/index.html\n"), "{}", first.shown());
    let index = text(&workspace, "class/index.html");
    let links: Vec<&str> = index
        .split("<th scope=\"row\"><a href=\"")
        .skip(1)
        .map(|rest| &rest[..rest.find('"').expect("an end")])
        .collect();
    assert_eq!(links.iter().filter(|link| !link.contains('#')).count(), 3, "{links:?}");
    assert!(links.len() > 3, "scenes that fail lead to a report: {links:?}");
    for link in &links {
        let (file, card) = link.split_once('#').unwrap_or((link, ""));
        let page = text(&workspace, &format!("class/{file}"));
        assert!(page.contains("<a href=\"../index.html\">The class</a>"));
        assert!(card.is_empty() || page.contains(&format!(" id=\"{card}\"")), "{link}");
    }
    let wrong = text(&workspace, "class/reports/fosssim-sample.pe-square-no-eh.html");
    assert!(body(&wrong).contains("Likely mistake") && body(&wrong).contains("class=\"stage\""), "no motion");
    assert!(body(&wrong).contains("id=\"reference-") && body(&wrong).contains("Coefficients"), "no polynomials");
    let right = text(&workspace, "class/reports/fosssim-sample.html");
    assert!(!body(&right).contains("class=\"stage\"") && body(&right).contains("scenes accepted</summary>"));
    // All results are stored, so no program is run again, and the pages are identical.
    let again = workspace.run(&words);
    let taken = again.err().lines().find(|line| line.starts_with("reused ")).expect("a line").to_owned();
    let numbers: Vec<&str> = taken.split(' ').filter(|word| word.parse::<u32>().is_ok()).collect();
    assert_eq!(numbers.first(), numbers.get(1), "{taken}");
    assert_eq!(text(&workspace, "class/reports/fosssim-sample.pe-square-no-eh.html"), wrong);
    // Without its card, a wrong scene is run again.
    std::fs::remove_dir_all(workspace.path("class/cards")).expect("cards");
    workspace.run(&words);
    assert_eq!(text(&workspace, "class/reports/fosssim-sample.pe-square-no-eh.html"), wrong);
}

/// Tests each level of hints through the whole program.
#[test]
fn a_page_tells_no_more_than_the_hints() {
    let Some(workspace) = grading::workspace() else { return };
    let submission = grading::submit(&workspace, &["pe-square-no-eh"]).remove(0);
    let page = |hints: &str| {
        let file = format!("--format=html={hints}.html");
        let run = workspace.run(["grade", &submission, "--suite", "suite.toml", "--hints", hints, &file, "--quiet"]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
        text(&workspace, &format!("{hints}.html"))
    };
    for (hints, has) in [
        ("none", [false; 4]),
        ("where", [true, false, false, false]),
        ("what", [true, true, false, false]),
        ("full", [true; 4]),
    ] {
        let page = page(hints);
        let body = body(&page);
        let found = [
            body.contains("First difference") && body.contains("id=\"submission-"),
            body.contains("Likely mistake"),
            body.contains("id=\"reference-") || body.contains("Coefficients") || body.contains("data-plot"),
            body.contains(">expected<") || body.contains("Proof: "),
        ];
        assert_eq!(found, has, "{hints}");
        assert!(page.len() < 3_000_000, "{}", page.len());
    }
    assert!(
        !workspace.exists("cards") && !workspace.exists("fosssim-grades"),
        "a page alone leaves nothing else behind"
    );
}

#[test]
fn explain_has_a_page_too() {
    let workspace = Workspace::new();
    let trace = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/traces/flawed.bin");
    let scene = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls";
    let explain = |hints: &str| {
        let run = workspace.run([
            "explain",
            scene,
            trace.to_str().expect("a path"),
            "--format=html",
            "--output=page.html",
            "--hints",
            hints,
        ]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
        text(&workspace, "page.html")
    };
    let full = explain("full");
    assert!(body(&full).contains("Likely mistake") && body(&full).contains("id=\"reference-"), "{}", full.len());
    let what = explain("what");
    assert!(body(&what).contains("Likely mistake") && !body(&what).contains("id=\"reference-"), "{}", what.len());
    assert!(!body(&what).contains("Coefficients") && !body(&what).contains("data-plot"));
}

/// A page of a grading against recordings also has both motions, and distinguishes own errors from consequences.
#[test]
fn a_grading_against_recordings_has_its_motions() {
    let Some(workspace) = grading::workspace() else { return };
    let submission = grading::submit(&workspace, &["failsafe-angular-overwritten"]).remove(0);
    let scene = "GeometricTests/pair-becomes-rigid";
    let words = [
        "grade",
        &submission,
        "--scene",
        scene,
        "--recorded",
        "--hints",
        "full",
        "--quiet",
        "--format",
        "html=page.html",
    ];
    let run = workspace.run(words);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let page = text(&workspace, "page.html");
    let body = body(&page);
    assert!(body.contains("id=\"reference-") && body.contains("id=\"submission-"), "no motion");
    assert!(body.contains("The verdict compares with the recording"), "{body}");
    // Only one step is wrong by itself, although the recorded run differs from there on.
    assert!(body.contains(" 1 wrong by themselves, 9 right but starting from a wrong state"), "{body}");
    assert!(body.contains("Likely mistake"), "{body}");
}

/// No page for students contains a group that the suite hides from them.
#[test]
fn pages_to_hand_out_hold_no_hidden_group() {
    let Some(workspace) = grading::workspace() else { return };
    let suite = "schema = 1\nname = \"Veils\"\nhints = \"full\"\n\
        [[group]]\nname = \"Shown\"\npoints = 1\nscenes = [\"asset:ContinuousTimeTests/head-on-equal-masses\"]\n\
        [[group]]\nname = \"Veiled\"\npoints = 2\nvisibility = \"hidden\"\n\
        scenes = [\"asset:ContinuousTimeTests/spinning-edge-sweeps-balls\"]\n";
    workspace.write("veils.toml", suite);
    let mut words = grading::submit(&workspace, &["pp-contact-reversed", "pe-linear-one-ab"]);
    words.splice(0..0, ["grade", "--suite", "veils.toml", "--output", "class", "--for", "student"].map(str::to_owned));
    let run = workspace.run(&words);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    for (mistake, shown) in [("pp-contact-reversed", "wrong answer</span> "), ("pe-linear-one-ab", "accepted</span> ")]
    {
        let file = format!("fosssim-sample.{mistake}.html");
        let student = text(&workspace, &format!("class/students/{file}"));
        let staff = text(&workspace, &format!("class/reports/{file}"));
        assert!(
            staff.contains("Veiled") && staff.contains("spinning-edge-sweeps-balls") && staff.contains("index.html")
        );
        assert!(
            !student.contains("Veiled")
                && !student.contains("spinning-edge-sweeps-balls")
                && !student.contains("index.html")
        );
        assert!(student.contains(shown), "{student}");
    }
    let formats = ["text", "json", "junit", "markdown", "github", "csv", "prairielearn", "html"];
    let formats = formats.map(|format| format!("--format={format}={format}.out"));
    let formats: Vec<&str> = formats.iter().map(String::as_str).chain(["--format=text"]).collect();
    let student = ["grade", &words[7], "--suite", "veils.toml", "--for", "student"];
    let printed = workspace.run([&student[..], &formats].concat());
    let reports = || formats[..8].iter().map(|format| text(&workspace, format.rsplit('=').next().expect("a file")));
    assert_eq!(printed.code, Some(1), "{}", printed.shown());
    for report in reports().chain([printed.out(), printed.err()]) {
        assert!(!report.contains("Veiled") && !report.contains("spinning-edge-sweeps-balls"), "{report}");
        assert!(
            report.is_empty() || !report.contains("Simulation complete"),
            "what programs print may tell of hidden scenes"
        );
    }
    assert_eq!(reports().filter(|report| report.contains("are hidden")).count(), 7, "all but CSV");
    workspace.run([&student[..], &formats, &["--platform-hides"]].concat());
    assert_eq!(
        reports().filter(|report| report.contains("Veiled")).count(),
        4,
        "a platform that hides groups has them"
    );
    for (reader, runs) in [("student", "1/1\n"), ("staff", "2/2\n")] {
        let report = format!("html={reader}.html");
        let words = ["grade", &words[7], "--suite", "veils.toml", "--for", reader, "--format", &report, "--quiet"];
        workspace.run([&words[..], &["--progress", "progress", "--published-page", "published.html"]].concat());
        assert_eq!(text(&workspace, "progress"), runs, "a count tells of no hidden scene");
    }
    assert!(!text(&workspace, "student.html").contains("Veiled"));
    // When the pages are published, students see the points of all groups, and what the hints allow.
    let published = text(&workspace, "published.html");
    assert!(published.contains("Veiled") && published.contains(" of 3 points"), "{published}");
}

/// A smallest scene is made only from a scene that students may see, and its hints apply.
#[test]
fn smallest_scenes_tell_students_what_their_group_does() {
    let Some(workspace) = grading::workspace() else { return };
    let suite = "schema = 1\nname = \"Veils\"\nshow_output = true\n\
        [[group]]\nname = \"Shown\"\nhints = \"what\"\nscenes = [\"asset:ContinuousTimeTests/head-on-equal-masses\"]\n\
        [[group]]\nname = \"Veiled\"\nvisibility = \"hidden\"\n\
        scenes = [\"asset:ContinuousTimeTests/spinning-edge-sweeps-balls\"]\n";
    workspace.write("veils.toml", suite);
    let submissions = grading::submit(&workspace, &["pp-contact-reversed", "pe-linear-one-ab"]);
    let words = ["grade", &submissions[0], &submissions[1], "--suite", "veils.toml", "--smallest", "--output", "class"];
    let run = workspace.run(words);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let tells = |file: &str| {
        let page = text(&workspace, file);
        ["The smallest scene: ", "&lt;particle ", "By hand"].map(|words| body(&page).contains(words))
    };
    let [seen, unseen] = ["pp-contact-reversed", "pe-linear-one-ab"].map(|name| format!("fosssim-sample.{name}.html"));
    for page in [&seen, &unseen] {
        assert_eq!(tells(&format!("class/reports/{page}")), [true; 3]);
    }
    assert_eq!(tells(&format!("class/students/{seen}")), [true, true, false]);
    assert_eq!(tells(&format!("class/students/{unseen}")), [false; 3], "it comes from a hidden scene");
    let lines = text(&workspace, "class/grades.jsonl");
    assert_eq!(lines.lines().filter(|line| line.contains("\"smallest\":[{\"origin\":")).count(), 2);
    assert!(lines.contains("\"worth\":[1.0]"), "{lines:.2000}");
    // Where the suite hides program output, students get none.
    workspace.write("veils.toml", text(&workspace, "veils.toml").replace("show_output = true", ""));
    let run = workspace.run([&words[..], &["--fresh"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.shown());
    assert_eq!(
        (tells(&format!("class/students/{seen}"))[0], tells(&format!("class/reports/{seen}"))[0]),
        (false, true)
    );
}

/// Staff see the numbers of every scene. Students see what the suite allows, group by group. The assignment's own
/// `--hints` changes nothing for staff.
#[test]
fn staff_sees_everything_beside_pages_for_students() {
    let Some(workspace) = grading::workspace() else { return };
    let group = |name: &str, hints: &str, scene: &str| {
        format!("[[group]]\nname = \"{name}\"\nhints = \"{hints}\"\nscenes = [\"asset:{scene}\"]\n")
    };
    let told = "ContinuousTimeTests/spinning-edge-sweeps-balls";
    let untold = "ImpulsesTests/off-centre-on-turning-edge";
    let suite = group("Told", "full", told) + &group("Untold", "none", untold);
    workspace.write("groups.toml", format!("schema = 1\nname = \"Groups\"\n{suite}"));
    let submission = grading::submit(&workspace, &["pe-square-no-eh"]).remove(0);
    let numbers = |page: &str| {
        let articles = page.split("<article ").skip(1).map(|article| {
            let scene = article.split_once("data-scene=\"").expect("a name").1.split_once('"').expect("its end").0;
            (scene.to_owned(), article.contains("id=\"reference-") && article.contains("Coefficients"))
        });
        articles.collect::<std::collections::BTreeMap<_, _>>()
    };
    let both = |told_is: bool, untold_is: bool| [(told.to_owned(), told_is), (untold.to_owned(), untold_is)].into();
    let words = ["grade", &submission, "--suite", "groups.toml", "--for", "student", "--quiet"];
    let files = ["--format", "html=student.html", "--staff-page", "staff.html"];
    let run = workspace.run([&words[..], &files].concat());
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let (student, staff) = (text(&workspace, "student.html"), text(&workspace, "staff.html"));
    assert_eq!((numbers(&student), numbers(&staff)), (both(true, false), both(true, true)));
    let run = workspace.run([&words[..], &files, &["--hints", "where"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let (student, staff) = (text(&workspace, "student.html"), text(&workspace, "staff.html"));
    assert_eq!((numbers(&student), numbers(&staff)), (both(false, false), both(true, true)));
    // The class is graded for staff first, and then again with pages for students.
    for reader in ["staff", "student"] {
        let run = workspace.run(["grade", &submission, "--suite", "groups.toml", "--output", "out", "--for", reader]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
        assert_eq!(numbers(&text(&workspace, "out/report.html")), both(true, true), "{reader}");
    }
    let name = Path::new(&submission).file_name().expect("a name").to_string_lossy().into_owned();
    assert_eq!(numbers(&text(&workspace, &format!("out/students/{name}.html"))), both(true, false));
}

/// A course's page for browsers contains the course's suite, but nothing that the suite hides.
#[test]
fn a_course_s_page_for_browsers_holds_nothing_that_its_suite_hides_from_its_readers() {
    let workspace = Workspace::new();
    let scene = |words: &str| format!("{}<!-- {words} -->\n", fosssim_testing::scenes::ALL_KINDS);
    for (name, words) in [("seen/[a]", "in the open"), ("kept/b", "behind the curtain"), ("late/c", "for later")] {
        std::fs::create_dir_all(workspace.path(name).parent().expect("a folder")).expect("made");
        workspace.write(format!("{name}.xml"), scene(words));
    }
    let suite = "schema = 1\nname = \"A \\\"course\\\"\"\n# the secret is a sum\n\
        [[group]]\nname = \"Open\"\npoints = 3\nscenes = [\"seen/*.xml\", \
        \"asset:GeometricTests/pair-becomes-rigid\"]\n\
        [[group]]\nname = \"Curtain\"\nvisibility = \"hidden\"\nscenes = [\"kept/*.xml\"]\n\
        [[group]]\nname = \"Later\"\nvisibility = \"after_due_date\"\nscenes = [\"late/*.xml\"]\n";
    workspace.write("suite.toml", suite);
    workspace.write("module.wasm", b"\0asm\x01\0\0\0");
    let page = |reader: &[&str]| {
        let words = ["page", "--module", "module.wasm", "--suite", "suite.toml", "--output", "page.html"];
        let run = workspace.run(words.iter().chain(reader));
        assert_eq!(run.code, Some(0), "{}", run.shown());
        text(&workspace, "page.html")
    };
    let open =
        ["in the open", "Open", "A \\\\\\\"course", "seen/[[]a[]].xml", "asset:GeometricTests/pair-becomes-rigid"];
    let hidden = ["behind the curtain", "Curtain", "kept/b", "for later", "Later", "late/c"];
    for reader in [&[][..], &["--for", "student"]] {
        let page = page(reader);
        assert!(open.iter().all(|words| page.contains(words)), "{reader:?}");
        assert!(!hidden.iter().any(|words| page.contains(words)) && !page.contains("the secret"), "{reader:?}");
    }
    let staff = page(&["--for", "staff"]);
    assert!(open.iter().chain(&hidden).all(|words| staff.contains(words)));
    workspace.write("suite.toml", suite.replace("points = 3", "visibility = \"hidden\""));
    let run = workspace.run(["page", "--module", "module.wasm", "--suite", "suite.toml", "--output", "none.html"]);
    assert!(run.code == Some(2) && run.err().contains("hides all its groups"), "{}", run.shown());
}
