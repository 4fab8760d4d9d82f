//! Explanations of mistakes: lines for people, a view for programs.
//!
//! They show what they are given: how much that is, [`Hints::cut`](fosssim_grading::config::Hints::cut) decides. Words may
//! come from a submission only as numbers.
use super::{number::exact, view::Number};
use fosssim_mistakes::{
    diagnose::{About, Example, Explanation},
    student::{Row, find},
};
use serde::Serialize;

/// So many other mistakes that can't be told apart are listed.
const LISTED: usize = 3;

/// The lines about explanations, the likeliest first; nothing without any. Indented by two below each sentence.
#[must_use]
pub fn lines(explanations: &[Explanation]) -> Vec<String> {
    explanations.iter().flat_map(of_one).collect()
}

/// The sentence about the likeliest mistake, or about those that explain everything together, for formats with room for one
/// line.
#[must_use]
pub fn sentence(explanations: &[Explanation]) -> Option<String> {
    let together: Vec<&str> = explanations
        .iter()
        .filter(|one| one.is_complete() && one.about == About::Mistake)
        .map(|one| one.what.as_str())
        .collect();
    if together.len() > 1 {
        return Some(format!("likely mistakes: {}", together.join(" ")));
    }
    explanations.first().map(|explanation| match explanation.reproduced {
        0 => explanation.what.clone(),
        _ => format!("likely mistake: {}", explanation.what),
    })
}

fn of_one(explanation: &Explanation) -> Vec<String> {
    // What reproduces nothing is an observation, not a mistake that is likely.
    let mut lines = vec![match explanation {
        Explanation { what, samples: 0, .. } => what.clone(),
        Explanation { what, reproduced: 0, samples, .. } => format!("{what} ({samples} looked at)"),
        Explanation { what, .. } if explanation.is_unfinished() => what.clone(),
        Explanation { about: About::Mistake, what, reproduced, samples, .. } => {
            format!("likely mistake: {what} (in {reproduced} of {samples} wrong steps tried)")
        }
        Explanation { what, reproduced, samples, .. } => {
            format!("likely mistake: {what} (fits {reproduced} of {samples} polynomials looked at)")
        }
    }];
    lines.extend(explanation.details.iter().map(|detail| format!("  {detail}")));
    if !explanation.same_as.is_empty() && !explanation.is_unfinished() {
        let (shown, more) = explanation.same_as.split_at(explanation.same_as.len().min(LISTED));
        let more = if more.is_empty() { String::new() } else { format!(" And {} more.", more.len()) };
        let words = |key: &String| find(key).map_or_else(|| format!("{key}."), Row::sentence);
        let shown: Vec<String> = shown.iter().map(words).collect();
        lines.push(format!("  can't be told apart here from: {}{more}", shown.join(" ")));
    }
    if let Some(example) = &explanation.example {
        lines.extend(of_example(example));
    }
    lines
}

fn of_example(example: &Example) -> Vec<String> {
    let given: Vec<String> =
        example.given.iter().map(|input| format!("{} = {}", input.name, vector(&input.value))).collect();
    let mut lines = vec![format!("  example: step {}, {}", example.step, example.place)];
    if !given.is_empty() {
        lines.push(format!("    given     {}", given.join(", ")));
    }
    lines.push(format!("    expected  {}", list(&example.expected)));
    lines.push(format!("    actual    {}", list(&example.actual)));
    lines
}

fn vector(values: &[f64]) -> String {
    match values {
        [value] => exact(*value),
        values => format!("({})", list(values)),
    }
}

fn list(values: &[f64]) -> String {
    if values.is_empty() {
        return "nothing".to_owned();
    }
    values.iter().map(|value| exact(*value)).collect::<Vec<_>>().join(", ")
}

/// An explanation in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExplanationView {
    /// A stable key.
    pub key: String,
    /// The sentence.
    pub text: String,
    /// The exact form, one line each.
    pub details: Vec<String>,
    /// Of `samples`, how many it reproduces.
    pub reproduced: u64,
    /// Polynomials or steps that were looked at.
    pub samples: u64,
    /// Keys of mistakes that can't be told apart from it.
    pub same_as: Vec<String>,
    /// A small instance.
    pub example: Option<ExampleView>,
}

/// An example in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExampleView {
    /// The step, from 1.
    pub step: u32,
    /// Where, in words.
    pub place: String,
    /// What went in.
    pub given: Vec<InputView>,
    /// What should have come out.
    pub expected: Vec<Number>,
    /// What did.
    pub actual: Vec<Number>,
}

/// A named input in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputView {
    /// Its name.
    pub name: String,
    /// Its components.
    pub value: Vec<Number>,
}

impl From<&Explanation> for ExplanationView {
    fn from(explanation: &Explanation) -> Self {
        Self {
            key: explanation.key.clone(),
            text: explanation.what.clone(),
            details: explanation.details.clone(),
            reproduced: explanation.reproduced,
            samples: explanation.samples,
            same_as: explanation.same_as.clone(),
            example: explanation.example.as_ref().map(ExampleView::from),
        }
    }
}

impl From<&Example> for ExampleView {
    fn from(example: &Example) -> Self {
        let numbers = |values: &[f64]| values.iter().copied().map(Number).collect();
        Self {
            step: example.step,
            place: example.place.clone(),
            given: example
                .given
                .iter()
                .map(|input| InputView { name: input.name.clone(), value: numbers(&input.value) })
                .collect(),
            expected: numbers(&example.expected),
            actual: numbers(&example.actual),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use fosssim_grading::config::Hints;
    use fosssim_mistakes::diagnose::{ExampleValue, OfPolynomials};

    /// One with everything, one with the least.
    pub(crate) fn explanations() -> Vec<Explanation> {
        let input = |name: &str, value: &[f64]| ExampleValue { name: name.to_owned(), value: value.to_vec() };
        vec![
            Explanation {
                key: "pe-radius-not-squared".to_owned(),
                about: About::Mistake,
                what: "The sum of radii is not squared.".to_owned(),
                details: vec!["t^2: R^2 (e1.e1) has weight 0, expected 1".to_owned()],
                reproduced: 11,
                samples: 12,
                example: Some(Example {
                    step: 3,
                    place: "particle 3 and edge 1, pass 0".to_owned(),
                    given: vec![input("x1", &[0.5, -1.0]), input("R", &[0.25])],
                    expected: vec![1.0, -0.125],
                    actual: vec![1.0, f64::NAN],
                }),
                same_as: ["a", "b", "c", "d", "e"].map(str::to_owned).into(),
            },
            Explanation {
                key: "unexplained".to_owned(),
                about: About::Polynomials { kinds: Vec::new(), found: OfPolynomials::Nothing },
                what: "Nothing that is known explains the overlap polynomial.".to_owned(),
                details: Vec::new(),
                reproduced: 0,
                samples: 9,
                example: None,
                same_as: Vec::new(),
            },
        ]
    }

    #[test]
    fn the_likeliest_mistake_comes_first_with_all_that_is_known() {
        insta::assert_snapshot!(lines(&explanations()).join("\n"), @r"
        likely mistake: The sum of radii is not squared. (in 11 of 12 wrong steps tried)
          t^2: R^2 (e1.e1) has weight 0, expected 1
          can't be told apart here from: a. b. c. And 2 more.
          example: step 3, particle 3 and edge 1, pass 0
            given     x1 = (0.5, -1), R = 0.25
            expected  1, -0.125
            actual    1, nan
        Nothing that is known explains the overlap polynomial. (9 looked at)
        ");
        assert_eq!(sentence(&explanations()).as_deref(), Some("likely mistake: The sum of radii is not squared."));
        assert_eq!(
            sentence(&explanations()[1..]).as_deref(),
            Some("Nothing that is known explains the overlap polynomial.")
        );
        assert_eq!((lines(&[]), sentence(&[])), (Vec::new(), None));
        let known = |key: &str, what: &str| {
            let (key, what) = (key.to_owned(), what.to_owned());
            Explanation { key, what, reproduced: 5, samples: 5, ..explanations().swap_remove(0) }
        };
        let both = [known("pp-no-two", "One."), known("response-sign", "Two.")];
        assert_eq!(sentence(&both).as_deref(), Some("likely mistakes: One. Two."));
    }

    #[test]
    fn hints_decide_what_is_there_to_be_shown() {
        let told = |hints: Hints| lines(&hints.cut(explanations()));
        assert!(told(Hints::Where).is_empty());
        let what = told(Hints::What);
        assert_eq!(what.len(), 2);
        assert!(!what.join("\n").contains("weight") && !what.join("\n").contains("0.125"), "{what:?}");
        assert_eq!(told(Hints::Full), lines(&explanations()));
    }

    #[test]
    fn json_holds_the_same() {
        let view = serde_json::to_value(ExplanationView::from(&explanations()[0])).expect("JSON");
        assert_eq!(view["key"], "pe-radius-not-squared");
        assert_eq!(view["example"]["given"][1]["value"][0], 0.25);
        assert_eq!(view["example"]["actual"][1], "nan");
        assert_eq!(view["same_as"].as_array().map(Vec::len), Some(5));
    }
}
