//! Filters that search for the number of a call.
//!
//! The kernel goes through a filter once for each call that exists when it is installed, and again for each call of the
//! program whose answer depends on more than the number. The compiler's chain of comparisons is four instructions for a
//! call; a binary search takes some twenty for any. The cost of the filters then follows
//! their length, because the kernel checks and translates them each time; so calls that are answered alike share one
//! answer.

use std::{collections::BTreeMap, io};

use seccompiler::{BpfProgram, SeccompAction, sock_filter};

const JUMP: u16 = 0x05;
const JUMP_IF_EQUAL: u16 = 0x15;
const JUMP_IF_GREATER_OR_EQUAL: u16 = 0x35;
const LOAD_ABSOLUTE: u16 = 0x20;
const RETURN_CONSTANT: u16 = 0x06;
/// The farthest that a comparison can jump.
const FARTHEST: usize = 255;

/// The answer of a filter to a call.
#[derive(Debug, Clone)]
pub(super) enum Answer {
    /// Always this.
    Constant(u32),
    /// The answer of the first of these filters that does not allow the call; they need not ask for the number again.
    Asked(Vec<BpfProgram>),
}

/// The filter that answers so, and `otherwise` to all other calls. `frame` is a filter without rules: it looks at the
/// architecture, and answers.
///
/// # Errors
///
/// A frame that does not end with an answer.
pub(super) fn filter(answers: &BTreeMap<u32, Answer>, otherwise: u32, mut frame: BpfProgram) -> io::Result<BpfProgram> {
    if frame.pop().is_none_or(|last| last.code != RETURN_CONSTANT) {
        return Err(io::Error::other("a filter that does not end with its answer"));
    }
    // The number is the first word of the kernel's description of a call.
    frame.push(sock_filter { code: LOAD_ABSOLUTE, jt: 0, jf: 0, k: 0 });
    let mut fragments = Vec::new();
    let leaves = leaves(answers, otherwise, &mut fragments);
    let mut tail = Tail::new(&fragments);
    let first = tail.search(&leaves);
    tail.begin_at(first);
    frame.extend(tail.reversed.into_iter().rev());
    Ok(frame)
}

/// The treatment of calls from a number on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leaf {
    Answer(u32),
    /// The fragment of this index.
    Go(usize),
}

/// The numbers from which on something else is done, rising, the first one 0.
fn leaves(answers: &BTreeMap<u32, Answer>, otherwise: u32, fragments: &mut Vec<BpfProgram>) -> Vec<(u32, Leaf)> {
    let mut leaves = vec![(0, Leaf::Answer(otherwise))];
    let mut add = |number, leaf| match leaves.last_mut() {
        Some((first, last)) if *first == number => *last = leaf,
        Some((_, last)) if *last == leaf => {}
        _ => leaves.push((number, leaf)),
    };
    for (number, answer) in answers {
        add(
            *number,
            match answer {
                Answer::Constant(answer) => Leaf::Answer(*answer),
                Answer::Asked(programs) => {
                    let fragment = one_after_the_other(programs);
                    // Many calls are asked the same.
                    let known = fragments.iter().position(|known| *known == fragment);
                    Leaf::Go(known.unwrap_or_else(|| {
                        fragments.push(fragment);
                        fragments.len() - 1
                    }))
                }
            },
        );
        add(number + 1, Leaf::Answer(otherwise));
    }
    leaves
}

/// Filters of which each goes on with the next where it would allow the call.
fn one_after_the_other(programs: &[BpfProgram]) -> BpfProgram {
    let mut joined = BpfProgram::new();
    for (index, program) in programs.iter().enumerate() {
        let is_last = index + 1 == programs.len();
        for (at, instruction) in program.iter().enumerate() {
            let allows = *instruction == answer(SeccompAction::Allow.into());
            joined.push(if allows && !is_last { jump(program.len() - at - 1) } else { instruction.clone() });
        }
    }
    joined
}

/// The end of a filter, which grows towards its beginning: so it is known how far each comparison has to jump, and
/// answers and fragments are shared by all comparisons from which they can be reached.
struct Tail {
    /// The instructions, the last one first.
    reversed: BpfProgram,
    /// The nearest place that leads to a leaf, counted from the end.
    places: Vec<(Leaf, usize)>,
}

impl Tail {
    fn new(fragments: &[BpfProgram]) -> Self {
        let mut tail = Self { reversed: BpfProgram::new(), places: Vec::new() };
        for (index, fragment) in fragments.iter().enumerate() {
            tail.reversed.extend(fragment.iter().rev().cloned());
            tail.places.push((Leaf::Go(index), tail.last()));
        }
        tail
    }

    /// The place of the instruction that was added last.
    fn last(&self) -> usize {
        self.reversed.len() - 1
    }

    /// The number of instructions between an instruction that is added now and the place.
    fn distance(&self, place: usize) -> usize {
        self.last() - place
    }

    /// Adds the search among these leaves; the answer is the place where it begins.
    fn search(&mut self, leaves: &[(u32, Leaf)]) -> usize {
        if let [(_, leaf)] = leaves {
            return self.leaf(*leaf);
        }
        let (low, high) = leaves.split_at(leaves.len() / 2);
        let least = high[0].0;
        let (mut above, mut below) = (self.search(high), self.search(low));
        // A jump that has to be added puts the other place farther away.
        while self.distance(above).max(self.distance(below)) > FARTHEST {
            let far = if self.distance(above) > FARTHEST { &mut above } else { &mut below };
            *far = self.jump_to(*far);
        }
        let (jt, jf) = (self.distance(above) as u8, self.distance(below) as u8);
        self.reversed.push(sock_filter { code: JUMP_IF_GREATER_OR_EQUAL, jt, jf, k: least });
        self.last()
    }

    /// A place near by that leads to the leaf.
    fn leaf(&mut self, leaf: Leaf) -> usize {
        let known = self.places.iter().position(|(known, _)| *known == leaf);
        if let Some(index) = known {
            let place = self.places[index].1;
            if self.distance(place) <= FARTHEST {
                return place;
            }
        }
        let place = match (leaf, known) {
            (Leaf::Go(_), Some(index)) => self.jump_to(self.places[index].1),
            (Leaf::Go(fragment), None) => unreachable!("fragment {fragment} lies at the end"),
            (Leaf::Answer(word), _) => {
                self.reversed.push(answer(word));
                self.last()
            }
        };
        match known {
            Some(index) => self.places[index].1 = place,
            None => self.places.push((leaf, place)),
        }
        place
    }

    fn jump_to(&mut self, place: usize) -> usize {
        let over = self.distance(place);
        self.reversed.push(jump(over));
        self.last()
    }

    /// Makes the place the first instruction.
    fn begin_at(&mut self, place: usize) {
        if place != self.last() {
            self.jump_to(place);
        }
    }
}

/// Skips this number of instructions.
fn jump(over: usize) -> sock_filter {
    sock_filter { code: JUMP, jt: 0, jf: 0, k: over as u32 }
}

/// A filter for one call without its beginning, which asks for the architecture, as the frame does, and for the number:
/// two jumps follow, on into the rules and past them. One that begins otherwise is left as it is.
pub(super) fn without_number(mut program: BpfProgram, frame: &[sock_filter]) -> BpfProgram {
    let head = frame.len() - 1;
    let begins = program.get(..head) == frame.get(..head);
    if let Some([load, compare, into, past]) = program.get(head..head + 4)
        && begins
        && (load.code, load.k) == (LOAD_ABSOLUTE, 0)
        && (compare.code, compare.jt, compare.jf) == (JUMP_IF_EQUAL, 0, 1)
        && (into, past.code) == (&jump(1), JUMP)
    {
        program.drain(..head + 4);
    }
    program
}

/// Ends the filter with this answer.
pub(super) fn answer(word: u32) -> sock_filter {
    sock_filter { code: RETURN_CONSTANT, jt: 0, jf: 0, k: word }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const AND: u16 = 0x54;
    const JUMP_IF_GREATER: u16 = 0x25;

    /// The answer of a filter: the kernel's rules for these instructions, on its description of a call.
    pub(in super::super) fn run(program: &[sock_filter], call: u32, architecture: u32, arguments: [u64; 6]) -> u32 {
        let mut description = vec![call, architecture, 0, 0];
        description.extend(arguments.iter().flat_map(|argument| [*argument as u32, (*argument >> 32) as u32]));
        let (mut at, mut value) = (0, 0);
        loop {
            let now = &program[at];
            at += 1;
            let holds = match now.code {
                LOAD_ABSOLUTE => {
                    value = description[now.k as usize / 4];
                    continue;
                }
                AND => {
                    value &= now.k;
                    continue;
                }
                JUMP => {
                    at += now.k as usize;
                    continue;
                }
                RETURN_CONSTANT => return now.k,
                JUMP_IF_EQUAL => value == now.k,
                JUMP_IF_GREATER => value > now.k,
                JUMP_IF_GREATER_OR_EQUAL => value >= now.k,
                other => panic!("an instruction that filters are not made of: {other:#x}"),
            };
            at += usize::from(if holds { now.jt } else { now.jf });
        }
    }
}
