//! Reproduces the order in which the C++ library's sort leaves entries with equal keys.
//!
//! Introsort is quicksort with a median of three, heapsort if the recursion is too deep, and a final insertion sort.
//! Entries with equal keys keep their order only in lists of up to [`MAX_INSERTION_LENGTH`] entries. The original's
//! sums depend on the order.

/// The maximum length of parts that are left to the final insertion sort.
const MAX_INSERTION_LENGTH: usize = 16;

/// Sorts entries by ascending keys. Entries with NaN keys end up in unspecified places.
pub(super) fn sort<T: Copy>(list: &mut [T], key: impl Fn(&T) -> f64 + Copy) {
    let is_less = |one: &T, other: &T| key(one) < key(other);
    if let Some(depth) = list.len().checked_ilog2() {
        divide(list, 2 * depth, is_less);
        insert_all(list, is_less);
    }
}

fn divide<T: Copy>(mut list: &mut [T], mut depth: u32, is_less: impl Fn(&T, &T) -> bool + Copy) {
    while list.len() > MAX_INSERTION_LENGTH {
        if depth == 0 {
            return heapsort(list, is_less);
        }
        depth -= 1;
        let middle = list.len() / 2;
        let last = list.len() - 1;
        let median = median([1, middle, last], |one, other| is_less(&list[one], &list[other]));
        list.swap(0, median);
        let cut = partition(list, is_less);
        let (low, high) = list.split_at_mut(cut);
        divide(high, depth, is_less);
        list = low;
    }
}

/// Returns the index of the median entry.
fn median([a, b, c]: [usize; 3], is_less: impl Fn(usize, usize) -> bool) -> usize {
    match (is_less(a, b), is_less(b, c), is_less(a, c)) {
        (true, true, _) | (false, false, false) => b,
        (true, false, true) | (false, true, false) => c,
        (true, false, false) | (false, _, true) => a,
    }
}

/// Moves entries below the first entry before those above it. Returns the start of the second part.
fn partition<T: Copy>(list: &mut [T], is_less: impl Fn(&T, &T) -> bool) -> usize {
    let pivot = list[0];
    let (mut first, mut last) = (1, list.len());
    loop {
        // The bounds stop the search at NaN keys.
        while first < list.len() && is_less(&list[first], &pivot) {
            first += 1;
        }
        last -= 1;
        while last > 0 && is_less(&pivot, &list[last]) {
            last -= 1;
        }
        if first >= last {
            return first.min(list.len() - 1);
        }
        list.swap(first, last);
        first += 1;
    }
}

fn heapsort<T: Copy>(list: &mut [T], is_less: impl Fn(&T, &T) -> bool + Copy) {
    for parent in (0..list.len() / 2).rev() {
        sift(list, parent, list[parent], is_less);
    }
    for end in (1..list.len()).rev() {
        let value = list[end];
        list[end] = list[0];
        sift(&mut list[..end], 0, value, is_less);
    }
}

/// Moves a hole from index `top` to the bottom of a heap. Then moves `value` up from there to its place.
fn sift<T: Copy>(heap: &mut [T], top: usize, value: T, is_less: impl Fn(&T, &T) -> bool) {
    let mut hole = top;
    while 2 * hole + 2 < heap.len() {
        let right = 2 * hole + 2;
        let child = if is_less(&heap[right], &heap[right - 1]) { right - 1 } else { right };
        heap[hole] = heap[child];
        hole = child;
    }
    if 2 * hole + 2 == heap.len() {
        heap[hole] = heap[2 * hole + 1];
        hole = 2 * hole + 1;
    }
    while hole > top && is_less(&heap[(hole - 1) / 2], &value) {
        heap[hole] = heap[(hole - 1) / 2];
        hole = (hole - 1) / 2;
    }
    heap[hole] = value;
}

/// Sorts by insertion; equal keys keep their order.
fn insert_all<T: Copy>(list: &mut [T], is_less: impl Fn(&T, &T) -> bool) {
    for end in 1..list.len() {
        let value = list[end];
        // The search passes NaN keys only in this case.
        let is_least = end < MAX_INSERTION_LENGTH && is_less(&value, &list[0]);
        let mut hole = end;
        while hole > 0 && (is_least || is_less(&value, &list[hole - 1])) {
            list[hole] = list[hole - 1];
            hole -= 1;
        }
        list[hole] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sorts numbers, and returns each number's previous index.
    fn sorted(keys: &[f64]) -> Vec<usize> {
        let mut list: Vec<(f64, usize)> = keys.iter().copied().zip(0..).collect();
        sort(&mut list, |entry| entry.0);
        assert!(list.is_sorted_by(|one, other| one.0 <= other.0), "{list:?}");
        list.into_iter().map(|(_, place)| place).collect()
    }

    #[test]
    fn up_to_sixteen_equal_keys_keep_their_order_and_more_do_not() {
        assert_eq!(sorted(&[1.0; 16]), (0..16).collect::<Vec<_>>());
        assert_ne!(sorted(&[1.0; 17]), (0..17).collect::<Vec<_>>());
    }

    #[test]
    fn all_lists_are_sorted_and_bad_ones_by_a_heap() {
        assert!(sorted(&[]).is_empty());
        for count in [2_u32, 17, 100, 1000] {
            let keys = |key: &dyn Fn(u32) -> u32| (0..count).map(|i| f64::from(key(i))).collect::<Vec<f64>>();
            sorted(&keys(&|i| i));
            sorted(&keys(&|i| count - i));
            sorted(&keys(&|i| i.wrapping_mul(2_654_435_761) % 7));
            // The median of three is always among the smallest, so quicksort alone would take a quadratic number of
            // steps.
            sorted(&keys(&|i| if i % 2 == 0 { count + i } else { i }));
        }
        let mut none = [f64::NAN, 1.0, f64::NAN, 0.0].repeat(10);
        sort(&mut none, |key| *key);
    }

    #[test]
    fn a_heap_sorts() {
        let mut list: Vec<u32> = (0..100).map(|i| i * 37 % 41).collect();
        heapsort(&mut list, |one, other| one < other);
        assert!(list.is_sorted());
    }
}
