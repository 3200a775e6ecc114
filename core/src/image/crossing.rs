//! Whether sides of a closed line meet where they should not.
//!
//! Stretches of sides whose boxes are apart have no two that meet, and neither has one that goes on to the same sides of the frame
//! all the way, so most pairs are never looked at: time grows little faster than the number of points.

use core::cmp::Ordering;
use core::ops::Range;

use super::point::Point;

/// The first two sides of a closed line through `count` points, all finite, that meet where they should not.
#[must_use]
pub fn first_crossing(count: usize, at: impl Fn(usize) -> Point) -> Option<(usize, usize)> {
    // One copy of the code for all callers.
    let line = Line { count, at: &at };
    // Which are the first is asked only where there are some.
    line.meets_itself().then(|| line.first_pair()).flatten()
}

/// Stretches that a line is cut into, whose boxes are kept.
const STRETCHES: usize = 64;

/// Sides whose pairs are looked at one by one.
const FEW: usize = 16;

struct Line<'l> {
    count: usize,
    at: &'l dyn Fn(usize) -> Point,
}

impl Line<'_> {
    fn side(&self, number: usize) -> (Point, Point) {
        let next = if number + 1 == self.count {
            0
        } else {
            number + 1
        };
        ((self.at)(number), (self.at)(next))
    }

    /// Whether two sides, the first given first, meet where they should not.
    fn touch(&self, first: usize, second: usize) -> bool {
        let (a, b) = (self.side(first), self.side(second));
        if second == first + 1 || (first == 0 && second == self.count - 1) {
            return folds_back(a, b);
        }
        // Most pairs are far apart: boxes are compared before anything is multiplied, first those of a part of each number.
        Extent::of(a).meets(&Extent::of(b)) && boxes_meet(a, b) && segments_meet(a, b)
    }

    fn first_pair(&self) -> Option<(usize, usize)> {
        let pairs = |first| (first + 1..self.count).map(move |second| (first, second));
        let mut pairs = (0..self.count).flat_map(pairs);
        pairs.find(|&(first, second)| self.touch(first, second))
    }

    /// Whether any two sides do.
    fn meets_itself(&self) -> bool {
        let length = self.count.div_ceil(STRETCHES).max(1);
        let stretch = |number: usize| {
            let start = (number * length).min(self.count);
            start..(start + length).min(self.count)
        };
        let boxes: [Extent; STRETCHES] =
            core::array::from_fn(|number| self.around(stretch(number)));
        let used = self.count.div_ceil(length);
        boxes.iter().take(used).enumerate().any(|(number, own)| {
            let sides = stretch(number);
            let mut after = boxes.iter().enumerate().take(used).skip(number + 1);
            self.meets(sides.clone())
                || after.any(|(other, theirs)| {
                    own.meets(theirs) && self.meet(sides.clone(), stretch(other))
                })
        })
    }

    /// Whether any two of some sides do.
    fn meets(&self, sides: Range<usize>) -> bool {
        if self.goes_on(sides.clone()) {
            return false;
        }
        if sides.len() <= FEW {
            let mut firsts = sides.clone();
            return firsts
                .any(|first| (first + 1..sides.end).any(|second| self.touch(first, second)));
        }
        let [before, after] = halves(sides);
        self.meets(before.clone()) || self.meets(after.clone()) || self.meet(before, after)
    }

    /// Whether any of some sides and any of those after them do.
    fn meet(&self, before: Range<usize>, after: Range<usize>) -> bool {
        if !self
            .around(before.clone())
            .meets(&self.around(after.clone()))
        {
            return false;
        }
        if before.len().max(after.len()) <= FEW {
            let theirs = self.around(after.clone());
            let mut firsts = before.filter(|&first| Extent::of(self.side(first)).meets(&theirs));
            return firsts.any(|first| after.clone().any(|second| self.touch(first, second)));
        }
        if before.len() >= after.len() {
            let [a, b] = halves(before);
            self.meet(a, after.clone()) || self.meet(b, after)
        } else {
            let [a, b] = halves(after);
            self.meet(before.clone(), a) || self.meet(before, b)
        }
    }

    /// Whether some sides all go on in the same of the four directions between a frame's sides: then any two of them that are not
    /// neighbours lie apart, and none folds back. `false` where rounding could hide that.
    fn goes_on(&self, sides: Range<usize>) -> bool {
        let (mut last, mut ways) = (None, [Ordering::Equal; 2]);
        let end = if sides.end == self.count {
            0
        } else {
            sides.end
        };
        sides.chain([end]).all(|number| {
            let Some(own) = exact_keys((self.at)(number)) else {
                return false;
            };
            let Some(before) = last.replace(own) else {
                return true;
            };
            let steps = [own[0].cmp(&before[0]), own[1].cmp(&before[1])];
            let mut goes_on = steps != [Ordering::Equal; 2];
            for (way, step) in ways.iter_mut().zip(steps) {
                if *way == Ordering::Equal {
                    *way = step;
                }
                goes_on &= step == Ordering::Equal || step == *way;
            }
            goes_on
        })
    }

    /// The box around some sides.
    fn around(&self, sides: Range<usize>) -> Extent {
        let end = if sides.end == self.count {
            0
        } else {
            sides.end
        };
        let mut all = Extent::round((self.at)(end));
        sides.for_each(|number| all.grow((self.at)(number)));
        all
    }
}

fn halves(range: Range<usize>) -> [Range<usize>; 2] {
    let middle = range.start + range.len() / 2;
    [range.start..middle, middle..range.end]
}

/// Least and greatest column and row, as whole numbers that rise with them ([`keys`]): to compare those takes a tenth of the time on
/// a processor without numbers of 64 bits. Boxes that are apart by a millionth of their place may seem to meet.
struct Extent {
    low: [i32; 2],
    high: [i32; 2],
}

impl Extent {
    fn round(point: Point) -> Self {
        let own = keys(point);
        Self {
            low: own,
            high: own,
        }
    }

    fn of((a, b): (Point, Point)) -> Self {
        let mut both = Self::round(a);
        both.grow(b);
        both
    }

    #[inline]
    fn grow(&mut self, point: Point) {
        let [column, row] = keys(point);
        self.low = [self.low[0].min(column), self.low[1].min(row)];
        self.high = [self.high[0].max(column), self.high[1].max(row)];
    }

    fn meets(&self, other: &Self) -> bool {
        let meets =
            |axis: usize| self.high[axis] >= other.low[axis] && other.high[axis] >= self.low[axis];
        meets(0) && meets(1)
    }
}

/// Numbers that rise with the coordinates, though not each time: the upper half of their bits.
#[inline]
fn keys(point: Point) -> [i32; 2] {
    let key = |value: f64| {
        let upper = (value.to_bits() >> 32) as i32;
        // Below zero it is the other way round; both zeros are one.
        if upper < 0 {
            (upper ^ i32::MAX).wrapping_add(1)
        } else {
            upper
        }
    };
    [key(point.column), key(point.row)]
}

/// Numbers that rise with coordinates that are not negative; none where these are so small, or so large, that a product of two differences
/// is zero or infinite.
#[inline]
fn exact_keys(point: Point) -> Option<[u64; 2]> {
    const LEAST: u32 = (1023 - 100) << 20;
    const MOST: u32 = (1023 + 100) << 20;
    let bits = [point.column.to_bits(), point.row.to_bits()];
    let is_plain = |bits: u64| bits == 0 || (LEAST..MOST).contains(&((bits >> 32) as u32));
    bits.iter().all(|&bits| is_plain(bits)).then_some(bits)
}

/// Whether the boxes of two sides meet, in all bits.
fn boxes_meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let meet = |a: f64, b: f64, c: f64, d: f64| a.max(b) >= c.min(d) && c.max(d) >= a.min(b);
    meet(a.column, b.column, c.column, d.column) && meet(a.row, b.row, c.row, d.row)
}

/// Twice the signed area of the triangle `a b c`.
pub(super) fn orientation(a: Point, b: Point, c: Point) -> f64 {
    (b.column - a.column) * (c.row - a.row) - (b.row - a.row) * (c.column - a.column)
}

#[cfg_attr(target_os = "none", inline(never))]
fn within_box([a, b, p]: &[Point; 3]) -> bool {
    let between = |x: f64, y: f64, v: f64| v >= x.min(y) && v <= x.max(y);
    between(a.column, b.column, p.column) && between(a.row, b.row, p.row)
}

/// Whether two segments have a point in common (Cormen et al., *Introduction to Algorithms*, 33.1).
fn segments_meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let corners = [[a, b, c], [a, b, d], [c, d, a], [c, d, b]];
    let ways = corners.map(|[a, b, p]| orientation(a, b, p));
    let straddles = |[x, y]: [f64; 2]| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    let mut ends = corners.iter().zip(&ways);
    ways.as_chunks().0.iter().all(|&two| straddles(two))
        || ends.any(|(corners, &way)| way == 0.0 && within_box(corners))
}

/// Whether two sides with a common vertex lie on each other, or one of them has no length.
fn folds_back(a: (Point, Point), b: (Point, Point)) -> bool {
    let (before, shared, after) = if a.1 == b.0 {
        (a.0, a.1, b.1)
    } else {
        (b.0, b.1, a.1)
    };
    let ahead = (shared.column - before.column) * (after.column - shared.column)
        + (shared.row - before.row) * (after.row - shared.row);
    orientation(before, shared, after) == 0.0 && ahead <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Oracle: every pair of sides, in order, their boxes in the numbers as they are.
    fn naive(points: &[Point]) -> Option<(usize, usize)> {
        let count = points.len();
        let side = |number: usize| (points[number], points[(number + 1) % count]);
        for first in 0..count {
            for second in first + 1..count {
                let (a, b) = (side(first), side(second));
                let neighbours = second == first + 1 || (first == 0 && second == count - 1);
                let touch = match neighbours {
                    true => folds_back(a, b),
                    false => segments_meet(a, b),
                };
                if touch {
                    return Some((first, second));
                }
            }
        }
        None
    }

    properties! {
        #[test]
        fn it_is_the_first_pair_of_all(
            radii in proptest::collection::vec(0.5..1.0f64, 3..300),
            moved in proptest::option::of((0..300usize, -2.0..2.0f64, -2.0..2.0f64)),
            whole in any::<bool>(), positive in any::<bool>(), scale in 1.0..60.0f64,
        ) {
            let count = radii.len();
            let mut points: Vec<Point> = radii
                .iter()
                .enumerate()
                .map(|(k, radius)| {
                    let (sin, cos) = libm::sincos(k as f64 / count as f64 * core::f64::consts::TAU);
                    Point::new(scale * radius * cos, scale * radius * sin)
                })
                .collect();
            if let Some((at, column, row)) = moved {
                points[at % count] = Point::new(scale * column, scale * row);
            }
            if positive {
                // Where numbers are compared exactly.
                for point in &mut points {
                    *point = Point::new(point.column + 130.0, point.row + 130.0);
                }
            }
            if whole {
                // Points that coincide, sides on each other, zeros of both signs.
                for point in &mut points {
                    *point = Point::new(libm::round(point.column), libm::round(point.row));
                }
            }
            prop_assert_eq!(first_crossing(count, |number| points[number]), naive(&points));
        }

        /// Where they do nobody looks for a crossing among them.
        #[test]
        fn sides_go_on_where_no_step_leads_back(
            steps in proptest::collection::vec((0..4u32, 0..4u32), 3..30),
            mirrored in proptest::array::uniform2(any::<bool>()),
            back in proptest::option::of((any::<prop::sample::Index>(), 0..2usize)),
        ) {
            let mut at = [200i32; 2];
            let mut points = Vec::from([at]);
            let mut stands = false;
            // Whether a step leads back on an axis on which another leads ahead.
            let (mut ahead, mut behind) = ([false; 2], [false; 2]);
            let turned = back.map(|(step, axis)| (step.index(steps.len()), axis));
            for (number, &(column, row)) in steps.iter().enumerate() {
                let mut step = [column, row].map(|along| along as i32);
                if let Some((_, axis)) = turned.filter(|(turned, _)| *turned == number) {
                    step[axis] = -step[axis];
                }
                stands |= step == [0; 2];
                for axis in 0..2 {
                    ahead[axis] |= step[axis] > 0;
                    behind[axis] |= step[axis] < 0;
                    at[axis] += step[axis];
                }
                points.push(at);
            }
            let expected = !stands && (0..2).all(|axis| !(ahead[axis] && behind[axis]));
            let place = |number: usize| {
                let at: [i32; 2] = core::array::from_fn(|axis| {
                    let along = points[number % points.len()][axis];
                    if mirrored[axis] { 1000 - along } else { along }
                });
                Point::new(f64::from(at[0]), f64::from(at[1]))
            };
            // The last side closes the line, and is not asked for.
            let line = Line { count: points.len(), at: &place };
            prop_assert_eq!(line.goes_on(0..steps.len()), expected);
        }

        #[test]
        fn boxes_meet_where_they_have_a_place_in_common(
            ends in proptest::array::uniform4((-5..5i32, -5..5i32)),
        ) {
            let [a, b, c, d] = ends.map(|(column, row)| Point::new(column.into(), row.into()));
            // Ends are whole numbers, so that boxes that meet have a whole place in common.
            let holds = |one: i32, other: i32, place: i32| (one.min(other)..=one.max(other)).contains(&place);
            let meet = |of: fn((i32, i32)) -> i32| {
                let [a, b, c, d] = ends.map(of);
                (-5..5).any(|place| holds(a, b, place) && holds(c, d, place))
            };
            let expected = meet(|(column, _)| column) && meet(|(_, row)| row);
            prop_assert_eq!(boxes_meet((a, b), (c, d)), expected);
            prop_assert_eq!(Extent::of((a, b)).meets(&Extent::of((c, d))), expected);
        }
    }
}
