//! Finds the changes from one picture to the next, because films store only the changes.
use crate::size::Size;

/// A rectangle of pixels, which is never empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChangedArea {
    pub left: u32,
    pub top: u32,
    pub width: u32,
    pub height: u32,
}

impl ChangedArea {
    /// Returns the smallest rectangle outside of which two pictures of one byte per pixel are equal. If they are equal
    /// everywhere, the rectangle is one pixel, because a film has no empty pictures. The first picture of a film has no
    /// previous one, and its rectangle is the whole picture.
    pub fn from_pictures(size: Size, before: &[u8], after: &[u8]) -> Self {
        if before.is_empty() {
            return Self { left: 0, top: 0, width: size.width(), height: size.height() };
        }
        let row = size.width() as usize;
        let differs = |y: &usize| before[y * row..(y + 1) * row] != after[y * row..(y + 1) * row];
        let rows = 0..size.height() as usize;
        let (Some(top), Some(bottom)) = (rows.clone().find(differs), rows.rev().find(differs)) else {
            return Self { left: 0, top: 0, width: 1, height: 1 };
        };
        let (mut left, mut right) = (size.width() as usize - 1, 0);
        for y in top..=bottom {
            let (old, new) = (&before[y * row..(y + 1) * row], &after[y * row..(y + 1) * row]);
            let differs = |x: &usize| old[*x] != new[*x];
            if let Some(first) = (0..left).find(differs) {
                left = first;
            }
            if let Some(last) = (right + 1..old.len()).rev().find(differs) {
                right = last;
            }
        }
        let right = right.max(left);
        #[expect(clippy::cast_possible_truncation, reason = "within the picture")]
        let part = Self {
            left: left as u32,
            top: top as u32,
            width: (right - left + 1) as u32,
            height: (bottom - top + 1) as u32,
        };
        part
    }

    /// Returns the bytes of the rectangle, row by row.
    pub fn extract(self, size: Size, bytes: &[u8]) -> Vec<u8> {
        let row = size.width() as usize;
        let mut part = Vec::with_capacity(self.width as usize * self.height as usize);
        for y in self.top..self.top + self.height {
            let start = y as usize * row + self.left as usize;
            part.extend_from_slice(&bytes[start..start + self.width as usize]);
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_is_tight_and_enough() {
        let size = Size::new(20, 16).unwrap();
        let before = vec![0_u8; size.pixels()];
        for (dots, expected) in [
            (&[][..], [0, 0, 1, 1]),
            (&[(3, 4)], [3, 4, 1, 1]),
            (&[(0, 0)], [0, 0, 1, 1]),
            (&[(19, 15)], [19, 15, 1, 1]),
            (&[(0, 15), (19, 0)], [0, 0, 20, 16]),
            (&[(5, 7), (9, 2), (7, 7)], [5, 2, 5, 6]),
        ] {
            let mut after = before.clone();
            dots.iter().for_each(|&(x, y)| after[y * 20 + x] = 1);
            let part = ChangedArea::from_pictures(size, &before, &after);
            assert_eq!([part.left, part.top, part.width, part.height], expected, "{dots:?}");
            assert_eq!(part.extract(size, &after).iter().filter(|&&byte| byte == 1).count(), dots.len());
        }
    }
}
