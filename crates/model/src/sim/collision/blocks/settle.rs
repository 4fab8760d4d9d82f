//! Decides about single pairs whose coefficients are known, and writes their polynomials.
use super::{
    super::{impact::time_of_impact, particle_edge, particle_half_plane, particle_particle},
    Setting,
};
use crate::sim::{
    observer::{Impulse, Time},
    pair::{Pair, PairKind},
    search::{RootSearch, SearchCounts},
    step_error::StepError,
};
use fosssim_num::{
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::LEADING_COEFFICIENT,
    vector::{Vec2, at},
};

crate::drops_leading!();

/// Room for the coefficients of any pair, and as many more as a polynomial has.
const PADDED: usize = 17 + MAX_COEFFICIENTS;

/// Where polynomials go, and how many have gone there.
pub(super) struct Output<'a> {
    /// Room for all of them; none where nobody wants to know.
    pub room: Option<&'a mut [u8]>,
    /// Bytes that are written.
    pub used: usize,
    /// Polynomials that are written.
    pub polynomials: usize,
    /// The largest modulus of coefficients.
    pub largest: f64,
    /// The hit that was found, or why the search has no end. Handed on here, since it is seldom there and large.
    pub found: Result<Option<Impulse>, StepError>,
}

impl<'a> Output<'a> {
    /// Nothing is written yet.
    #[inline(always)]
    pub fn new(room: Option<&'a mut [u8]>) -> Self {
        Self { room, used: 0, polynomials: 0, largest: 0.0, found: Ok(None) }
    }

    /// Writes a pair's polynomials of which nothing is dropped.
    #[inline(always)]
    pub fn write_whole<const COEFFICIENTS: usize, const COUNT: usize, const BYTES: usize>(
        &mut self,
        coefficients: &[f64; COEFFICIENTS],
        lengths: [usize; COUNT],
    ) {
        let Some(room) = self.room.as_deref_mut().and_then(|room| room[self.used..].first_chunk_mut::<BYTES>()) else {
            return;
        };
        let (mut at, mut number) = (0, 0);
        for length in lengths {
            #[expect(clippy::cast_possible_truncation, reason = "at most six")]
            let size = length as u32;
            room[at..at + 4].copy_from_slice(&size.to_le_bytes());
            at += 4;
            for _ in 0..length {
                room[at..at + 8].copy_from_slice(&coefficients[number].to_le_bytes());
                (at, number) = (at + 8, number + 1);
            }
        }
        self.used += BYTES;
        self.polynomials += COUNT;
    }

    /// Writes the polynomials of a pair with an edge without their small leading coefficients.
    #[inline(always)]
    pub fn write_edge(&mut self, coefficients: &[f64; 17]) {
        let padded = padded(coefficients);
        self.write_one::<5, 44>(&padded, 0);
        self.write_one::<3, 28>(&padded, 5);
        self.write_one::<3, 28>(&padded, 8);
        self.write_one::<6, 52>(&padded, 11);
    }

    /// The same of another pair.
    #[inline(always)]
    pub fn write_two(&mut self, coefficients: &[f64; 5]) {
        let padded = padded(coefficients);
        self.write_one::<3, 28>(&padded, 0);
        self.write_one::<2, 20>(&padded, 3);
    }

    /// One polynomial, whose coefficients begin there; a copy of `LENGTH` coefficients takes `BYTES`, of which less may count.
    #[inline(always)]
    fn write_one<const LENGTH: usize, const BYTES: usize>(&mut self, padded: &[f64; PADDED], begin: usize) {
        let Some(room) = &mut self.room else { return };
        let mut dropped = 0;
        while dropped < LENGTH && padded[begin + dropped].abs() < LEADING_COEFFICIENT {
            dropped += 1;
        }
        let Some(kept) = padded[begin + dropped..].first_chunk::<LENGTH>() else { return };
        let mut bytes = [0; BYTES];
        #[expect(clippy::cast_possible_truncation, reason = "at most six")]
        bytes[..4].copy_from_slice(&((LENGTH - dropped) as u32).to_le_bytes());
        for (place, coefficient) in bytes[4..].as_chunks_mut::<8>().0.iter_mut().zip(kept) {
            *place = coefficient.to_le_bytes();
        }
        room[self.used..self.used + BYTES].copy_from_slice(&bytes);
        self.used += 4 + 8 * (LENGTH - dropped);
        self.polynomials += 1;
    }
}

/// The coefficients of a pair, and zeros behind them.
#[inline(always)]
fn padded<const COEFFICIENTS: usize>(coefficients: &[f64; COEFFICIENTS]) -> [f64; PADDED] {
    let mut padded = [0.0; PADDED];
    padded[..COEFFICIENTS].copy_from_slice(coefficients);
    padded
}

/// Asks the certificate about a pair, and the root finder where it knows no answer.
#[inline(always)]
pub(super) fn decide<const COUNT: usize>(
    setting: Setting<'_>,
    counts: &mut SearchCounts,
    pair: Pair,
    coefficients: &[f64],
    lengths: [usize; COUNT],
) -> Result<Option<Impulse>, StepError> {
    let mut begin = 0;
    let mut polynomials = [Polynomial::default(); COUNT];
    for (polynomial, length) in polynomials.iter_mut().zip(lengths) {
        *polynomial = Polynomial::untrimmed(&coefficients[begin..begin + length]);
        polynomial.trim();
        begin += length;
    }
    let time = time_of_impact(RootSearch::WhereNeeded, counts, setting.step, pair, &polynomials)?;
    let Time::Found(time) = time else { return Ok(None) };
    Ok((time <= 1.0).then(|| normal(setting, pair, time)).flatten().map(|normal| Impulse { pair, normal, time }))
}

/// The contact normal; none where it is zero and therefore no hit.
fn normal(setting: Setting<'_>, pair: Pair, time: f64) -> Option<Vec2> {
    let Setting { bodies, q_start, displacements, .. } = setting;
    let (first, second) = (pair.first as usize, pair.second as usize);
    let x = |particle: usize| at(q_start, particle);
    let d = |particle: usize| at(displacements, particle);
    match pair.kind {
        PairKind::ParticleParticle => Some(particle_particle::normal(x(first), d(first), x(second), d(second), time)),
        PairKind::ParticleEdge => {
            let particles = [first, bodies.edges[second][0], bodies.edges[second][1]];
            particle_edge::normal(particles.map(x), particles.map(d), time)
        }
        PairKind::ParticleHalfPlane => {
            let (point, normal) = (bodies.points[second], bodies.normals[second]);
            let squared = normal.dot(&normal);
            Some(particle_half_plane::normal(x(first), d(first), point, normal, squared, time))
        }
    }
}
