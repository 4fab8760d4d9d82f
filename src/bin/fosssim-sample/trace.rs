//! The trace: positions, velocities, impulses and polynomials, record after record, strictly forwards so that a pipe
//! will do (trace-format.md).
use std::io::{self, Write};

use fosssim_oracle::{num::polynomial::Polynomial, scene::Collision};

use crate::{
    catalogue::{Mistake, Student},
    hostile,
    world::{Contact, Object, State, StepLog},
};

/// Writes the records of one run.
pub struct Trace<W> {
    output: W,
    student: Student,
    impulses: bool,
    polynomials: bool,
    records: u64,
}

impl<W: Write> Trace<W> {
    /// A trace for scenes of this collision type.
    pub fn new(output: W, collision: &Collision, student: Student) -> Self {
        let polynomials = matches!(collision, Collision::ContinuousTime { .. } | Collision::Hybrid { .. });
        let impulses = polynomials || matches!(collision, Collision::Simple { .. });
        Self { output, student, impulses, polynomials, records: 0 }
    }

    /// Writes one record into the buffer behind the trace.
    pub fn record(&mut self, state: &State, log: &StepLog) -> io::Result<()> {
        self.records += 1;
        if self.records == 1 && self.student.makes(Mistake::LogNoInitial) {
            return Ok(());
        }
        for value in state.x.iter().chain(&state.v) {
            let value = match self.student.mistake() {
                #[expect(clippy::cast_possible_truncation, reason = "this is the mistake: a float in the trace")]
                Some(Mistake::LogSinglePrecision) => f64::from(*value as f32),
                Some(Mistake::HostileNanState) if self.records > 10 => f64::NAN,
                _ => *value,
            };
            self.output.write_all(&value.to_le_bytes())?;
        }
        if self.impulses {
            self.impulses(&log.impulses)?;
        }
        if self.polynomials {
            self.polynomials(&log.polynomials)?;
        }
        Ok(())
    }

    /// Hands the trace's end over.
    pub fn finish(mut self) -> io::Result<()> {
        hostile::after_trace(self.student, &mut self.output)?;
        self.output.flush()
    }

    /// Makes sure that what was recorded so far is out.
    pub fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }

    /// Writes raw bytes, which no correct program does.
    pub fn raw(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.output.write_all(bytes)
    }

    fn integer(&mut self, value: usize) -> io::Result<()> {
        self.output.write_all(&i32::try_from(value).unwrap_or(i32::MAX).to_le_bytes())
    }

    fn impulses(&mut self, impulses: &[Contact]) -> io::Result<()> {
        let listed: Vec<&Contact> = match self.student.mistake() {
            Some(Mistake::LogNoImpulses) => Vec::new(),
            Some(Mistake::LogDuplicateImpulses) => impulses.iter().flat_map(|impulse| [impulse, impulse]).collect(),
            Some(Mistake::LogImpulsesReversed) => impulses.iter().rev().collect(),
            _ => impulses.iter().collect(),
        };
        self.integer(listed.len())?;
        for impulse in listed {
            let (kind, second) = match impulse.pair.object {
                Object::Particle(index) => (0, index),
                Object::Edge(index) => (1, index),
                Object::HalfPlane(index) => (2, index),
            };
            for value in [kind, impulse.pair.particle, second] {
                self.integer(value)?;
            }
            let n =
                if self.student.makes(Mistake::LogNanContacts) { [f64::NAN; 2] } else { [impulse.n.x, impulse.n.y] };
            for value in [n[0], n[1], impulse.time] {
                self.output.write_all(&value.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn polynomials(&mut self, polynomials: &[Polynomial]) -> io::Result<()> {
        match self.student.mistake() {
            Some(Mistake::HostileHugeCounts) => self.output.write_all(&2_000_000_000_i32.to_le_bytes())?,
            Some(Mistake::HostileNegativeCounts) => self.output.write_all(&(-1_i32).to_le_bytes())?,
            _ => self.integer(polynomials.len())?,
        }
        for index in 0..polynomials.len() {
            let partner = index ^ 1;
            let swapped = self.student.makes(Mistake::LogSwapped) && partner < polynomials.len();
            let polynomial = &polynomials[if swapped { partner } else { index }];
            let coefficients = logged(self.student, polynomial.coefficients());
            self.integer(coefficients.len())?;
            for coefficient in coefficients {
                self.output.write_all(&coefficient.to_le_bytes())?;
            }
        }
        Ok(())
    }
}

/// The coefficients as this program logs them.
fn logged(student: Student, coefficients: &[f64]) -> Vec<f64> {
    let mut list = coefficients.to_vec();
    match student.mistake() {
        Some(Mistake::LogLowestFirst) => list.reverse(),
        Some(Mistake::LogNegated) => list.iter_mut().for_each(|coefficient| *coefficient = -*coefficient),
        Some(Mistake::LogNan) => list.fill(f64::NAN),
        Some(Mistake::LogTiny) => list.fill(1e-11),
        Some(Mistake::LogZeros) => list.fill(0.0),
        Some(Mistake::LogPadded) => list.insert(0, 0.0),
        Some(Mistake::LogTrailingZero) => list.push(0.0),
        Some(Mistake::LogRounded) => {
            list.iter_mut()
                .for_each(|coefficient| *coefficient = format!("{coefficient:.5e}").parse().unwrap_or(*coefficient));
        }
        _ => {}
    }
    list
}
