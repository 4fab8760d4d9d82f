//! Autograders of platforms, each in the folder layout of its platform.
use super::{SUITE, submit, workspace};
use crate::workspace::{Run, Workspace, finish, submission};
use fosssim_testing::{Need, skip};
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::Command,
};

/// Returns a workspace if the sandbox, bash and Python are available.
fn with_python() -> Option<Workspace> {
    let workspace = workspace()?;
    if Command::new("python3").arg("--version").output().is_err() {
        skip(Need::Python, "there is no python3");
        return None;
    }
    Some(workspace)
}

fn script(name: &str) -> Command {
    let mut command = Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("integrations").join(name));
    command.env_clear().env("PATH", std::env::var_os("PATH").unwrap_or_default());
    command
}

fn executable(path: &Path) {
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("a mode");
}

#[test]
fn the_gradescope_zip_works_in_its_layout() {
    let Some(workspace) = with_python() else { return };
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut build = script("gradescope/build");
    build.arg(workspace.path("autograder.zip")).args(["--binary", env!("CARGO_BIN_EXE_fosssim-oracle")]);
    build.args(["--suite".as_ref(), workspace.path("suite.toml").as_os_str()]);
    let built = finish(&mut build);
    assert_eq!(built.code, Some(0), "{}", built.shown());
    let layout = workspace.path("autograder");
    for folder in ["source", "submission", "results"] {
        fs::create_dir_all(layout.join(folder)).expect("a folder");
    }
    let mut unzip = Command::new("python3");
    unzip.args(["-m", "zipfile", "-e"]).arg(workspace.path("autograder.zip")).arg(layout.join("source"));
    assert!(unzip.status().expect("python3").success());
    let run_autograder = || {
        let mut run = Command::new("bash");
        run.arg(layout.join("source/run_autograder")).env_clear().env("PATH", &path).env("AUTOGRADER_ROOT", &layout);
        let run = finish(run.current_dir(&layout));
        let results = fs::read(layout.join("results/results.json")).expect("results whatever happens");
        (run, serde_json::from_slice::<serde_json::Value>(&results).expect("JSON"))
    };
    // Python's `unzip` drops permission bits; Gradescope keeps them.
    for program in ["fosssim-oracle", "grade"] {
        executable(&layout.join("source").join(program));
    }

    let (run, results) = run_autograder();
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert_eq!(results["score"], 0.0, "no program was submitted: {results}");
    assert_eq!(results.to_string().matches("the upload has no program called FOSSSim").count(), 1, "{results}");
    fs::write(layout.join("submission/FOSSSim"), submission("right")).expect("a submission");
    let (run, results) = run_autograder();
    assert_eq!(run.code, Some(0), "{}", run.shown());
    assert_eq!(results["score"], 20.0, "{results}");
    fs::write(layout.join("source/suite/suite.toml"), "nonsense").expect("a broken suite");
    let (run, results) = run_autograder();
    assert_eq!(run.code, Some(1), "our own fault is no grading");
    assert!(results.get("score").is_none(), "{results}");
}

/// Runs PrairieLearn's entry point in its layout, `/grade`, and reads the results.
fn grade_for_prairielearn(root: &Path) -> (Run, serde_json::Value) {
    let mut run = Command::new(root.join("serverFilesCourse/fosssim/run.sh"));
    let path = std::env::var_os("PATH").unwrap_or_default();
    let run = finish(run.env_clear().env("PATH", path).env("GRADE_ROOT", root).current_dir(root));
    let results = fs::read(root.join("results/results.json")).expect("results whatever happens");
    (run, serde_json::from_slice(&results).expect("JSON"))
}

#[test]
fn the_question_for_prairielearn_works_in_its_layout() {
    let Some(workspace) = with_python() else { return };
    let course: PathBuf = workspace.path("course");
    let build = || {
        let mut build = script("prairielearn/build");
        build.arg(&course).args(["--binary", env!("CARGO_BIN_EXE_fosssim-oracle")]);
        finish(build.args(["--suite".as_ref(), workspace.path("suites/course.toml").as_os_str()]))
    };
    let refused = build();
    assert!(refused.code == Some(2) && refused.err().contains("infoCourse.json"), "{}", refused.shown());
    workspace.write("course/infoCourse.json", "{}");
    workspace.write("suites/course.toml", SUITE);
    assert_eq!(build().code, Some(0));
    let info = fs::read(course.join("questions/fosssim/info.json")).expect("a question");
    let read: serde_json::Value = serde_json::from_slice(&info).expect("JSON");
    let entry = read["externalGradingOptions"]["entrypoint"].as_str().expect("an entry point");
    assert_eq!(entry, "/grade/serverFilesCourse/fosssim/run.sh");
    assert_eq!(build().code, Some(0), "made again");
    assert_eq!(
        fs::read(course.join("questions/fosssim/info.json")).expect("a question"),
        info,
        "it keeps its identity"
    );

    // PrairieLearn copies the course's files and the upload, which has lost its mode.
    let root = workspace.path("grade");
    fs::create_dir_all(root.join("student")).expect("a folder");
    let copied = Command::new("cp").arg("-r").arg(course.join("serverFilesCourse")).arg(&root).status();
    assert!(copied.expect("cp").success());
    let (run, results) = grade_for_prairielearn(&root);
    assert_eq!((run.code, &results["gradable"]), (Some(0), &false.into()), "no program was uploaded: {results}");
    fs::write(root.join("student/FOSSSim"), submission("right")).expect("an upload");
    let (run, results) = grade_for_prairielearn(&root);
    assert_eq!((run.code, &results["score"]), (Some(0), &1.0.into()), "{results}");
    fs::write(root.join("serverFilesCourse/fosssim/suite/suite.toml"), "nonsense").expect("a broken suite");
    let (run, results) = grade_for_prairielearn(&root);
    assert_eq!((run.code, &results["gradable"]), (Some(1), &false.into()), "our own fault costs no attempt: {results}");
}

/// PrairieLearn calls the element's controller in the element's folder.
const RENDER: &str = "\
import importlib.util, json, sys
spec = importlib.util.spec_from_file_location('element', 'fosssim-report.py')
element = importlib.util.module_from_spec(spec)
spec.loader.exec_module(element)
print(element.render('<fosssim-report></fosssim-report>', json.loads(sys.argv[1])), end='')
";

#[test]
fn the_element_for_prairielearn_shows_groups_scenes_and_the_mistake_and_nothing_hidden() {
    let Some(workspace) = with_python() else { return };
    let chevron = Command::new("python3").args(["-c", "import chevron"]).output().expect("python3");
    if !chevron.status.success() {
        return skip(Need::Chevron, "python3 has no chevron");
    }
    workspace.write("course/infoCourse.json", "{}");
    let mut build = script("prairielearn/build");
    build.arg(workspace.path("course")).args(["--binary", env!("CARGO_BIN_EXE_fosssim-oracle")]);
    assert_eq!(finish(&mut build).code, Some(0));
    let element = workspace.path("course/elements/fosssim-report");
    let info: serde_json::Value =
        serde_json::from_slice(&fs::read(element.join("info.json")).expect("an element")).expect("JSON");
    assert!(element.join(info["controller"].as_str().expect("a controller")).exists());
    let question = fs::read_to_string(workspace.path("course/questions/fosssim/question.html")).expect("a question");
    assert!(question.contains("<fosssim-report></fosssim-report>"), "{question}");

    let render = |panel: &str, feedback: serde_json::Value| {
        let data = serde_json::json!({"panel": panel, "feedback": feedback}).to_string();
        let run = finish(Command::new("python3").args(["-c", RENDER, &data]).current_dir(&element));
        assert_eq!(run.code, Some(0), "{}", run.shown());
        run.out()
    };
    let program = &submit(&workspace, &["pe-square-no-eh"])[0];
    let veiled = "[[group]]\nname = \"Veiled\"\npoints = 5\nvisibility = \"hidden\"\n\
                  scenes = [\"asset:ContinuousTimeTests/spinning-edge-sweeps-balls\"]\n";
    for (hidden, message) in [("", ">wrong answer<"), (veiled, "on the tests shown here (")] {
        workspace.write("suite.toml", SUITE.replace("\"Zones\"", "\"<i>Zones\"") + hidden);
        workspace.run(["grade", program, "--suite", "suite.toml", "--format", "prairielearn=results.json"]);
        let results: serde_json::Value = serde_json::from_slice(&workspace.read("results.json")).expect("JSON");
        let shown = render("submission", serde_json::json!({"succeeded": true, "results": results}));
        for words in
            [message, "most likely mistake: Particle-edge: ", "of 10<", "&lt;i&gt;Zones", "ImpulsesTests/off-centre"]
        {
            assert!(shown.contains(words), "{words}: {shown}");
        }
        assert!(!shown.contains("Veiled") && !shown.contains("spinning-edge") && !shown.contains("<i>"), "{shown}");
        assert_eq!(render("question", serde_json::json!({"succeeded": true, "results": results})), "");
    }
    assert_eq!(render("submission", serde_json::json!({})), "", "not graded yet");
    let failed = render("submission", serde_json::json!({"succeeded": false, "message": "out of <memory>"}));
    assert!(failed.contains("out of &lt;memory&gt;"), "{failed}");
}

#[test]
fn the_action_for_github_writes_summary_report_and_points() {
    let Some(workspace) = with_python() else { return };
    for (mistake, code, points) in [("right", 0, "points=20"), ("pe-square-no-eh", 1, "points=")] {
        let program = workspace.path("FOSSSim");
        fs::write(&program, submission(mistake)).expect("a program");
        executable(&program);
        let mut action = script("github/grade");
        let here = Path::new(env!("CARGO_BIN_EXE_fosssim-oracle")).parent().expect("a folder");
        let path = format!("{}:{}", here.display(), std::env::var("PATH").unwrap_or_default());
        action.env("PATH", path).env("FOSSSIM_SUBMISSION", &program).env("FOSSSIM_SUITE", "suite.toml");
        action.env("GITHUB_STEP_SUMMARY", workspace.path("summary")).env("GITHUB_OUTPUT", workspace.path("output"));
        workspace.write("output", "");
        let run = finish(action.current_dir(workspace.path("")));
        assert_eq!(run.code, Some(code), "{}", run.shown());
        let output = String::from_utf8(workspace.read("output")).expect("text");
        assert!(output.starts_with(points) && output.contains("\nreport=fosssim-grades/report.html\n"), "{output}");
        assert_eq!(run.out().contains("::error"), code == 1, "annotations: {}", run.shown());
        assert!(!workspace.read("summary").is_empty() && workspace.exists("fosssim-grades/report.html"));
    }
    // The script of the action exists, and reads exactly the action's inputs.
    let action = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("action.yml")).expect("the action");
    for name in ["integrations/github/grade", "FOSSSIM_SUBMISSION", "FOSSSIM_SUITE", "FOSSSIM_OUTPUT"] {
        assert!(action.contains(name), "{name}");
    }
}
