use super::*;
use fosssim_evidence::{BUDGET, Focus, Rulings, gather};
use fosssim_judge::{Outcome, Rules, parity};
use fosssim_mistakes::{
    diagnose,
    student::{self, Student},
};
use fosssim_model::scene::{Scene, original};

fn asset(name: &str) -> Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name);
    original::read(&std::fs::read(path).expect("a scene")).expect("a scene").scene
}

fn page(scene: &Scene, scene_name: &str, trace_name: &str, trace: &[u8]) -> String {
    let options = parity::Options { fair: true, ..Default::default() };
    let mut nobody = ();
    let mut rulings = Rulings::new(&mut nobody);
    let outcome: Outcome = parity::judge(scene, trace, &options, &mut rulings);
    let explanations = diagnose::explain(scene, trace);
    let focus: Vec<Focus> = outcome.examples.iter().map(Focus::from).collect();
    let evidence = gather(scene, trace, &rulings.into_steps(&outcome), true, &focus, BUDGET);
    let check = Check {
        scene: scene_name,
        trace: trace_name,
        outcome: &outcome,
        explanations: &explanations,
        rules: Rules::Both,
        steps: &crate::check::WrongSteps::new(crate::check::Shown::None),
        audit: false,
    };
    let case = Case { check, scene, evidence: Some(&evidence), what_if: None };
    Page { title: trace_name, cases: vec![case] }.html()
}

fn of_mistake(scene: &Scene, id: &str) -> Vec<u8> {
    let mistake = student::find(id).expect("a mistake").mistake;
    student::trace(scene, Student::new(Some(mistake))).unwrap_or_else(|(trace, _)| trace)
}

/// The essentials are text: without script, in print, and for who can't see pictures.
#[test]
fn the_essentials_need_no_script() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let html = page(&scene, "spinning", "mine.bin", &of_mistake(&scene, "pe-linear-one-ab"));
    let without: String =
        html.split("<script").map(|part| part.split_once("</script>").map_or(part, |p| p.1)).collect();
    for words in [
        "WRONG ANSWER",
        "What explains it",
        "Where it goes wrong first",
        "differs",
        "the fair rules",
        "All steps",
        "<svg",
    ] {
        assert!(without.contains(words), "{words} is missing in {without}");
    }
}

#[test]
fn names_and_texts_that_look_like_markup_stay_text() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let hostile = "</script><script>alert(1)</script><img src=x onerror=alert(1)>\u{202e}'\"&";
    let html = page(&scene, hostile, hostile, &of_mistake(&scene, "pp-contact-reversed"));
    assert!(!html.contains("<script>alert") && !html.contains("<img") && !html.contains('\u{202e}'));
    // The script, its data and nothing else.
    assert_eq!(html.matches("<script").count(), 4);
    assert_eq!(html.matches("</script>").count(), 4);
    assert!(html.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
}

/// The policy allows the script and the style sheet that are there, by their digests, and nothing that needs more.
#[test]
fn the_policy_fits_the_page() {
    let html = Page { title: "empty", cases: Vec::new() }.html();
    let between = |from: &str, to: &str| html.split_once(from).and_then(|(_, rest)| rest.split_once(to)).expect(from).0;
    assert!(html.contains(&format!("script-src '{}'", digest(between("<script>", "</script>")))));
    assert!(html.contains(&format!("style-src '{}'", digest(between("<style>", "</style>")))));
    for word in [" style=", "javascript:", "eval(", "new Function", "http:", "https:", "innerHTML"] {
        let allowed = if word == "http:" { html.matches("http://www.w3.org/2000/svg").count() } else { 0 };
        assert_eq!(html.matches(word).count(), allowed, "{word}");
    }
    assert!(SCRIPT.len() + STYLE.len() < 60_000);
}

/// A failing scene of a course's size stays small enough to be mailed.
#[test]
fn a_page_is_small() {
    let scene = asset("HolisticTests/crowd-of-twenty-balls.xml");
    let html = page(&scene, "crowd", "mine.bin", &of_mistake(&scene, "failsafe-angular-overwritten"));
    assert!(html.len() < 700_000, "{}", html.len());
}

/// What the viewer reads is what the trace holds, to the last bit.
#[test]
fn the_motion_is_exact() {
    use base64::Engine;
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let trace = of_mistake(&scene, "pp-contact-reversed");
    let html = page(&scene, "s", "t", &trace);
    let packed = html.split_once("id=\"submission-0\">").and_then(|(_, rest)| rest.split_once('<')).expect("a block").0;
    let packed = base64::engine::general_purpose::STANDARD.decode(packed).expect("base64");
    let bytes = miniz_oxide::inflate::decompress_to_vec(&packed).expect("deflate");
    // The first record is the start of the file; the last state that is kept is in the file, too.
    let state = 32 * scene.particles.len();
    assert_eq!(bytes[..state], trace[..state]);
    let last = &bytes[bytes.len() - state..];
    assert!(trace.windows(state).any(|window| window == last));
}
