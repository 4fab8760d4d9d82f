//! The records of one step as bytes, to be compared with those of a trace before anything is decoded.
use super::{decode, layout::Layout, log::Log};
use crate::sim::{Detection, Impulse, Observer, Pass, State, Wanted};

/// The records that [`Recorder`](super::Recorder) would write of a step, in pieces that are not copied: the observer of
/// that step.
#[derive(Debug, Clone)]
pub struct StepBytes {
    layout: Layout,
    log: Log,
    /// The mid record and the end record; the former is empty where the layout has none.
    records: [RecordBytes; 2],
    /// Whether a number of a state is not finite.
    has_odd_states: bool,
    /// The state of the mid record.
    mid: State,
}

/// A record: what stands before the polynomials, and how many bytes of the step's polynomials belong to it.
#[derive(Debug, Clone, Default)]
struct RecordBytes {
    head: Vec<u8>,
    polynomials: usize,
}

impl StepBytes {
    /// For steps of a scene with this layout.
    #[must_use]
    pub fn new(layout: Layout) -> Self {
        Self { layout, log: Log::default(), records: Default::default(), has_odd_states: false, mid: State::default() }
    }

    /// The step's records, each in two pieces: what stands before the polynomials, and these.
    pub fn records(&self) -> impl Iterator<Item = [&[u8]; 2]> {
        let skipped = if self.layout.polynomials { 0 } else { 1 };
        let polynomials = self.log.polynomials.bytes();
        self.records[skipped..].iter().map(|record| [&record.head[..], &polynomials[..record.polynomials]])
    }

    /// Number of bytes of all records.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records().flatten().map(<[u8]>::len).sum()
    }

    /// Whether no step has been observed yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether all numbers of the states after the step are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        !self.has_odd_states
    }

    /// The state of the mid record, where the layout has one.
    #[must_use]
    pub fn mid(&self) -> Option<&State> {
        self.layout.polynomials.then_some(&self.mid)
    }

    /// Number of polynomials in the end record.
    #[must_use]
    pub fn polynomials(&self) -> usize {
        self.log.polynomials.count()
    }

    /// The largest modulus of their coefficients, see
    /// [`PolynomialBytes::largest`](crate::sim::PolynomialBytes::largest).
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.log.polynomials.largest()
    }

    /// Memory that the lists of the end record take when they are decoded, in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        let polynomials = &self.log.polynomials;
        // A size is four bytes in the trace and eight in memory.
        let impulses = self.log.impulses() * decode::IMPULSE_MEMORY;
        impulses.max(polynomials.bytes().len() + 4 * polynomials.count())
    }

    /// Whether `holds` is true of the coefficients of any polynomial, highest power first.
    pub fn any(&self, mut holds: impl FnMut(&[f64]) -> bool) -> bool {
        let mut coefficients = Vec::new();
        self.log.polynomials.iter().any(|own| {
            coefficients.clear();
            coefficients.extend(own.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)));
            holds(&coefficients)
        })
    }

    fn record(&mut self, index: usize, state: &State) {
        let Self { layout, log, records, has_odd_states, .. } = self;
        let RecordBytes { head, polynomials } = &mut records[index];
        head.clear();
        log.write_head(head, *layout, state);
        *polynomials = log.polynomials.bytes().len();
        *has_odd_states |= !state.is_finite();
    }
}

impl Observer for StepBytes {
    fn begin_step(&mut self, _step: u32) {
        self.log.begin_step();
        self.has_odd_states = false;
    }

    fn begin_pass(&mut self, pass: Pass) {
        self.log.begin_pass(pass);
    }

    #[inline]
    fn wanted(&mut self) -> Wanted<'_> {
        Wanted::Bytes(&mut self.log.polynomials)
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        self.log.detection(detection);
    }

    fn impulse(&mut self, impulse: &Impulse) {
        self.log.impulse(impulse);
    }

    fn synchronised(&mut self, state: &State) {
        if self.layout.polynomials {
            self.record(0, state);
            self.mid.clone_from(state);
        }
    }

    fn end_step(&mut self, _step: u32, state: &State) {
        self.record(1, state);
    }
}
