//! The corpus of root-finder vectors: every zero and every first time must match the original bit for bit.
use fosssim_oracle::num::{
    first_time::{first_time, first_time_of_lists},
    polynomial::{MAX_COEFFICIENTS, Polynomial, trim},
    rpoly::zeros,
};

use crate::corpus;

/// The value that marks a first-time search without an end in the records.
const ENDLESS: u64 = 0x7FF8_DEAD_0000_0000;

/// A reader of the records' fields, in order.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn byte(&mut self) -> u8 {
        let (&byte, rest) = self.0.split_first().expect("the record is complete");
        self.0 = rest;
        byte
    }

    fn number(&mut self) -> f64 {
        let (bytes, rest) = self.0.split_first_chunk::<8>().expect("the record is complete");
        self.0 = rest;
        f64::from_le_bytes(*bytes)
    }

    fn numbers(&mut self) -> Vec<f64> {
        (0..self.byte()).map(|_| self.number()).collect()
    }
}

/// Returns whether the bits are equal; all NaNs count as equal.
fn same(actual: f64, expected: f64) -> bool {
    actual.to_bits() == expected.to_bits() || (actual.is_nan() && expected.is_nan())
}

#[test]
fn zeros_match_the_original_bit_for_bit() {
    let Some(folder) = corpus::folder() else { return };
    let bytes = corpus::unpack(&folder.join("roots/rpoly.bin.zst"));
    let mut fields = Fields(&bytes);
    let mut cases = 0;
    while !fields.0.is_empty() {
        let length = fields.byte();
        let count = i32::from(fields.byte().cast_signed());
        let coefficients: Vec<f64> = (0..length).map(|_| fields.number()).collect();
        let expected: Vec<(f64, f64)> = (0..count).map(|_| (fields.number(), fields.number())).collect();
        match zeros(&coefficients) {
            Err(_) => assert_eq!(count, -2, "case {cases}: {coefficients:?}"),
            Ok(actual) => {
                assert_eq!(actual.count(), count, "case {cases}: {coefficients:?}");
                let equal = actual.as_slice().iter().zip(&expected).all(|(a, e)| same(a.0, e.0) && same(a.1, e.1));
                assert!(equal, "case {cases}: {coefficients:?}\nactual {actual:?}\nexpected {expected:?}");
            }
        }
        cases += 1;
    }
    corpus::ran("root_vectors::zeros", cases);
}

/// Compares one file of groups, and returns the number of its cases.
fn compare_first_times(file: &str, cut: fn(&[f64]) -> &[f64]) {
    let Some(folder) = corpus::folder() else { return };
    let bytes = corpus::unpack(&folder.join("roots").join(file));
    let mut fields = Fields(&bytes);
    let mut cases = 0;
    while !fields.0.is_empty() {
        let lists: Vec<Vec<f64>> = (0..fields.byte()).map(|_| fields.numbers()).collect();
        let expected = fields.number();
        // Some lists have degree six, which no detection polynomial has.
        let actual = if lists.iter().all(|list| cut(list).len() <= MAX_COEFFICIENTS) {
            let polynomials: Vec<Polynomial> = lists.iter().map(|list| Polynomial::untrimmed(cut(list))).collect();
            first_time(&polynomials)
        } else {
            first_time_of_lists(lists.iter().map(|list| cut(list)))
        };
        match actual {
            Err(_) => assert_eq!(expected.to_bits(), ENDLESS, "case {cases}: {lists:?}"),
            Ok(actual) => assert!(
                expected.to_bits() != ENDLESS && same(actual, expected),
                "case {cases}: {lists:?}: actual {actual:e}, expected {expected:e}"
            ),
        }
        cases += 1;
    }
    corpus::ran(file, cases);
}

#[test]
fn first_times_of_the_dropping_build_match_bit_for_bit() {
    compare_first_times("first_time.bin.zst", trim);
}

#[test]
fn first_times_of_the_non_dropping_build_match_bit_for_bit() {
    compare_first_times("first_time_nodrop.bin.zst", |list| list);
}
