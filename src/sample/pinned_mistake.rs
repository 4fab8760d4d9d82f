//! Pins a mistake to a copy of this program. Whatever its name is, the copy acts as the sample and makes this mistake.
//! It can therefore be submitted like a student's program.
//!
//! The program has a reserved place for the mistake's id, which is filled in the copy. The copy therefore does not need
//! to read a file, which the sandbox might not allow.

use crate::sandbox::MARK_BACKWARDS;

/// The id in a copy that makes no mistake. Only the demo creates such a copy, and the demo removes it again.
pub const RIGHT_ID: &str = "right";

/// The number of bytes that are reserved for the id, or for several ids separated by commas. Unused bytes are zero.
const ID_BYTES: usize = 256;
/// The number of bytes of the reserved place.
const SLOT_BYTES: usize = MARK_BACKWARDS.len() + ID_BYTES;

/// The reserved place for the id in the program.
type PinSlot = [u8; SLOT_BYTES];

static PINNED_ID: PinSlot = empty_slot();

/// Returns the mistake that is pinned to this program, if there is one.
pub fn pinned_mistake() -> Option<&'static str> {
    read(&PINNED_ID)
}

/// Returns a reserved place that contains no mistake.
const fn empty_slot() -> PinSlot {
    let mut slot = [0; SLOT_BYTES];
    let mut index = 0;
    while index < MARK_BACKWARDS.len() {
        slot[index] = MARK_BACKWARDS[MARK_BACKWARDS.len() - 1 - index];
        index += 1;
    }
    slot
}

/// Reads the mistake in a reserved place, if it contains one.
fn read(slot: &PinSlot) -> Option<&str> {
    // The compiler must not assume the content of the place, because it is overwritten later.
    let id = &std::hint::black_box(slot)[MARK_BACKWARDS.len()..];
    let end = id.iter().position(|byte| *byte == 0).unwrap_or(id.len());
    std::str::from_utf8(&id[..end]).ok().filter(|id| !id.is_empty())
}

/// Writes a mistake's id into a copy of this program. Returns `None` if the program has no reserved place, or if the id
/// is too long.
pub fn write(program: &[u8], id: &str) -> Option<Vec<u8>> {
    let mut mark = std::hint::black_box(MARK_BACKWARDS);
    mark.reverse();
    let mut found = memchr::memmem::find_iter(program, &mark);
    let (Some(start), None) = (found.next(), found.next()) else { return None };
    let mut copy = program.to_vec();
    let room = copy.get_mut(start + mark.len()..start + SLOT_BYTES)?;
    // One byte must remain zero, to mark the end of the id.
    if id.is_empty() || id.len() >= room.len() {
        return None;
    }
    room.fill(0);
    room[..id.len()].copy_from_slice(id.as_bytes());
    Some(copy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pinned_mistake_is_read_again() {
        let program = |place: &PinSlot| [b"before", &place[..], b"after"].concat();
        assert_eq!(read(&empty_slot()), None);
        let pinned = write(&program(&empty_slot()), "pe-square-no-eh").expect("a place");
        let place: &PinSlot = pinned[6..6 + SLOT_BYTES].try_into().expect("as long");
        assert_eq!(read(place), Some("pe-square-no-eh"));
        assert_eq!((&pinned[..6], &pinned[6 + SLOT_BYTES..]), (&b"before"[..], &b"after"[..]));
        // Another id may replace it, also a shorter one.
        let shorter = write(&pinned, "short").expect("a place");
        assert_eq!(read(shorter[6..6 + SLOT_BYTES].try_into().expect("as long")), Some("short"));
    }

    #[test]
    fn a_program_without_one_place_for_it_is_left_alone() {
        let place = empty_slot();
        assert_eq!(write(b"no sample at all", "a"), None);
        assert_eq!(write(&[place, place].concat(), "a"), None);
        assert_eq!(write(&place, ""), None);
        assert_eq!(write(&place, &"x".repeat(ID_BYTES)), None);
        assert_eq!(write(&place[..SLOT_BYTES - 1], "a"), None);
    }
}
