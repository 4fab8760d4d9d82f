use super::*;

#[test]
fn the_template_is_a_valid_suite() {
    let template = suite_template("t2m2").expect("a template");
    let suite = read(&template).expect("sound");
    assert_eq!((suite.limits, suite.skip_limits), (RunLimits::default(), SkipLimits::default()));
    assert_eq!(suite.command, default_command());
    assert_eq!(suite.rules, Rules::Fair);
    let without = template.replacen("rules = \"fair\"\n", "", 1);
    assert_eq!(read(&without).expect("sound").rules, Rules::Fair, "the default");
    assert!(!suite.groups.is_empty());
}

#[test]
fn many_problems_of_a_long_line_are_reported_together() {
    let text = format!("name = \"{}\"\nrun = [{}]\nlast = 1\n", "ü".repeat(9), "[], ".repeat(100_000));
    let problems = read(&text).expect_err("wrong").problems;
    let at = |index: usize| problems[index].0.to_string();
    assert_eq!((at(2), at(100_001), at(100_002)), ("2:8".into(), "2:400004".into(), "3:1".into()));
}

#[test]
fn every_problem_is_reported_with_its_position() {
    let text = "schema = 2\nname = \"\"\nrules = \"kind\"\nrun = [\"sh\", \"{scene}\"]\n[limits]\ncpu_seconds = -1.0\n\
                [[group]]\nname = \"a\"\nscenes = []\npoints = -5.0\n";
    insta::assert_snapshot!(read(text).expect_err("wrong"), @r#"
    1:10: schema 2 is not known: this version reads schema 1
    2:8: the suite's name is empty
    3:9: rules "kind" is unknown; choose "parity", "fair" or "both"
    4:7: run has no {program}, so the program would not get it; add it
    4:7: run has no {trace}, so the program would not get it; add it
    4:7: run must begin with {program}
    6:15: cpu_seconds is -1: it must be between 0.01 and 86400
    9:10: group "a" has no scenes
    10:10: points is -5: it must be between 0 and 1000000
    "#);
}

#[test]
fn a_course_s_own_words_have_a_known_key_and_an_address() {
    let text = |key: &str, link: &str| {
        format!(
            "schema = 1\nname = \"a\"\n[[mistake]]\nkey = \"{key}\"\nlink = \"{link}\"\npoints = 2\n\
             [[group]]\nname = \"b\"\nscenes = [\"asset:*\"]\ntext = \"Section 3.\"\n"
        )
    };
    let suite = read(&text("pp-no-two", "https://example.edu/9")).expect("a suite");
    assert_eq!(suite.notes["pp-no-two"].to_string(), "https://example.edu/9; rubric points: 2");
    assert_eq!(suite.groups[0].note.as_ref().expect("a note").to_string(), "Section 3");
    let error = read(&text("pp-no-tow", "javascript:alert(1)")).unwrap_err().to_string();
    assert!(error.contains("4:7: no mistake has the key \"pp-no-tow\"; did you mean \"pp-no-two\"?"), "{error}");
    for key in ["term-missing", "letter", "stage-order", "all-zero"] {
        assert!(read(&text(key, "https://example.edu")).is_ok(), "{key}");
    }
    let unknown = read(&text("no-such-slip", "https://example.edu")).unwrap_err().to_string();
    assert!(unknown.contains("no mistake has the key \"no-such-slip\"; `fosssim-oracle sample --list`"), "{unknown}");
    assert!(error.contains("5:8: link must be a URL that begins with https:// or http://"), "{error}");
}

#[test]
fn misspelt_keys_are_named_with_what_was_meant() {
    let error = read("schema = 1\nnmae = \"x\"\n").expect_err("wrong").to_string();
    assert!(error.contains("2:1: unknown key `nmae` in the suite: did you mean `name`?"), "{error}");
}

#[test]
fn unknown_keys_and_bad_values_are_reported_together() {
    let text = "schema = \"1\"\nname = \"x\"\nrules = \"Fair!\"\nhints = \"half\"\nshow_output = 1\ncpu_seconds = 3\n\
                run = \"{program}\"\n[limits]\ncpu-second = 1\nmemory_mib = \"512\"\nfiles = nan\n[build]\n\
                comand = [\"make\"]\nprogram = \"../x\"\n[[group]]\nnam = \"a\"\nscenes = [\"asset:No/*\", 3]\n\
                credit = \"step\"\n[[group]]\nname = \"b\"\nscenes = []\npoints = -1\nweight = 2\n";
    let error = read(text).expect_err("wrong");
    let told = error.to_string();
    for line in [
        "1:10: schema must be a whole number that is not negative, not a string",
        "3:9: rules \"Fair!\" is unknown; choose \"parity\", \"fair\" or \"both\"; did you mean \"fair\"?",
        "4:9: hints \"half\" is unknown; choose \"none\", \"where\", \"what\" or \"full\"",
        "5:15: show_output must be true or false, not an integer",
        "6:1: unknown key `cpu_seconds` in the suite: it belongs in [limits]",
        "7:7: run must be a list of texts, [\"...\"], not a string",
        "9:1: unknown key `cpu-second` in [limits]: did you mean `cpu_seconds`?",
        "10:14: memory_mib must be a number, not a string",
        "11:9: files is NaN: it must be between 1 and 1000000",
        "13:1: unknown key `comand` in [build]: did you mean `command`?",
        "build.program \"../x\" must be a path inside the submission's folder",
        "16:1: unknown key `nam` in this [[group]]: did you mean `name`?",
        "17:25: each of scenes must be a text in quotes, not an integer",
        "18:10: credit \"step\" is unknown; choose \"scenes\", \"steps\" or \"all\"; did you mean \"steps\"?",
        "21:10: group \"b\" has no scenes",
        "22:10: points is -1: it must be between 0 and 1000000",
        "23:1: unknown key `weight` in this [[group]]: the keys are name, scenes, points, extra, credit",
    ] {
        assert!(told.contains(line), "{line}\n{told}");
    }
    assert_eq!(error.problems.len(), 17, "and nothing else: {told}");
}

#[test]
fn broken_lines_are_reported_without_their_consequences() {
    let error = read("schema = 1\nname = \n[[group]]\nscenes = [\"a\"\n").expect_err("wrong");
    assert!(error.problems.iter().all(|(at, _)| at.line >= 2), "{error}");
    assert!(!error.to_string().contains("no [[group]]"), "{error}");
    assert!(read("").expect_err("empty").to_string().contains("no [[group]]"));
    // An integer that no reader accepts is out of its range, and the rest of the suite is still read.
    let large = "schema = 1\nname = \"a\"\n[[group]]\nname = \"b\"\nscenes = [\"a\"]\npoints = 99999999999999999999\n";
    let told = read(large).expect_err("too many").to_string();
    assert!(
        told.contains("6:10: points is 100000000000000000000: it must be between") && !told.contains("[["),
        "{told}"
    );
}
