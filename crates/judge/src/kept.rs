//! A trace that comes once, kept while it is judged as far as somebody may want to look at it again.
//!
//! Steps that are the reference's byte for byte are not kept: the reference makes their records again from the state
//! before them, as it did when they were compared. So a right trace takes no memory, and of others what differs. Of
//! what lies beyond [`LONGEST`], or no longer fits, the steps are kept in which a book has found something, each with
//! the record before it.
use super::{
    options::Options,
    outcome::Outcome,
    progress::{Both, Progress, StepPlace, WrongStep},
    replay,
};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation, State},
    trace::{Layout, StepBytes},
};
use std::{
    io::{self, Read},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The greatest length of a trace's beginning that may be kept as a whole, in bytes.
pub const LONGEST: u64 = 64 << 20;

/// Memory for wrong steps beyond the beginning, in bytes.
const LATE: usize = 8 << 20;

/// The size of pieces that are read beyond the place where judging stopped.
const PIECE: usize = 64 * 1024;

/// Keeps a trace while it is read and judged. It stays whole when judging panics.
#[derive(Debug)]
pub struct TraceKeeper<'a> {
    scene: &'a Scene,
    store: Mutex<KeptBytes>,
}

impl<'a> TraceKeeper<'a> {
    /// For a trace of this scene; at most `most` bytes of its beginning are kept, and nothing at all with 0.
    #[must_use]
    pub fn new(scene: &'a Scene, most: usize) -> Self {
        Self { scene, store: Mutex::new(KeptBytes::new(Layout::of(scene), most)) }
    }

    /// Judges the trace, which is kept as it is read.
    pub fn judge<R: Read + Send>(&self, trace: R, options: &Options, progress: &mut dyn Progress) -> Outcome {
        replay::judge(
            self.scene,
            KeepingReader { is_judged: true, ..self.reader(trace) },
            options,
            &mut Both(&mut KeepingProgress(self), progress),
        )
    }

    /// The trace, which is kept as it is read.
    pub fn reader<R>(&self, trace: R) -> KeepingReader<'_, R> {
        KeepingReader { store: &self.store, is_judged: false, inner: trace }
    }

    /// Keeps what follows behind the place where judging stopped, as far as it would have been kept.
    pub fn read_on<R: Read>(&self, trace: R) {
        let mut reader = self.reader(trace);
        let mut piece = vec![0; PIECE];
        while lock(&self.store).wants_more() {
            match reader.read(&mut piece) {
                Ok(0) => return,
                Err(error) if error.kind() != io::ErrorKind::Interrupted => return,
                _ => {}
            }
        }
    }

    /// The kept trace.
    #[must_use]
    pub fn into_kept(self) -> KeptTrace<'a> {
        KeptTrace { scene: self.scene, store: self.store.into_inner().unwrap_or_else(PoisonError::into_inner) }
    }
}

fn lock(store: &Mutex<KeptBytes>) -> MutexGuard<'_, KeptBytes> {
    store.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A reader whose bytes are kept.
#[derive(Debug)]
pub struct KeepingReader<'k, R> {
    store: &'k Mutex<KeptBytes>,
    /// Whether steps are judged as they are read, so that it is soon known which need not be kept.
    is_judged: bool,
    inner: R,
}

impl<R: Read> Read for KeepingReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        let mut store = lock(self.store);
        match count {
            0 => store.has_ended |= !buffer.is_empty(),
            _ => store.keep(&buffer[..count], self.is_judged),
        }
        Ok(count)
    }
}

/// Hears which steps are the reference's and which are wrong.
struct KeepingProgress<'k, 'a>(&'k TraceKeeper<'a>);

impl Progress for KeepingProgress<'_, '_> {
    fn step_wrong(&mut self, wrong: &WrongStep<'_>) {
        lock(&self.0.store).wrong = wrong.step;
    }

    fn step_passed(&mut self, place: &StepPlace) {
        lock(&self.0.store).pass(place);
    }
}

/// The kept steps, and the bytes behind the steps that are judged.
#[derive(Debug, Default)]
struct KeptBytes {
    layout: Layout,
    most: usize,
    /// The beginning of the trace, piece by piece.
    pieces: Vec<Piece>,
    /// Memory of the pieces, in bytes.
    memory: usize,
    /// The offset up to which they reach.
    covered: u64,
    /// Whether nothing comes to the beginning any more.
    is_closed: bool,
    late: Vec<LateStep>,
    late_memory: usize,
    /// Bytes that were read, from the last record on that a step may start from; those before `start` are done with.
    tail: Vec<u8>,
    start: usize,
    /// The offset of `tail[start]`.
    base: u64,
    /// The last step in which something was found.
    wrong: u32,
    /// Whether bytes are left out until the next step has been judged.
    is_skipping: bool,
    has_ended: bool,
}

/// A piece of a trace's beginning.
#[derive(Debug)]
enum Piece {
    /// Its bytes.
    Bytes(Vec<u8>),
    /// Steps of the reference: how many steps come before them, how many they are, and the state before them.
    Own { done: u32, steps: u32, from: State },
}

/// A wrong step beyond the beginning.
#[derive(Debug)]
pub struct LateStep {
    /// The step, from 1.
    pub step: u32,
    /// The record before it, and its own.
    pub records: Vec<u8>,
}

impl KeptBytes {
    fn new(layout: Layout, most: usize) -> Self {
        Self { layout, most, is_closed: most == 0, ..Self::default() }
    }

    /// Whether what comes next belongs to the beginning.
    fn wants_more(&self) -> bool {
        !self.is_closed && self.end() < LONGEST
    }

    /// The offset behind all that was read.
    fn end(&self) -> u64 {
        self.base + (self.tail.len() - self.start) as u64
    }

    /// The bytes that were read from one offset to another, as far as they are still there.
    fn read(&self, begin: u64, end: u64) -> &[u8] {
        &self.tail[self.place(begin)..self.place(end)]
    }

    /// Where the byte of this offset lies in the tail.
    fn place(&self, offset: u64) -> usize {
        let behind = usize::try_from(offset.saturating_sub(self.base)).unwrap_or(usize::MAX);
        self.start.saturating_add(behind).min(self.tail.len())
    }

    /// Keeps bytes that have been read. A record that does not fit ends the beginning; while steps are judged, nothing
    /// is kept of it.
    fn keep(&mut self, bytes: &[u8], is_judged: bool) {
        if self.most == 0 {
            return;
        }
        if self.is_skipping {
            self.base += bytes.len() as u64;
            return;
        }
        // Beyond the beginning, only for steps that are found wrong.
        let room = match (self.is_closed, is_judged) {
            (true, _) => LATE,
            (false, true) => self.most.max(LATE),
            (false, false) => self.most,
        };
        if self.tail.len() - self.start + bytes.len() > room {
            if !self.is_closed && !is_judged {
                self.tail.extend_from_slice(bytes);
                let room = self.most.saturating_sub(self.memory) as u64;
                self.add(self.end().min(self.covered + room));
                self.base = self.end();
            } else {
                self.base = self.end() + bytes.len() as u64;
            }
            (self.is_closed, self.is_skipping) = (true, true);
            (self.tail, self.start) = (Vec::new(), 0);
            return;
        }
        if self.tail.capacity() - self.tail.len() < bytes.len() {
            self.tail.drain(..self.start);
            self.start = 0;
        }
        self.tail.extend_from_slice(bytes);
    }

    /// Adds the bytes up to an offset to the beginning.
    fn add(&mut self, end: u64) {
        let places = self.place(self.covered)..self.place(end);
        let bytes = &self.tail[places];
        self.memory += bytes.len();
        self.covered = end.max(self.covered);
        match self.pieces.last_mut() {
            Some(Piece::Bytes(last)) => last.extend_from_slice(bytes),
            _ if bytes.is_empty() => {}
            _ => self.pieces.push(Piece::Bytes(bytes.to_vec())),
        }
    }

    /// A step has been judged, and reading starts from its end record at the earliest.
    fn pass(&mut self, place: &StepPlace) {
        if self.most == 0 {
            return;
        }
        self.is_closed |= place.begin > LONGEST || self.memory >= self.most;
        if !self.is_closed {
            self.add(place.begin);
            match (place.is_own, self.pieces.last_mut()) {
                (true, Some(Piece::Own { steps, .. })) => *steps += 1,
                (true, _) => {
                    let from = self.state(place.before);
                    self.memory += self.layout.state_bytes();
                    self.pieces.push(Piece::Own { done: place.step - 1, steps: 1, from });
                }
                (false, _) => self.add(place.end),
            }
            self.covered = place.end;
        } else if self.wrong == place.step && self.base <= place.before && self.late_memory < LATE {
            let records = self.read(place.before, place.end).to_vec();
            self.late_memory += records.len();
            self.late.push(LateStep { step: place.step, records });
        }
        self.is_skipping = false;
        if let Some(done) = place.last.checked_sub(self.base) {
            self.start = self.start.saturating_add(usize::try_from(done).unwrap_or(usize::MAX)).min(self.tail.len());
            self.base = place.last;
        }
        if self.start == self.tail.len() {
            self.tail.clear();
            self.start = 0;
        }
    }

    /// The state of the record at this offset.
    fn state(&self, at: u64) -> State {
        let bytes = self.read(at, at + self.layout.state_bytes() as u64);
        let mut numbers = bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let positions = numbers.by_ref().take(2 * self.layout.particles).collect();
        State { positions, velocities: numbers.collect() }
    }

    /// The bytes behind the pieces.
    fn rest(&self) -> &[u8] {
        if self.is_closed { &[] } else { self.read(self.covered, self.end()) }
    }
}

/// The parts of a trace that were kept.
#[derive(Debug)]
pub struct KeptTrace<'a> {
    scene: &'a Scene,
    store: KeptBytes,
}

impl KeptTrace<'_> {
    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        self.scene
    }

    /// The beginning, byte for byte.
    #[must_use]
    pub fn beginning(&self) -> Beginning<'_> {
        let (pieces, rest) = (self.store.pieces.iter(), self.store.rest());
        Beginning { scene: self.scene, pieces, rest: Some(rest), bytes: &[], run: None, made: Vec::new(), at: 0 }
    }

    /// Whether the beginning is all of it.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        !self.store.is_closed && self.store.has_ended
    }

    /// Wrong steps that lie beyond the beginning, in their order.
    #[must_use]
    pub fn late(&self) -> &[LateStep] {
        &self.store.late
    }

    /// The first bytes, at most this number.
    #[must_use]
    pub fn bytes(&self, most: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        // It is in memory, and what the reference has made once it makes again.
        let _ = self.beginning().take(most as u64).read_to_end(&mut bytes);
        bytes
    }
}

/// Reads the beginning of a trace again.
#[derive(Debug)]
pub struct Beginning<'a> {
    scene: &'a Scene,
    pieces: std::slice::Iter<'a, Piece>,
    /// The bytes behind the pieces.
    rest: Option<&'a [u8]>,
    /// The rest of the piece that is being read.
    bytes: &'a [u8],
    run: Option<Run>,
    /// A step of the run, and how much of it has been read.
    made: Vec<u8>,
    at: usize,
}

/// Steps that the reference makes again.
#[derive(Debug)]
struct Run {
    simulation: Simulation,
    records: StepBytes,
    /// Steps before the next one.
    done: u32,
    left: u32,
}

impl Run {
    /// Writes the records of the next step.
    fn step(&mut self, made: &mut Vec<u8>) -> io::Result<()> {
        self.simulation.set_steps_done(self.done);
        self.simulation.step(&mut self.records).map_err(|error| io::Error::other(error.to_string()))?;
        (self.done, self.left) = (self.done + 1, self.left - 1);
        self.records.records().flatten().for_each(|piece| made.extend_from_slice(piece));
        Ok(())
    }
}

impl Beginning<'_> {
    /// Goes on to the next piece; false at the end.
    fn next_piece(&mut self) -> bool {
        match self.pieces.next() {
            Some(Piece::Bytes(bytes)) => self.bytes = bytes,
            Some(Piece::Own { done, steps, from }) => {
                let run = self.run.get_or_insert_with(|| Run {
                    simulation: Simulation::new(self.scene, RootSearch::WhereNeeded),
                    records: StepBytes::new(Layout::of(self.scene)),
                    done: 0,
                    left: 0,
                });
                run.simulation.state_mut().clone_from(from);
                (run.done, run.left) = (*done, *steps);
            }
            None => match self.rest.take() {
                Some(rest) => self.bytes = rest,
                None => return false,
            },
        }
        true
    }
}

impl Read for Beginning<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if self.at < self.made.len() {
                let count = (&self.made[self.at..]).read(buffer)?;
                self.at += count;
                return Ok(count);
            }
            if !self.bytes.is_empty() {
                return self.bytes.read(buffer);
            }
            if let Some(run) = self.run.as_mut().filter(|run| run.left > 0) {
                self.made.clear();
                self.at = 0;
                run.step(&mut self.made)?;
            } else if !self.next_piece() {
                return Ok(0);
            }
        }
    }
}

#[cfg(test)]
mod tests;
