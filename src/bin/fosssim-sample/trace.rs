//! The trace: positions, velocities, impulses and polynomials, record after record, strictly forwards so that a pipe
//! will do (trace-format.md).
use std::io::{self, Write};

use fosssim_oracle::{
    scene::Collision,
    student::{Contact, Mistake, Object, Record, State, StepLog, Student},
};

use crate::hostile;

/// Writes the records of one run.
pub struct Trace<W> {
    output: W,
    student: Student,
    collision: Collision,
    records: u64,
}

impl<W: Write> Trace<W> {
    /// A trace for scenes of this collision type.
    pub fn new(output: W, collision: &Collision, student: Student) -> Self {
        Self { output, student, collision: *collision, records: 0 }
    }

    /// Writes one record into the buffer behind the trace.
    pub fn record(&mut self, state: &State, log: &StepLog) -> io::Result<()> {
        self.records += 1;
        if self.records == 1 && self.student.makes(Mistake::LogNoInitial) {
            return Ok(());
        }
        let record = Record::new(self.student, &self.collision, state, log);
        let hidden = self.student.makes(Mistake::HostileNanState) && self.records > 10;
        for value in record.x.iter().chain(&record.v) {
            let value = if hidden { f64::NAN } else { *value };
            self.output.write_all(&value.to_le_bytes())?;
        }
        if let Some(impulses) = &record.impulses {
            self.impulses(impulses)?;
        }
        if let Some(polynomials) = &record.polynomials {
            self.polynomials(polynomials)?;
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
        self.integer(impulses.len())?;
        for impulse in impulses {
            let (kind, second) = match impulse.pair.object {
                Object::Particle(index) => (0, index),
                Object::Edge(index) => (1, index),
                Object::HalfPlane(index) => (2, index),
            };
            for value in [kind, impulse.pair.particle, second] {
                self.integer(value)?;
            }
            for value in [impulse.n.x, impulse.n.y, impulse.time] {
                self.output.write_all(&value.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn polynomials(&mut self, polynomials: &[Vec<f64>]) -> io::Result<()> {
        match self.student.mistake() {
            Some(Mistake::HostileHugeCounts) => self.output.write_all(&2_000_000_000_i32.to_le_bytes())?,
            Some(Mistake::HostileNegativeCounts) => self.output.write_all(&(-1_i32).to_le_bytes())?,
            _ => self.integer(polynomials.len())?,
        }
        for coefficients in polynomials {
            self.integer(coefficients.len())?;
            for coefficient in coefficients {
                self.output.write_all(&coefficient.to_le_bytes())?;
            }
        }
        Ok(())
    }
}
