//! `check`: reports on right, wrong and damaged traces.
mod streams;

use super::{
    schemas,
    workspace::{BEAM, BOUNCE, DRIFT, Run, Workspace, finish, trace_of},
};
use fosssim_oracle::{
    judge::{Rules, replay},
    report::{
        check::{Check, WrongSteps},
        style::Style,
    },
    scene,
    trace::{Frame, Layout, Reader, Writer},
};
use serde_json::Value;
/// Returns the report on `trace` for `scene`, as text and as JSON, checked against its schema.
fn reports(scene: &str, trace: &[u8]) -> (Run, Value) {
    let workspace = Workspace::new();
    workspace.write("scene.xml", scene);
    workspace.write("trace.bin", trace);
    let text = workspace.run(["check", "scene.xml", "trace.bin"]);
    let json = workspace.run(["check", "scene.xml", "trace.bin", "--format", "json"]);
    assert_eq!(text.code, json.code);
    (text, schemas::valid("check", &json.stdout))
}

/// Returns the reference trace of a scene with changed frames.
fn changed(scene: &str, change: impl FnOnce(&mut Vec<Frame>)) -> Vec<u8> {
    let layout = Layout::for_scene(&scene::read("scene", scene.as_bytes()).unwrap().scene);
    let trace = trace_of(scene);
    let mut reader = Reader::from_slice(&trace, layout);
    let mut frames = Vec::new();
    let mut frame = Frame::default();
    while reader.next(&mut frame).unwrap() {
        frames.push(frame.clone());
    }
    change(&mut frames);
    let mut writer = Writer::new(Vec::new(), layout);
    frames.iter().for_each(|frame| writer.write_frame(frame));
    writer.finish().unwrap().0
}

/// Changes the first coefficient of polynomial `index`.
fn scale(frame: &mut Frame, index: usize, factor: f64) {
    let log = std::mem::take(&mut frame.polynomials);
    for (number, coefficients) in log.iter().enumerate() {
        let mut coefficients = coefficients.to_vec();
        if number == index {
            coefficients[0] *= factor;
        }
        frame.polynomials.push(&coefficients);
    }
}

#[test]
fn a_right_trace_is_accepted() {
    let (text, json) = reports(BOUNCE, &trace_of(BOUNCE));
    insta::assert_snapshot!("accepted", text.shown());
    insta::assert_snapshot!("accepted_json", format!("{json:#}"));
}

#[test]
fn a_wrong_coefficient_is_shown_side_by_side() {
    let trace = changed(BOUNCE, |frames| scale(&mut frames[2], 0, 2.0));
    let (text, json) = reports(BOUNCE, &trace);
    insta::assert_snapshot!("wrong_coefficient", text.shown());
    insta::assert_snapshot!("wrong_coefficient_json", format!("{json:#}"));
}

#[test]
fn unmatched_collisions_are_distinguished() {
    let missed = changed(BOUNCE, |frames| frames[2].impulses.clear());
    insta::assert_snapshot!("missed_collision", reports(BOUNCE, &missed).0.shown());
    let superfluous = changed(BOUNCE, |frames| {
        let mut impulse = frames[2].impulses[0];
        impulse.kind = 1;
        frames[2].impulses.push(impulse);
        impulse.kind = 77;
        frames[2].impulses.push(impulse);
    });
    insta::assert_snapshot!("superfluous_collision", reports(BOUNCE, &superfluous).0.shown());
    let normal = changed(BOUNCE, |frames| frames[2].impulses[0].normal.x = 0.125);
    insta::assert_snapshot!("wrong_normal", reports(BOUNCE, &normal).0.shown());
}

#[test]
fn polynomials_of_another_number_or_size_are_distinguished() {
    let fewer = changed(BEAM, |frames| frames[2].polynomials.clear());
    insta::assert_snapshot!("too_few_polynomials", reports(BEAM, &fewer).0.shown());
    let more = changed(BEAM, |frames| {
        for polynomial in frames[2].polynomials.clone().iter() {
            frames[2].polynomials.push(polynomial);
        }
    });
    insta::assert_snapshot!("too_many_polynomials", reports(BEAM, &more).0.shown());
    let degree = changed(BOUNCE, |frames| {
        frames[2].polynomials.clear();
        frames[2].polynomials.push(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        frames[2].polynomials.push(&[-0.25, 0.25]);
    });
    insta::assert_snapshot!("wrong_degree", reports(BOUNCE, &degree).0.shown());
}

#[test]
fn states_that_differ_raise_residuals() {
    let trace = changed(DRIFT, |frames| {
        frames[3].state.positions[0] += 1e-3;
        frames[3].state.velocities[1] = -0.5;
    });
    let (text, json) = reports(DRIFT, &trace);
    insta::assert_snapshot!("wrong_state", text.shown());
    insta::assert_snapshot!("wrong_state_json", format!("{json:#}"));
}

#[test]
fn not_a_number_is_written_as_a_string() {
    let trace = changed(DRIFT, |frames| frames[4].state.positions[0] = f64::NAN);
    let (text, json) = reports(DRIFT, &trace);
    assert_eq!(text.code, Some(1));
    assert!(matches!(json["parity"]["accumulated_position_residual"].as_str(), Some("nan" | "-nan")), "{json:#}");
}

#[test]
fn a_step_without_result_is_a_wrong_answer() {
    let trace = changed(BEAM, |frames| frames[0].state.positions[4] = f64::NAN);
    let (text, json) = reports(BEAM, &trace);
    assert_eq!((text.code, json["problem"]["kind"].as_str()), (Some(1), Some("step_without_result")), "{json:#}");
    insta::assert_snapshot!("step_without_result", text.shown());
    assert_eq!(json["verdict"], "wrong answer", "the trace can be read to its end");
    let trace = changed(BEAM, |frames| frames[2].state.velocities[5] = f64::INFINITY);
    let (text, _) = reports(BEAM, &trace);
    assert!(text.out().contains("particle 2 ends with velocity ("), "{}", text.shown());
}

#[test]
fn colors_only_decorate() {
    let scene = scene::read("scene", BOUNCE.as_bytes()).unwrap().scene;
    let trace = changed(BOUNCE, |frames| scale(&mut frames[2], 0, 2.0));
    let outcome = replay::judge(&scene, &trace[..], &replay::Options::default(), &mut ());
    let steps = &WrongSteps::default();
    let (explanations, rules) = (&[][..], Rules::Both);
    let check = Check { scene: "s", trace: "t", outcome: &outcome, explanations, rules, steps, other_file_kind: None };
    let colored = check.render_text(Style::Color);
    let mut plain = String::new();
    for piece in colored.split('\x1b') {
        // The text before the first piece has no color code.
        plain += if plain.is_empty() && !colored.starts_with('\x1b') {
            piece
        } else {
            piece.split_once('m').map_or("", |(_, text)| text)
        };
    }
    assert_ne!(colored, plain);
    assert_eq!(check.render_text(Style::Plain), plain);
}

/// The bytes may end inside the last list of a record.
#[test]
fn a_record_that_is_cut_does_not_count() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    let trace = trace_of(BOUNCE);
    // This keeps the positions, velocities and impulses, and all but one byte of the polynomials.
    workspace.write("cut.bin", &trace[..163]);
    let check = workspace.run(["check", "scene.xml", "cut.bin"]);
    assert!(check.out().contains("the trace ends after 1 record, but this scene's trace has 5"), "{}", check.shown());
}

#[test]
fn damaged_traces_are_bad_traces_with_a_position() {
    let trace = trace_of(BOUNCE);
    let cut = |length: usize| trace[..length].to_vec();
    let with = |at: usize, bytes: &[u8]| {
        let mut trace = trace.clone();
        trace[at..at + bytes.len()].copy_from_slice(bytes);
        trace
    };
    for (name, damaged) in [
        ("empty", cut(0)),
        ("cut_in_initial_state", cut(20)),
        ("cut_in_state", cut(50)),
        ("cut_before_record", cut(164)),
        ("cut_in_impulses", cut(100)),
        ("huge_impulse_count", with(72, &i32::MAX.to_le_bytes())),
        ("huge_polynomial_count", with(112, &i32::MAX.to_le_bytes())),
    ] {
        let (text, json) = reports(BOUNCE, &damaged);
        assert_eq!((text.code, json["verdict"].as_str()), (Some(1), Some("bad trace")), "{name}");
        insta::assert_snapshot!(name, text.shown());
    }
}

#[test]
fn input_that_the_original_ignores_is_recorded() {
    let trace = trace_of(BOUNCE);
    let trailing = [&trace[..], b"more"].concat();
    insta::assert_snapshot!("trailing_bytes", reports(BOUNCE, &trailing).0.shown());
    // The coefficients of the last polynomial share their last byte, so the original does not notice the difference.
    let shorter = &trace[..trace.len() - 1];
    insta::assert_snapshot!("last_byte_missing", reports(BOUNCE, shorter).0.shown());
    let mut negative = trace;
    negative[36..40].copy_from_slice(&(-5_i32).to_le_bytes());
    insta::assert_snapshot!("negative_count", reports(BOUNCE, &negative).0.shown());
}

#[test]
fn every_cut_ends_with_a_report() {
    let trace = trace_of(BOUNCE);
    for length in 0..trace.len() {
        let workspace = Workspace::new();
        workspace.write("scene.xml", BOUNCE);
        workspace.write("trace.bin", &trace[..length]);
        let run = workspace.run(["check", "scene.xml", "trace.bin", "--format", "json"]);
        let json: Value = serde_json::from_slice(&run.stdout).unwrap_or_else(|_| panic!("{length}: {}", run.shown()));
        let placed = json["problem"]["offset"].is_u64() || json["damage"]["offset"].is_u64();
        // One length is that of a trace with states only, so the report contains a remark about it.
        let only_remark = run.err().is_empty() || run.err().contains("only positions and velocities");
        assert!(placed && only_remark, "{length}: {}", run.shown());
    }
}

#[test]
fn another_scenes_trace_is_not_accepted() {
    for (scene, trace) in [(BOUNCE, BEAM), (BEAM, BOUNCE), (BOUNCE, DRIFT), (DRIFT, BOUNCE), (BEAM, DRIFT)] {
        let (text, json) = reports(scene, &trace_of(trace));
        assert_eq!(text.code, Some(1), "{json:#}");
    }
}

#[test]
fn inputs_that_cannot_be_used_are_our_side_of_the_counter() {
    let workspace = Workspace::with_trace(BOUNCE);
    workspace.write("folder/inside", "");
    for (name, arguments) in [
        ("missing_scene", ["check", "nowhere.xml", "trace.bin"]),
        ("missing_trace", ["check", "scene.xml", "nowhere.bin"]),
        ("scene_is_a_folder", ["check", "folder", "trace.bin"]),
        ("trace_is_a_folder", ["check", "scene.xml", "folder"]),
        ("unknown_asset", ["check", "asset:Nowhere/nothing", "trace.bin"]),
        ("not_a_scene", ["check", "trace.bin", "trace.bin"]),
    ] {
        let run = workspace.run(arguments);
        assert_eq!((run.code, run.stdout.len()), (Some(2), 0), "{name}");
        insta::assert_snapshot!(name, run.shown());
    }
}

#[test]
fn all_errors_of_a_scene_are_reported_at_once() {
    let workspace = Workspace::with_trace(BOUNCE);
    let scene = "<scene>\n\t<duration time=\"abc\"/>\n  <integrator type=\"explicit\" dt=\"0\"/>\n  <collision \
                 type=\"none\" COR=\"x\"/>\n  <particle m=\"-1\" px=\"0\"/>\n <edge i=\"0\" j=\"9\"/><foo/>\n\
                 <halfplane px=\"0\" py=\"0\" nx=\"0\" ny=\"0\"/>\n</scene>\n";
    workspace.write("bad.xml", scene);
    insta::assert_snapshot!("scene_errors", workspace.run(["check", "bad.xml", "trace.bin"]).shown());
    workspace.write("broken.xml", "<scene>\n  <duration time=\"1\"\n  <integrator/>\n</scene>");
    insta::assert_snapshot!("scene_syntax_error", workspace.run(["check", "broken.xml", "trace.bin"]).shown());
    workspace.write("empty.xml", "");
    insta::assert_snapshot!("scene_empty", workspace.run(["check", "empty.xml", "trace.bin"]).shown());
}

#[test]
fn the_bundled_trace_of_the_readme_shows_its_mistake() {
    let workspace = Workspace::new();
    let scene = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls";
    let run = workspace.run(["check", scene, &format!("{scene}/flawed")]);
    assert_eq!(run.code, Some(1), "{}", run.shown());
    let out = run.out();
    assert!(out.starts_with("WRONG ANSWER") && out.contains("coefficient of t^2"), "{out}");
}

/// Returns a correct trace that ends inside a list of polynomials, like that of a program that crashed or was killed.
fn broken_off(trace: &[u8], length: usize) -> String {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BEAM);
    workspace.write("trace.bin", &trace[..length]);
    workspace.run(["check", "scene.xml", "trace.bin", "--rules", "both"]).out()
}

#[test]
fn an_incomplete_last_record_is_not_a_mistake() {
    let trace = trace_of(BEAM);
    let lengths = (1..60).map(|part| trace.len() * part / 60);
    for length in lengths.chain([trace.len() - 1, trace.len() - 8, trace.len() - 60]) {
        let text = broken_off(&trace, length);
        for blame in ["likely mistake", "No simple mistake", "First difference", "wrong coefficient", "Where to look"] {
            assert!(!text.contains(blame), "cut at {length} of {}: {blame} in\n{text}", trace.len());
        }
        assert!(text.starts_with("BAD TRACE") || text.contains("the trace is damaged"), "{text}");
    }
}

#[test]
fn a_mistake_before_the_break_is_still_reported() {
    let mut trace = changed(BEAM, |frames| scale(&mut frames[2], 0, 2.0));
    trace.truncate(trace.len() - 8);
    let text = broken_off(&trace, trace.len());
    assert!(text.contains("1 of ") && text.contains("First difference: step 1 of"), "{text}");
}

#[test]
fn another_scenes_trace_is_asked_about_and_not_explained() {
    let other = BEAM.replace("px=\"0.25\"", "px=\"0.5\"");
    assert_ne!(other, BEAM);
    for (trace, longer) in [(trace_of(&other), false), ([trace_of(&other), vec![0; 400]].concat(), true)] {
        let (text, json) = reports(BEAM, &trace);
        let out = text.out();
        let first = out.lines().next().unwrap_or_default();
        assert!(
            first.ends_with("match the scene.") == longer && first.contains("Does this trace belong to this scene?"),
            "{first}"
        );
        for blame in ["likely mistake", "First difference", "Where to look", "Likely cause"] {
            assert!(!out.contains(blame), "{blame} in\n{out}");
        }
        assert_eq!(json["explanations"][0]["key"], "other-scene");
        assert_eq!(json["explanations"].as_array().map(Vec::len), Some(1));
    }
}

/// Returns a trace in which the moving ball's states are wrong in every step, and its second velocity as well.
fn wrong_drift() -> Vec<u8> {
    changed(DRIFT, |frames| {
        frames[1].state.positions[0] += 1e-3;
        frames[3].state.positions[0] += 1e-3;
        frames[3].state.velocities[1] = -0.5;
    })
}

#[test]
fn all_wrong_steps_are_shown_on_demand() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", DRIFT);
    workspace.write("trace.bin", wrong_drift());
    let short = workspace.run(["check", "scene.xml", "trace.bin"]).out();
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--all"]);
    assert_eq!(run.code, Some(1));
    assert!(!short.contains("Step 3 of 4"), "{short}");
    insta::assert_snapshot!("all_steps", run.shown());
    let (_, json) = reports(DRIFT, &wrong_drift());
    assert_eq!(json["wrong_step_numbers"].as_array().map(Vec::len), json["wrong_steps"].as_u64().map(|n| n as usize));
    assert!(json["shown_steps"].is_null(), "{json:#}");
    let json = checked_json(&workspace, &["--all"]);
    let shown: Vec<_> = json["shown_steps"].as_array().unwrap().iter().map(|step| &step["step"]).collect();
    assert_eq!(shown, json["wrong_step_numbers"].as_array().unwrap().iter().collect::<Vec<_>>());
}

#[test]
fn single_steps_are_shown_alone() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", DRIFT);
    workspace.write("trace.bin", wrong_drift());
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--step", "3,0"]);
    assert_eq!(run.code, Some(1));
    insta::assert_snapshot!("two_steps", run.shown());
    let json = checked_json(&workspace, &["--step", "3"]);
    let [step] = &json["shown_steps"].as_array().unwrap()[..] else { panic!("{json:#}") };
    assert_eq!((&step["step"], step["findings"][0]["kind"].as_str()), (&3.into(), Some("position")), "{json:#}");
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--step", "5"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("has 4 steps; there is no step 5"), "{}", run.err());
    // A trace that could not be judged is not reported as right.
    workspace.write("cut.bin", &wrong_drift()[..150]);
    let run = workspace.run(["check", "scene.xml", "cut.bin", "--step", "4"]);
    assert!(run.out().contains("Step 4 of 4: not judged"), "{}", run.shown());
}

fn checked_json(workspace: &Workspace, options: &[&str]) -> Value {
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--format", "json"].iter().chain(options));
    schemas::valid("check", &run.stdout)
}

#[test]
fn github_gets_annotations() {
    let workspace = Workspace::with_trace(DRIFT);
    let check = |trace: &str| workspace.run(["check", "scene.xml", trace, "--format", "github"]);
    let right = check("trace.bin");
    assert_eq!((right.code, right.out()), (Some(0), String::new()), "{}", right.shown());
    workspace.write("wrong, 100%.bin", wrong_drift());
    let wrong = check("wrong, 100%.bin");
    assert_eq!((wrong.code, wrong.out().lines().count()), (Some(1), 1), "{}", wrong.shown());
    let line = "::error title=wrong%2C 100%25.bin%3A wrong answer::4 of 4 steps are wrong, the first is step 1; step \
        1: particle 0";
    assert!(wrong.out().starts_with(line), "{}", wrong.shown());
    workspace.write("cut.bin", &workspace.read("trace.bin")[..150]);
    assert!(check("cut.bin").out().contains("the trace can't be read any further at "), "{}", check("cut.bin").shown());
}

#[test]
fn json_says_what_the_text_says() {
    let trailing = [&wrong_drift()[..], b"more"].concat();
    for trace in [trace_of(DRIFT), wrong_drift(), trailing, trace_of(DRIFT)[..150].to_vec()] {
        let (text, json) = reports(DRIFT, &trace);
        let text = text.out();
        let lists = ["advice", "commands", "notes"].into_iter().flat_map(|list| json[list].as_array().expect(list));
        for words in lists.chain([&json["summary"]]) {
            assert!(text.contains(words.as_str().expect("words")), "{words} is not in {text}");
        }
        for heading in ["Where to look", "Notes"] {
            let list = if heading == "Notes" { "notes" } else { "advice" };
            assert_eq!(text.contains(heading), !json[list].as_array().expect(list).is_empty(), "{text}");
        }
    }
}

#[test]
fn the_cause_comes_first() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    workspace.write("trace.bin", changed(BOUNCE, |frames| scale(&mut frames[2], 0, 2.0)));
    let short = workspace.run(["check", "scene.xml", "trace.bin"]).out();
    let place = |words: &str| short.find(words).unwrap_or_else(|| panic!("no {words} in {short}"));
    assert!(place("Likely cause") < place("First difference") && place("First difference") < place("Rule books"));
}

#[test]
fn files_that_are_not_traces_are_reported_in_one_line() {
    let workspace = Workspace::new();
    workspace.write("scene.xml", BOUNCE);
    for (bytes, says) in [
        (&b""[..], "it is empty"),
        (b"{\"grades\": []}\n", "it looks like JSON"),
        (b"<!DOCTYPE html>\n<html></html>", "it looks like HTML"),
        (b"Overall success: \x1b[31;1mFailed.\n", "it looks like text"),
        ("\u{fc}ber 600 Schritte\n".as_bytes(), "it looks like text"),
        (b"\x7fELF\x02\x01\x01\0\0\0", "it looks like a program (ELF)"),
    ] {
        workspace.write("thing", bytes);
        let run = workspace.run(["check", "scene.xml", "thing"]);
        assert_eq!((run.code, run.out().lines().count()), (Some(1), 1), "{}", run.shown());
        assert!(
            run.out().starts_with("BAD TRACE: thing is not a trace: ") && run.out().contains(says),
            "{}",
            run.shown()
        );
    }
    // A truncated file is still recognized as a trace.
    workspace.write("thing", &trace_of(BOUNCE)[..20]);
    assert!(!workspace.run(["check", "scene.xml", "thing"]).out().contains("is not a trace"));
}

#[test]
fn a_detection_that_is_not_written_yet_is_asked_about() {
    let empty = changed(BOUNCE, |frames| frames.iter_mut().for_each(|frame| frame.polynomials.clear()));
    let (text, _) = reports(BOUNCE, &empty);
    assert!(text.out().contains("never calls the course's root finder; is it written yet?"), "{}", text.shown());
}

#[test]
fn the_commands_that_look_closer_work_as_they_stand() {
    let workspace = Workspace::new();
    workspace.write("my scene.xml", BOUNCE);
    workspace.write("it's mine.bin", changed(BOUNCE, |frames| scale(&mut frames[2], 0, 2.0)));
    let run = workspace.run(["check", "my scene.xml", "it's mine.bin", "--format", "json"]);
    let json: Value = serde_json::from_slice(&run.stdout).unwrap();
    let commands: Vec<_> = json["commands"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    assert!(commands[0].starts_with("fosssim-oracle detect ") && commands.len() == 3, "{commands:?}");
    let program = env!("CARGO_BIN_EXE_fosssim-oracle");
    for command in commands {
        let line = command.replacen("fosssim-oracle", program, 1);
        let mut shell = std::process::Command::new("sh");
        let run = finish(shell.args(["-c", &line]).current_dir(workspace.path("")));
        assert_eq!(run.code, Some(0), "{command}: {}", run.shown());
    }
    assert!(workspace.exists("step1.svg"));
    workspace.write("right.bin", trace_of(BOUNCE));
    assert!(!workspace.run(["check", "my scene.xml", "right.bin"]).out().contains("  $ "));
}
