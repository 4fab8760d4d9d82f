//! Shows the passes of a step as a calculation by hand, with the impulses and the rigid motions that follow
//! (collisions.md 3 to 6).
use super::{format_vector, render_states, render_table};
use crate::{
    detect::{self, DetectReport, Overlap},
    number::format_short,
    style::Style,
    words::explanation::explain_letters,
};
use fosssim_findings::{PairText, PassText, explanation::Subject};
use fosssim_judge::{overlap::OverlapCheck, study::Study};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Decision, Detection, Impulse, Observer, Pair, PairKind, PairMotion, Pass, Stage, State, Zone},
};
use fosssim_num::vector::{Vec2, unit, vector_at};
use fosssim_student::assignments::t2m2::{
    Inputs,
    formulas::{Formula, readings},
};

/// Describes the passes and responses of a step while the reference computes it.
pub(super) struct CollisionWalk<'a> {
    scene: &'a Scene,
    /// The pair whose detection is written in full. It is written only once.
    pair: Option<(Pair, Option<Pass>)>,
    text: String,
    /// The positions at the start of the step.
    start: Vec<f64>,
    /// The end positions that the last pass or collision used. For `simple` handling, also the end velocities.
    observed_state: State,
}

impl<'a> CollisionWalk<'a> {
    /// Creates the description of a scene's first step.
    pub(super) fn new(scene: &'a Scene, pair: Option<(Pair, Option<Pass>)>) -> Self {
        let start = State::for_scene(scene).positions;
        Self { scene, pair, text: String::new(), start, observed_state: State::default() }
    }

    /// Returns the description; `None` if the scene has no collision handling.
    pub(super) fn finish(self) -> Option<String> {
        (!self.text.is_empty()).then_some(self.text)
    }

    fn shift(&self, particle: usize) -> Vec2 {
        vector_at(&self.observed_state.positions, particle) - vector_at(&self.start, particle)
    }

    /// Renders the detection of a pair; `None` if its computation has no result.
    fn detection_text(&self, detection: &Detection<'_>) -> Option<String> {
        let &Detection { pass, pair, q_start, q_end, .. } = detection;
        if pass.stage == Stage::Simple {
            let study = &OverlapCheck::for_pair(self.scene, 1, &State::for_scene(self.scene), pair).ok()??;
            let report = Overlap { study, scene: "small.xml", trace: None, step: 1, pair, logged: None };
            return Some(format!("{}:\n{}\n", PairText(pair), report.render_body(format_short, Style::Plain)));
        }
        let motion = &PairMotion::from_positions(self.scene, pair, q_start, q_end);
        let computation = DetectReport { study: &Study::for_motion(motion).ok()?, place: None }
            .computation(format_short, Style::Plain);
        let moving = detect::render_motion(motion, format_short, Style::Plain);
        Some(format!("{}:\n{moving}\n{}{computation}\n", PairText(pair), render_letters(motion)))
    }
}

impl Observer for CollisionWalk<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.text += &format!("Pass {}: {}\n", pass.index + 1, PassText(pass));
    }

    fn observe_positions(&mut self, _: &[f64], q_end: &[f64]) {
        self.observed_state.positions = q_end.to_vec();
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let Detection { pass, pair, decision, .. } = *detection;
        if self.pair.is_some_and(|(requested, when)| requested == pair && when.is_none_or(|when| when == pass)) {
            self.text.extend(self.detection_text(detection));
            self.pair = None;
        }
        if let Decision::Hit { time, normal } = decision {
            self.observed_state =
                State { positions: detection.q_end.to_vec(), velocities: detection.velocities.to_vec() };
            let when =
                if pass.stage == Stage::Simple { String::new() } else { format!(" at t = {}", format_short(time)) };
            self.text += &format!("  {} collide{when} with n = {}\n", PairText(pair), format_vector(normal));
        }
    }

    fn end_pass(&mut self, pass: Pass, hits: usize) {
        if hits == 0 {
            let consequence = if matches!(pass.stage, Stage::Impulses { .. }) { ", so the loop ends" } else { "" };
            self.text += &format!("  nothing collides{consequence}\n");
        }
    }

    fn observe_impulse(&mut self, impulse: &Impulse) {
        let (scene, Impulse { pair, normal, time }) = (self.scene, *impulse);
        let (first, second) = (pair.first as usize, pair.second as usize);
        let is_simple = matches!(scene.collision, Collision::Simple { .. });
        let u = unit(normal);
        let mut text = format!("Response to {}: u = n / |n| = {}\n", PairText(pair), format_vector(u));
        let weights = match pair.kind {
            PairKind::ParticleParticle => vec![(first, 1.0), (second, -1.0)],
            PairKind::ParticleHalfPlane => vec![(first, 1.0)],
            PairKind::ParticleEdge => {
                let edge = &scene.edges[second];
                let position = |particle: usize| match is_simple {
                    true => vector_at(&self.observed_state.positions, particle),
                    false => vector_at(&self.start, particle) + time * self.shift(particle),
                };
                let [y1, y2, y3] = [first, edge.first, edge.second].map(position);
                let alpha = ((y1 - y2).dot(&(y3 - y2)) / (y3 - y2).dot(&(y3 - y2))).clamp(0.0, 1.0);
                text += &format!("  alpha = {}: the nearest point of the edge at that time\n", format_short(alpha));
                vec![(first, 1.0), (edge.first, alpha - 1.0), (edge.second, -alpha)]
            }
        };
        let speed = |particle: usize| match is_simple {
            true => vector_at(&self.observed_state.velocities, particle),
            false => (1.0 / scene.time_step) * self.shift(particle),
        };
        let rate = |particle: usize| match &scene.particles[particle] {
            // A contact with a half-plane moves even a fixed particle.
            body if body.fixed && pair.kind != PairKind::ParticleHalfPlane => 0.0,
            body => 1.0 / body.mass,
        };
        let rates: f64 = weights.iter().map(|&(particle, w)| w * w * rate(particle)).sum();
        let closing: f64 = weights.iter().map(|&(particle, w)| w * speed(particle).dot(&u)).sum();
        let factor = 1.0 + scene.collision.restitution();
        let size = if rates == 0.0 { 0.0 } else { -factor * closing / rates };
        let is_held = rates == 0.0;
        let [factor, closing, rates, result] = [factor, closing, rates, size].map(format_short);
        let (velocity, moves) = if is_simple { ("v", "") } else { ("D = dx / h", ", x += h times that") };
        text += &format!("  J = -(1 + COR) (sum of w {velocity:.1}.u) / (sum of w^2/m) = ");
        text += &match is_held {
            true => "0, because all are fixed\n".to_owned(),
            false => format!("-{factor} * {closing} / {rates} = {result}\n"),
        };
        let rows = weights.iter().map(|&(particle, w)| {
            let change = w * size * rate(particle) * u;
            [
                particle.to_string(),
                format_vector(speed(particle)),
                format_short(w),
                format_short(rate(particle)),
                format_vector(change),
            ]
        });
        text += &render_table(["particle", velocity, "w", "1/m", &format!("v += w J/m u{moves}")], rows);
        self.text += &text;
    }

    fn observe_zones(&mut self, _: u32, zones: &[Zone<'_>]) {
        let names: Vec<String> = zones.iter().map(zone_name).collect();
        self.text +=
            &format!("  impact zones: {}\n", if names.is_empty() { "none".to_owned() } else { names.join(", ") });
    }

    fn observe_failsafe(&mut self, _: u32, zone: &Zone<'_>) {
        self.text += &format!("Rigid failsafe of zone {}\n", zone_name(zone));
        self.text += &rigid_motion(self.scene, zone, &self.start, |particle| self.shift(particle));
    }

    fn end_step(&mut self, _: u32, state: &State) {
        if !self.text.is_empty() {
            self.text += &format!("End of the step\n{}", render_states(state));
        }
    }
}

/// Renders the formulas of a pair's polynomials, and the values of their letters. The formula of the particle-edge
/// approach is left out, because the course's library contains it.
fn render_letters(motion: &PairMotion) -> String {
    let (inputs, mut lines) = (Inputs::new(motion), Vec::new());
    for subject in Subject::all_of_kind(motion.kind()) {
        let Formula { letters, terms, degree } = &readings(*subject)[0];
        lines.push(format!("  {}", subject.name()));
        let sum = |power: usize| {
            let products = terms.iter().filter(|term| term.power == power).map(|term| {
                let names: Vec<&str> = term.letters.iter().map(|&letter| letters[letter].name).collect();
                let sign = if term.weight < 0.0 { "-" } else { "+" };
                let size = term.weight.abs();
                let factor = if size == 1.0 { String::new() } else { format!("{size} ") };
                format!(" {sign} {factor}{}", names.join(" "))
            });
            let products: String = products.collect();
            format!("    t^{power}: {}", products.strip_prefix(" + ").unwrap_or(products.trim_start()))
        };
        lines.extend((0..=*degree).rev().filter(|_| *subject != Subject::EdgeApproach).map(sum));
        let values = letters.iter().map(|letter| {
            let meaning = if letter.meaning.is_empty() { String::new() } else { format!(" = {}", letter.meaning) };
            format!("{}{meaning} = {}", letter.name, format_short((letter.value)(&inputs).value))
        });
        let values: Vec<String> = values.collect();
        let values = values.chunks(5).map(|some| format!("    with {}", some.join(", "))).collect::<Vec<_>>();
        lines.extend(values.into_iter().filter(|line| !lines.contains(line)).collect::<Vec<_>>());
    }
    lines.extend(explain_letters(&lines, &[motion.kind()]).map(|line| format!("  {line}")));
    format!("Formulas\n{}\n", lines.join("\n"))
}

/// Returns the parts of a zone as text, such as `{0, 1, half-plane}`.
fn zone_name(zone: &Zone<'_>) -> String {
    let particles = zone.particles.iter().map(u32::to_string);
    let parts: Vec<String> = particles.chain(zone.half_plane.then(|| "half-plane".to_owned())).collect();
    format!("{{{}}}", parts.join(", "))
}

/// Renders the motion of a zone as one rigid body. The motion follows from the positions at the start of the step and
/// their changes.
fn rigid_motion(scene: &Scene, zone: &Zone<'_>, start: &[f64], shift: impl Fn(usize) -> Vec2) -> String {
    let members = || zone.particles.iter().map(|&particle| particle as usize);
    if zone.half_plane || members().any(|particle| scene.particles[particle].fixed) {
        return "  a half-plane or a fixed particle stops it: x is the position at the step's start, v is 0\n"
            .to_owned();
    }
    let mass = |particle: usize| scene.particles[particle].mass;
    let rate = 1.0 / members().map(mass).sum::<f64>();
    let center = rate * members().map(|particle| mass(particle) * vector_at(start, particle)).sum::<Vec2>();
    let motion = rate * members().map(|particle| mass(particle) * shift(particle)).sum::<Vec2>();
    let sum =
        |quantity: &dyn Fn(usize) -> f64| members().map(|particle| mass(particle) * quantity(particle)).sum::<f64>();
    let s = |particle: usize| vector_at(start, particle) - center;
    let angular_momentum = sum(&|particle| s(particle).perp(&(shift(particle) - motion)));
    let inertia = sum(&|particle| s(particle).dot(&s(particle)));
    let rows = members().map(|index| {
        [index.to_string(), format_short(mass(index)), format_vector(s(index)), format_vector(shift(index) - motion)]
    });
    format!(
        "  x_cm = {}, dx_cm = {}\n{}  L = sum of m s x (dx - dx_cm) = {}, I = sum of m |s|^2 = {}, \
         omega = L / I = {}\n  x = x_cm + dx_cm + cos(omega) s + sin(omega) (-s_y, s_x), v = (x - xs) / h\n",
        format_vector(center),
        format_vector(motion),
        render_table(["particle", "m", "s = xs - x_cm", "dx - dx_cm"], rows),
        format_short(angular_momentum),
        format_short(inertia),
        format_short(angular_momentum / inertia)
    )
}
