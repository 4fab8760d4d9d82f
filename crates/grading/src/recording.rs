//! Recordings are the reference's traces of scenes. A manifest and digests of each step make differences readable.
//!
//! The module does not read or write files. It computes recordings from scenes, and compares them with earlier ones.
//! The folder `references` has the same subfolders as the folder of scenes. For `<name>.xml` it contains
//! `<name>.bin.zst` (the trace) and `<name>.steps` (a digest for each step). The file `manifest.txt` lists the name,
//! the steps, the bytes and the SHA-256 of each recording.
use fosssim_model::{
    scene::{self, Problems, Scene},
    sim::{RootSearch, Simulation, StepError},
    trace::{Frame, Layout, Reader, Recorder},
};
use sha2::{Digest, Sha256};
use similar::TextDiff;
use std::io::{self, Read};

/// The compression level of recordings for zstd. It is high, because recordings are seldom made but belong to every
/// release.
const COMPRESSION_LEVEL: i32 = 19;

/// The recording of one scene: the reference's trace, and its digests.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// The name of the scene, as `Group/name`.
    pub name: String,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The reference's trace of the scene.
    pub trace: Vec<u8>,
    /// The text of the `.steps` file: a digest for each step, the sizes, and the SHA-256 of the whole trace.
    pub digests: String,
    sha256: String,
}

/// The reason why a scene can't be recorded.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The scene has errors.
    #[error("the scene has errors:\n{0}")]
    Scene(#[from] Problems),
    /// A step has no result.
    #[error("the simulation stops: {0}")]
    Step(#[from] StepError),
    /// The trace could not be collected.
    #[error("the trace could not be collected: {0}")]
    Io(#[from] io::Error),
}

impl Recording {
    /// Simulates a scene, and returns its recording. `xml` is the content of the scene's file.
    ///
    /// # Errors
    /// Fails if the scene has errors, or a step has no result.
    pub fn for_scene(name: &str, xml: &[u8]) -> Result<Self, RecordError> {
        let scene = scene::read(name, xml)?.scene;
        let trace = simulate_trace(&scene)?;
        Ok(Self {
            name: name.to_owned(),
            steps: scene.step_count(),
            sha256: format_digest(&trace),
            digests: list_digests(&trace, Layout::for_scene(&scene)),
            trace,
        })
    }

    /// Returns the content of the recording's `.bin.zst` file.
    ///
    /// # Errors
    /// Fails if zstd fails.
    pub fn pack(&self) -> io::Result<Vec<u8>> {
        zstd::encode_all(&self.trace[..], COMPRESSION_LEVEL)
    }

    /// Returns the line of the manifest for this recording.
    fn manifest_line(&self) -> String {
        format!("{} {} steps {} bytes sha256 {}\n", self.name, self.steps, self.trace.len(), self.sha256)
    }

    /// Describes how this recording differs from the stored files; `None` if it does not differ.
    pub fn describe_difference(&self, packed: Option<&[u8]>, steps: Option<&[u8]>) -> Option<String> {
        let Some(packed) = packed else { return Some(format!("{}: there is no recording\n", self.name)) };
        let mut text = String::new();
        match unpack(packed, self.trace.len()) {
            Err(error) => text += &format!("{}: the recording can't be unpacked: {error}\n", self.name),
            Ok(recorded) if recorded != self.trace => {
                let at = recorded.iter().zip(&self.trace).take_while(|(old, new)| old == new).count();
                text += &format!("{}: the traces differ, beginning at byte {at}\n", self.name);
            }
            Ok(_) => {}
        }
        let steps = String::from_utf8_lossy(steps.unwrap_or_default());
        text += &render_diff(&format!("{}.steps", self.name), &steps, &self.digests);
        (!text.is_empty()).then_some(text)
    }
}

/// Returns the manifest of these recordings, in the given order.
pub fn render_manifest<'a>(recordings: impl IntoIterator<Item = &'a Recording>) -> String {
    recordings.into_iter().map(Recording::manifest_line).collect()
}

/// Returns a unified diff from the stored recording to the present simulation; empty if they are equal. Line ends are
/// ignored, because Git may have changed them in the stored text.
pub fn render_diff(name: &str, recorded: &str, now: &str) -> String {
    let (old, new) = (format!("recorded/{name}"), format!("simulated/{name}"));
    let recorded = recorded.replace("\r\n", "\n");
    TextDiff::from_lines(recorded.as_str(), now).unified_diff().context_radius(1).header(&old, &new).to_string()
}

/// Returns the text of a `.steps` file: for each step the beginning of the SHA-256 of its records' bytes, with the
/// initial record as step 0, and a line about the whole trace.
fn list_digests(trace: &[u8], layout: Layout) -> String {
    let (mut reader, mut frame) = (Reader::from_slice(trace, layout), Frame::default());
    let (mut text, mut start) = (String::new(), 0);
    while reader.next(&mut frame).is_ok_and(|is_record| is_record) {
        let record = reader.record_count() - 1;
        if !layout.is_mid_record(record) {
            let end = usize::try_from(reader.offset()).unwrap_or(trace.len());
            text += &format!("{} {}\n", layout.step_of_record(record), &format_digest(&trace[start..end])[..16]);
            start = end;
        }
    }
    text + &format!("{} bytes, {} records, sha256 {}\n", trace.len(), reader.record_count(), format_digest(trace))
}

/// Returns the SHA-256 of some bytes as hexadecimal digits.
fn format_digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Simulates a scene, and returns its trace.
pub(super) fn simulate_trace(scene: &Scene) -> Result<Vec<u8>, RecordError> {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder)?;
    }
    Ok(recorder.finish()?.0)
}

/// Returns the trace in a compressed recording. If it is longer than expected, it is cut one byte after the expected
/// length, which is enough to show a difference.
fn unpack(packed: &[u8], expected: usize) -> io::Result<Vec<u8>> {
    let mut trace = Vec::with_capacity(expected);
    zstd::stream::read::Decoder::new(packed)?.take(expected as u64 + 1).read_to_end(&mut trace)?;
    Ok(trace)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &[u8] = br#"<scene><duration time="0.04"/><integrator type="explicit-euler" dt="0.01"/>
        <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0"/></scene>"#;

    #[test]
    fn a_recording_agrees_with_itself() {
        let recording = Recording::for_scene("Group/name", SCENE).unwrap();
        assert_eq!((recording.steps, recording.trace.len()), (4, 5 * 32));
        let packed = recording.pack().unwrap();
        assert_eq!(recording.describe_difference(Some(&packed), Some(recording.digests.as_bytes())), None);
        let crlf = recording.digests.replace('\n', "\r\n");
        assert_eq!(recording.describe_difference(recording.pack().ok().as_deref(), Some(crlf.as_bytes())), None);
        assert!(render_manifest(&[recording]).starts_with("Group/name 4 steps 160 bytes sha256 "));
    }

    #[test]
    fn a_changed_byte_is_shown_with_its_place_and_its_step() {
        let recording = Recording::for_scene("Group/name", SCENE).unwrap();
        let mut other = recording.clone();
        other.trace[32 * 3 + 1] ^= 1;
        let layout = Layout { particles: 1, has_impulses: false, has_polynomials: false, steps: 4 };
        other.digests = list_digests(&other.trace, layout);
        let shown =
            recording.describe_difference(Some(&other.pack().unwrap()), Some(other.digests.as_bytes())).unwrap();
        assert!(shown.contains("differ, beginning at byte 97\n"), "{shown}");
        assert!(shown.contains("\n-3 ") && shown.contains("\n+3 ") && !shown.contains("\n-2 "), "{shown}");
    }

    #[test]
    fn a_missing_or_damaged_recording_is_reported() {
        let recording = Recording::for_scene("Group/name", SCENE).unwrap();
        assert!(recording.describe_difference(None, None).unwrap().contains("there is no recording"));
        let packed = recording.pack().unwrap();
        let shown = recording.describe_difference(Some(&packed[..packed.len() - 3]), None).unwrap();
        assert!(shown.contains("can't be unpacked"), "{shown}");
    }
}
