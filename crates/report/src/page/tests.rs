use super::*;
use crate::check::{StepChoice, WrongSteps};
use fosssim_evidence::{Focus, MAX_NUMBERS, StepRulings, gather};
use fosssim_findings::CourseNote;
use fosssim_grading::{
    Grade, Reason, SceneResult, Verdict,
    config::{Credit, Marking, Visibility},
    disclosure::Disclosure,
    result::{ProgramProgress, RunEnd, WrongTrace},
    score,
};
use fosssim_judge::{Book, FindingKind, Outcome, Rules, replay};
use fosssim_mistakes::{
    diagnose::{self, Explanation},
    together::disclosure::limit_explanations,
};
use fosssim_model::scene::{Scene, original};
use fosssim_student::{self as student, Student};

fn asset(name: &str) -> Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2").join(name);
    original::read(&std::fs::read(path).expect("a scene")).expect("a scene").scene
}

fn page(scene: &Scene, scene_name: &str, trace_name: &str, trace: &[u8]) -> String {
    told(scene, scene_name, trace_name, trace, Hints::Full)
}

fn told(scene: &Scene, scene_name: &str, trace_name: &str, trace: &[u8], hints: Hints) -> String {
    let options = replay::Options { uses_fair_rules: true, ..Default::default() };
    let mut rulings = StepRulings::default();
    let outcome: Outcome = replay::judge(scene, trace, &options, &mut rulings);
    let explanations = limit_explanations(hints, diagnose::explain(scene, trace));
    let focus: Vec<Focus> = outcome.parity.findings.examples.iter().map(Focus::from).collect();
    let evidence = gather(scene, &mut &trace[..], &rulings.into_steps(&outcome), true, &focus, MAX_NUMBERS);
    let check = check_of(scene_name, trace_name, &outcome, &explanations);
    Case { check, scene, evidence: Some(&evidence), mistake_run: None, hints, has_trace: true }.render_page(trace_name)
}

fn check_of<'a>(scene: &'a str, trace: &'a str, outcome: &'a Outcome, explanations: &'a [Explanation]) -> Check<'a> {
    static NONE: std::sync::LazyLock<WrongSteps> = std::sync::LazyLock::new(|| WrongSteps::new(StepChoice::None));
    let (rules, steps) = (Rules::Both, &*NONE);
    Check { scene, trace, outcome, explanations, rules, steps, other_file_kind: None }
}

fn text_of(scene: &Scene, trace: &[u8]) -> String {
    let outcome =
        replay::judge(scene, trace, &replay::Options { uses_fair_rules: true, ..Default::default() }, &mut ());
    check_of("scene", "trace", &outcome, &[]).render_text(crate::style::Style::Plain)
}

fn of_mistake(scene: &Scene, id: &str) -> Vec<u8> {
    let mistake = student::find(id).expect("a mistake").mistake;
    student::record_trace(scene, Student::new(Some(mistake))).unwrap_or_else(|(trace, _)| trace)
}

/// The most important parts are text: without a script, in print, and for blind readers.
#[test]
fn the_essentials_need_no_script() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let html = page(&scene, "spinning", "mine.bin", &of_mistake(&scene, "pe-linear-one-ab"));
    let without: String =
        html.split("<script").map(|part| part.split_once("</script>").map_or(part, |p| p.1)).collect();
    for words in
        ["wrong answer", "Likely mistake", "First difference", "differs", "the fair rules", "All steps", "<svg"]
    {
        assert!(without.contains(words), "{words} is missing in {without}");
    }
}

/// The text report and the page give the same place, reason and verdicts for a trace that cannot be read to its end.
#[test]
fn a_page_says_where_and_why_a_trace_ends_and_agrees_with_the_text() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let whole = of_mistake(&scene, "pe-linear-one-ab");
    for (trace, words) in [
        (whole[..whole.len() / 2 + 3].to_vec(), ["Stopped at step", "did the program crash, or was it stopped"]),
        ([&whole[..], &[0; 100]].concat(), ["bytes follow the last record", "the original never reads them"]),
    ] {
        let html = page(&scene, "spinning", "mine.bin", &trace);
        assert!(!html.contains("rules agree"), "{html}");
        for words in words {
            assert!(html.contains(words), "{words}");
        }
        let told = text_of(&scene, &trace);
        let books = told.split_once("Rule books\n").expect("the books are told").1;
        for line in books.lines().take(2) {
            let (name, rest) = line.trim().split_once(": ").expect("a verdict");
            let (word, grounds) = rest.split_once(": ").unwrap_or((rest, ""));
            let row = format!("<li>{}: ", markup::escape(name));
            let row = html.split_once(&row).expect("a row").1.split_once("</li>").expect("a row").0;
            assert!(row.contains(word) && row.contains(&markup::escape(grounds)), "{line} in {row}");
        }
    }
}

/// Both reports show a mistake in a response or in the failsafe first as a wrong state at the end of its step. The
/// formulas of the later polynomials are right.
#[test]
fn a_wrong_state_comes_before_the_polynomials_that_follow_from_it() {
    for (name, id) in [
        ("HolisticTests/balls-in-a-box.xml", "response-halved"),
        ("GeometricTests/pair-becomes-rigid.xml", "failsafe-angular-overwritten"),
    ] {
        let scene = asset(name);
        let trace = of_mistake(&scene, id);
        let html = page(&scene, "scene", "mine.bin", &trace);
        let first = html.split_once("First difference").expect("it is told").1;
        let first = first.split_once("</section>").expect("a card").0;
        assert!(first.contains("where particle") && first.contains("<mark>"), "{first}");
        assert!(html.contains("Polynomials that are wrong only because of wrong positions"), "{id}");
        assert!(!html.contains("The detection calls that are wrong"), "{id}");
        let told = text_of(&scene, &trace);
        let first = told.split_once("First difference").expect("it is told").1.lines().nth(1).expect("a line");
        assert!(first.contains("ends at"), "{first}");
    }
}

/// The page about a file that is no trace contains no further statements.
#[test]
fn a_page_about_no_trace_has_no_verdicts_of_books() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let outcome =
        replay::judge(&scene, &b""[..], &replay::Options { uses_fair_rules: true, ..Default::default() }, &mut ());
    let check = Check { other_file_kind: Some("is empty"), ..check_of("head-on", "mine.bin", &outcome, &[]) };
    let case = Case { check, scene: &scene, evidence: None, mistake_run: None, hints: Hints::Full, has_trace: true };
    let html = case.render_page("mine.bin");
    assert!(html.contains("is not a trace: it is empty") && !html.contains("fair rules"), "{html}");
}

/// A trace that was not stored completely is not compared with a complete run.
#[test]
fn a_proof_is_reported_only_for_complete_traces() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let trace = of_mistake(&scene, "pp-contact-reversed");
    let mut rulings = StepRulings::default();
    let options = replay::Options { uses_fair_rules: true, ..Default::default() };
    let outcome = replay::judge(&scene, &trace[..], &options, &mut rulings);
    let focus = Focus::from_outcome(&outcome);
    let evidence = gather(&scene, &mut &trace[..], &rulings.into_steps(&outcome), true, &focus, MAX_NUMBERS);
    let named = &diagnose::explain(&scene, &trace)[0];
    assert!(MistakeRun::for_scene(&scene, named, Some(&trace), &evidence).expect("a run").equal);
    assert_eq!(MistakeRun::for_scene(&scene, named, None, &evidence), None);
}

#[test]
fn names_and_texts_that_look_like_markup_stay_text() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let hostile = "</script><script>alert(1)</script><img src=x onerror=alert(1)>\u{202e}'\"&";
    let html = page(&scene, hostile, hostile, &of_mistake(&scene, "pp-contact-reversed"));
    assert!(!html.contains("<script>alert") && !html.contains("<img") && !html.contains('\u{202e}'));
    // There are only the script and its data.
    assert_eq!(html.matches("<script").count(), 4);
    assert_eq!(html.matches("</script>").count(), 4);
    assert!(html.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
}

/// The policy allows only the existing script and style sheet, by their digests.
#[test]
fn the_policy_fits_the_page() {
    let html = render_document("empty", "", script());
    let between = |from: &str, to: &str| html.split_once(from).and_then(|(_, rest)| rest.split_once(to)).expect(from).0;
    assert!(html.contains(&format!("script-src '{}'", digest(between("<script>", "</script>")))));
    assert!(html.contains(&format!("style-src '{}'", digest(between("<style>", "</style>")))));
    for word in [" style=", "javascript:", "eval(", "new Function", "http:", "https:", "innerHTML"] {
        let allowed = if word == "http:" { html.matches("http://www.w3.org/2000/svg").count() } else { 0 };
        assert_eq!(html.matches(word).count(), allowed, "{word}");
    }
    assert!(script().len() + STYLE.len() < 84_000, "{}", script().len() + STYLE.len());
}

/// A failing scene of a course's size gives a page that is small enough for mail.
#[test]
fn a_page_is_small() {
    let scene = asset("HolisticTests/crowd-of-twenty-balls.xml");
    let html = page(&scene, "crowd", "mine.bin", &of_mistake(&scene, "failsafe-angular-overwritten"));
    assert!(html.len() < 700_000, "{}", html.len());
}

/// The motion that the viewer reads is exactly the trace's.
#[test]
fn the_motion_is_exact() {
    use base64::Engine;
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let trace = of_mistake(&scene, "pp-contact-reversed");
    let html = page(&scene, "s", "t", &trace);
    let packed = html.split_once("id=\"submission-0\">").and_then(|(_, rest)| rest.split_once('<')).expect("a block").0;
    let packed = base64::engine::general_purpose::STANDARD.decode(packed).expect("base64");
    let bytes = miniz_oxide::inflate::decompress_to_vec(&packed).expect("deflate");
    // The first record is the start of the file, and the last stored state is also in the file.
    let state = 32 * scene.particles.len();
    assert_eq!(bytes[..state], trace[..state]);
    let last = &bytes[bytes.len() - state..];
    assert!(trace.windows(state).any(|window| window == last));
}

/// Returns the card of a wrong trace for readers of this level, and the whole result.
fn drawn(scene: &Scene, id: &str, hints: Hints) -> (Option<Card>, SceneResult) {
    let trace = of_mistake(scene, id);
    let mut rulings = StepRulings::default();
    let options = replay::Options { uses_fair_rules: true, ..Default::default() };
    let outcome = replay::judge(scene, &trace[..], &options, &mut rulings);
    let focus: Vec<Focus> = outcome.parity.findings.examples.iter().map(Focus::from).collect();
    let evidence = gather(scene, &mut &trace[..], &rulings.into_steps(&outcome), true, &focus, MAX_NUMBERS);
    let all = diagnose::explain(scene, &trace);
    let explanations = limit_explanations(hints, all.clone());
    let what_if = MistakeRun {
        id: id.to_owned(),
        sentence: student::find(id).expect("a mistake").summary.to_owned(),
        track: evidence.reference.clone(),
        equal: true,
    };
    let steps = crate::check::WrongSteps::new(crate::check::StepChoice::None);
    let check = Check {
        scene: "Group/scene",
        trace: "",
        outcome: &outcome,
        explanations: &explanations,
        rules: Rules::Fair,
        steps: &steps,
        other_file_kind: None,
    };
    let case = Case { check, scene, evidence: Some(&evidence), mistake_run: Some(&what_if), hints, has_trace: false };
    let card = Card::for_case(&case, 3).and_then(|card| Card::from_stored(&card.to_stored()));
    let why = Reason::Wrong(WrongTrace::Undisclosed);
    let mut result = SceneResult::without_run("Group/scene", scene.step_count(), Verdict::WrongAnswer, why);
    result.disclosure = Some(Disclosure::from_outcome(&outcome, Rules::Fair));
    result.explanations = all;
    (card, result)
}

/// Returns a group of ten points whose scenes have this level of hints.
fn marking(hints: Hints) -> Marking {
    Marking {
        points: 10.0,
        credit: Credit::Scenes,
        visibility: Visibility::Visible,
        hints,
        is_extra: false,
        speed: None,
    }
}

/// Returns the grade of the wrong submission with these results.
fn wrong(results: Vec<SceneResult>, hints: Hints) -> Grade {
    Grade {
        groups: vec![with_results(marking(hints), results)],
        verdict: Verdict::WrongAnswer,
        shows_output: true,
        ..crate::grade::samples::accepted_grade()
    }
}

/// Returns the page of a submission with these results, all of which have the same card.
fn page_of(results: Vec<SceneResult>, card: Option<&Card>) -> String {
    let grade = wrong(results, Hints::Full);
    GradePage { grade: &grade, card: &|_| card.cloned(), class: None, reader: Audience::Staff }.html()
}

/// Returns the pages of a submission for staff, and for students with this level of hints.
fn graded(scene: &Scene, id: &str, hints: Hints) -> [String; 2] {
    let ((own, mut result), (full, _)) = (drawn(scene, id, hints), drawn(scene, id, Hints::Full));
    (result.card, result.card_for_students) = (Some("full".to_owned()), own.is_some().then(|| "own".to_owned()));
    let grade = wrong(vec![result], hints);
    let card = |name: Option<&str>| match name {
        Some("full") => full.clone(),
        Some("own") => own.clone(),
        _ => None,
    };
    [Audience::Staff, Audience::Student]
        .map(|reader| GradePage { grade: &grade, card: &card, class: None, reader }.html())
}

/// An opened card is never empty.
#[test]
fn a_program_that_prints_nothing_is_reported_as_silent() {
    let reason = Reason::Program(ProgramProgress { limit: None, steps: 0 });
    let result = |stderr: &str| SceneResult {
        ended: Some(RunEnd::Exited(3)),
        stderr: stderr.to_owned(),
        ..SceneResult::without_run("Group/scene", 5, Verdict::RuntimeError, reason.clone())
    };
    assert!(page_of(vec![result("")], None).contains("<p class=\"hint\">It printed nothing.</p>"));
    // A scene without pictures shows what the program printed.
    let html = page_of(vec![result("no memory")], None);
    assert!(html.contains("<details class=\"table\" open><summary>Standard error</summary>"), "{html}");
    assert!(!html.contains("It printed nothing."));
    let traces = SceneResult { ended: None, ..result("") };
    assert!(!page_of(vec![traces], None).contains("It printed nothing."), "there was no program");
}

/// The details that a level hides are not in the file at all: neither as text, nor in the viewer's data.
#[test]
fn hidden_details_are_not_in_the_file() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let id = "pe-linear-one-ab";
    let pages = [Hints::None, Hints::Where, Hints::What, Hints::Full].map(|hints| graded(&scene, id, hints));
    let [[staff, none], [_, place], [_, what], [_, full]] = pages;
    assert_eq!(staff, full, "staff see as much as a student with full hints");
    let script = |html: &str| html.matches("<script>").count();
    assert!([&none, &place, &what, &full].iter().all(|html| script(html) == 1));
    // The viewer's own text and the style sheet are the same for all.
    let body = |html: &str| {
        let body = html.split_once("</style>").expect("a style sheet").1;
        body.split_once("<script>").expect("a script").0.to_owned()
    };
    let [none, place, what, full] = [none, place, what, full].map(|html| body(&html));
    let row = student::find(id).expect("a mistake");
    assert!(row.summary.len() > 10);
    for (html, level) in [(&none, "none"), (&place, "where"), (&what, "what")] {
        for hidden in [
            "id=\"reference-",
            "id=\"what-",
            "\"whatIf\":{",
            "Coefficients",
            "First difference<",
            "differs",
            "expected",
            "data-plot",
            "Proof",
        ] {
            assert!(!html.contains(hidden), "{hidden} at level {level}");
        }
        assert!(!html.contains(row.term), "{level}");
        assert_eq!(html.contains(row.summary), level == "what", "{level}");
        assert_eq!(html.contains("First difference: step"), level != "none", "{level}");
        assert_eq!(html.contains("id=\"submission-"), level != "none", "{level}");
        assert_eq!(html.contains("class=\"steps\""), level != "none", "{level}");
    }
    for shown in [
        "id=\"reference-",
        "\"whatIf\":{",
        "Coefficients",
        "First difference",
        "differs",
        "data-plot",
        "Proof",
        row.summary,
    ] {
        assert!(full.contains(shown), "{shown}");
    }
}

/// Motions and outputs without space are omitted, scene by scene, and the page contains a message.
#[test]
fn a_page_stays_below_its_budget_and_says_what_it_leaves_out() {
    let scene = asset("HolisticTests/crowd-of-twenty-balls.xml");
    let (card, result) = drawn(&scene, "failsafe-angular-overwritten", Hints::Full);
    let noisy = "\u{202e}\"".repeat(2000);
    for count in [1, 80] {
        let name = |number: usize| SceneResult {
            scene: format!("Group/{number}"),
            stdout: noisy.clone(),
            stderr: noisy.clone(),
            ..result.clone()
        };
        let html = page_of((0..count).map(name).collect(), card.as_ref());
        assert!(html.len() < 3_000_000, "{count}: {}", html.len());
        assert_eq!(html.matches("<article").count(), count);
        let with = html.matches("id=\"submission-").count();
        let lines = ["no space for the motion", "no space for the pictures and the motion"];
        let without: usize = lines.iter().map(|line| html.matches(line).count()).sum();
        assert_eq!(with + without, count);
        assert_eq!(html.contains("The page would grow beyond 3 MB"), count > 1);
        assert_eq!(html.contains("no space for the output of programs in this scene and the next ones"), count > 1);
        assert!(with > 0 && html.contains("Coefficients"), "{with}");
    }
}

#[test]
fn a_program_whose_files_are_missing_is_not_sent_to_a_debugger() {
    for (code, advises_debugger) in [(127, false), (1, true)] {
        let reason = crate::grade::samples::reason_with_text("it ended");
        let scene = |name: &str| SceneResult {
            scene: name.to_owned(),
            ended: Some(RunEnd::Exited(code)),
            ..SceneResult::without_run("", 10, Verdict::RuntimeError, reason.clone())
        };
        let grade = Grade {
            groups: vec![with_results(marking(Hints::Full), vec![scene("A/one"), scene("A/two")])],
            verdict: Verdict::RuntimeError,
            ..crate::grade::samples::accepted_grade()
        };
        let html = GradePage { grade: &grade, card: &|_| None, class: None, reader: Audience::Staff }.html();
        assert_eq!(html.contains("fsanitize"), advises_debugger, "{code}");
        assert_eq!(html.contains("file was not found: the program runs alone"), !advises_debugger, "{code}");
    }
}

/// A named mistake comes before unexplained scenes. Its scene with the fewest findings comes first.
#[test]
fn the_most_telling_scene_is_opened_first_and_links_lead_to_it() {
    let named = |scene: &str, id: &str| {
        let (card, result) = drawn(&asset(scene), id, Hints::Full);
        (SceneResult { scene: scene.to_owned(), ..result }, card)
    };
    let unexplained = SceneResult {
        scene: "Group/crash".to_owned(),
        ..SceneResult::without_run("", 10, Verdict::RuntimeError, crate::grade::samples::reason_with_text("it crashed"))
    };
    let id = "failsafe-angular-overwritten";
    let (large, small) = ("HolisticTests/crowd-of-twenty-balls.xml", "GeometricTests/pair-becomes-rigid.xml");
    let scenes = [(unexplained, None), named(large, id), named(small, id)];
    let called = |(result, _): &(SceneResult, _)| SceneResult { card: Some(result.scene.clone()), ..result.clone() };
    let results = scenes.iter().map(called).collect();
    let card = |name: Option<&str>| scenes.iter().find(|(result, _)| Some(&*result.scene) == name)?.1.clone();
    let mut grade = Grade {
        groups: vec![with_results(marking(Hints::Full), results)],
        verdict: Verdict::RuntimeError,
        ..crate::grade::samples::accepted_grade()
    };
    fosssim_mistakes::together::reconcile_explanations(&mut grade);
    let html = GradePage { grade: &grade, card: &card, class: None, reader: Audience::Staff }.html();
    let articles: Vec<&str> = html.split("<article ").skip(1).collect();
    let order = [small, large, "Group/crash"];
    for (number, (article, scene)) in articles.iter().zip(order).enumerate() {
        assert!(article.contains(&format!("data-scene=\"{scene}\"")), "{scene}");
        assert_eq!(article.contains("<details class=\"scene\" open>"), number == 0, "{scene}");
    }
    // Other scenes with the same cause are in a closed section after it.
    assert!(articles[0].contains("<details class=\"alike\"><summary>1 more scene with the same cause</summary>"));
    // Both the mistake and its group link to that scene, and a terminal names the same scene.
    let text = crate::formats::Format::Text.render(&[grade.clone()]);
    assert!(text.contains(&format!("Scene to look at first\n  WA {small}: ")), "{text}");
    let place = format!("<a href=\"#scene-{}\">{}</a>", grade_page::scene_key(small), small.replace('/', "/<wbr>"));
    assert!(
        html.matches(&place).count() == 2 && html.contains(&format!("id=\"scene-{}\"", grade_page::scene_key(small)))
    );
}

/// A wrong position that no known mistake explains is reported before the polynomials that follow from it, in all
/// formats.
#[test]
fn a_wrong_position_is_named_before_the_polynomials_that_follow_from_it() {
    let (_, result) = drawn(&asset("ImpulsesTests/plastic-impacts.xml"), "gravity-missing", Hints::Full);
    let mut grade = Grade {
        groups: vec![with_results(marking(Hints::Full), vec![result])],
        verdict: Verdict::WrongAnswer,
        ..crate::grade::samples::accepted_grade()
    };
    fosssim_mistakes::together::reconcile_explanations(&mut grade);
    let html = GradePage { grade: &grade, card: &|_| None, class: None, reader: Audience::Staff }.html();
    assert!(html.contains("<h2>What differs</h2>") && !html.contains("<h2>Likely mistake"), "{html}");
    // The card of the scene gives the same cause as the head of the page.
    assert!(!html.contains("No simple mistake"), "{html}");
    let words = "he first difference is a wrong position, which no known mistake explains.";
    assert!(html.contains(&format!("T{words}")), "{html}");
    // The table of scenes has only keys.
    let formats = crate::formats::Format::ALL.iter().filter(|format| **format != crate::formats::Format::Csv);
    for format in formats {
        let report = format.render(std::slice::from_ref(&grade));
        assert!(report.contains(&format!("T{words}")), "{format:?}: {report}");
        assert!(!report.contains("No simple mistake"), "{format:?}: {report}");
    }
    // The original's rules may reject an earlier polynomial.
    let told = grade.groups[0].scenes[0].result.disclosure.as_mut().expect("a disclosure");
    let wrong = told.parity.examples.iter().find(|one| one.kind() == FindingKind::Coefficient).cloned();
    assert!(wrong.is_some(), "{told:?}");
    (told.official, told.parity.first_divergence) = (Book::Parity, wrong);
    let text = crate::formats::Format::Text.render(&[grade]);
    assert!(text.contains(&format!("By the fair rules, t{words}")), "{text}");
}

fn with_results(marking: Marking, results: Vec<SceneResult>) -> fosssim_grading::GroupGrade {
    score::grade_group("Group", marking, results.into_iter().map(|result| (result, false)).collect())
}

/// A page for students shows nothing about hidden groups: no name, no points, no mistake, no output.
#[test]
fn a_student_s_page_has_no_hidden_group() {
    let scene = asset("GeometricTests/pair-becomes-rigid.xml");
    let (card, seen) = drawn(&scene, "failsafe-angular-overwritten", Hints::Full);
    let (_, secret) =
        drawn(&asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml"), "pe-linear-one-ab", Hints::Full);
    let crash = SceneResult {
        stdout: "secret output".to_owned(),
        ..SceneResult::without_run(
            "Secret/crash",
            1,
            Verdict::RuntimeError,
            crate::grade::samples::reason_with_text("a secret fall"),
        )
    };
    let marking = |points, visibility| Marking {
        points,
        credit: Credit::Scenes,
        visibility,
        hints: Hints::Full,
        is_extra: false,
        speed: None,
    };
    let named = |name: &str, group| fosssim_grading::GroupGrade { name: name.to_owned(), ..group };
    let grade = Grade {
        groups: vec![
            named("Shown", with_results(marking(7.0, Visibility::Visible), vec![seen])),
            named("Veiled", with_results(marking(13.0, Visibility::Hidden), vec![secret.clone(), crash])),
            named("Later", with_results(marking(17.0, Visibility::AfterDueDate), vec![secret])),
        ],
        verdict: Verdict::RuntimeError,
        points: Some(0.0),
        max_points: 37.0,
        shows_output: true,
        ..crate::grade::samples::accepted_grade()
    };
    let page = |reader| GradePage { grade: &grade, card: &|_| card.clone(), class: None, reader }.html();
    let (staff, student) = (page(Audience::Staff), page(Audience::Student));
    let mistake = student::find("pe-linear-one-ab").expect("a mistake").summary;
    for hidden in ["Veiled", "Later", "secret", "Secret/", mistake, "of 37", "of 13", "run-time error", "by the suite"]
    {
        assert!(staff.contains(hidden), "{hidden} is not even on the page for staff");
        assert!(!student.contains(hidden), "{hidden}");
    }
    for shown in ["Shown", "of 7", "wrong answer", "Other groups are hidden", "id=\"submission-"] {
        assert!(student.contains(shown), "{shown}");
    }
}

/// A course's words are next to their mistake or group. The link works, and text is never markup.
#[test]
fn a_course_adds_its_own_words() {
    let (_, result) =
        drawn(&asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml"), "pe-linear-one-ab", Hints::Full);
    let mut grade = wrong(vec![result], Hints::Full);
    fosssim_mistakes::together::reconcile_explanations(&mut grade);
    let note = CourseNote {
        text: Some("Lecture <9>.".to_owned()),
        link: Some("https://example.edu/9?a&b".to_owned()),
        points: Some(2.0),
    };
    grade.groups[0].note = Some(note.clone());
    grade.notes = [("pe-linear-one-ab".to_owned(), note)].into();
    let page = GradePage { grade: &grade, card: &|_| None, class: None, reader: Audience::Student }.html();
    let told = "The course: <a href=\"https://example.edu/9?a&amp;b\" rel=\"noopener\">Lecture &lt;9&gt;</a>; rubric \
                points: 2.";
    assert_eq!(page.matches(told).count(), 2, "{page}");
    assert!(
        crate::grade::head_lines(&grade)[0].contains("(The course: Lecture <9>; https://example.edu/9?a&b; rubric")
    );
}
