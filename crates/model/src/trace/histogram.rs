//! The number of steps for each number of entries.
use std::{collections::BTreeMap, fmt};

/// The greatest number of different values that are printed.
const SHOWN: usize = 12;

/// A histogram of numbers per step.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Histogram(BTreeMap<u64, u64>);

impl Histogram {
    /// Counts one step with this number of entries.
    pub fn add(&mut self, entries: u64) {
        *self.0.entry(entries).or_default() += 1;
    }

    /// Returns the pairs of a number of entries and how many steps have it, ascending.
    pub fn iter(&self) -> impl Iterator<Item = (u64, u64)> {
        self.0.iter().map(|(&entries, &steps)| (entries, steps))
    }

    /// Returns the sum of all entries.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.iter().map(|(entries, steps)| entries * steps).sum()
    }
}

/// Writes `0 in 73 steps, 1 in 2 steps`; of many different values the first ones and the largest.
impl fmt::Display for Histogram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let one = |entries, steps| format!("{entries} in {steps} step{}", if steps == 1 { "" } else { "s" });
        let mut parts: Vec<String> = self.iter().take(SHOWN).map(|(entries, steps)| one(entries, steps)).collect();
        if let Some((largest, steps)) = self.0.iter().next_back().filter(|_| self.0.len() > SHOWN) {
            parts.push(format!("{} more values", self.0.len() - SHOWN - 1));
            parts.push(format!("at most {}", one(*largest, *steps)));
        }
        f.write_str(if parts.is_empty() { "no step" } else { "" })?;
        f.write_str(&parts.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_listed_ascending_and_many_are_shortened() {
        let mut histogram = Histogram::default();
        assert_eq!(histogram.to_string(), "no step");
        [3, 0, 3].into_iter().for_each(|entries| histogram.add(entries));
        assert_eq!(histogram.to_string(), "0 in 1 step, 3 in 2 steps");
        assert_eq!(histogram.total(), 6);
        (0..20).for_each(|entries| histogram.add(entries));
        assert!(histogram.to_string().ends_with("11 in 1 step, 7 more values, at most 19 in 1 step"), "{histogram}");
    }
}
