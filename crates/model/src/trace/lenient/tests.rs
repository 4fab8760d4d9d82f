use super::*;
use crate::trace::{Frame, Writer};

const LAYOUT: Layout = Layout { particles: 0, has_impulses: true, has_polynomials: true, steps: 0 };

#[test]
fn a_record_may_hold_what_the_scenes_passes_log() {
    let memory = |particles: usize, collision: &str| {
        let particle = |number: usize| format!(r#"<particle m="1" px="{number}" py="0" vx="0" vy="0" fixed="0"/>"#);
        let head = r#"<duration time="1"/><integrator type="explicit-euler" dt="1"/>"#;
        let particles: String = (0..particles).map(particle).collect();
        let xml = format!("<scene>{head}<collision {collision}/>{particles}</scene>");
        record_memory(&crate::scene::read("scene", xml.as_bytes()).unwrap().scene)
    };
    let hybrid = |rounds: u32| format!(r#"type="hybrid" maxiters="{rounds}" k="0""#);
    assert_eq!(memory(20, r#"type="continuous-time""#), MIN_RECORD_BYTES);
    assert_eq!(memory(20, &hybrid(10)), MIN_RECORD_BYTES);
    assert_eq!(memory(20, &hybrid(10_000)), 20 * 19 * (10_000 + 2 + 60) * MAX_POLYNOMIAL_BYTES);
    assert_eq!(memory(1000, &hybrid(10_000)), MAX_RECORD_BYTES);
}

#[test]
fn polynomials_beyond_the_limit_are_counted_and_not_kept() {
    // The lists exceed the window and have polynomials of every size. Another record follows.
    let polynomials: Vec<Vec<f64>> = (0..60_000).map(|number| vec![1.5; number % 9]).collect();
    let list: Vec<&[f64]> = polynomials.iter().map(Vec::as_slice).collect();
    let bytes = [record(&list), record(&[&[2.0]])].concat();
    for limit in [0, 1, 4096, 100_000] {
        let mut reader = LenientReader::new(&bytes[..], LAYOUT).with_limit(limit);
        let mut frame = LenientFrame::default();
        reader.next(&mut frame).unwrap();
        assert!(frame.is_cut() && frame.logged_polynomials == 60_000 && frame.note.is_none(), "{limit}");
        // All polynomials in the buffer are decoded at once.
        assert!(decode::memory_bytes(&frame.polynomials) <= limit + 4 * super::super::source::WINDOW_BYTES);
        let kept: Vec<&[f64]> = frame.polynomials.iter().collect();
        assert_eq!(kept, list[..kept.len()]);
        reader.next(&mut frame).unwrap();
        assert_eq!((frame.logged_polynomials, frame.is_cut(), frame.polynomials.get(0)), (1, false, &[2.0][..]));
        assert!(!reader.has_more());
    }
}

#[test]
fn a_cut_behind_the_limit_leaves_the_count() {
    let bytes = record(&[[1.0; 6].as_slice(); 60_000]);
    for cut in [bytes.len() - 1, bytes.len() - 48, bytes.len() - 60] {
        let mut reader = LenientReader::new(&bytes[..cut], LAYOUT).with_limit(1000);
        let mut frame = LenientFrame::default();
        reader.next(&mut frame).unwrap();
        assert!(frame.note.is_some() && frame.logged_polynomials == 60_000, "cut at {cut}");
        assert_eq!(reader.next(&mut frame).unwrap_err().cause, ReadFailure::State);
    }
}

#[test]
fn a_monstrous_polynomial_is_kept_in_part() {
    let monster = vec![1.0; 1_000_000];
    let (frame, _) = read(&record(&[&[1.0], &monster, &[2.0]]));
    assert_eq!((frame.logged_polynomials, frame.is_cut()), (3, false));
    assert_eq!(frame.polynomials.get(1).len(), MAX_KEPT_COEFFICIENTS);
    assert_eq!(frame.polynomials.get(2), [2.0]);
}

/// Returns a record without particles that contains these polynomials.
fn record(polynomials: &[&[f64]]) -> Vec<u8> {
    let mut frame = Frame::default();
    polynomials.iter().for_each(|p| frame.polynomials.push(p));
    let mut writer = Writer::new(Vec::new(), LAYOUT);
    writer.write_frame(&frame);
    writer.finish().unwrap().0
}

/// Reads one record. Returns the frame and the reason why reading the next one stops.
fn read(bytes: &[u8]) -> (LenientFrame, ReadStop) {
    let mut reader = LenientReader::from_slice(bytes, LAYOUT);
    let mut frame = LenientFrame::default();
    reader.next(&mut frame).unwrap();
    let stop = reader.next(&mut LenientFrame::default()).unwrap_err();
    (frame, stop)
}

#[test]
fn a_missing_coefficient_repeats_the_one_before() {
    let bytes = record(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0]]);
    let (frame, stop) = read(&bytes[..8 + 28 + 4 + 16]);
    let read: Vec<&[f64]> = frame.polynomials.iter().collect();
    assert_eq!(read, [&[1.0, 2.0, 3.0][..], &[4.0, 5.0, 5.0], &[]]);
    assert!(!frame.is_unchanged);
    let note = frame.note.unwrap();
    assert_eq!(note.what, TraceFormatError::SizeBeyondEnd { polynomial: 1, size: 3, left: 16 });
    assert_eq!(note.offset, 36);
    assert_eq!(stop.cause, ReadFailure::State, "a failed stream has not even a state of zero bytes");
}

#[test]
fn a_cut_coefficient_keeps_the_high_order_bytes_of_the_one_before() {
    let (a, b) = (f64::from_bits(0x3ff0_0000_0000_1111), f64::from_bits(0x4008_2222_3333_4444));
    let bytes = record(&[&[a, b]]);
    let (frame, _) = read(&bytes[..8 + 4 + 8 + 3]);
    assert_eq!(frame.polynomials.get(0)[1].to_bits(), 0x3ff0_0000_0033_4444);
    // Without an earlier record, the other bytes are 0. The result is tiny here, so it is dropped with all following
    // coefficients.
    let (frame, _) = read(&bytes[..8 + 4 + 7]);
    assert_eq!(frame.polynomials.get(0), [0.0; 0]);
    let (frame, _) = read(&record(&[&[f64::from_bits(0x00ff_0000_0000_0001)]])[..8 + 4 + 7]);
    assert_eq!(frame.polynomials.len(), 1);
}

#[test]
fn polynomials_behind_a_cut_are_empty() {
    let bytes = record(&[&[1.0], &[2.0], &[3.0]]);
    for cut in 8 + 12..8 + 12 + 4 {
        let (frame, _) = read(&bytes[..cut]);
        assert_eq!(frame.polynomials.iter().collect::<Vec<_>>(), [&[1.0][..], &[], &[]], "cut at {cut}");
        assert_eq!(frame.note.unwrap().what, TraceFormatError::PolynomialCut { polynomial: 1, count: 3 });
    }
}

#[test]
fn small_leading_coefficients_are_dropped_and_nan_stops_the_dropping() {
    let bytes = record(&[&[1e-13, -1e-13, 2.0, 0.0], &[0.0, 0.0], &[0.0, f64::NAN, 1.0], &[1e-12]]);
    let mut frame = LenientFrame::default();
    LenientReader::from_slice(&bytes, LAYOUT).next(&mut frame).unwrap();
    let log = &frame.polynomials;
    assert_eq!((log.get(0), log.get(1), log.get(3)), (&[2.0, 0.0][..], &[][..], &[1e-12][..]));
    assert!(log.get(2)[0].is_nan() && log.get(2)[1] == 1.0);
    assert!(!frame.is_unchanged && frame.note.is_none());
}

#[test]
fn a_sound_list_is_plain() {
    let bytes = record(&[&[1.0, 0.0], &[], &[f64::NAN; 6], &[2.0; 9]]);
    let mut frame = LenientFrame::default();
    LenientReader::from_slice(&bytes, LAYOUT).next(&mut frame).unwrap();
    assert!(frame.is_unchanged);
    assert_eq!(frame.polynomials.get(3), [2.0; 9]);
}

#[test]
fn negative_counts_and_sizes_are_zero_and_skip_nothing() {
    let mut bytes = record(&[&[], &[1.0]]);
    bytes[0..4].copy_from_slice(&(-3_i32).to_le_bytes());
    bytes[8..12].copy_from_slice(&(-1_i32).to_le_bytes());
    let (frame, stop) = read(&bytes);
    assert_eq!(frame.polynomials.iter().collect::<Vec<_>>(), [&[][..], &[1.0]]);
    assert_eq!(frame.note.unwrap().what, TraceFormatError::NegativeCount { list: RecordList::Impulses, count: -3 });
    assert!(!frame.is_unchanged);
    assert_eq!(stop.cause, ReadFailure::Impulses, "at the end of the file the count is missing");
}

#[test]
fn nonsense_counts_cost_no_memory() {
    let count = |count: i32| count.to_le_bytes();
    let cases = [
        (vec![count(i32::MAX)], ReadFailure::Memory),
        (vec![count(1000)], ReadFailure::Impulses),
        (vec![count(0), count(i32::MAX)], ReadFailure::Memory),
        (vec![count(0), count(1), count(i32::MAX)], ReadFailure::Memory),
    ];
    for (words, cause) in cases {
        let stop = LenientReader::from_slice(&words.concat(), LAYOUT).next(&mut LenientFrame::default()).unwrap_err();
        assert_eq!(stop.cause, cause);
    }
    let (frame, _) = read(&[count(0), count(1_000_000)].concat());
    assert_eq!(frame.polynomials.len(), 1_000_000, "the original makes as many empty ones");
}

#[test]
fn endless_lists_end_at_the_limit() {
    let count = |count: i32| count.to_le_bytes();
    // The lists contain impulses, empty polynomials, a polynomial of zeros that are all dropped, and empty ones.
    let heads = [vec![count(i32::MAX)], vec![count(0), count(i32::MAX)], vec![count(0), count(i32::MAX), count(99)]];
    for head in heads {
        let head = head.concat();
        let mut reader = LenientReader::new((&head[..]).chain(std::io::repeat(0)), LAYOUT);
        reader.limit = 1 << 20;
        let expected = if head.len() == 4 { ReadFailure::Limit } else { ReadFailure::Memory };
        assert_eq!(reader.next(&mut LenientFrame::default()).unwrap_err().cause, expected);
        assert!(reader.offset() < 1 << 21);
    }
}

#[test]
fn an_error_of_the_stream_is_named() {
    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("cable unplugged"))
        }
    }
    let stop = LenientReader::new(Broken, LAYOUT).next(&mut LenientFrame::default()).unwrap_err();
    assert_eq!(stop.cause, ReadFailure::Io);
    assert!(stop.to_string().ends_with("reading failed: cable unplugged"), "{stop}");
}
