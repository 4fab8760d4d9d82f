//! Explanations as the journal keeps them.
//!
//! Numbers are kept as text: JSON has none for values that are not finite, and a shortest text reads back exactly.
use fosssim_mistakes::diagnose::{Example, ExampleValue, Explanation};
use serde::{Deserialize, Serialize};

/// An explanation, line by line of [`Explanation`].
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct KeptExplanation {
    key: String,
    what: String,
    details: Vec<String>,
    reproduced: u64,
    samples: u64,
    example: Option<KeptExample>,
    same_as: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct KeptExample {
    step: u32,
    place: String,
    given: Vec<(String, Vec<String>)>,
    expected: Vec<String>,
    actual: Vec<String>,
}

impl From<&Explanation> for KeptExplanation {
    fn from(explanation: &Explanation) -> Self {
        Self {
            key: explanation.key.clone(),
            what: explanation.what.clone(),
            details: explanation.details.clone(),
            reproduced: explanation.reproduced,
            samples: explanation.samples,
            example: explanation.example.as_ref().map(|example| KeptExample {
                step: example.step,
                place: example.place.clone(),
                given: example.given.iter().map(|input| (input.name.clone(), texts(&input.value))).collect(),
                expected: texts(&example.expected),
                actual: texts(&example.actual),
            }),
            same_as: explanation.same_as.clone(),
        }
    }
}

impl From<KeptExplanation> for Explanation {
    fn from(kept: KeptExplanation) -> Self {
        Self {
            key: kept.key,
            what: kept.what,
            details: kept.details,
            reproduced: kept.reproduced,
            samples: kept.samples,
            example: kept.example.map(|example| Example {
                step: example.step,
                place: example.place,
                given: example
                    .given
                    .into_iter()
                    .map(|(name, value)| ExampleValue { name, value: numbers(&value) })
                    .collect(),
                expected: numbers(&example.expected),
                actual: numbers(&example.actual),
            }),
            same_as: kept.same_as,
        }
    }
}

fn texts(values: &[f64]) -> Vec<String> {
    values.iter().map(f64::to_string).collect()
}

/// What somebody has made unreadable becomes NaN.
fn numbers(texts: &[String]) -> Vec<f64> {
    texts.iter().map(|text| text.parse().unwrap_or(f64::NAN)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_reads_back_the_same() {
        let explanation = Explanation {
            key: "reversed".to_owned(),
            what: "The coefficients are reversed.".to_owned(),
            details: vec!["t^2".to_owned()],
            reproduced: 4,
            samples: 5,
            example: Some(Example {
                step: 7,
                place: "particles 0 and 1".to_owned(),
                given: vec![ExampleValue { name: "x1".to_owned(), value: vec![0.1, -1e-300] }],
                expected: vec![f64::INFINITY, 1.0 / 3.0],
                actual: vec![f64::NEG_INFINITY],
            }),
            same_as: vec!["other".to_owned()],
        };
        let line = serde_json::to_string(&KeptExplanation::from(&explanation)).expect("JSON");
        let kept: KeptExplanation = serde_json::from_str(&line).expect("JSON");
        assert_eq!(Explanation::from(kept), explanation);
    }
}
