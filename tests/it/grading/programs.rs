//! Submissions that are not programs, not yet programs, or other people's programs.
use super::{SUITE, rows, workspace};
use crate::workspace::submission;
use fosssim_testing::{Need, skip};
use std::{os::unix::fs::symlink, path::Path};

#[test]
fn programs_that_cannot_run_are_explained() {
    let Some(workspace) = workspace() else { return };
    workspace.write("text", "no program");
    workspace.write("script", "#!/no/such/interpreter\n");
    for name in ["text", "script"] {
        let path = workspace.path(name);
        std::fs::set_permissions(path, std::os::unix::fs::PermissionsExt::from_mode(0o755)).expect("a mode");
    }
    workspace.write("of-windows", b"MZ\x90\0\x03\0\0\0");
    std::fs::create_dir(workspace.path("empty")).expect("a folder");
    for (program, words) in [
        ("text", "not a program"),
        ("script", "its interpreter /no/such/interpreter"),
        ("of-windows", "built for Windows"),
    ] {
        let run = workspace.run(["grade", program, "--suite", "suite.toml", "--output", "of-one", "--fresh"]);
        assert_eq!(run.code, Some(1), "{}", run.shown());
        assert!(run.out().contains("unusable submission") && run.out().contains(words), "{program}: {}", run.shown());
        let journal = std::fs::read_to_string(workspace.path("of-one/journal.jsonl")).expect("a journal");
        assert_eq!(journal, "", "{program}: nothing was run");
    }
    for (words, arguments) in [
        ("no submission at missing", vec!["grade", "missing"]),
        ("contains no submission", vec!["grade", "empty"]),
        ("there is no suite t9m9: it is neither a file nor one of", vec!["grade", "text", "--suite", "t9m9"]),
        ("no suite nowhere.toml", vec!["grade", "text", "--suite", "nowhere.toml"]),
        ("did you mean t2m2?", vec!["grade", "text", "--suite", "tm2m2"]),
        ("did you mean t1m3?", vec!["suite", "init", "t1m3x"]),
        ("did you mean gradescope?", vec!["grade", "text", "--format", "gradscope"]),
        ("did you mean pe-square-no-eh?", vec!["demo", "--mistake", "pe-square-no-he"]),
        ("did you mean namespaces?", vec!["selftest", "--without", "namespace"]),
        ("no format yaml", vec!["grade", "text", "--format", "yaml"]),
        ("only one format can go to standard output", vec!["grade", "text", "--format", "text", "--format", "csv"]),
    ] {
        let run = workspace.run(&arguments);
        assert_eq!(run.code, Some(2), "{}", run.shown());
        assert!(run.err().contains(words), "{}", run.shown());
    }
    // The class is named by a shell's pattern: one empty folder does not stop the others.
    workspace.write("of-ann/FOSSSim", b"MZ");
    let class = workspace.run(["grade", "of-ann", "empty", "--suite", "suite.toml", "--output", "of-two", "--fresh"]);
    assert!(class.out().contains("the upload has no program called FOSSSim; it is empty"), "{}", class.shown());
    workspace.write("broken.toml", "schema = 1\nname = \"x\"\n[[group]]\nname = \"g\"\nscenes = [\"asset:No/*\"]\n");
    let run = workspace.run(["suite", "check", "broken.toml"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("broken.toml:5:11: no embedded scene matches asset:No/*"), "{}", run.shown());
}

#[test]
fn sources_are_built_in_the_sandbox_and_a_failed_build_is_a_compile_error() {
    let Some(workspace) = workspace() else { return };
    if !Path::new("/usr/bin/cc").exists() {
        skip(Need::Cc, "there is no /usr/bin/cc");
        return;
    }
    let build = "[build]\ncommand = [\"cc\", \"-o\", \"FOSSSim\", \"main.c\"]\nprogram = \"FOSSSim\"\n[[group]]";
    workspace.write("build.toml", SUITE.replacen("[[group]]", build, 1));
    workspace.write("class/broken/main.c", "int main() { return undeclared; }\n");
    workspace.write("class/lazy/main.c", "int main() { return 0; }\n");
    let run = workspace.run(["grade", "class", "--suite", "build.toml", "--output", "out", "--verbose"]);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let verdicts: Vec<_> = rows(&workspace.read("out/grades.csv")).into_iter().map(|(_, verdict, _)| verdict).collect();
    assert_eq!(verdicts, ["compile error", "no output"], "{}", run.shown());
    assert!(run.out().contains("undeclared"), "the compiler's words are shown: {}", run.shown());
    assert!(!workspace.exists("class/lazy/FOSSSim"), "the submission is not changed");
}

#[test]
fn links_that_leave_a_submission_are_not_followed() {
    let Some(workspace) = workspace() else { return };
    std::fs::create_dir_all(workspace.path("class/thief")).expect("a folder");
    std::fs::create_dir_all(workspace.path("class/none")).expect("a folder");
    symlink(env!("CARGO_BIN_EXE_fosssim-sample"), workspace.path("class/thief/FOSSSim")).expect("a link");
    let run = workspace.run(["grade", "class", "--suite", "suite.toml", "--output", "out"]);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let rows = rows(&workspace.read("out/grades.csv"));
    let told: Vec<_> = rows.iter().map(|(name, verdict, points)| (&name[..], &verdict[..], &points[..])).collect();
    assert_eq!(told, [("none", "unusable submission", "0"), ("thief", "unusable submission", "0")], "{}", run.shown());
    assert!(
        run.out().contains("the program can't be used: ")
            && run.out().contains("the upload has no program called FOSSSim; it is empty"),
        "{}",
        run.shown()
    );

    if Path::new("/bin/sh").exists() {
        // A build that leaves a link to another student's program has built no program.
        let build = "[build]\ncommand = [\"sh\", \"build.sh\"]\nprogram = \"out/FOSSSim\"\n[[group]]";
        workspace.write("build.toml", SUITE.replacen("[[group]]", build, 1));
        workspace.write("secret/FOSSSim", submission("right"));
        let script = format!("ln -s {} out\n", workspace.path("secret").display());
        workspace.write("sources/thief/build.sh", script);
        let run = workspace.run(["grade", "sources", "--suite", "build.toml", "--output", "built"]);
        assert!(run.out().contains("compile error") && !run.out().contains("AC "), "{}", run.shown());
    }
}
