//! Sides of pixels to points at equal distances along a smooth line.

use super::trace::Side;
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
    sides: &'a [Side],
    closed: bool,
    reach: usize,
    plane: Plane,
    at: usize,
    /// The window that `sum` is of, as offsets into the sides repeated.
    window: core::ops::Range<usize>,
    sum: [u32; 2],
}

impl<'a> Smooth<'a> {
    pub(super) fn new(sides: &'a [Side], closed: bool, reach: usize, plane: Plane) -> Self {
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

    fn side(&self, at: usize) -> Side {
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
/// point is not its first again. Nothing for a line shorter than two distances.
pub(super) fn resample(line: &Smooth<'_>, spacing: f64, mut emit: impl FnMut([f64; 2])) -> f64 {
    let length = length(line.clone());
    let intervals = (length / spacing + 0.5) as usize;
    let mut points = line.clone();
    let (2.., Some(mut from)) = (intervals, points.next()) else {
        return 0.0;
    };
    let step = length / intervals as f64;
    let wanted = intervals + usize::from(!line.closed);
    emit(from);
    let (mut passed, mut emitted) = (0.0, 1);
    for to in points {
        let side = distance(from, to);
        while emitted < wanted && side > 0.0 && emitted as f64 * step <= passed + side {
            let share = (emitted as f64 * step - passed) / side;
            emit([0, 1].map(|k| from[k] + share * (to[k] - from[k])));
            emitted += 1;
        }
        passed += side;
        from = to;
    }
    // Rounding may have left the end out.
    if emitted < wanted {
        emit(from);
    }
    step
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
