//! Describes wrong polynomials.
use super::{capitalize, letters};
use crate::number::format_short;
use fosssim_judge::PowerText;
use fosssim_mistakes::diagnose::{Guess, PolynomialDetail, PolynomialEvidence, Substitute, Weight};
use fosssim_model::sim::PairKind;
use fosssim_student::assignments::t2m2::{Letter, Reading, Subject, find_edit, letter};

/// Describes the fault of wrong polynomials.
pub(super) fn describe_evidence(subjects: &[Subject], found: &PolynomialEvidence) -> String {
    let names: Vec<&str> = subjects.iter().map(|subject| subject.name()).collect();
    let names = names.join(", ");
    let beginning = capitalize(&names);
    match found {
        PolynomialEvidence::Guess(guess) => format!("{beginning}: {}.", describe_guess(guess)),
        PolynomialEvidence::Missing => format!("Polynomials are not passed to the root finder: {names}."),
        PolynomialEvidence::NearlyRight => {
            format!("{beginning}: The formula is right, but has more round-off than the rules allow.")
        }
        PolynomialEvidence::Nothing => {
            let plural = if subjects.len() > 1 { "s" } else { "" };
            format!("No simple mistake explains the polynomial{plural}: {names}.")
        }
    }
}

fn describe_guess(guess: &Guess) -> String {
    match guess {
        Guess::List(guess) => guess.words().to_owned(),
        Guess::Named(key) => find_edit(key).map_or(key.as_ref(), |edit| edit.sentence).to_owned(),
        Guess::Quantity(guess) => guess.words().to_owned(),
        Guess::Coefficients { powers, wrong } => {
            let names: Vec<&str> = powers.iter().map(|power| power_name(*power)).collect();
            wrong.words().replace("{}", &names.join(", "))
        }
    }
}

/// Names the coefficient of a power of t.
const fn power_name(power: usize) -> &'static str {
    match power {
        0 => "constant",
        1 => "linear",
        2 => "quadratic",
        3 => "cubic",
        4 => "quartic",
        _ => "quintic",
    }
}

/// Renders a line about the exact form of the mistake.
pub(super) fn describe_detail(detail: &PolynomialDetail) -> String {
    match detail {
        PolynomialDetail::Logged { logged, of } => format!("{logged} of {of} polynomials are logged per detection"),
        PolynomialDetail::RightUpTo(error) => format!("right up to {error:.0e} of the size of its terms"),
        PolynomialDetail::Differs { subject, power, count, of } => {
            let beginning = subject.map(|subject| format!("{}: ", subject.name())).unwrap_or_default();
            format!("{beginning}the {} differs in {count} of {of} samples", PowerText(*power))
        }
        PolynomialDetail::Holds(value) => format!("the list always contains only {value}"),
        PolynomialDetail::Every(value) => format!("every coefficient is {value}"),
        PolynomialDetail::SinglePrecision => "every value is a float".to_owned(),
        PolynomialDetail::InPlaceOf { used, expected } => {
            format!("the {} polynomial is used instead of {}", used.name(), expected.name())
        }
        PolynomialDetail::Exchanged { powers: [one, other] } => {
            format!("the {} and the {} are exchanged", PowerText(*one), PowerText(*other))
        }
        PolynomialDetail::LastOnly(1) => "only the constant coefficient is there".to_owned(),
        PolynomialDetail::LastOnly(length) => format!("only the last {length} coefficients are there"),
        PolynomialDetail::FirstOnly(length) => format!("only the first {length} coefficients are there"),
        PolynomialDetail::Displacements(factor) => format!("every displacement is multiplied by {factor}"),
        PolynomialDetail::Reach { kind, used, expected } => {
            let name = if *kind == PairKind::ParticleHalfPlane { "the radius" } else { "the sum of the radii" };
            format!("{name} is {used} instead of {}", format_short(*expected))
        }
        PolynomialDetail::Named { key, has_only_edge_pairs } => {
            letters::name_radii(find_edit(key).map_or(key.as_ref(), |edit| edit.detail), *has_only_edge_pairs)
        }
        PolynomialDetail::StandsFor { reading, letter, stand } => describe_substitute(*reading, letter, stand),
        PolynomialDetail::Factor { power, factor } if *factor == 0.0 => format!("the {} is 0", PowerText(*power)),
        PolynomialDetail::Factor { power, factor } => format!("the {} is multiplied by {factor}", PowerText(*power)),
        PolynomialDetail::Unknown { power } => format!("no simple change explains the {}", PowerText(*power)),
        PolynomialDetail::Weight(weight) => describe_weight(weight),
        PolynomialDetail::Alternative(weights) => {
            let weights: Vec<String> = weights.iter().map(describe_weight).collect();
            format!("Cannot be distinguished here from: {}", weights.join("; "))
        }
    }
}

/// Returns the meaning of a letter in a formula; `None` if the letter's name explains it.
fn letter_meaning(reading: Reading, name: &str) -> Option<&'static str> {
    letter(reading, name).map(|Letter { meaning, .. }| *meaning).filter(|meaning| !meaning.is_empty())
}

/// Writes a letter of a formula with its meaning.
fn describe_letter(reading: Reading, name: &str) -> String {
    letter_meaning(reading, name).map_or_else(|| name.to_owned(), |meaning| format!("{name} = {meaning}"))
}

fn describe_substitute(reading: Reading, letter: &str, stand: &Substitute) -> String {
    let stand = match stand {
        Substitute::Scaled(factor) => format!("{factor} {letter}"),
        Substitute::Letter(other) => describe_letter(reading, other),
        Substitute::Dot { vectors: [one, two], negated } => format!("{}{one}.{two}", if *negated { "-" } else { "" }),
        Substitute::One => "1".to_owned(),
    };
    match letter_meaning(reading, letter) {
        None => format!("{stand} is used instead of {letter}"),
        Some(meaning) => format!("{stand} is used instead of {letter} = {meaning}"),
    }
}

fn describe_weight(weight: &Weight) -> String {
    let Weight { reading, power, letters, expected, actual } = weight;
    let mut meanings: Vec<String> = letters
        .iter()
        .filter(|name| letter_meaning(*reading, name).is_some())
        .map(|name| describe_letter(*reading, name))
        .collect();
    meanings.dedup();
    let meanings = if meanings.is_empty() { String::new() } else { format!(" ({})", meanings.join(", ")) };
    let (power, product) = (PowerText(*power), letters.join(" "));
    format!("in the {power}, {product} has the factor {actual} instead of {expected}{meanings}")
}
