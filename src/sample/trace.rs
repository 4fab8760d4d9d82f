//! Writes the trace, which consists of positions, velocities, impulses and polynomials, record after record. It is
//! written from the beginning to the end, so it can be written to a pipe (trace-format.md).
use std::io::{self, Write};

use crate::{
    scene::Collision,
    student::{Area, Mistake, Record, State, StepLog, Student},
};

use super::hostile;

/// Writes the records of one run.
pub struct Trace<W> {
    output: W,
    student: Student,
    collision: Collision,
    records: u64,
    /// The bytes of the record that is being written.
    bytes: Vec<u8>,
}

impl<W: Write> Trace<W> {
    /// Creates a writer for the trace of a scene with this collision handling.
    pub fn new(output: W, collision: &Collision, student: Student) -> Self {
        Self { output, student, collision: *collision, records: 0, bytes: Vec::new() }
    }

    /// Adds one record to the trace.
    pub fn record(&mut self, state: &State, log: &StepLog) -> io::Result<()> {
        self.records += 1;
        if self.records == 1 && self.student.makes(Mistake::LogNoInitial) {
            return Ok(());
        }
        let mut record = Record::new(self.student, &self.collision, state, log);
        if self.student.makes(Mistake::HostileNanState) && self.records > 10 {
            record.x.fill(f64::NAN);
            record.v.fill(f64::NAN);
        }
        let claim = match self.student.mistake_in(&[Area::Process]) {
            Some(Mistake::HostileHugeCounts) => Some(2_000_000_000),
            Some(Mistake::HostileNegativeCounts) => Some(-1),
            _ => None,
        };
        self.bytes.clear();
        record.encode(claim, &mut self.bytes);
        self.output.write_all(&self.bytes)
    }

    /// Finishes the trace.
    pub fn finish(mut self) -> io::Result<()> {
        hostile::write_after_trace(self.student, &mut self.output)?;
        self.output.flush()
    }

    /// Makes sure that all bytes so far are written.
    pub fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }

    /// Writes other bytes, which no correct program does.
    pub fn write_raw(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.output.write_all(bytes)
    }
}
