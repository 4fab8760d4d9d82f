//! Rows of equal height, each with the boxes that it touches, to find boxes that overlap along y.
use super::extent::BodyExtent;

/// The boxes of each row, in the order of the boxes.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    /// The first and the last row of each box.
    spans: Vec<[usize; 2]>,
    /// The start of each row in `boxes_of_rows`, and the end of the last row.
    starts: Vec<usize>,
    boxes_of_rows: Vec<usize>,
    /// For each row, the index in `boxes_of_rows` after the boxes visited so far.
    later: Vec<usize>,
    /// The boxes that overlap the current one.
    found: Vec<usize>,
}

impl Rows {
    /// Assigns boxes to rows. The ends of the boxes along y are finite, and no upper end is below its lower end.
    ///
    /// A row is at least as high as the average box, so a box is in three rows on average at most.
    pub fn assign(&mut self, boxes: &[BodyExtent]) {
        let ends = || boxes.iter().map(BodyExtent::ends_along_y);
        let (mut lowest, mut highest, mut total) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for [low, high] in ends() {
            (lowest, highest, total) = (lowest.min(low), highest.max(high), total + (high - low));
        }
        #[expect(clippy::cast_precision_loss, reason = "the height of a row need not be exact")]
        let density = boxes.len() as f64 / total.max(highest - lowest);
        let density = if density.is_finite() { density } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "no end is below the lowest")]
        let row = |y: f64| ((y - lowest) * density) as usize;
        self.spans.clear();
        self.spans.extend(ends().map(|ends| ends.map(row)));
        self.collect_boxes();
    }

    /// Lists the boxes of each row.
    fn collect_boxes(&mut self) {
        let Self { spans, starts, boxes_of_rows: boxes, .. } = self;
        // While rows are filled, the entry after that of a row is the index of its next box.
        let rows = spans.iter().map(|[_, last]| last + 1).max().unwrap_or(0);
        starts.clear();
        starts.resize(rows + 2, 0);
        spans.iter().flat_map(|&[first, last]| first..=last).for_each(|row| starts[row + 2] += 1);
        (2..starts.len()).for_each(|row| starts[row] += starts[row - 1]);
        boxes.resize(starts[rows + 1], 0);
        for (index, &[first, last]) in spans.iter().enumerate() {
            for start in &mut starts[first + 1..=last + 1] {
                boxes[*start] = index;
                *start += 1;
            }
        }
    }

    /// Calls `visit` for all pairs of boxes that overlap or touch, in order of the first box, then of the second. The
    /// boxes are those of [`assign`](Self::assign), sorted by their lower ends along x.
    pub fn visit_overlaps(&mut self, boxes: &[BodyExtent], mut visit: impl FnMut(&BodyExtent, &BodyExtent)) {
        let Self { spans, starts, boxes_of_rows, later, found } = self;
        later.clone_from(starts);
        for (one, &[first, last]) in boxes.iter().zip(&*spans) {
            for row in first..=last {
                later[row] += 1;
                for &index in &boxes_of_rows[later[row]..starts[row + 1]] {
                    let other = &boxes[index];
                    if other.begins_behind(one) {
                        break;
                    }
                    // A pair counts in the first row that both boxes are in.
                    if row == first.max(spans[index][0]) && one.overlaps(other) {
                        found.push(index);
                    }
                }
            }
            found.sort_unstable();
            found.drain(..).for_each(|index| visit(one, &boxes[index]));
        }
    }
}
