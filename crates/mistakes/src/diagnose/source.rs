//! What explanations read: the records of a trace, as far as they are at hand.
use fosssim_judge::kept::LateStep;
use fosssim_model::{
    scene::Scene,
    trace::{Layout, Lenient, LenientFrame, record_memory},
};
use std::io::Read;

/// The records of a trace.
pub(super) struct Source<'a> {
    /// Its beginning.
    pub(super) beginning: Box<dyn Read + 'a>,
    /// Whether that is all of it.
    pub(super) is_whole: bool,
    /// Steps beyond.
    pub(super) late: &'a [LateStep],
}

impl<'a> Source<'a> {
    /// All of a trace.
    pub(super) fn whole(trace: impl Read + 'a) -> Self {
        Self { beginning: Box::new(trace), is_whole: true, late: &[] }
    }
}

/// The records of one step.
#[derive(Debug, Default)]
pub(super) struct StepFrames {
    /// The record before it.
    pub(super) before: LenientFrame,
    /// The one in its middle, where the scene has one.
    pub(super) mid: LenientFrame,
    /// The one at its end.
    pub(super) end: LenientFrame,
}

impl StepFrames {
    /// The records of a step that was kept; `None` unless all are sound.
    pub(super) fn of_late(scene: &Scene, late: &LateStep) -> Option<Self> {
        let layout = Layout::of(scene);
        let mut reader = Lenient::of_slice(&late.records, layout).with_limit(record_memory(scene));
        let mut frames = Self::default();
        let Self { before, mid, end } = &mut frames;
        let is_sound =
            read(&mut reader, before) && (!layout.polynomials || read(&mut reader, mid)) && read(&mut reader, end);
        is_sound.then_some(frames)
    }
}

/// Reads a record. False at the end of what is sound: nobody is to blame for what is left of a damaged record.
pub(super) fn read<R: Read>(reader: &mut Lenient<R>, frame: &mut LenientFrame) -> bool {
    reader.next(frame).is_ok() && frame.note.is_none()
}
