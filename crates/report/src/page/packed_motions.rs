//! Motions in the form that the viewer reads: exact doubles, deflated and encoded in base64. Motions that would take
//! too much space become rounded positions.
//!
//! A rounded motion is a block of bytes. It begins with the number of exact records as an 8-byte integer, and these
//! records as doubles. For each record and each coordinate, the difference from the previous record follows, in units.
//! The difference is zigzag-coded, with seven bits per byte and the lowest bits first (as Protocol Buffers code
//! integers). All numbers are little-endian.
use base64::Engine;
use fosssim_evidence::{Evidence, Track};

/// The maximum size of one case's exact motions on a page, in bytes. The largest course scene (11 particles, 1,601
/// records) takes 384 KB for both motions.
pub const MAX_EXACT_BYTES: usize = 540_000;

/// The maximum size in bytes of motions before compression. Larger motions are rounded without trying to compress them.
const MAX_COMPRESSED_BYTES: usize = 12 * MAX_EXACT_BYTES;

/// The maximum number of exact values in a rounded motion. The records around steps with details are exact.
const MAX_EXACT_VALUES: usize = 16_000;

/// The number of units across the extent of all bodies, for rounded positions.
const UNITS_PER_EXTENT: f64 = 65536.0;

/// The code for a value that is NaN, or too large to be written as a number of units.
const NO_UNIT_MARK: i64 = 1 << 40;

/// The precision of stored motions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// Motions are exact if there is space for them; otherwise they are rounded.
    Budgeted,
    /// Motions are rounded in any case.
    Rounded,
}

/// The unit to which positions are rounded, and the records that stay exact.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rounding {
    /// The unit of rounded positions, which is a power of two.
    pub(super) unit: f64,
    /// The indices of the records that stay exact, counted from the first stored record.
    pub(super) exact: Vec<usize>,
}

/// The motions of one case, in base64.
#[derive(Debug)]
pub(super) struct PackedMotions {
    pub(super) blocks: Vec<String>,
    pub(super) rounded: Option<Rounding>,
}

impl PackedMotions {
    pub(super) fn from_evidence(evidence: &Evidence, tracks: &[(&str, &Track)], precision: Precision) -> Self {
        let raw: usize = tracks.iter().map(|(_, track)| 8 * track.values.len()).sum();
        if precision == Precision::Budgeted && raw <= MAX_COMPRESSED_BYTES {
            let blocks: Vec<String> =
                tracks.iter().map(|(_, track)| encode_base64(&to_le_bytes(&track.values))).collect();
            if blocks.iter().map(String::len).sum::<usize>() <= MAX_EXACT_BYTES {
                return Self { blocks, rounded: None };
            }
        }
        let rounded =
            Rounding { unit: position_unit(tracks, evidence.layout.particles), exact: select_exact_records(evidence) };
        let blocks = tracks
            .iter()
            .map(|(_, track)| encode_base64(&round_track(track, evidence.layout.particles, &rounded)))
            .collect();
        Self { blocks, rounded: Some(rounded) }
    }
}

fn to_le_bytes(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Deflates bytes without a header and encodes them in base64.
fn encode_base64(bytes: &[u8]) -> String {
    base64::engine::general_purpose::STANDARD.encode(miniz_oxide::deflate::compress_to_vec(bytes, 8))
}

/// Returns the unit of rounded positions. It is a power of two, so that its multiples are exact.
fn position_unit(tracks: &[(&str, &Track)], particles: usize) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (_, track) in tracks {
        for record in track.values.chunks_exact((4 * particles).max(1)) {
            for &value in record[..2 * particles].iter().filter(|value| value.abs() < 1e12) {
                (low, high) = (low.min(value), high.max(value));
            }
        }
    }
    let extent = if high > low { high - low } else { 1.0 };
    (extent / UNITS_PER_EXTENT).log2().floor().exp2()
}

/// Returns the indices of the records around steps with details. Those around the first wrong steps come first.
fn select_exact_records(evidence: &Evidence) -> Vec<usize> {
    let (layout, window) = (evidence.layout, evidence.window);
    let room = MAX_EXACT_VALUES / (4 * layout.particles).max(1);
    let per_step = layout.records_per_step() as usize;
    let mut records = Vec::new();
    for up in evidence.inspected.iter().filter(|up| up.step > window.first && up.step <= window.last) {
        let end = (up.step - window.first) as usize * per_step;
        records.extend((end - per_step..=end).filter(|record| !records.contains(record)).collect::<Vec<_>>());
    }
    records.truncate(room);
    records
}

fn round_track(track: &Track, particles: usize, rounded: &Rounding) -> Vec<u8> {
    let size = 4 * particles;
    let exact_records: Vec<usize> =
        rounded.exact.iter().copied().take_while(|&record| record < track.records).collect();
    let mut out = (exact_records.len() as u64).to_le_bytes().to_vec();
    for record in exact_records {
        out.extend(to_le_bytes(&track.values[record * size..][..size]));
    }
    let mut last = vec![0_i64; 2 * particles];
    for record in track.values.chunks_exact(size.max(1)) {
        for (last, &value) in last.iter_mut().zip(&record[..2 * particles]) {
            let units = (value / rounded.unit).round();
            #[expect(clippy::cast_possible_truncation, reason = "it is below 2^40")]
            #[expect(clippy::cast_precision_loss, reason = "a power of two")]
            let now = if units.abs() < NO_UNIT_MARK as f64 { units as i64 } else { NO_UNIT_MARK };
            let difference = now - *last;
            *last = now;
            let mut code = ((difference << 1) ^ (difference >> 63)).cast_unsigned();
            while code > 127 {
                out.push((code & 127) as u8 | 128);
                code >>= 7;
            }
            out.push(code as u8);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_evidence::Window;
    use fosssim_model::trace::Layout;

    fn evidence(particles: usize, steps: u32, value: impl Fn(usize) -> f64) -> Evidence {
        let layout = Layout { particles, has_impulses: false, has_polynomials: false, steps };
        let records = steps as usize + 1;
        let track = Track { values: (0..4 * particles * records).map(value).collect(), records };
        let (window, inspected) = (Window { first: 0, last: steps }, Vec::new());
        Evidence { layout, window, reference: track.clone(), submission: track, steps: Vec::new(), inspected }
    }

    fn pack(evidence: &Evidence, precision: Precision) -> PackedMotions {
        PackedMotions::from_evidence(
            evidence,
            &[("submission", &evidence.submission), ("reference", &evidence.reference)],
            precision,
        )
    }

    /// A course's scenes are exact; scenes that would take more than the budget are rounded.
    #[test]
    fn motions_are_exact_within_the_budget() {
        let small = evidence(11, 400, |k| (k as f64).sin());
        assert!(pack(&small, Precision::Budgeted).rounded.is_none());
        // Noise cannot be compressed.
        let large = evidence(200, 400, |k| (k as f64 * 12.9898).sin() * 43758.5453 % 1.0);
        let rounded = pack(&large, Precision::Budgeted);
        assert!(rounded.rounded.is_some());
        assert!(pack(&small, Precision::Rounded).rounded.is_some());
    }

    /// Read back as the viewer reads it, a rounded motion is off by no more than half a unit.
    #[test]
    fn rounded_motions_are_near() {
        let value = |k: usize| if k == 12 { f64::NAN } else { (k as f64 * 0.37).sin() * (1.0 + k as f64) };
        let all = evidence(3, 20, value);
        let Rounding { unit, .. } = pack(&all, Precision::Rounded).rounded.expect("rounded");
        let bytes = round_track(&all.submission, 3, &Rounding { unit, exact: vec![2, 5] });
        assert_eq!(u64::from_le_bytes(bytes[..8].try_into().expect("eight")), 2);
        assert_eq!(bytes[8..8 + 96], super::to_le_bytes(&all.submission.values[24..36])[..]);
        let (mut at, mut last) = (8 + 2 * 96, [0_i64; 6]);
        for record in all.submission.values.chunks_exact(12) {
            for (last, value) in last.iter_mut().zip(&record[..6]) {
                let (mut code, mut shift) = (0_u64, 0);
                loop {
                    code |= u64::from(bytes[at] & 127) << shift;
                    (at, shift) = (at + 1, shift + 7);
                    if bytes[at - 1] < 128 {
                        break;
                    }
                }
                *last += (code >> 1).cast_signed() ^ -(code & 1).cast_signed();
                match value.is_nan() {
                    true => assert_eq!(*last, NO_UNIT_MARK),
                    false => assert!((*last as f64 * unit - value).abs() <= 0.5 * unit, "{value}"),
                }
            }
        }
        assert_eq!(at, bytes.len());
    }
}
