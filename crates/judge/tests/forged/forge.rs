//! Correct traces with random errors, programs whose polynomials have factors, and the results that the fair rules may
//! give for both.
use fosssim_judge::{
    Finding, FindingKind,
    fair::{
        FairVerdict, Judgment,
        compare::{compare, is_round_off, shows_factor},
        formulas::{BoundedPairMotion, ExpectedPolynomials},
    },
    replay::{self, Options},
};
use fosssim_model::{
    scene::Scene,
    sim::{Detection, Observer, Pair, PairKind, RootSearch, Simulation, SteeringObserver, StepController},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use fosssim_num::{bounded::BoundedValue, polynomial::Polynomial};

/// Products of coefficients of this size overflow.
const OVERFLOWS: f64 = 1e100;

/// The number of steps up to which a single polynomial may be a tenth of its kind, so that its factor is no outlier.
const FEW: usize = 40;

/// A generator of numbers that look random and are the same in every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    /// Returns ten to the power of a uniform number.
    fn log(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(low + (high - low) * self.bits() as f64 / (1_u64 << 53) as f64)
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

/// A polynomial of the reference's own run.
struct Known {
    pair: Pair,
    number: usize,
    expected: ExpectedPolynomials,
}

/// A scene, its correct trace, and the right values of its polynomials.
pub struct Stage {
    name: String,
    scene: Scene,
    frames: Vec<Frame>,
    steps: Vec<Vec<Known>>,
}

/// Records the right value of each polynomial.
struct Note<'a>(&'a Scene, Vec<Known>);

impl Observer for Note<'_> {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let &Detection { pair, q_start, q_end, .. } = detection;
        let expected = BoundedPairMotion::for_pair(self.0, pair, q_start, q_end).polynomials();
        self.1.extend((0..pair.kind.polynomial_count()).map(|number| Known { pair, number, expected }));
    }
}

/// Multiplies polynomials. The course's library drops the coefficients that become small, and the step continues with
/// the others.
struct Multiply<'a, F>(&'a Scene, F);

impl<F: FnMut(Pair, usize, &[f64]) -> f64> StepController for Multiply<'_, F> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        let whole = BoundedPairMotion::for_pair(self.0, pair, q_start, q_end).polynomials();
        for (number, polynomial) in polynomials.iter_mut().enumerate() {
            let factor = (self.1)(pair, number, polynomial.coefficients());
            let own: Vec<f64> = whole.polynomial(number).iter().map(|c| c.value).collect();
            *polynomial = scaled(&own, if factor.is_finite() { factor } else { 1.0 });
        }
    }
}

fn scaled(list: &[f64], factor: f64) -> Polynomial {
    Polynomial::trimmed(&list.iter().map(|c| factor * c).collect::<Vec<_>>())
}

impl Stage {
    /// Returns the stage of a scene, or `None` if the scene logs no polynomials or the reference has no result.
    pub fn of(name: &str, scene: Scene) -> Option<Self> {
        let frames = run(&scene, &mut ())?;
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        let mut steps = Vec::new();
        for _ in 0..scene.step_count() {
            let mut note = Note(&scene, Vec::new());
            simulation.step(&mut note).ok()?;
            steps.push(note.1);
        }
        let stage = Self { name: name.to_owned(), scene, frames, steps };
        let is_logged = |step: usize| stage.frames[step * stage.records_per_step()].polynomials.len();
        let are_logged = (1..=stage.steps.len()).all(|step| is_logged(step) == stage.steps[step - 1].len());
        (are_logged && stage.steps.iter().any(|step| !step.is_empty())).then_some(stage)
    }

    fn known(&self, step: usize, index: usize) -> &Known {
        &self.steps[step - 1][index]
    }

    fn records_per_step(&self) -> usize {
        Layout::for_scene(&self.scene).records_per_step() as usize
    }

    /// Returns the correct trace with the polynomials that `change` returns, the same in both records of a step. A
    /// polynomial for which it returns `None` is kept.
    fn relogged(&self, change: impl Fn(usize, usize, &[f64]) -> Option<Vec<f64>>) -> Vec<u8> {
        let mut writer = Writer::new(Vec::new(), Layout::for_scene(&self.scene));
        for (number, frame) in self.frames.iter().enumerate() {
            let mut frame = frame.clone();
            let log = std::mem::take(&mut frame.polynomials);
            let step = number.div_ceil(self.records_per_step());
            for (index, own) in log.iter().enumerate() {
                match change(step, index, own) {
                    Some(list) => frame.polynomials.push(&list),
                    None => frame.polynomials.push(own),
                }
            }
            writer.write_frame(&frame);
        }
        writer.finish().expect("memory").0
    }

    fn judged(&self, trace: &[u8]) -> Result<Judgment, String> {
        let [quick, slow] = [false, true].map(|one_by_one| {
            let options =
                Options { uses_fair_rules: true, threads: 1, judges_individually: one_by_one, ..Options::default() };
            replay::judge(&self.scene, trace, &options, &mut ())
        });
        if format!("{quick:?}") != format!("{slow:?}") {
            return Err("two ways of judging differ".to_owned());
        }
        Ok(*quick.fair.expect("asked"))
    }

    /// Returns the coefficients of the end record's polynomial.
    fn own(&self, step: usize, index: usize) -> &[f64] {
        self.frames[step * self.records_per_step()].polynomials.get(index)
    }
}

/// Returns the frames of a run that `steer` may change, or `None` if the run has a step without a result.
fn run(scene: &Scene, steer: &mut dyn Observer) -> Option<Vec<Frame>> {
    let layout = Layout::for_scene(scene);
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
    for _ in 0..layout.steps {
        simulation.step(&mut (&mut *steer, &mut recorder)).ok()?;
    }
    let trace = recorder.finish().expect("memory").0;
    let mut reader = Reader::from_slice(&trace, layout);
    let (mut frames, mut frame) = (Vec::new(), Frame::default());
    while reader.next(&mut frame).ok()? {
        frames.push(frame.clone());
    }
    Some(frames)
}

/// The factors of a correct trace's polynomials.
#[derive(Debug, Clone, Copy)]
enum Base {
    One,
    Constant(f64),
    /// Each polynomial is divided by its size.
    Size,
}

impl Base {
    fn draw(random: &mut Random) -> Self {
        match random.below(4) {
            0 => Self::Constant(random.log(-5.0, 5.0)),
            1 => Self::Size,
            _ => Self::One,
        }
    }

    fn of(&self, own: &[f64]) -> f64 {
        match *self {
            Self::One => 1.0,
            Self::Constant(factor) => factor,
            Self::Size => own.iter().map(|c| c.abs()).fold(0.0, f64::max).recip(),
        }
    }
}

/// The polynomials that are changed.
#[derive(Debug, Clone, Copy)]
enum Target {
    One {
        step: usize,
        index: usize,
    },
    OfStep {
        step: usize,
        kind: PairKind,
        number: usize,
    },
    OfTrace {
        kind: PairKind,
        number: usize,
    },
    Step {
        step: usize,
    },
    /// About one polynomial in this number.
    Some {
        of: usize,
        seed: u64,
    },
    /// All polynomials except about one in this number.
    AllBut {
        of: usize,
        seed: u64,
    },
}

impl Target {
    fn draw(stage: &Stage, random: &mut Random) -> Self {
        let steps: Vec<usize> = (1..=stage.steps.len()).filter(|step| !stage.steps[step - 1].is_empty()).collect();
        let step = random.pick(&steps);
        let index = random.below(stage.steps[step - 1].len());
        let &Known { pair: Pair { kind, .. }, number, .. } = stage.known(step, index);
        let (of, seed) = (random.pick(&[2, 5, 50, 500]), random.bits());
        match random.below(9) {
            0..=3 => Self::One { step, index },
            4 => Self::OfStep { step, kind, number },
            5 => Self::OfTrace { kind, number },
            6 => Self::Step { step },
            7 => Self::Some { of, seed },
            _ => Self::AllBut { of, seed },
        }
    }

    fn holds(&self, stage: &Stage, at: (usize, usize)) -> bool {
        let known = || stage.known(at.0, at.1);
        let is_one = |of: usize, seed: u64| Random::new(seed ^ (at.0 * 100_003 + at.1) as u64).below(of) == 0;
        match *self {
            Self::One { step, index } => at == (step, index),
            Self::OfStep { step, kind, number } => {
                at.0 == step && known().pair.kind == kind && known().number == number
            }
            Self::OfTrace { kind, number } => known().pair.kind == kind && known().number == number,
            Self::Step { step } => at.0 == step,
            Self::Some { of, seed } => is_one(of, seed),
            Self::AllBut { of, seed } => !is_one(of, seed),
        }
    }
}

/// The change of a polynomial.
#[derive(Debug, Clone, Copy)]
enum Change {
    Empty,
    DropLeading(usize),
    DropTrailing(usize),
    Negate,
    Zeros,
    /// Each polynomial is replaced by another one of the same step, whose index is larger by this number.
    Exchange(usize),
    /// One coefficient gets this value.
    Value(f64),
    Constant(f64),
    LeadingZeros(usize),
    /// The polynomial is multiplied by a factor, and the course's library drops small coefficients.
    Factor(f64),
}

impl Change {
    fn draw(random: &mut Random) -> Self {
        let some = 1 + random.below(5);
        match random.below(12) {
            0..=2 => Self::Empty,
            3 => Self::DropLeading(some),
            4 => Self::DropTrailing(some),
            5 => Self::Negate,
            6 => Self::Zeros,
            7 => Self::Exchange(1 + random.below(40)),
            8 => Self::Value(random.pick(&[f64::NAN, f64::INFINITY, 0.0, 5e-324, 1e300, -1e-9])),
            9 => Self::Constant(random.log(-12.0, 3.0) * random.pick(&[1.0, -1.0])),
            10 => Self::LeadingZeros(some),
            _ => Self::Factor(random.log(-14.0, 0.0)),
        }
    }

    fn of(&self, stage: &Stage, (step, index): (usize, usize), own: &[f64]) -> Vec<f64> {
        let mut list = own.to_vec();
        match *self {
            Self::Empty => list.clear(),
            Self::DropLeading(count) => _ = list.drain(..count.min(own.len())),
            Self::DropTrailing(count) => list.truncate(own.len().saturating_sub(count)),
            Self::Negate => list.iter_mut().for_each(|c| *c = -*c),
            Self::Zeros => list.fill(0.0),
            Self::Exchange(by) => {
                let others = stage.steps[step - 1].len();
                list = stage.own(step, (index + by) % others).to_vec();
            }
            Self::Value(value) => {
                let place = (step + index) % own.len().max(1);
                list.iter_mut().skip(place).take(1).for_each(|c| *c = value);
            }
            Self::Constant(value) => list = vec![value],
            Self::LeadingZeros(count) => _ = list.splice(..0, std::iter::repeat_n(0.0, count)),
            Self::Factor(factor) => list = scaled(own, factor).coefficients().to_vec(),
        }
        list
    }
}

/// Returns whether a changed polynomial may be accepted, whatever the other polynomials are. It may have any numbers if
/// it is zero except for round-off. It is right with the program's factor. It is also right with a factor on which two
/// of its coefficients agree, or with which no coefficient is dropped.
fn has_reason(known: &Known, own: &[f64], list: &[f64], factor: f64) -> bool {
    let of_form = |expected: &[BoundedValue]| {
        let scaled: Vec<BoundedValue> =
            expected.iter().map(|c| BoundedValue { value: factor * c.value, bound: factor * c.bound }).collect();
        let Ok(found) = compare(&scaled, list, &[1.0]) else { return false };
        let is_one = found.scale.is_none_or(|scale| (scale - 1.0).abs() < 1e-9);
        is_round_off(&scaled) || is_one || list.len() >= own.len() || shows_factor(&scaled, list)
    };
    of_form(known.expected.polynomial(known.number)) || known.expected.other_form(known.number).is_some_and(of_form)
}

/// Makes a correct trace wrong. Returns the result of the fair rules if it is not allowed.
pub fn forge(stage: &Stage, random: &mut Random) -> Option<String> {
    let base = Base::draw(random);
    let (target, change) = (Target::draw(stage, random), Change::draw(random));
    // A single polynomial that is multiplied by a factor may be the only evidence for dropped coefficients. Among few
    // polynomials it is sufficient.
    let is_alone = random.below(3) == 0 && stage.steps.len() > FEW;
    let voucher = is_alone.then(|| (Target::draw(stage, random), random.log(-13.0, -6.0)));
    let changed = |step, index, own: &[f64]| {
        let at = (step, index);
        let own = scaled(own, base.of(own));
        let own = own.coefficients();
        match voucher {
            _ if target.holds(stage, at) => change.of(stage, at, own),
            Some((other, factor)) if matches!(other, Target::One { .. }) && other.holds(stage, at) => {
                Change::Factor(factor).of(stage, at, own)
            }
            _ => own.to_vec(),
        }
    };
    let same = |one: &[f64], other: &[f64]| {
        one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.to_bits() == other.to_bits())
    };
    // A polynomial that is multiplied by a factor is right, even if the course's library has dropped its small
    // coefficients.
    let is_of_program = matches!(change, Change::Factor(_));
    let without_reason = (1..=stage.steps.len())
        .flat_map(|step| (0..stage.steps[step - 1].len()).map(move |index| (step, index)))
        .filter(|&at| target.holds(stage, at))
        .find(|&(step, index)| {
            let own = stage.own(step, index);
            let (factor, list) = (base.of(own), changed(step, index, own));
            let right = scaled(own, factor);
            let (right, factor) = (right.coefficients(), if factor.is_finite() { factor } else { 1.0 });
            !same(right, &list) && !has_reason(stage.known(step, index), right, &list, factor)
        });
    let trace = stage.relogged(|step, index, own| Some(changed(step, index, own)));
    let what = || format!("{}: {change:?} of {target:?}, {base:?}, {voucher:?}", stage.name);
    match stage.judged(&trace) {
        Err(fault) => Some(format!("{}: {fault}", what())),
        Ok(judged) if judged.verdict == FairVerdict::Accepted && !is_of_program => {
            without_reason.map(|(step, index)| {
                let known = stage.known(step, index);
                let expected: Vec<f64> = known.expected.polynomial(known.number).iter().map(|c| c.value).collect();
                let list = changed(step, index, stage.own(step, index));
                format!("{}: accepted, step {step}, {:?} {expected:?} {list:?}", what(), known.pair)
            })
        }
        Ok(_) => None,
    }
}

/// The factors of a program's polynomials.
#[derive(Debug, Clone, Copy)]
enum Factors {
    All(f64),
    Kind(PairKind, f64),
    Number(PairKind, usize, f64),
    /// Each polynomial has another factor, between 1 and this.
    Each(f64),
    /// Each pair has another factor, between this and its reciprocal.
    Pair(f64),
    /// Each polynomial is divided by its size, or by the absolute value of its leading coefficient.
    Size,
    Leading,
}

/// Runs a program whose polynomials have factors. Returns the result of the fair rules if it is not allowed. They may
/// reject the program if dropped coefficients change a decision, or if polynomials are dropped and no other polynomial
/// of the kind shows a factor.
pub fn multiply(stage: &Stage, random: &mut Random) -> Option<String> {
    let kind = random.pick(&PairKind::ALL);
    let factor = if random.below(2) == 0 { random.log(-300.0, 300.0) } else { random.log(-12.0, 6.0) };
    let factors = match random.below(11) {
        0..=2 => Factors::All(factor),
        3..=4 => Factors::Kind(kind, factor),
        5..=6 => Factors::Number(kind, random.below(kind.polynomial_count()), factor),
        7 => Factors::Each(random.log(0.0, 6.0)),
        8 => Factors::Pair(random.log(0.0, 6.0)),
        9 => Factors::Size,
        _ => Factors::Leading,
    };
    let mut each = Random::new(random.bits());
    let steer = Multiply(&stage.scene, |pair: Pair, number: usize, own: &[f64]| match (factors, pair.kind) {
        (Factors::All(factor), _) => factor,
        (Factors::Kind(of, factor), kind) if of == kind => factor,
        (Factors::Number(of, by, factor), kind) if (of, by) == (kind, number) => factor,
        (Factors::Each(most), _) => each.log(0.0, most.log10()),
        (Factors::Pair(most), _) => {
            Random::new(1_000_003 * u64::from(pair.first) + u64::from(pair.second)).log(-most.log10(), most.log10())
        }
        (Factors::Size, _) => Base::Size.of(own),
        (Factors::Leading, _) => own.first().map_or(1.0, |c| c.abs().recip()),
        (Factors::Kind(..) | Factors::Number(..), _) => 1.0,
    });
    let frames = run(&stage.scene, &mut SteeringObserver(steer))?;
    let is_whole = |frame: &Frame| frame.polynomials.iter().flatten().all(|c| c.is_finite());
    if !frames.iter().all(is_whole) {
        return None;
    }
    let mut writer = Writer::new(Vec::new(), Layout::for_scene(&stage.scene));
    frames.iter().for_each(|frame| writer.write_frame(frame));
    let what = || format!("{}: {factors:?}", stage.name);
    let judged = match stage.judged(&writer.finish().expect("memory").0) {
        Err(fault) => return Some(format!("{}: {fault}", what())),
        Ok(judged) => judged,
    };
    let counts = &judged.findings.counts;
    let lost = counts.get(FindingKind::TrimmedDecision);
    let gone = counts.get(FindingKind::Coefficient);
    // Larger numbers overflow in the course's root finder, which then decides differently.
    let largest =
        frames.iter().flat_map(|frame| frame.polynomials.iter().flatten()).fold(0.0_f64, |most, c| most.max(c.abs()));
    if largest > OVERFLOWS {
        return None;
    }
    // A program that misses a collision may end with two balls at the same position.
    let beyond = counts.get(FindingKind::Position).min(lost);
    let is_explained = lost + gone + beyond == counts.total();
    let is_documented = judged.rejection.is_none() && is_explained;
    (judged.verdict != FairVerdict::Accepted && !is_documented).then(|| {
        let first = judged.findings.first_divergence.map(|first| first.to_string());
        format!("{}: {:?} {first:?} {counts:?}", what(), judged.rejection)
    })
}

/// Makes one coefficient of a polynomial wrong. The pair's positions are proven right, because the polynomial from the
/// same coordinates is right. Returns the result of the fair rules if it is not allowed: they must report the formula
/// as wrong.
pub fn misprint(stage: &Stage, random: &mut Random) -> Option<String> {
    let Target::One { step, index } = Target::draw(stage, random) else { return None };
    let known = stage.known(step, index);
    let last = known.pair.kind.polynomial_count() - 1;
    let other = last - known.number;
    let (own, beside) = (stage.own(step, index), stage.own(step, index + other - known.number));
    let proof = known.expected.polynomial(other);
    let mut list = own.to_vec();
    let place = random.below(own.len().max(1));
    *list.get_mut(place)? *= 1.5;
    let of_form = |expected: &[BoundedValue]| compare(expected, &list, &[1.0]).is_ok();
    let is_right = of_form(known.expected.polynomial(known.number));
    let is_of_other_form = known.expected.other_form(known.number).is_some_and(of_form);
    if is_right || is_of_other_form || is_round_off(proof) || !shows_factor(proof, beside) {
        return None;
    }
    let trace = stage.relogged(|at, number, _| ((at, number) == (step, index)).then(|| list.clone()));
    let what = || format!("{}: coefficient {place} of polynomial {index} of step {step}", stage.name);
    match stage.judged(&trace) {
        Err(fault) => Some(format!("{}: {fault}", what())),
        Ok(judged) => {
            let first = judged.findings.first_divergence;
            // The decision of a wrong polynomial may lead to other positions after it.
            let is_formula =
                |finding: &Finding| matches!(finding.kind(), FindingKind::Coefficient | FindingKind::PolynomialDegree);
            (!first.as_ref().is_some_and(is_formula))
                .then(|| format!("{}: {:?}", what(), first.map(|first| first.to_string())))
        }
    }
}
