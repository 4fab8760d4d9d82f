//! Filters that search for the number of a call.
//!
//! The kernel goes through a filter once for each call that exists when it is installed, and again for each call of the program
//! whose answer depends on more than the number. The compiler's chain of comparisons is four instructions for a call; a search
//! that halves what is left takes some twenty for any, and what a run spends on its filters becomes a small part of it.

use std::collections::BTreeMap;
use std::io;

use seccompiler::{BpfProgram, SeccompAction, sock_filter};

const JUMP: u16 = 0x05;
const JUMP_IF_EQUAL: u16 = 0x15;
const JUMP_IF_GREATER_OR_EQUAL: u16 = 0x35;
const LOAD_ABSOLUTE: u16 = 0x20;
const RETURN_CONSTANT: u16 = 0x06;
/// The farthest that a comparison can jump.
const FARTHEST: usize = 255;

/// What a filter answers to a call.
#[derive(Debug, Clone)]
pub(super) enum Answer {
    /// Always this.
    Constant(u32),
    /// What the first of these filters says that does not allow it; they need not ask for the number again.
    Asked(Vec<BpfProgram>),
}

/// The filter that answers so, and `otherwise` to all other calls. `frame` is a filter without rules: it looks at the architecture,
/// and answers.
///
/// # Errors
///
/// A frame that does not end with an answer.
pub(super) fn filter(answers: &BTreeMap<u32, Answer>, otherwise: u32, mut frame: BpfProgram) -> io::Result<BpfProgram> {
    if frame.pop().is_none_or(|last| last.code != RETURN_CONSTANT) {
        return Err(io::Error::other("a filter that does not end with its answer"));
    }
    // The number is the first word of what the kernel shows.
    frame.push(sock_filter { code: LOAD_ABSOLUTE, jt: 0, jf: 0, k: 0 });
    let mut fragments = Vec::new();
    let leaves = leaves(answers, otherwise, &mut fragments);
    let tree = tree(&leaves);
    let mut starts = Vec::new();
    let mut next = tree.len();
    for fragment in &fragments {
        starts.push(next);
        next += fragment.len();
    }
    frame.extend(tree.into_iter().enumerate().map(|(at, node)| match node {
        Node::Instruction(instruction) => instruction,
        Node::Go(fragment) => jump(starts[fragment] - at - 1),
    }));
    frame.extend(fragments.into_iter().flatten());
    Ok(frame)
}

/// What is done with calls from a number on.
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
                    fragments.push(one_after_the_other(programs));
                    Leaf::Go(fragments.len() - 1)
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

enum Node {
    Instruction(sock_filter),
    /// A jump to the fragment of this index.
    Go(usize),
}

/// The search among the leaves.
fn tree(leaves: &[(u32, Leaf)]) -> Vec<Node> {
    if let [(_, leaf)] = leaves {
        return vec![match leaf {
            Leaf::Answer(word) => Node::Instruction(answer(*word)),
            Leaf::Go(fragment) => Node::Go(*fragment),
        }];
    }
    let (low, high) = leaves.split_at(leaves.len() / 2);
    let least = high[0].0;
    let (low, high) = (tree(low), tree(high));
    let compare =
        |jt: usize, jf: usize| sock_filter { code: JUMP_IF_GREATER_OR_EQUAL, jt: jt as u8, jf: jf as u8, k: least };
    let first = match low.len() {
        near @ ..=FARTHEST => vec![compare(near, 0)],
        far => vec![compare(0, 1), jump(far)],
    };
    first.into_iter().map(Node::Instruction).chain(low).chain(high).collect()
}

/// Passes over so many instructions.
fn jump(over: usize) -> sock_filter {
    sock_filter { code: JUMP, jt: 0, jf: 0, k: over as u32 }
}

/// A filter for one call without its beginning, which asks for the architecture, as the frame does, and for the number: two jumps
/// follow, on into the rules and past them. One that begins otherwise is left as it is.
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

    /// What a filter answers: the kernel's rules for these instructions, on its description of a call.
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
