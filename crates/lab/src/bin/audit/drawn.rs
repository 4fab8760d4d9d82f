//! Random traces on random scenes: polynomials with factors, roundings and lost coefficients, near the bounds of what
//! is right. Judging by the shortcuts and the full way have to say the same to the last field.
use super::{Random, judging::both_ways, lanes};
use fosssim_lab::runs::{frames, is_accepted, reference};
use fosssim_oracle::{
    scene::Scene,
    student::{self, CATALOGUE, Student},
    trace::{Layout, Writer},
};
use rayon::prelude::*;
use std::process::ExitCode;

/// Programs with other polynomials that are right; half of the traces are theirs, the others begin with the
/// reference's.
const VARIANTS: [&str; 4] = ["quintic-right", "normalised-per-pair", "rearranged-pe", "rearranged-pp"];

/// The number of differing lines that are shown, around the first place.
const SHOWN: usize = 20;

/// Compares this number of traces.
pub fn run(traces: u64, seed: u64) -> ExitCode {
    let compared: Vec<(bool, Vec<String>)> =
        (0..traces).into_par_iter().filter_map(|number| compare(number, seed)).collect();
    let accepted = compared.iter().filter(|(accepted, _)| *accepted).count();
    let differing: Vec<&String> = compared.iter().flat_map(|(_, differing)| differing).collect();
    println!("{traces} traces, {accepted} accepted by the fair rules, {} outcomes differ", differing.len());
    differing.iter().take(SHOWN).for_each(|what| println!("{what}"));
    ExitCode::from(u8::from(!differing.is_empty()))
}

/// Whether the fair rules accept a trace, and how its outcomes differ around the first place.
fn compare(number: u64, seed: u64) -> Option<(bool, Vec<String>)> {
    let mut random = Random::new(seed, number);
    let scene = lanes::draw(&mut random);
    let trace = draw(&mut random, &scene)?;
    let mut differing = Vec::new();
    let mut accepted = false;
    for fair in [false, true] {
        let outcomes = both_ways(&scene, &trace, fair);
        accepted |= is_accepted(&outcomes[0]);
        let [one, other] = outcomes.map(|outcome| format!("{outcome:?}"));
        if one != other {
            let first = one.bytes().zip(other.bytes()).take_while(|(one, other)| one == other).count();
            let [one, other] =
                [one, other].map(|text| text.chars().skip(first.saturating_sub(200)).take(400).collect::<String>());
            differing.push(format!("trace {number}, fair {fair}, {:?}:\n  {one}\n  {other}", scene.collision));
        }
    }
    Some((accepted, differing))
}

/// A trace; none where the scene has no result.
fn draw(random: &mut Random, scene: &Scene) -> Option<Vec<u8>> {
    let own = if random.chance(2) {
        let id = VARIANTS[random.below(VARIANTS.len() as u64) as usize];
        let row = CATALOGUE.iter().find(|row| row.id == id).expect("a variant");
        student::trace(scene, Student::new(Some(row.mistake))).ok()?
    } else {
        reference(scene)?
    };
    let factors = RandomFactors::draw(random);
    let noise = [0.0, 1.0, random.log(0.0, 3.0)][random.below(3) as usize];
    let every = 1 + random.below(40);
    let seed = random.bits();
    let mut writer = Writer::new(Vec::new(), Layout::of(scene));
    for (number, mut frame) in (0_u64..).zip(frames(scene, &own)) {
        // Both records of a step change alike.
        let step = number.div_ceil(2);
        let log = std::mem::take(&mut frame.polynomials);
        for (index, own) in log.iter().enumerate() {
            let mut random = Random::new(seed, step.wrapping_mul(0x9E37_79B9) ^ index as u64);
            let factor = factors.of(&mut random, index);
            let sum: f64 = own.iter().map(|c| c.abs()).sum();
            let is_noisy = noise > 0.0 && random.below(every) == 0;
            let changed = own.iter().map(|c| {
                let off = if is_noisy { noise * random.uniform(-1.0, 1.0) * f64::EPSILON } else { 0.0 };
                factor * (c + off * if random.chance(2) { *c } else { sum })
            });
            let changed: Vec<f64> = changed.skip_while(|c| c.abs() < 1e-12).collect();
            frame.polynomials.push(&changed);
        }
        writer.frame(&frame);
    }
    Some(writer.finish().expect("memory").0)
}

/// The factors of a program's polynomials.
enum RandomFactors {
    /// One for all.
    One(f64),
    /// One for each of several in turn.
    InTurn([f64; 6]),
    /// Another one each time.
    Each,
}

impl RandomFactors {
    fn draw(random: &mut Random) -> Self {
        match random.below(4) {
            0 => Self::One(1.0),
            1 => Self::One(if random.chance(2) { random.log(-13.0, 8.0) } else { random.log(-1.0, 1.0) }),
            2 => Self::InTurn(std::array::from_fn(|_| random.log(-2.0, 2.0))),
            _ => Self::Each,
        }
    }

    fn of(&self, random: &mut Random, index: usize) -> f64 {
        match self {
            Self::One(factor) => *factor,
            Self::InTurn(factors) => factors[index % factors.len()],
            Self::Each => random.log(-1.0, 1.0),
        }
    }
}
