//! The sample that shows a mistake best: wrong, with inputs that are quickly written down, early.
use super::study::{Case, Study};
use crate::assignments::t2m2::{Body, Motion};
use crate::diagnose::{Example, ExampleValue};
use fosssim_judge::PairWords;
use fosssim_num::{polynomial::Polynomial, vector::Vec2};

fosssim_model::drops_leading!();

/// The example of a study, with the number of characters that its inputs take.
pub(super) fn smallest(study: &Study) -> Option<(usize, Example)> {
    let wrong = study.cases.iter().filter(|case| !case.right);
    let best = wrong.min_by_key(|case| (digits(case), case.sample.step, case.sample.pass))?;
    Some((digits(best), example(study, best)))
}

fn example(study: &Study, case: &Case) -> Example {
    let sample = case.sample;
    let expected: Vec<f64> = case.expected.iter().map(|coefficient| coefficient.value).collect();
    Example {
        step: sample.step,
        place: format!("{}, pass {}, {} polynomial", PairWords(sample.pair), sample.pass, study.subject.name()),
        given: given(&sample.motion),
        // As the course's library would log it.
        expected: Polynomial::trimmed(&expected).coefficients().to_vec(),
        actual: case.logged.to_vec(),
    }
}

/// How many characters the inputs take.
fn digits(case: &Case) -> usize {
    given(&case.sample.motion).iter().flat_map(|input| &input.value).map(|value| value.to_string().len()).sum()
}

fn given(motion: &Motion) -> Vec<ExampleValue> {
    match motion {
        Motion::Particles { bodies, radii } => {
            let mut list = moving(bodies);
            list.extend([number("r1", radii[0]), number("r2", radii[1])]);
            list
        }
        Motion::Edge { bodies, radii } => {
            let mut list = moving(bodies);
            list.extend([number("r1", radii[0]), number("re", radii[1])]);
            list
        }
        Motion::HalfPlane { body, radius, point, normal } => vec![
            vector("x", body.start),
            vector("dx", body.displacement),
            vector("p", *point),
            vector("n", *normal),
            number("r", *radius),
        ],
    }
}

fn moving(bodies: &[Body]) -> Vec<ExampleValue> {
    let starts = ["x1", "x2", "x3"].into_iter().zip(bodies).map(|(name, body)| vector(name, body.start));
    let moves = ["dx1", "dx2", "dx3"].into_iter().zip(bodies).map(|(name, body)| vector(name, body.displacement));
    starts.chain(moves).collect()
}

fn vector(name: &'static str, value: Vec2) -> ExampleValue {
    ExampleValue { name: name.to_owned(), value: vec![value.x, value.y] }
}

fn number(name: &'static str, value: f64) -> ExampleValue {
    ExampleValue { name: name.to_owned(), value: vec![value] }
}
