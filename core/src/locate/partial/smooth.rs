//! Sides of pixels to points at equal distances along a smooth line.

use super::trace::PixelSide;
use crate::math::sqrt;

/// From half pixels to plane coordinates: to the right and upwards from the frame's middle, in
/// widths of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) middle: [f64; 2],
    /// Height of a pixel divided by its width.
    pub(super) aspect: f64,
}

impl Plane {
    pub(super) fn new(width: usize, height: usize, aspect: f64) -> Self {
        Self {
            middle: [width as f64 / 2.0, height as f64 / 2.0],
            aspect,
        }
    }

    /// The plane point at a column and row.
    pub(super) fn point(&self, column: f64, row: f64) -> [f64; 2] {
        [
            column - self.middle[0],
            (self.middle[1] - row) * self.aspect,
        ]
    }

    /// Column and row of a plane point.
    pub(super) fn frame(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.middle[0] + x, self.middle[1] - y / self.aspect]
    }
}

/// The middles of sides, averaged over `reach` neighbours either way; fewer at the ends of an open
/// stretch. A closed one ends with its first point again.
#[derive(Clone)]
pub(super) struct Smooth<'a> {
    sides: &'a [PixelSide],
    closed: bool,
    reach: usize,
    plane: Plane,
    at: usize,
    /// The window that `sum` is of, as offsets into the sides repeated.
    window: core::ops::Range<usize>,
    sum: [u32; 2],
}

impl<'a> Smooth<'a> {
    pub(super) fn new(sides: &'a [PixelSide], closed: bool, reach: usize, plane: Plane) -> Self {
        Self {
            sides,
            closed,
            reach: reach.min(sides.len() / 2),
            plane,
            at: 0,
            window: 0..0,
            sum: [0; 2],
        }
    }

    /// The window of the point at `self.at`. Of a closed stretch all is shifted by `reach`.
    fn wanted(&self) -> core::ops::Range<usize> {
        if self.closed {
            return self.at..self.at + 2 * self.reach + 1;
        }
        let beyond = self.sides.len() - 1 - self.at;
        let reach = self.reach.min(self.at).min(beyond);
        self.at - reach..self.at + reach + 1
    }

    fn side(&self, at: usize) -> PixelSide {
        let count = self.sides.len();
        let shift = if self.closed { count - self.reach } else { 0 };
        self.sides[(at + shift) % count]
    }
}

impl Iterator for Smooth<'_> {
    type Item = [f64; 2];

    fn next(&mut self) -> Option<[f64; 2]> {
        let count = self.sides.len() + usize::from(self.closed);
        if self.at >= count || self.sides.is_empty() {
            return None;
        }
        let wanted = self.wanted();
        while self.window.end < wanted.end {
            let side = self.side(self.window.end);
            self.sum[0] += u32::from(side.column);
            self.sum[1] += u32::from(side.row);
            self.window.end += 1;
        }
        while self.window.start < wanted.start {
            let side = self.side(self.window.start);
            self.sum[0] -= u32::from(side.column);
            self.sum[1] -= u32::from(side.row);
            self.window.start += 1;
        }
        self.at += 1;
        let halves = 2.0 * wanted.len() as f64;
        let [column, row] = self.sum.map(|sum| f64::from(sum) / halves);
        Some(self.plane.point(column, row))
    }
}

/// Calls `emit` for points at equal distances along a line, as near to `spacing` as its length
/// allows, and gives that distance; an open line's ends are among the points, a closed one's last
/// point is not its first again. Nothing for a line shorter than two distances; `None` for one of
/// `most` points or more.
pub(super) fn resample(
    line: &Smooth<'_>,
    spacing: f64,
    most: usize,
    mut emit: impl FnMut([f64; 2]),
) -> Option<f64> {
    let length = length(line.clone());
    let intervals = (length / spacing + 0.5) as usize;
    if intervals >= most {
        return None;
    }
    let mut points = line.clone();
    let (2.., Some(mut from)) = (intervals, points.next()) else {
        return Some(0.0);
    };
    let step = length / intervals as f64;
    let wanted = intervals + usize::from(!line.closed);
    emit(from);
    let (mut passed, mut emitted) = (0.0, 1);
    for to in points {
        let side = distance(from, to);
        while emitted < wanted && side > 0.0 && emitted as f64 * step <= passed + side {
            let fraction = (emitted as f64 * step - passed) / side;
            emit([0, 1].map(|k| from[k] + fraction * (to[k] - from[k])));
            emitted += 1;
        }
        passed += side;
        from = to;
    }
    // Rounding may have left the end out.
    if emitted < wanted {
        emit(from);
    }
    Some(step)
}

fn length(line: Smooth<'_>) -> f64 {
    let mut from = None;
    line.fold(0.0, |sum, to| {
        let side = from.map_or(0.0, |from| distance(from, to));
        from = Some(to);
        sum + side
    })
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    sqrt(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plane() -> Plane {
        Plane::new(100, 80, 1.25)
    }

    /// Oracle: each average on its own.
    fn naive(sides: &[PixelSide], closed: bool, reach: usize) -> std::vec::Vec<[f64; 2]> {
        let count = sides.len();
        let reach = reach.min(count / 2);
        (0..count + usize::from(closed))
            .map(|at| {
                let reach = if closed {
                    reach
                } else {
                    reach.min(at).min(count - 1 - at)
                };
                let window = (at + count - reach..=at + count + reach).map(|k| sides[k % count]);
                let mean = |value: fn(PixelSide) -> u16| {
                    let sum: f64 = window.clone().map(|side| f64::from(value(side))).sum();
                    sum / (2 * reach + 1) as f64 / 2.0
                };
                plane().point(mean(|side| side.column), mean(|side| side.row))
            })
            .collect()
    }

    properties! {
        #[test]
        fn running_sums_give_the_averages(
            sides in proptest::collection::vec((0..200u16, 0..160u16), 1..40),
            closed in any::<bool>(),
            reach in 0..9usize
        ) {
            let sides: std::vec::Vec<_> =
                sides.iter().map(|&(column, row)| PixelSide { column, row }).collect();
            let smooth: std::vec::Vec<_> = Smooth::new(&sides, closed, reach, plane()).collect();
            let wanted = naive(&sides, closed, reach);
            prop_assert_eq!(smooth.len(), wanted.len());
            for (a, b) in smooth.iter().zip(&wanted) {
                prop_assert!(distance(*a, *b) < 1e-9, "{:?} {:?}", a, b);
            }
        }
    }

    /// Middles of the sides along a staircase that climbs one pixel in three.
    fn staircase() -> std::vec::Vec<PixelSide> {
        let mut sides = std::vec::Vec::new();
        for step in 0..30u16 {
            for k in 0..3 {
                sides.push(PixelSide {
                    column: 6 * step + 2 * k + 1,
                    row: 160 - 2 * step,
                });
            }
            sides.push(PixelSide {
                column: 6 * step + 6,
                row: 159 - 2 * step,
            });
        }
        sides
    }

    #[test]
    fn a_staircase_becomes_points_at_equal_distances() {
        let sides = staircase();
        let line = Smooth::new(&sides, false, 4, plane());
        let mut points = std::vec::Vec::new();
        let step = resample(&line, 5.0, 99, |point| points.push(point)).expect("fits");
        assert!((step - 5.0).abs() < 0.2, "{step}");
        for pair in points.windows(2) {
            let apart = distance(pair[0], pair[1]);
            assert!((apart / step - 1.0).abs() < 0.02, "{apart} of {step}");
        }
        let ends = [sides[0], sides[sides.len() - 1]]
            .map(|s| plane().point(f64::from(s.column) / 2.0, f64::from(s.row) / 2.0));
        assert!(distance(points[0], ends[0]) < 1e-9);
        assert!(distance(points[points.len() - 1], ends[1]) < 1e-9);
    }

    #[test]
    fn a_closed_line_goes_round_once_and_a_short_one_gives_nothing() {
        let corner = |column, row| PixelSide { column, row };
        let square: std::vec::Vec<PixelSide> = (0..40)
            .map(|at: u16| match (at / 10, 2 * (at % 10)) {
                (0, k) => corner(20 + k, 20),
                (1, k) => corner(40, 20 + k),
                (2, k) => corner(40 - k, 40),
                (_, k) => corner(20, 40 - k),
            })
            .collect();
        let line = Smooth::new(&square, true, 0, Plane::new(100, 80, 1.0));
        let mut points = std::vec::Vec::new();
        let step = resample(&line, 4.1, 11, |point| points.push(point)).expect("fits");
        assert_eq!((points.len(), step), (10, 4.0));
        assert!((distance(points[9], points[0]) - 4.0).abs() < 1e-9);
        let mut count = 0;
        for spacing in [4.1, 1e-300, 0.0] {
            assert_eq!(resample(&line, spacing, 10, |_| count += 1), None);
        }
        assert_eq!(resample(&line, 40.0, 9, |_| count += 1), Some(0.0));
        let one = Smooth::new(&square[..1], false, 3, plane());
        assert_eq!(resample(&one, 1.0, 9, |_| count += 1), Some(0.0));
        let none = Smooth::new(&[], true, 3, plane());
        assert_eq!(resample(&none, 1.0, 9, |_| count += 1), Some(0.0));
        assert_eq!(count, 0);
    }
}
