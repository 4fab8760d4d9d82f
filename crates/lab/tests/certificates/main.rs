//! Certificates and the root finder agree on random detections.
//!
//! Detections of the three pair types are drawn from wide and difficult distributions. Whenever the certificate
//! excludes an impact within the step, the search must exclude it as well: for the list, and for each polynomial alone,
//! so that no other polynomial hides a mistake. A fourth kind are products of linear factors with particularly
//! difficult zeros.
//!
//! `FOSSSIM_DETECTIONS` and `FOSSSIM_SEED` set the number of detections and their seed; the draws do not depend on the
//! number of processors. `--nocapture` prints how many detections each level decided, and how many only the search
//! could decide. A second table compares the certified decisions of `num::decision` (64 units of rounding, as in the
//! fair rules) with the root finder. Certified decisions are proved, so disagreements show the root finder's
//! properties. They are sorted by the original's intentional rules (`c t^m` counts as nowhere positive, and small
//! leading coefficients are dropped); all others come from its rounding.
#![forbid(unsafe_code)]
use fosssim_oracle::{
    num::{
        bounded::{BoundedValue, BoundedVector},
        certificate::{Level, find_exclusion},
        first_time::first_time,
        polynomial::Polynomial,
        vector::{Vec2, length},
    },
    sim::formulas,
};
use rayon::prelude::*;
use std::fmt::Write as _;

mod decisions;

use decisions::Decisions;

/// The number of detections that one thread draws at a time.
const BLOCK_DETECTIONS: u64 = 10_000;

#[test]
fn no_certificate_excludes_an_impact_that_the_search_finds() {
    let number = |name: &str, default| std::env::var(name).map_or(default, |text| text.parse().expect(name));
    let (detections, seed) = (number("FOSSSIM_DETECTIONS", 300_000), number("FOSSSIM_SEED", 1));
    let audited = |block: u64| {
        let (mut tally, mut random) = (AuditTally::default(), Random::new(seed, block));
        for index in 0..BLOCK_DETECTIONS.min(detections - block * BLOCK_DETECTIONS) {
            tally.audit(block * BLOCK_DETECTIONS + index, &mut random);
        }
        tally
    };
    let blocks = (0..detections.div_ceil(BLOCK_DETECTIONS)).into_par_iter();
    let total = blocks.map(audited).reduce(AuditTally::default, AuditTally::merge);
    let report = total.report();
    print!("{report}");
    assert_eq!(total.disagreements, 0, "{report}");
}

/// The descriptions of the certificate's levels, in order.
const LEVEL_NAMES: [&str; Level::ALL.len()] = ["nowhere positive", "a line", "a parabola", "Bernstein coefficients"];

/// The three pair types, in the order of collisions.md 1, and bare products.
const PAIR_NAMES: [&str; 4] = ["particle-particle", "particle-edge", "particle-half-plane", "product"];

/// Counts per pair type; the last entry of a row counts undecided detections.
#[derive(Default)]
struct AuditTally {
    decided: [[u64; Level::ALL.len() + 1]; PAIR_NAMES.len()],
    needless: [u64; PAIR_NAMES.len()],
    endless: [u64; PAIR_NAMES.len()],
    disagreements: u64,
    first: Option<(u64, String)>,
    decisions: [Decisions; PAIR_NAMES.len()],
}

impl AuditTally {
    fn audit(&mut self, index: u64, random: &mut Random) {
        let (pair, geometry, lists) = draw(random);
        let values = |list: &Vec<BoundedValue>| list.iter().map(|coefficient| coefficient.value).collect::<Vec<f64>>();
        let polynomials: Vec<Polynomial> = lists.iter().map(|list| Polynomial::trimmed(&values(list))).collect();
        let level = find_exclusion(&polynomials);
        let time = first_time(&polynomials);
        let column = level.map_or(Level::ALL.len(), |level| level as usize);
        self.decided[pair][column] += 1;
        self.endless[pair] += u64::from(time.is_err());
        let never = time.is_ok_and(|time| time > 1.0);
        self.needless[pair] += u64::from(never && level.is_none());
        let alone = |polynomial: &Polynomial| {
            let alone = std::slice::from_ref(polynomial);
            find_exclusion(alone).is_some() && !first_time(alone).is_ok_and(|time| time > 1.0)
        };
        if (level.is_some() && !never) || polynomials.iter().any(alone) {
            self.disagreements += 1;
            if self.first.as_ref().is_none_or(|&(first, _)| index < first) {
                let lists: Vec<&[f64]> = polynomials.iter().map(Polynomial::coefficients).collect();
                let certificate = level.map_or("one polynomial alone", |level| LEVEL_NAMES[level as usize]);
                let what = format!(
                    "{} ({geometry}): {certificate} excludes an impact, but {}\n{lists:?}",
                    PAIR_NAMES[pair],
                    decisions::describe_time(time.ok())
                );
                self.first = Some((index, what));
            }
        }
        self.decisions[pair].compare(index, geometry, &lists, &polynomials, time.ok());
    }

    fn merge(mut self, other: Self) -> Self {
        for pair in 0..PAIR_NAMES.len() {
            for (sum, count) in self.decided[pair].iter_mut().zip(other.decided[pair]) {
                *sum += count;
            }
            self.needless[pair] += other.needless[pair];
            self.endless[pair] += other.endless[pair];
        }
        for (sum, decisions) in self.decisions.iter_mut().zip(other.decisions) {
            sum.add(decisions);
        }
        self.disagreements += other.disagreements;
        self.first = [self.first, other.first].into_iter().flatten().min();
        self
    }

    fn report(&self) -> String {
        let mut text = String::new();
        for (pair, name) in PAIR_NAMES.iter().enumerate() {
            let row = &self.decided[pair];
            let sum: u64 = row.iter().sum();
            let share = |count: u64| 100.0 * count as f64 / sum.max(1) as f64;
            let _ = writeln!(text, "{name}: {sum} detections. An impact within the step is excluded by");
            for (words, count) in LEVEL_NAMES.iter().chain(["nothing: searched"].iter()).zip(row) {
                let _ = writeln!(text, "  {words:<22} {count:>12} {:>6.2} %", share(*count));
            }
            let _ = writeln!(
                text,
                "  The search finds no impact in {} of the latter, and never ends in {}.",
                self.needless[pair], self.endless[pair]
            );
        }
        text += "\nCertified decisions of the fair rules, which are true, and the search, which rounds:\n";
        for (decisions, name) in self.decisions.iter().zip(PAIR_NAMES) {
            decisions.report(name, &mut text);
        }
        // The reason for the exit code comes last.
        let _ = match &self.first {
            None => {
                writeln!(text, "\ndisagreements: 0. If a certificate excludes an impact, the search finds none.")
            }
            Some((index, what)) => {
                writeln!(text, "\ndisagreements: {}. First: detection {index}, {what}", self.disagreements)
            }
        };
        text
    }
}

/// A reproducible generator (splitmix64 seeding xorshift64*).
struct Random(u64);

impl Random {
    fn new(seed: u64, block: u64) -> Self {
        let mut z = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(block.wrapping_mul(0xD1B5_4A32_D192_ED03));
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        Self((z ^ (z >> 31)) | 1)
    }

    fn draw_bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    fn draw_below(&mut self, bound: u64) -> u64 {
        (self.draw_bits() >> 11) % bound
    }

    fn draw_uniform(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.draw_bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Returns 10 to the power of a uniform number.
    fn log(&mut self, lo: f64, hi: f64) -> f64 {
        10.0_f64.powf(self.draw_uniform(lo, hi))
    }

    fn draw_direction(&mut self) -> Vec2 {
        let angle = self.draw_uniform(0.0, std::f64::consts::TAU);
        Vec2::new(angle.cos(), angle.sin())
    }

    fn draw_point(&mut self, scale: f64) -> Vec2 {
        Vec2::new(self.draw_uniform(-scale, scale), self.draw_uniform(-scale, scale))
    }

    fn draw_grid_point(&mut self, reach: u64, unit: f64) -> Vec2 {
        let mut coordinate = || (self.draw_below(2 * reach + 1) as f64 - reach as f64) * unit;
        Vec2::new(coordinate(), coordinate())
    }

    fn draw_one_in(&mut self, one_in: u64) -> bool {
        self.draw_below(one_in) == 0
    }
}

fn turn(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// Three points with their displacements: a particle, and another particle, an edge's ends, or a half-plane's point and
/// normal (whose displacement is ignored).
struct RandomMotion {
    x: [Vec2; 3],
    d: [Vec2; 3],
    radius: f64,
}

/// A distribution of motions.
type Make = fn(&mut Random) -> RandomMotion;

/// Draws a detection: pair type, name of the distribution, polynomials.
fn draw(random: &mut Random) -> (usize, &'static str, Vec<Vec<BoundedValue>>) {
    let pair = [0, 1, 1, 2, 3][random.draw_below(5) as usize];
    if pair == 3 {
        return (pair, "zeros on a grid", vec![draw_product(random)]);
    }
    let kinds: [(&str, Make); 8] = [
        ("wide", draw_wide),
        ("grid", draw_grid_motion),
        ("near-rigid", near_rigid),
        ("resting", draw_resting_motion),
        ("grazing", draw_grazing_motion),
        ("far", draw_distant_motion),
        ("turning", draw_rotating_motion),
        ("bulk", draw_bulk_motion),
    ];
    let (name, make) = kinds[random.draw_below(kinds.len() as u64) as usize];
    let mut motion = make(random);
    // Rounds every displacement through end positions, like a simulation.
    for (x, d) in motion.x.iter().zip(&mut motion.d) {
        *d = (*x + *d) - *x;
    }
    let lists = match pair {
        0 => particle_particle(&motion),
        1 => particle_edge(&motion),
        _ => particle_half_plane(&motion),
    };
    (pair, name, lists)
}

/// Returns a polynomial of degree three to five with zeros on a coarse grid, some of them exactly or nearly multiple,
/// that is often negative within the step.
fn draw_product(random: &mut Random) -> Vec<BoundedValue> {
    let unit = [1.0, 0.5, 0.25, 0.1][random.draw_below(4) as usize];
    let degree = 3 + random.draw_below(3) as usize;
    let noise = if random.draw_one_in(2) { 0.0 } else { random.log(-16.0, -3.0) };
    let mut coefficients = [0.0; 6];
    coefficients[0] = random.draw_uniform(-1.0, 1.0).signum() * random.log(-6.0, 3.0);
    let mut count = 0;
    while count < degree {
        // Zeros within the step are mostly avoided.
        let place = (random.draw_below(33) as f64 - 16.0) * unit;
        if (0.0..=1.0).contains(&place) && !random.draw_one_in(16) {
            continue;
        }
        let repeat = if random.draw_one_in(2) { 2.min(degree - count) } else { 1 };
        for _ in 0..repeat {
            let zero = place + noise * random.draw_uniform(-1.0, 1.0);
            count += 1;
            for i in (1..=count).rev() {
                coefficients[i] -= zero * coefficients[i - 1];
            }
        }
    }
    coefficients[..=degree].iter().map(|&coefficient| BoundedValue::from_rounded(coefficient)).collect()
}

/// Makes a motion in which every object has its own scale and speed.
fn draw_wide(random: &mut Random) -> RandomMotion {
    let scale = random.log(-3.0, 4.0);
    let mut object = |spread: f64| {
        let size = scale * if random.draw_one_in(3) { random.log(-3.0, 3.0) } else { spread };
        let moves = if random.draw_one_in(4) { 0.0 } else { size * random.log(-12.0, 1.0) };
        (random.draw_point(size), random.draw_direction() * moves)
    };
    let [a, b, c] = [object(1.0), object(1.0), object(1.0)];
    RandomMotion { x: [a.0, b.0, c.0], d: [a.1, b.1, c.1], radius: scale * random.log(-3.0, 0.3) }
}

/// Makes a motion of integers or simple fractions, with frequent coincidences.
fn draw_grid_motion(random: &mut Random) -> RandomMotion {
    let unit = [1.0, 0.5, 0.25, 0.1, 1e-3][random.draw_below(5) as usize];
    let (reach, speed) = (1 + random.draw_below(12), random.draw_below(5));
    let radius = unit * [0.5, 1.0, 1.5, 2.0, 3.0][random.draw_below(5) as usize];
    let [a, b, c] = [(); 3].map(|()| random.draw_grid_point(reach, unit));
    let [e, f, g] = [(); 3].map(|()| random.draw_grid_point(speed, unit));
    RandomMotion { x: [a, b, c], d: [e, f, g], radius }
}

/// Makes a motion in which the second and third object move almost alike.
fn near_rigid(random: &mut Random) -> RandomMotion {
    let mut motion = draw_wide(random);
    let relative = random.log(-17.0, -1.0);
    motion.d[2] = motion.d[1] + random.draw_direction() * (relative * (length(motion.d[1]) + random.log(-9.0, 0.0)));
    motion
}

/// Makes a motion in which the particle touches, or nearly touches, and moves along the object or hardly moves.
fn draw_resting_motion(random: &mut Random) -> RandomMotion {
    let mut motion = draw_bulk_motion(random);
    let along = motion.x[2] - motion.x[1];
    let length = length(along);
    let normal = turn(along) * (1.0 / length);
    let gap = motion.radius * (1.0 + random.draw_uniform(-1.0, 3.0) * random.log(-17.0, -1.0));
    motion.x[0] = motion.x[1] + along * random.draw_uniform(-0.2, 1.2) + normal * gap;
    let slide = along * (random.draw_uniform(-1.0, 1.0) * random.log(-9.0, 0.0));
    let press = normal * (motion.radius * random.draw_uniform(-1.0, 1.0) * random.log(-14.0, 0.0));
    motion.d[0] = if random.draw_one_in(8) { motion.d[1] } else { motion.d[1] + slide + press };
    motion
}

/// Makes a motion in which the particle passes at about the sum of the radii at some time before, within or after the
/// step.
fn draw_grazing_motion(random: &mut Random) -> RandomMotion {
    let mut motion = if random.draw_one_in(2) { draw_wide(random) } else { draw_rotating_motion(random) };
    let time = random.draw_uniform(-2.0, 4.0);
    let target = motion.x[1] + motion.d[1] * time;
    let other = motion.x[2] + motion.d[2] * time;
    let along = other - target;
    let length = length(along);
    let normal = turn(along) * (1.0 / length);
    let gap = motion.radius * (1.0 + random.draw_uniform(-1.0, 1.0) * random.log(-16.0, 0.0));
    let meeting = target + along * random.draw_uniform(-0.1, 1.1) + normal * gap;
    let speed = motion.radius * random.log(-6.0, 2.0);
    let cross = normal * (speed * if random.draw_one_in(2) { 0.0 } else { random.log(-12.0, 0.0) });
    motion.d[0] = along * (speed / length) + cross + motion.d[1];
    motion.x[0] = meeting - motion.d[0] * time;
    motion
}

/// Returns a motion of bodies that are far apart compared with radii and motion.
fn draw_distant_motion(random: &mut Random) -> RandomMotion {
    let mut motion = draw_wide(random);
    let distance = motion.radius * random.log(0.0, 7.0);
    motion.x[0] = motion.x[1] + random.draw_direction() * distance;
    for i in 0..3 {
        let moves = if random.draw_one_in(3) { 0.0 } else { motion.radius * random.log(-13.0, 1.0) };
        motion.d[i] = if random.draw_one_in(3) { Vec2::new(moves, 0.0) } else { random.draw_direction() * moves };
    }
    motion
}

/// Returns the motion of an edge that turns by up to half a turn and stretches a little.
fn draw_rotating_motion(random: &mut Random) -> RandomMotion {
    let scale = random.log(-2.0, 3.0);
    let (center, half) = (random.draw_point(scale), random.draw_direction() * (scale * random.draw_uniform(0.1, 1.0)));
    let angle = random.draw_uniform(-1.0, 1.0) * random.log(-6.0, 0.5);
    let stretch = 1.0 + random.draw_uniform(-0.5, 0.5) * random.log(-6.0, 0.0);
    let turned = (half * angle.cos() + turn(half) * angle.sin()) * stretch;
    let shift = random.draw_direction() * (scale * random.log(-6.0, 0.5));
    let particle = random.draw_direction() * (scale * random.log(-6.0, 0.5));
    RandomMotion {
        x: [random.draw_point(2.0 * scale), center + half, center - half],
        d: [particle, shift + turned - half, shift - turned + half],
        radius: scale * random.log(-3.0, 0.0),
    }
}

/// Makes a motion in which everything moves together, with small differences, like most pairs of a scene.
fn draw_bulk_motion(random: &mut Random) -> RandomMotion {
    let scale = random.log(-3.0, 4.0);
    let together = random.draw_direction() * (scale * random.log(-8.0, 0.5));
    let spread = scale * random.log(-12.0, -0.5);
    let x = [(); 3].map(|()| random.draw_point(scale));
    let d = [(); 3].map(|()| together + random.draw_point(spread));
    RandomMotion { x, d, radius: scale * random.log(-3.0, -0.3) }
}

/// Returns the polynomials of collisions.md 2.
fn particle_particle(motion: &RandomMotion) -> Vec<Vec<BoundedValue>> {
    let [x1, x2, _] = motion.x.map(BoundedVector::from_rounded);
    let [d1, d2, _] = motion.d.map(BoundedVector::from_rounded);
    let (overlap, approach) = formulas::particle_particle(x1, d1, x2, d2, BoundedValue::from_rounded(motion.radius));
    vec![overlap.to_vec(), approach.to_vec()]
}

fn particle_half_plane(motion: &RandomMotion) -> Vec<Vec<BoundedValue>> {
    let [x, point, normal] = motion.x.map(BoundedVector::from_rounded);
    let (d, radius) = (BoundedVector::from_rounded(motion.d[0]), BoundedValue::from_rounded(motion.radius));
    let (overlap, approach) = formulas::particle_half_plane(x, d, radius, point, normal, normal.dot(normal));
    vec![overlap.to_vec(), approach.to_vec()]
}

fn particle_edge(motion: &RandomMotion) -> Vec<Vec<BoundedValue>> {
    let [x1, x2, x3] = motion.x.map(BoundedVector::from_rounded);
    let [d1, d2, d3] = motion.d.map(BoundedVector::from_rounded);
    let edge = formulas::EdgeMotions::new(x2, d2, x3, d3);
    let pair = formulas::particle_edge(x1, d1, &edge, BoundedValue::from_rounded(motion.radius));
    vec![pair.distance.to_vec(), pair.beyond_first.to_vec(), pair.before_second.to_vec(), pair.approach.to_vec()]
}
