//! Filters that ask for the number of a call and nothing else, as ranges of numbers.
//!
//! The kernel goes through a filter once for each call that exists when it is installed, and again for each call of the program
//! whose answer depends on more than the number. The compiler's chain of comparisons is four instructions for a call, ours four
//! for a range: a tenth, and what a run spends on its filters with it.

use std::collections::BTreeSet;
use std::io;

use seccompiler::{BpfProgram, SeccompAction, sock_filter};

const JUMP_IF_GREATER: u16 = 0x25;
const JUMP_IF_GREATER_OR_EQUAL: u16 = 0x35;
const LOAD_ABSOLUTE: u16 = 0x20;
const RETURN_CONSTANT: u16 = 0x06;

/// The filter that answers `inside` for these calls and `outside` for all others. `frame` is a filter without rules: it looks at
/// the architecture, and answers.
///
/// # Errors
///
/// A number that is none of a call, or a frame that does not end with its answer.
pub(super) fn filter(
    calls: &BTreeSet<i64>,
    inside: SeccompAction,
    outside: SeccompAction,
    mut frame: BpfProgram,
) -> io::Result<BpfProgram> {
    let (inside, outside) = (answer(inside), answer(outside));
    if frame.pop().is_none_or(|last| last != outside) {
        return Err(io::Error::other("a filter that does not end with its answer"));
    }
    // The number is the first word of what the kernel shows.
    frame.push(sock_filter { code: LOAD_ABSOLUTE, jt: 0, jf: 0, k: 0 });
    for (first, last) in ranges(calls)? {
        // Ranges rise: what lies before this one is in none that follows.
        frame.extend([
            jump(JUMP_IF_GREATER_OR_EQUAL, first),
            outside.clone(),
            jump(JUMP_IF_GREATER, last),
            inside.clone(),
        ]);
    }
    frame.push(outside);
    Ok(frame)
}

/// Consecutive numbers, as their first and last ones.
fn ranges(calls: &BTreeSet<i64>) -> io::Result<Vec<(u32, u32)>> {
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for call in calls {
        let number = u32::try_from(*call).map_err(io::Error::other)?;
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => ranges.push((number, number)),
        }
    }
    Ok(ranges)
}

/// Passes over the next instruction if the number compares with this one so.
fn jump(code: u16, number: u32) -> sock_filter {
    sock_filter { code, jt: 1, jf: 0, k: number }
}

fn answer(action: SeccompAction) -> sock_filter {
    sock_filter { code: RETURN_CONSTANT, jt: 0, jf: 0, k: action.into() }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const AND: u16 = 0x54;
    const JUMP: u16 = 0x05;
    const JUMP_IF_EQUAL: u16 = 0x15;

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
