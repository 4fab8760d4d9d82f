//! Records a simulation with an observer that writes the trace during the steps.
//!
//! The recorder only decides what is written and when (trace-format.md 2); it computes nothing. After the first step
//! with events it allocates memory only if a step logs more than every previous step.
use super::{
    layout::Layout,
    log::Log,
    writer::{Writer, WrittenTrace},
};
use crate::sim::{Detection, Impulse, Observer, Pass, State, WantedPairs};
use std::io::{self, Write};

/// Writes a trace. Pass it to [`Simulation::step`](crate::sim::Simulation::step) as the observer of every step, then
/// call [`Recorder::finish`].
///
/// A step that fails leaves the trace without its end record.
#[derive(Debug)]
pub struct Recorder<W: Write> {
    writer: Writer<W>,
    layout: Layout,
    log: Log,
}

impl<W: Write> Recorder<W> {
    /// Starts a trace with the record of the initial state, whose lists are empty. The stream needs no buffer.
    pub fn start(stream: W, layout: Layout, initial: &State) -> Self {
        let mut writer = Writer::new(stream, layout);
        let log = Log::default();
        writer.write_record(initial, &log);
        Self { writer, layout, log }
    }

    /// Returns the bytes and records written so far, including those in the buffer.
    pub fn written_trace(&self) -> WrittenTrace {
        self.writer.written_trace()
    }

    /// Returns whether writing has failed, so further steps are pointless.
    pub fn has_failed(&self) -> bool {
        self.writer.has_failed()
    }

    /// Writes the rest, flushes, and returns the stream.
    ///
    /// # Errors
    /// Fails with the first error that the stream reported, now or earlier.
    pub fn finish(mut self) -> io::Result<(W, WrittenTrace)> {
        self.writer.write_collected(self.log.polynomials.all_bytes());
        self.writer.finish()
    }
}

impl<W: Write> Observer for Recorder<W> {
    fn begin_step(&mut self, _step: u32) {
        // The writer is emptied between steps, because the records of one step borrow the same list.
        if self.writer.is_full() {
            self.writer.write_collected(self.log.polynomials.all_bytes());
        }
        if self.writer.has_unwritten() {
            self.log.begin_next_step();
        } else {
            self.log.begin_step();
        }
    }

    fn begin_pass(&mut self, pass: Pass) {
        self.log.begin_pass(pass);
    }

    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Bytes(&mut self.log.polynomials)
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        self.log.append_detection(detection);
    }

    fn observe_impulse(&mut self, impulse: &Impulse) {
        self.log.append_impulse(impulse);
    }

    fn observe_synchronization(&mut self, state: &State) {
        if self.layout.records_per_step() == 2 {
            self.writer.write_record(state, &self.log);
        }
    }

    fn end_step(&mut self, _step: u32, state: &State) {
        self.writer.write_record(state, &self.log);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{Decision, ImpactTime, Pair, PairKind, Stage};
    use fosssim_num::{polynomial::Polynomial, vector::Vec2};

    const PAIR: Pair = Pair { kind: PairKind::ParticleHalfPlane, first: 0, second: 3 };
    const IMPULSE: Impulse = Impulse { pair: PAIR, normal: Vec2::new(-0.0, -0.25), time: 0.5 };

    fn layout() -> Layout {
        Layout { particles: 1, has_impulses: true, has_polynomials: true, steps: 1 }
    }

    fn state(x: f64) -> State {
        State { positions: vec![x, 0.0], velocities: vec![0.0, 0.0] }
    }

    /// Simulates one pass of `stage` that finds one hit.
    fn pass(recorder: &mut Recorder<Vec<u8>>, stage: Stage) {
        let pass = Pass { stage, index: 0 };
        recorder.begin_pass(pass);
        let polynomials = [Polynomial::trimmed(&[1.0, 2.0, 3.0]), Polynomial::trimmed(&[])];
        let decision = Decision::Miss { time: ImpactTime::Excluded };
        recorder.observe_detection(&Detection {
            pass,
            pair: PAIR,
            polynomials: &polynomials,
            decision,
            q_start: &[],
            q_end: &[],
            velocities: &[],
        });
        recorder.end_pass(pass, 1);
        recorder.observe_impulse(&IMPULSE);
    }

    #[test]
    fn continuous_time_logs_the_same_lists_twice() {
        let mut recorder = Recorder::start(Vec::new(), layout(), &state(0.0));
        recorder.begin_step(1);
        pass(&mut recorder, Stage::ContinuousTime);
        recorder.observe_synchronization(&state(1.0));
        recorder.end_step(1, &state(1.0));
        let (bytes, written) = recorder.finish().unwrap();
        assert_eq!(bytes.len(), 40 + 2 * (40 + 36 + 28 + 4));
        assert_eq!(written, WrittenTrace { records: 3, bytes: bytes.len() as u64 });
        assert_eq!(bytes[32..40], [0; 8], "the initial record has empty lists");
        assert_eq!(bytes[40..148], bytes[148..]);
        assert_eq!(bytes[72..88], [1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0]);
        assert_eq!(bytes[112..120], [2, 0, 0, 0, 3, 0, 0, 0]);
    }

    #[test]
    fn hybrid_logs_no_impulses_and_the_mid_record_holds_the_polynomials_so_far() {
        let mut recorder = Recorder::start(Vec::new(), layout(), &state(0.0));
        recorder.begin_step(1);
        pass(&mut recorder, Stage::Impulses { round: 0 });
        recorder.observe_synchronization(&state(1.0));
        pass(&mut recorder, Stage::Geometric { round: 0 });
        recorder.end_step(1, &state(2.0));
        let (bytes, _) = recorder.finish().unwrap();
        assert_eq!(bytes.len(), 40 + (40 + 32) + (40 + 64));
        assert_eq!(bytes[72..80], [0, 0, 0, 0, 2, 0, 0, 0]);
        assert_eq!(bytes[112 + 32..112 + 40], [0, 0, 0, 0, 4, 0, 0, 0]);
        assert_eq!(bytes[112..120], 2.0_f64.to_le_bytes());
    }

    /// Tests that long lists, which are not copied before they are written, give the same trace as short ones.
    #[test]
    fn long_lists_stand_where_they_belong() {
        let polynomial = Polynomial::trimmed(&[1.0, 2.0, 3.0]);
        let mut recorder = Recorder::start(Vec::new(), layout(), &state(0.0));
        let mut expected = vec![0; 40];
        let mut random = 1_u32;
        for step in 1..=100 {
            recorder.begin_step(step);
            let mut list = Vec::new();
            for x in [-1.0, 1.0] {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                for _ in 0..random >> [20, 25, 31][step as usize % 3] {
                    recorder.log.polynomials.push(polynomial.coefficients());
                    list.extend([3, 0, 0, 0]);
                    [1.0, 2.0, 3.0].iter().for_each(|c: &f64| list.extend(c.to_le_bytes()));
                }
                let state = state(x * f64::from(step));
                recorder.writer.write_record(&state, &recorder.log);
                state.positions.iter().chain(&state.velocities).for_each(|c| expected.extend(c.to_le_bytes()));
                expected.extend([0; 4]);
                expected.extend((list.len() as u32 / 28).to_le_bytes());
                expected.extend(&list);
                assert_eq!(recorder.written_trace().bytes, expected.len() as u64);
            }
        }
        let (bytes, written) = recorder.finish().unwrap();
        assert!(bytes == expected);
        assert_eq!(written, WrittenTrace { records: 201, bytes: expected.len() as u64 });
        assert!(expected.len() > 1 << 21, "{}", expected.len());
    }

    /// The trace may have any length, and the buffer may become full at any point of a step.
    #[test]
    fn memory_does_not_grow_with_the_trace() {
        let mut recorder = Recorder::start(io::sink(), layout(), &state(0.0));
        for step in 1..=10_000 {
            recorder.begin_step(step);
            let polynomials = if step <= 2 { 3_500 } else { 40 };
            (0..polynomials).for_each(|_| recorder.log.polynomials.push(&[1.0, 2.0, 3.0]));
            recorder.observe_synchronization(&state(1.0));
            recorder.end_step(step, &state(1.0));
            let kept_size = recorder.log.polynomials.all_bytes().len();
            assert!(kept_size < 400_000, "{kept_size} bytes are kept in step {step}");
        }
    }

    #[test]
    fn lists_are_cleared_between_steps() {
        let mut recorder = Recorder::start(Vec::new(), layout(), &state(0.0));
        for step in 1..=2 {
            recorder.begin_step(step);
            if step == 1 {
                pass(&mut recorder, Stage::ContinuousTime);
            }
            recorder.observe_synchronization(&state(1.0));
            recorder.end_step(step, &state(1.0));
        }
        let (bytes, _) = recorder.finish().unwrap();
        assert_eq!(bytes.len(), 40 + 2 * 108 + 2 * 40);
    }
}
