//! Comparing two traces of one scene, bit by bit, in the memory of two records.
//!
//! This says where bytes part, not who is right: `judge` does that.
use super::{
    error::{List, TraceError},
    frame::{Frame, LoggedImpulse},
    reader::Reader,
};
use std::{fmt, io::Read};

/// How two traces compare.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Records that both have.
    pub frames: u64,
    /// Records among them that differ.
    pub differing: u64,
    /// The first difference.
    pub first: Option<Difference>,
    /// Why the left trace could not be read to its end, or the bytes behind its last record (not looked for when the
    /// other trace ended first).
    pub left: Result<u64, TraceError>,
    /// The same of the right trace.
    pub right: Result<u64, TraceError>,
}

impl Comparison {
    /// Whether both are complete, and the same bit for bit (bytes behind the last record apart).
    #[must_use]
    pub fn same(&self) -> bool {
        self.differing == 0 && self.left.is_ok() && self.right.is_ok()
    }
}

/// A place where two traces differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The record, from 0.
    pub frame: u64,
    /// Its step, from 1; 0 for the initial record.
    pub step: u32,
    /// Whether it is the step's mid record.
    pub mid: bool,
    /// The part that differs.
    pub block: Block,
}

/// A part that differs, with the left and the right value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Block {
    /// A component of a position or of a velocity.
    Coordinate {
        /// `position` or `velocity`.
        quantity: &'static str,
        /// The particle.
        particle: usize,
        /// `x` or `y`.
        axis: char,
        /// Left value.
        left: f64,
        /// Right value.
        right: f64,
    },
    /// An impulse.
    Impulse {
        /// Its number in the list, from 0.
        index: usize,
        /// Left value.
        left: LoggedImpulse,
        /// Right value.
        right: LoggedImpulse,
    },
    /// The lengths of two lists; their common beginnings agree.
    Count {
        /// Which lists.
        list: List,
        /// Left length.
        left: usize,
        /// Right length.
        right: usize,
    },
    /// The size of a polynomial.
    PolynomialSize {
        /// Its number in the list, from 0.
        index: usize,
        /// Left size.
        left: usize,
        /// Right size.
        right: usize,
    },
    /// A coefficient.
    Coefficient {
        /// The polynomial's number in the list, from 0.
        index: usize,
        /// Power of t.
        power: usize,
        /// Left value.
        left: f64,
        /// Right value.
        right: f64,
    },
}

/// Compares two traces record by record until one of them ends.
///
/// Both readers must have the same layout and stand at the beginning.
pub fn compare<'a, A: Read + 'a, B: Read + 'a>(left: Reader<A>, right: Reader<B>) -> Comparison {
    compare_boxed(left.boxed(), right.boxed())
}

/// The same, compiled here and not where it is called: traces are large, and callers may be compiled with less care.
fn compare_boxed<'a>(mut left: Reader<Box<dyn Read + 'a>>, mut right: Reader<Box<dyn Read + 'a>>) -> Comparison {
    let (mut a, mut b) = (Frame::default(), Frame::default());
    let (mut frames, mut differing, mut first) = (0, 0, None);
    let layout = left.layout();
    let (left, right) = loop {
        let (more_left, more_right) = (left.next(&mut a), right.next(&mut b));
        let (Ok(true), Ok(true)) = (&more_left, &more_right) else {
            // A trace that could go on while the other one can't has no last record yet.
            break (
                more_left.and_then(|more| if more { Ok(0) } else { left.trailing() }),
                more_right.and_then(|more| if more { Ok(0) } else { right.trailing() }),
            );
        };
        if let Some(block) = difference(&a, &b) {
            differing += 1;
            let (step, mid) = (layout.step_of(frames), layout.is_mid(frames));
            first.get_or_insert(Difference { frame: frames, step, mid, block });
        }
        frames += 1;
    };
    Comparison { frames, differing, first, left, right }
}

/// The first difference of two frames, in the order of the trace's bytes (a list's entries before its length).
#[must_use]
pub fn difference(left: &Frame, right: &Frame) -> Option<Block> {
    let number = |a: &[f64], b: &[f64]| {
        let index = a.iter().zip(b).position(|(a, b)| a.to_bits() != b.to_bits())?;
        Some((index, a[index], b[index]))
    };
    let count = |list, left, right| (left != right).then_some(Block::Count { list, left, right });
    for (quantity, left, right) in [
        ("position", &left.state.positions, &right.state.positions),
        ("velocity", &left.state.velocities, &right.state.velocities),
    ] {
        if let Some((index, left, right)) = number(left, right) {
            let axis = if index.is_multiple_of(2) { 'x' } else { 'y' };
            return Some(Block::Coordinate { quantity, particle: index / 2, axis, left, right });
        }
    }
    for (index, (&left, &right)) in left.impulses.iter().zip(&right.impulses).enumerate() {
        if !left.is_same(&right) {
            return Some(Block::Impulse { index, left, right });
        }
    }
    if let Some(block) = count(List::Impulses, left.impulses.len(), right.impulses.len()) {
        return Some(block);
    }
    for (index, (a, b)) in left.polynomials.iter().zip(right.polynomials.iter()).enumerate() {
        if a.len() != b.len() {
            return Some(Block::PolynomialSize { index, left: a.len(), right: b.len() });
        }
        if let Some((place, left, right)) = number(a, b) {
            return Some(Block::Coefficient { index, power: a.len() - 1 - place, left, right });
        }
    }
    count(List::Polynomials, left.polynomials.len(), right.polynomials.len())
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.first {
            None => writeln!(f, "{} records, no difference", self.frames)?,
            Some(first) => writeln!(f, "{} of {} records differ, the first at {first}", self.differing, self.frames)?,
        }
        for (side, end) in [("left", &self.left), ("right", &self.right)] {
            match end {
                Ok(0) => {}
                Ok(trailing) => writeln!(f, "{side}: {trailing} bytes behind the last record")?,
                Err(error) => writeln!(f, "{side}: {error}")?,
            }
        }
        Ok(())
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mid = if self.mid { ", mid record" } else { "" };
        write!(f, "record {} (step {}{mid}): {}", self.frame, self.step, self.block)
    }
}

impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Coordinate { quantity, particle, axis, left, right } => {
                write!(f, "{quantity} {axis} of particle {particle}: {}", numbers(left, right))
            }
            Self::Impulse { index, left, right } => write!(f, "impulse {index}: {left} against {right}"),
            Self::Count { list, left, right } => write!(f, "number of {list}s: {left} against {right}"),
            Self::PolynomialSize { index, left, right } => {
                write!(f, "size of polynomial {index}: {left} against {right}")
            }
            Self::Coefficient { index, power, left, right } => {
                write!(f, "coefficient of t^{power} of polynomial {index}: {}", numbers(left, right))
            }
        }
    }
}

/// Two numbers whose bits differ; bits are shown where the text does not (NaN).
fn numbers(left: f64, right: f64) -> String {
    if left.is_nan() && right.is_nan() {
        format!("NaN ({:#018x}) against NaN ({:#018x})", left.to_bits(), right.to_bits())
    } else {
        format!("{left:?} against {right:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        sim::State,
        trace::{Layout, Writer},
    };
    use fosssim_num::vector::Vec2;

    const LAYOUT: Layout = Layout { particles: 1, impulses: true, polynomials: true, steps: 1 };

    fn frame() -> Frame {
        let state = State { positions: vec![0.0; 2], velocities: vec![0.0; 2] };
        let normal = Vec2::new(1.0, 0.0);
        let impulses = vec![LoggedImpulse { kind: 2, first: 0, second: 1, normal, time: 0.5 }];
        let mut frame = Frame { state, impulses, ..Frame::default() };
        frame.polynomials.push(&[1.0, 2.0, 3.0]);
        frame
    }

    fn trace(frames: &[Frame]) -> Vec<u8> {
        let mut writer = Writer::new(Vec::new(), LAYOUT);
        frames.iter().for_each(|frame| writer.frame(frame));
        writer.finish().unwrap().0
    }

    fn compared(left: &[u8], right: &[u8]) -> Comparison {
        compare(Reader::of_slice(left, LAYOUT), Reader::of_slice(right, LAYOUT))
    }

    /// The message when the right trace's mid record is changed so.
    fn said(change: impl FnOnce(&mut Frame)) -> String {
        let mut changed = frame();
        change(&mut changed);
        let comparison = compared(&trace(&[frame(), frame(), frame()]), &trace(&[frame(), changed, frame()]));
        assert_eq!((comparison.frames, comparison.differing, comparison.same()), (3, 1, false));
        comparison.first.unwrap().to_string()
    }

    #[test]
    fn every_block_is_compared_bit_by_bit() {
        let place = "record 1 (step 1, mid record): ";
        let expect = |said: String, text: &str| assert_eq!(said.strip_prefix(place).unwrap(), text);
        expect(said(|f| f.state.positions[1] = -0.0), "position y of particle 0: 0.0 against -0.0");
        expect(said(|f| f.state.velocities[0] = 1.0), "velocity x of particle 0: 0.0 against 1.0");
        expect(
            said(|f| f.impulses[0].time = 0.25),
            "impulse 0: particle 0 - half-plane 1, normal (1.0, 0.0), time 0.5 against particle 0 - half-plane 1, \
             normal (1.0, 0.0), time 0.25",
        );
        expect(said(|f| f.impulses.clear()), "number of impulses: 1 against 0");
        expect(said(|f| f.polynomials.coefficients[0] = 1.5), "coefficient of t^2 of polynomial 0: 1.0 against 1.5");
        expect(said(|f| f.polynomials.push(&[])), "number of polynomials: 1 against 2");
        let shorter = |f: &mut Frame| {
            f.polynomials.clear();
            f.polynomials.push(&[2.0, 3.0]);
        };
        expect(said(shorter), "size of polynomial 0: 3 against 2");
    }

    #[test]
    fn the_side_that_ends_early_is_named() {
        let whole = trace(&[frame(), frame(), frame()]);
        let comparison = compared(&whole, &whole[..whole.len() - 1]);
        assert_eq!((comparison.frames, comparison.differing), (2, 0));
        assert!(comparison.left.is_ok() && !comparison.same());
        assert_eq!(comparison.right.as_ref().unwrap_err().frame, 2);
        assert!(comparison.to_string().starts_with("2 records, no difference\nright: byte "), "{comparison}");
        assert!(compared(&whole, &whole).same());
    }
}
