//! Explanations of mistakes, as lines of text and as JSON.
//!
//! The functions show everything in an explanation. Before they are called, `mistakes::together::disclosure` removes
//! the parts that the reader may not see. Data of a submission appear only as numbers.
use super::{
    detect::format_polynomial,
    number::{format_count, format_exact, format_rounded_or},
    style::Style,
    view::{to_key, view},
    words::explanation::{describe, describe_place, known_sentence, list_details},
};
use fosssim_mistakes::diagnose::{Example, ExamplePlace, ExampleValue, Explanation, ExplanationTopic};

/// The maximum number of mistakes in a list of those that can't be distinguished.
const MAX_LISTED: usize = 3;

/// Returns the lines of a report about explanations, the likeliest first. The lines that belong to a sentence are below
/// it, and are indented by two spaces.
pub fn explanation_texts(explanations: &[Explanation], style: Style) -> Vec<String> {
    explanations.iter().flat_map(|explanation| list_explanation_lines(explanation, style)).collect()
}

/// Returns one sentence about the likeliest mistake, or about the mistakes that together explain everything. It is for
/// formats with a single line. Returns `None` if there are no explanations.
pub fn render_sentence(explanations: &[Explanation]) -> Option<String> {
    if let Some(first) = explanations.first().filter(|first| first.reports_non_finite_value()) {
        return Some(describe(first));
    }
    let together: Vec<String> = explanations
        .iter()
        .filter(|explanation| explanation.is_complete() && explanation.topic == ExplanationTopic::Mistake)
        .map(describe)
        .collect();
    if together.len() > 1 {
        return Some(format!("likely mistakes: {}", together.join(" ")));
    }
    explanations.first().map(|explanation| match explanation.reproduced {
        0 => describe(explanation),
        _ => format!("likely mistake: {}", describe(explanation)),
    })
}

/// The parts of a report's text about one explanation.
#[derive(Default)]
pub(crate) struct ExplanationParts {
    /// Whether the explanation is a likely mistake; otherwise it is only an observation.
    pub(crate) is_likely: bool,
    /// The sentence that names the mistake.
    pub(crate) sentence: String,
    /// The sentence about how many wrong steps or polynomials the mistake reproduces.
    pub(crate) evidence: Option<String>,
    /// Lines with the exact form of the mistake, and with the mistakes that can't be distinguished from it.
    pub(crate) details: Vec<String>,
    /// Lines with an example of the mistake from the trace.
    pub(crate) example: Vec<String>,
}

impl ExplanationParts {
    /// Creates the parts. Formulas are written in the given style.
    pub(crate) fn new(explanation: &Explanation, style: Style) -> Self {
        let Explanation { reproduced, samples, topic: about, .. } = explanation;
        // An explanation that reproduces nothing is an observation, not a likely mistake.
        let (is_likely, evidence) = match (about, *reproduced) {
            _ if *samples == 0 => (false, None),
            (_, 0) => (false, Some(format!("{samples} checked"))),
            (ExplanationTopic::Unfinished | ExplanationTopic::Pairs(_), _) => (false, None),
            (ExplanationTopic::Mistake, _) => (true, Some(describe_evidence(*reproduced, *samples))),
            _ => (true, Some(format!("fits {reproduced} of {samples} polynomials"))),
        };
        let mut details: Vec<String> =
            list_details(explanation).iter().map(|line| style.format_formulas(line)).collect();
        if !explanation.is_unfinished() {
            details.extend(describe_others(&explanation.same_as));
        }
        let example =
            explanation.example.as_ref().map(|example| list_example_lines(example, style)).unwrap_or_default();
        Self { is_likely, sentence: describe(explanation), evidence, details, example }
    }
}

/// Describes how many of the tried wrong steps a mistake reproduces. The trace may have more wrong steps, which were
/// not tried.
fn describe_evidence(reproduced: u64, samples: u64) -> String {
    match samples {
        1 if reproduced == 1 => "reproduces the only wrong step tried".to_owned(),
        _ if reproduced == samples => format!("reproduces all {samples} wrong steps tried"),
        _ => format!("reproduces {reproduced} of {samples} wrong steps tried"),
    }
}

fn list_explanation_lines(explanation: &Explanation, style: Style) -> Vec<String> {
    let ExplanationParts { is_likely, sentence: what, evidence, details, example } =
        ExplanationParts::new(explanation, style);
    let likely = if is_likely { "likely mistake: " } else { "" };
    let evidence = evidence.map_or_else(String::new, |evidence| format!(" ({evidence})"));
    let mut lines = vec![format!("{likely}{what}{evidence}")];
    lines.extend(details.iter().chain(&example).map(|line| format!("  {line}")));
    lines
}

/// Describes the explanations that can't be distinguished from this one. Known mistakes are named. Others have no
/// sentence, so they are only counted.
fn describe_others(keys: &[String]) -> Option<String> {
    let named: Vec<String> = keys.iter().filter_map(|key| known_sentence(key)).collect();
    let (shown, left_out) = named.split_at(named.len().min(MAX_LISTED));
    let more_count = left_out.len() + keys.len() - named.len();
    match (shown.is_empty(), more_count) {
        (true, 0) => None,
        (true, _) => {
            Some(format!("Cannot be distinguished here from {}", format_count(more_count as u64, "other formula")))
        }
        (false, 0) => Some(format!("Cannot be distinguished here from: {}.", list_sentences(shown))),
        (false, _) => {
            Some(format!("Cannot be distinguished here from: {}; and {more_count} more.", list_sentences(shown)))
        }
    }
}

/// Joins sentences, each of which may contain a colon, into one list.
fn list_sentences(sentences: &[String]) -> String {
    sentences.iter().map(|sentence| sentence.trim_end_matches('.')).collect::<Vec<_>>().join("; ")
}

fn list_example_lines(example: &Example, style: Style) -> Vec<String> {
    let given = example.given.iter();
    let given: Vec<String> = given
        .map(|given| format!("{} = {}", style.format_formulas(&to_key(&given.input)), format_vector(&given.value)))
        .collect();
    let mut lines = vec![format!("example: step {}, {}", example.step, describe_place(&example.place))];
    if !given.is_empty() {
        lines.push(format!("  given     {}", given.join(", ")));
    }
    let is_polynomial = matches!(
        example.place,
        ExamplePlace::Given { .. } | ExamplePlace::Polynomial { .. } | ExamplePlace::NumberedPolynomial(_)
    );
    let [expected, actual] = [&example.expected, &example.actual]
        .map(|values| if is_polynomial { format_polynomial(values, format_exact) } else { format_list(values) });
    lines.extend([format!("  expected  {expected}"), format!("  actual    {actual}")]);
    lines
}

fn format_vector(values: &[f64]) -> String {
    let number = |value: &f64| format_rounded_or(*value, format_exact);
    match values {
        [value] => number(value),
        values => format!("({})", values.iter().map(number).collect::<Vec<_>>().join(", ")),
    }
}

fn format_list(values: &[f64]) -> String {
    if values.is_empty() {
        return "nothing".to_owned();
    }
    values.iter().map(|value| format_exact(*value)).collect::<Vec<_>>().join(", ")
}

view! {
    /// An explanation in JSON, with its key, its evidence and its sentences.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ExplanationView from explanation: Explanation {
        /// A name for the mistake that programs can rely on. It never changes.
        pub key: String = explanation.key.clone(),
        /// The sentence that names the mistake.
        pub text: String = describe(explanation),
        /// The exact form of the mistake, one entry per line.
        pub details: Vec<String> = list_details(explanation),
        /// The number of `samples` that the mistake reproduces.
        pub reproduced: u64 = explanation.reproduced,
        /// The number of polynomials or steps that were checked.
        pub samples: u64 = explanation.samples,
        /// The keys of mistakes that can't be distinguished from this one.
        pub same_as: Vec<String> = explanation.same_as.clone(),
        /// A small instance of the mistake; null if there is none.
        pub example: Option<ExampleView> = explanation.example.as_ref().map(ExampleView::from),
    }
}

view! {
    /// A small instance of a mistake in JSON.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ExampleView from example: Example {
        /// The number of the step, from 1.
        pub step: u32 = example.step,
        /// The place of the example in the step, as text.
        pub place: String = describe_place(&example.place),
        /// The values from which the example is computed.
        pub given: Vec<ExampleValue> = example.given.clone(),
        /// The result that a correct program computes.
        #[serde(with = "fosssim_num::number_serde")]
        #[schemars(with = "Vec<crate::view::WrittenNumber>")]
        pub expected: Vec<f64> = example.expected.clone(),
        /// The result that this program computes.
        #[serde(with = "fosssim_num::number_serde")]
        #[schemars(with = "Vec<crate::view::WrittenNumber>")]
        pub actual: Vec<f64> = example.actual.clone(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use fosssim_findings::Hints;
    use fosssim_judge::Role;
    use fosssim_mistakes::diagnose::{Detail, PolynomialDetail, PolynomialEvidence, Weight, explain, find_formula};
    use fosssim_mistakes::together::disclosure::limit_explanations;
    use fosssim_model::{
        scene::original,
        sim::{Pair, PairKind},
    };
    use fosssim_student::{
        self as student, CATALOG, RowKind, Student,
        assignments::t2m2::{Input, Reading, Subject},
        find,
    };
    use fosssim_testing::scenes;

    /// Returns one explanation with all parts, and one with as few as possible.
    pub(crate) fn explanations() -> Vec<Explanation> {
        let input = |input, value: &[f64]| ExampleValue { input, value: value.to_vec() };
        let pair = Pair { kind: PairKind::ParticleEdge, first: 3, second: 1 };
        let subject = Subject::EdgeOverlap;
        let (reading, letters) = (Reading { subject, number: 0 }, vec!["i".into(), "R^2".into()]);
        let weight = Weight { reading, power: 2, letters, expected: 1.0, actual: 0.0 };
        vec![
            Explanation {
                key: "pe-radius-not-squared".to_owned(),
                topic: ExplanationTopic::Mistake,
                details: vec![Detail::Polynomial(PolynomialDetail::Weight(weight))],
                reproduced: 11,
                samples: 12,
                example: Some(Example {
                    step: 3,
                    place: ExamplePlace::Polynomial { pair, pass: 0, role: Role::Overlap },
                    given: vec![input(Input::X1, &[0.5, -1.0]), input(Input::Re, &[0.25])],
                    expected: vec![1.0, -0.125],
                    actual: vec![1.0, f64::NAN],
                }),
                same_as: ["a", "b", "c", "d", "e"].map(str::to_owned).into(),
                contradicted_keys: Vec::new(),
                claims: Vec::new(),
            },
            Explanation {
                key: "unexplained".to_owned(),
                topic: ExplanationTopic::Polynomials { subjects: vec![subject], found: PolynomialEvidence::Nothing },
                details: Vec::new(),
                reproduced: 0,
                samples: 9,
                example: None,
                same_as: Vec::new(),
                contradicted_keys: Vec::new(),
                claims: Vec::new(),
            },
        ]
    }

    #[test]
    fn the_likeliest_mistake_comes_first_with_all_that_is_known() {
        insta::assert_snapshot!(explanation_texts(&explanations(), Style::Plain).join("\n"), @r"
        likely mistake: Particle-edge: The sum of the radii is not squared. (reproduces 11 of 12 wrong steps tried)
          in the coefficient of t^2, i R^2 has the factor 0 instead of 1 (i = d32.d32)
          Cannot be distinguished here from 5 other formulas
          example: step 3, particle 3 and edge 1, pass 1, overlap polynomial
            given     x1 = (0.5, -1), re = 0.25
            expected  t - 0.125
            actual    t + nan
        No simple mistake explains the polynomial: particle-edge overlap. (9 checked)
        ");
        assert_eq!(
            render_sentence(&explanations()).as_deref(),
            Some("likely mistake: Particle-edge: The sum of the radii is not squared.")
        );
        assert_eq!(
            render_sentence(&explanations()[1..]).as_deref(),
            Some("No simple mistake explains the polynomial: particle-edge overlap.")
        );
        assert_eq!((explanation_texts(&[], Style::Plain), render_sentence(&[])), (Vec::new(), None));
        let cataloged = |key: &str| {
            let key = key.to_owned();
            Explanation { key, reproduced: 5, samples: 5, ..explanations().swap_remove(0) }
        };
        let sentences = ["pp-no-two", "response-sign"].map(|key| find(key).expect("a row").sentence());
        assert_eq!(
            render_sentence(&["pp-no-two", "response-sign"].map(cataloged)),
            Some(format!("likely mistakes: {}", sentences.join(" ")))
        );
    }

    /// A run of the reference with this mistake writes the same values. Fitted weights would therefore add nothing to
    /// the mistake's term.
    #[test]
    fn a_known_mistake_has_a_term_and_no_weights() {
        let weights = |explanation: Explanation| match explanation.details.as_slice() {
            [Detail::Polynomial(PolynomialDetail::Weight(weight))] => vec![weight.clone()],
            other => panic!("{other:?}"),
        };
        let mut one = explanations().swap_remove(0);
        let other = Detail::Polynomial(PolynomialDetail::Alternative(weights(one.clone())));
        one.details.push(other);
        assert!(list_details(&one)[1].starts_with("Cannot be distinguished"));
        one.details.insert(0, Detail::Term("pe-radius-not-squared".into()));
        let row = find("pe-radius-not-squared").expect("a row");
        assert_eq!(list_details(&one), [row.term]);
    }

    #[test]
    fn hints_decide_what_is_there_to_be_shown() {
        let told = |hints: Hints| explanation_texts(&limit_explanations(hints, explanations()), Style::Plain);
        assert!(told(Hints::Where).is_empty());
        let what = told(Hints::What);
        assert_eq!(what.len(), 2);
        assert!(!what.join("\n").contains("weight") && !what.join("\n").contains("0.125"), "{what:?}");
        assert_eq!(told(Hints::Full), explanation_texts(&explanations(), Style::Plain));
    }

    #[test]
    fn json_holds_the_same() {
        let view = serde_json::to_value(ExplanationView::from(&explanations()[0])).expect("JSON");
        assert_eq!(view["key"], "pe-radius-not-squared");
        assert_eq!(view["example"]["given"][1]["value"][0], 0.25);
        assert_eq!(view["example"]["actual"][1], "nan");
        assert_eq!(view["same_as"].as_array().map(Vec::len), Some(5));
    }

    #[test]
    fn no_mistake_of_the_catalog_gives_a_formula_away_below_full() {
        let scene = original::read(scenes::ALL_KINDS.as_bytes()).expect("a scene").scene;
        let mut told = 0;
        for row in CATALOG.iter().filter(|row| row.kind == RowKind::Wrong) {
            let trace =
                student::record_trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
            for one in limit_explanations(Hints::What, explain(&scene, &trace)) {
                let others = one.same_as.iter().map(|key| find(key).expect("a known mistake").sentence());
                for sentence in others.chain([describe(&one)]) {
                    assert_eq!(find_formula(&sentence), None, "{}: {one:?}", row.id);
                }
                assert!(one.details.is_empty() && one.example.is_none(), "{one:?}");
                told += 1;
            }
        }
        assert!(told > 100, "{told} explanations");
    }
}
