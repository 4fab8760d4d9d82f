//! Finds the sample that shows a mistake best: it is wrong, early, and has short inputs.
use super::study::{PolynomialSample, PolynomialStudy};
use crate::diagnose::{Example, ExamplePlace, ExampleValue};
use fosssim_model::sim::{PairMotion, PointMotion};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use fosssim_student::assignments::t2m2::Input;

fosssim_model::drops_leading!();

/// Returns the wrong sample with the shortest inputs as an example, after the number of characters of these inputs.
/// Returns `None` if no sample is wrong.
pub(super) fn find_smallest_example(study: &PolynomialStudy) -> Option<(usize, Example)> {
    let wrong = study.cases.iter().filter(|case| !case.is_right);
    let best = wrong.min_by_key(|case| (count_input_characters(case), case.sample.step, case.sample.pass))?;
    Some((count_input_characters(best), build_example(study, best)))
}

fn build_example(study: &PolynomialStudy, case: &PolynomialSample) -> Example {
    let sample = case.sample;
    let expected: Vec<f64> = case.expected.iter().map(|coefficient| coefficient.value).collect();
    Example {
        step: sample.step,
        place: ExamplePlace::Given { pair: sample.pair, pass: sample.pass, subject: study.subject },
        given: example_values(&sample.motion),
        // The polynomial in the form in which the course's library would log it.
        expected: Polynomial::trimmed(&expected).coefficients().to_vec(),
        actual: case.logged.to_vec(),
    }
}

/// Returns the number of characters of the inputs.
fn count_input_characters(case: &PolynomialSample) -> usize {
    example_values(&case.sample.motion).iter().flat_map(|input| &input.value).map(|value| value.to_string().len()).sum()
}

fn example_values(motion: &PairMotion) -> Vec<ExampleValue> {
    match motion {
        PairMotion::Particles { centers, radii } => motion_values(centers, [Input::R1, Input::R2], radii),
        PairMotion::Edge { center, ends, radii } => {
            motion_values(&[*center, ends[0], ends[1]], [Input::R1, Input::Re], radii)
        }
        PairMotion::HalfPlane { center, radius, point, normal } => vec![
            vector_value(Input::X, center.start),
            vector_value(Input::Dx, center.shift),
            vector_value(Input::P, *point),
            vector_value(Input::N, *normal),
            number_value(Input::R, *radius),
        ],
    }
}

fn motion_values(points: &[PointMotion], names: [Input; 2], radii: &[f64; 2]) -> Vec<ExampleValue> {
    let starts = [Input::X1, Input::X2, Input::X3].into_iter().zip(points.iter().map(|point| point.start));
    let shifts = [Input::Dx1, Input::Dx2, Input::Dx3].into_iter().zip(points.iter().map(|point| point.shift));
    let vectors = starts.chain(shifts).map(|(input, value)| vector_value(input, value));
    vectors.chain(names.into_iter().zip(radii).map(|(input, value)| number_value(input, *value))).collect()
}

fn vector_value(input: Input, value: Vec2) -> ExampleValue {
    ExampleValue { input, value: vec![value.x, value.y] }
}

fn number_value(input: Input, value: f64) -> ExampleValue {
    ExampleValue { input, value: vec![value] }
}
