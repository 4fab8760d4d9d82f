//! Clips lines and areas to a rectangle before they are drawn, because bodies may be arbitrarily far away, and drawing
//! libraries handle only small coordinates.
use crate::shape::Point;

/// A rectangle from `low` to `high`.
#[derive(Debug, Clone, Copy)]
pub struct ClipRectangle {
    pub low: Point,
    pub high: Point,
}

impl ClipRectangle {
    /// Returns the part of a line inside the rectangle (Liang and Barsky, ACM TOG 3, 1984), or `None` if there is none.
    pub fn clip_line(&self, from: Point, to: Point) -> Option<[Point; 2]> {
        if !from.iter().chain(&to).all(|value| value.is_finite()) {
            return None;
        }
        let way = [to[0] - from[0], to[1] - from[1]];
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            for (rate, room) in [(-way[axis], from[axis] - self.low[axis]), (way[axis], self.high[axis] - from[axis])] {
                if rate == 0.0 {
                    if room < 0.0 {
                        return None;
                    }
                } else if rate < 0.0 {
                    enter = enter.max(room / rate);
                } else {
                    leave = leave.min(room / rate);
                }
            }
        }
        if !(enter <= leave) {
            return None;
        }
        let at = |time: f64| [from[0] + time * way[0], from[1] + time * way[1]];
        let ends = [if enter > 0.0 { at(enter) } else { from }, if leave < 1.0 { at(leave) } else { to }];
        // A line is not drawn if it is so long that its points have no digits left inside the picture.
        let is_near = |[x, y]: Point| {
            let room = 1.0 + self.high[0] - self.low[0] + self.high[1] - self.low[1];
            x >= self.low[0] - room && x <= self.high[0] + room && y >= self.low[1] - room && y <= self.high[1] + room
        };
        ends.iter().all(|&end| is_near(end)).then_some(ends)
    }

    /// Returns the corners of the part of the rectangle where `inside`, a linear function of the position, is not
    /// negative (Sutherland and Hodgman, Comm. ACM 17, 1974).
    pub fn clip_half_plane(&self, inside: impl Fn(Point) -> f64) -> Vec<Point> {
        let ([left, top], [right, bottom]) = (self.low, self.high);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        let mut polygon = Vec::new();
        for (k, &corner) in corners.iter().enumerate() {
            let next = corners[(k + 1) % 4];
            let (here, there) = (inside(corner), inside(next));
            if here >= 0.0 {
                polygon.push(corner);
            }
            if (here < 0.0) != (there < 0.0) {
                let share = here / (here - there);
                if share.is_finite() {
                    polygon
                        .push([corner[0] + share * (next[0] - corner[0]), corner[1] + share * (next[1] - corner[1])]);
                }
            }
        }
        polygon
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: ClipRectangle = ClipRectangle { low: [0.0, 0.0], high: [10.0, 5.0] };

    #[test]
    fn lines_are_cut_at_the_frame() {
        assert_eq!(FRAME.clip_line([1.0, 1.0], [9.0, 4.0]), Some([[1.0, 1.0], [9.0, 4.0]]));
        assert_eq!(FRAME.clip_line([-10.0, 2.0], [1e9, 2.0]), Some([[0.0, 2.0], [10.0, 2.0]]));
        assert_eq!(FRAME.clip_line([-1.0, 6.0], [11.0, 6.0]), None);
        assert_eq!(FRAME.clip_line([f64::NAN, 0.0], [1.0, 1.0]), None);
        assert_eq!(FRAME.clip_line([f64::NEG_INFINITY, 0.0], [1.0, 1.0]), None);
        assert_eq!(FRAME.clip_line([3.0, 3.0], [3.0, 3.0]), Some([[3.0, 3.0]; 2]));
        for far in [1e100, 1e300, f64::MAX] {
            for ends in
                FRAME.clip_line([-far, -far], [far, far]).into_iter().chain(FRAME.clip_line([-far, 1.0], [far, 2.0]))
            {
                assert!(ends.iter().flatten().all(|value| value.abs() < 100.0), "{ends:?}");
            }
        }
    }

    #[test]
    fn a_side_of_a_line_is_a_polygon() {
        assert_eq!(FRAME.clip_half_plane(|[x, _]| x - 4.0), [[4.0, 0.0], [10.0, 0.0], [10.0, 5.0], [4.0, 5.0]]);
        assert_eq!(FRAME.clip_half_plane(|_| 1.0).len(), 4);
        assert_eq!(FRAME.clip_half_plane(|_| -1.0).len(), 0);
        assert_eq!(FRAME.clip_half_plane(|_| f64::NAN).len(), 0);
    }
}
