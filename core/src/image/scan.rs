//! Exact scan conversion: which pixel centres a polygon or triangle covers.
//!
//! Vertices are rounded to 1/4096 pixel and everything after that is integer arithmetic, so two
//! triangles that fraction an edge neither overlap nor leave a gap, and every target fills the
//! same pixels. A pixel belongs to a shape when its centre does; a centre exactly on an edge
//! belongs to the shape below or to the right of it (Foley et al., *Computer Graphics*, 3.6).

use core::ops::Range;

use crate::image::contour::Point;

/// Binary places of a fixed-point coordinate.
pub(crate) const PLACES: u32 = 12;
pub(crate) const ONE: i64 = 1 << PLACES;
const HALF: i64 = ONE / 2;

/// How far rounding moves a coordinate at most, pixels.
pub(crate) const ROUNDING: f64 = 0.5 / ONE as f64;

/// Beside this number an `f64` holds whole numbers alone, and those of 32 bits in its low bits.
pub(crate) const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Coordinates beyond this many pixels are refused: products of two must stay in 64 bits.
pub const MAX_COORDINATE: f64 = 131_072.0;

/// An image point in units of 1/4096 pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedPoint {
    column: i32,
    row: i32,
}

impl FixedPoint {
    /// The frame's upper left corner: what static memory is filled with.
    pub const ZERO: Self = Self { column: 0, row: 0 };

    /// In place of a point: no coordinate is that far out.
    pub(crate) const NONE: Self = Self {
        column: i32::MIN,
        row: i32::MIN,
    };

    /// The point at so many units of 1/4096 pixel.
    pub(crate) fn of_units(column: i32, row: i32) -> Self {
        Self { column, row }
    }

    /// The nearest fixed point; `None` beyond [`MAX_COORDINATE`] or for a NaN.
    #[must_use]
    pub(crate) fn from_point(point: Point) -> Option<Self> {
        let (rounded, inside) = Self::rounded(point);
        inside.then_some(rounded)
    }

    /// The nearest fixed point, and whether it is one: outside of [`MAX_COORDINATE`] it is not.
    /// Without a branch, so that many can be rounded at once.
    pub(crate) fn rounded(Point { column, row }: Point) -> (Self, bool) {
        // As `<=`: numbers above zero rise with their bits, and a NaN has more than any.
        let inside = |value: f64| value.abs().to_bits() <= MAX_COORDINATE.to_bits();
        // The sum is rounded to a whole number (of two as near, to the even one).
        let fix = |value: f64| (value * ONE as f64 + WHOLE).to_bits() as i32;
        let point = Self {
            column: fix(column),
            row: fix(row),
        };
        (point, inside(column) & inside(row))
    }

    /// The same place where a column and row, not beyond any mask, are the first: exact.
    pub(crate) fn counted_from(self, [column, row]: [usize; 2]) -> Self {
        Self {
            column: self.column - column as i32 * ONE as i32,
            row: self.row - row as i32 * ONE as i32,
        }
    }

    /// Twice the signed area of the triangle `a`, `b`, `c`, in squares of 1/4096 pixel; positive
    /// where it is run clockwise as seen on the screen.
    pub(crate) fn doubled_area([a, b, c]: [Self; 3]) -> i64 {
        let right = |p: Self| i64::from(p.column) - i64::from(a.column);
        let down = |p: Self| i64::from(p.row) - i64::from(a.row);
        right(b) * down(c) - down(b) * right(c)
    }

    /// Column and row, pixels.
    pub(crate) fn place(self) -> [f32; 2] {
        // Of `map` some compilers leave a loop.
        [
            self.column as f32 / ONE as f32,
            self.row as f32 / ONE as f32,
        ]
    }

    /// Column and row in units of 1/4096 pixel: exact up to 4096 pixels.
    pub(crate) fn units(self) -> [f32; 2] {
        [self.column as f32, self.row as f32]
    }

    pub(crate) fn is_above(self, other: Self) -> bool {
        self.row < other.row
    }
}

/// As working memory for a number of 32 bits.
impl From<u32> for FixedPoint {
    fn from(number: u32) -> Self {
        Self {
            column: number as i32,
            row: 0,
        }
    }
}

impl FixedPoint {
    #[inline(always)]
    pub(crate) fn number(self) -> u32 {
        self.column as u32
    }
}

/// Bits of a quarter of a point.
const QUARTER: u32 = u16::BITS;

/// As working memory for four small numbers, each told by the lowest two bits of a number.
impl FixedPoint {
    #[inline(always)]
    pub(crate) fn quarter(self, which: usize) -> u16 {
        let half = if which & 2 == 0 {
            self.column
        } else {
            self.row
        };
        (half as u32 >> (which as u32 % 2 * QUARTER)) as u16
    }

    #[inline(always)]
    pub(crate) fn set_quarter(&mut self, which: usize, number: u16) {
        let half = if which & 2 == 0 {
            &mut self.column
        } else {
            &mut self.row
        };
        let shift = which as u32 % 2 * QUARTER;
        *half = *half & !(i32::from(u16::MAX) << shift) | i32::from(number) << shift;
    }
}

/// As 64 bits of working memory for other things than points.
impl From<u64> for FixedPoint {
    fn from(bits: u64) -> Self {
        Self {
            column: bits as i32,
            row: (bits >> 32) as i32,
        }
    }
}

impl From<FixedPoint> for u64 {
    fn from(point: FixedPoint) -> Self {
        Self::from(point.row as u32) << 32 | Self::from(point.column as u32)
    }
}

/// Index of the first pixel whose centre is at or beyond a coordinate.
fn first_centre(coordinate: i32) -> i32 {
    // ceil((coordinate - HALF) / ONE)
    (coordinate + HALF as i32 - 1) >> PLACES
}

/// The rows whose centre line runs between the ends of an edge, cut to `0..height`: those that it crosses.
pub(crate) fn rows_between([a, b]: [FixedPoint; 2], height: usize) -> Range<usize> {
    let cut = |row: i32| usize::try_from(first_centre(row)).unwrap_or(0).min(height);
    cut(a.row.min(b.row))..cut(a.row.max(b.row))
}

/// A polygon side, ordered downwards, so that its crossings do not depend on who asks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    from: FixedPoint,
    /// To its other end: 31 bits at most.
    right: i32,
    down: i32,
}

impl Edge {
    pub(crate) fn new([a, b]: [FixedPoint; 2]) -> Self {
        let (from, to) = if a.row <= b.row { (a, b) } else { (b, a) };
        Self {
            from,
            right: to.column.wrapping_sub(from.column),
            down: to.row.wrapping_sub(from.row),
        }
    }

    /// Rows that it crosses, and on each the first column whose centre is at or to the right of it: the quotient of two integers,
    /// rounded up, and from row to row their sums. Exact.
    pub(crate) fn columns(&self, rows: Range<usize>) -> impl Iterator<Item = (usize, i64)> + use<> {
        // A level edge crosses no row.
        let down = self.down.max(1);
        let (mut whole, mut part) = (self.right / down, self.right % down);
        if part < 0 {
            (whole, part) = (whole - 1, part + down);
        }
        let (whole, part, down) = (i64::from(whole), i64::from(part), i64::from(down));
        // An edge that crosses no row may begin below the one that is named.
        let centre = (rows.start as i64 * ONE + HALF - i64::from(self.from.row)).max(0);
        let (beyond, rest) = quotient((part * centre) as u64, self.down.max(1) as u32);
        // In units of 1/4096 pixel, and that many parts of one as `down` is.
        let place = i64::from(self.from.column) - HALF + whole * centre + i64::from(beyond);
        let mut column = (place + i64::from(rest > 0) + ONE - 1) >> PLACES;
        // How far the edge is from that centre, -1 to 0 columns, in such parts.
        let mut left = (place - column * ONE) * down + i64::from(rest);
        rows.map(move |row| {
            let own = column;
            (column, left) = (column + whole, left + part * ONE);
            if left > 0 {
                (column, left) = (column + 1, left - down * ONE);
            }
            (row, own)
        })
    }
}

/// Quotient, of 32 bits, and remainder of a number by one of 31. Most numbers have 32 bits themselves: those of 64 no
/// microcontroller divides, and the function that does takes a kilobyte.
fn quotient(number: u64, by: u32) -> (u32, u32) {
    let by = by.max(1);
    match u32::try_from(number) {
        Ok(number) => (number / by, number % by),
        Err(_) if cfg!(target_os = "none") => bit_by_bit(number, by),
        Err(_) => {
            let by = u64::from(by);
            ((number / by) as u32, (number % by) as u32)
        }
    }
}

fn bit_by_bit(number: u64, by: u32) -> (u32, u32) {
    let (mut rest, mut bits) = ((number >> 32) as u32, number as u32);
    for _ in 0..u32::BITS {
        rest = rest << 1 | bits >> 31;
        bits <<= 1;
        if rest >= by {
            rest -= by;
            bits |= 1;
        }
    }
    (bits, rest)
}

/// The pixels that a triangle may cover the centres of: columns and rows, not cut to a frame.
/// Most triangles of a CAD model are smaller than a pixel and cover none.
#[inline]
pub(crate) fn pixel_box([a, b, c]: [FixedPoint; 3]) -> [Range<i32>; 2] {
    let range =
        |a: i32, b: i32, c: i32| first_centre(a.min(b).min(c))..first_centre(a.max(b).max(c));
    [
        range(a.column, b.column, c.column),
        range(a.row, b.row, c.row),
    ]
}

/// Least and greatest column and row of a triangle, in units of 1/4096 pixel, and what rounding elsewhere, by up to a thousandth of a pixel, may
/// put a place of it into.
#[inline(always)]
pub(crate) fn touched([a, b, c]: &[FixedPoint; 3]) -> [[i32; 2]; 2] {
    const BESIDE: i32 = ONE as i32 / 1000 + 1;
    [
        [
            a.column.min(b.column).min(c.column) - BESIDE,
            a.row.min(b.row).min(c.row) - BESIDE,
        ],
        [
            a.column.max(b.column).max(c.column) + BESIDE,
            a.row.max(b.row).max(c.row) + BESIDE,
        ],
    ]
}

/// Calls `fill(row, from, to)` for each row of the triangle that has pixel centres: columns
/// `from..to`, not yet cut to a frame's width.
pub(crate) fn triangle_spans(
    corners: [FixedPoint; 3],
    height: usize,
    mut fill: impl FnMut(usize, i64, i64),
) {
    if pixel_box(corners).iter().any(Range::is_empty) {
        return;
    }
    let [a, b, c] = sorted_by_row(corners);
    let long = Edge::new([a, c]);
    for ends in [[a, b], [b, c]] {
        let short = Edge::new(ends);
        let rows = rows_between(ends, height);
        for ((row, x), (_, y)) in long.columns(rows.clone()).zip(short.columns(rows)) {
            fill(row, x.min(y), x.max(y));
        }
    }
}

fn sorted_by_row([a, b, c]: [FixedPoint; 3]) -> [FixedPoint; 3] {
    let order = |a: FixedPoint, b: FixedPoint| if a.row <= b.row { (a, b) } else { (b, a) };
    let (a, b) = order(a, b);
    let (b, c) = order(b, c);
    let (a, b) = order(a, b);
    [a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_lies_outside_the_rows_of_a_frame_crosses_none() {
        let whole = MAX_COORDINATE as i32 * ONE as i32;
        for at in [-whole, -9000, -5, ONE as i32 * 64, whole - 3] {
            for column in [-whole, -1, 0, 70_000, whole] {
                let corner = |column: i32, down: i32| FixedPoint {
                    column: column.clamp(-whole, whole),
                    row: at + down,
                };
                let corners = [
                    corner(column, 0),
                    corner(column + 5, 1),
                    corner(column - whole, 3),
                ];
                triangle_spans(corners, 64, |row, _, _| panic!("row {row}"));
                for ends in [[corners[0], corners[1]], [corners[1], corners[2]]] {
                    let rows = rows_between(ends, 64);
                    assert_eq!(Edge::new(ends).columns(rows).count(), 0, "{ends:?}");
                }
            }
        }
    }

    properties! {
        #[test]
        fn numbers_of_64_bits_are_divided_bit_by_bit(
            by in 1u32..1 << 31,
            quotient in any::<u32>(),
            rest in any::<prop::sample::Index>(),
        ) {
            let rest = rest.index(by as usize) as u32;
            let number = u64::from(by) * u64::from(quotient) + u64::from(rest);
            prop_assert_eq!(bit_by_bit(number, by), (quotient, rest));
            prop_assert_eq!(super::quotient(number, by), (quotient, rest));
        }

        #[test]
        fn columns_are_exact_quotients(
            a in (-(1 << 29)..1 << 29, -(1 << 29)..1 << 29),
            b in (-(1 << 29)..1 << 29, -(1 << 29)..1 << 29),
            near in any::<bool>(),
            fraction in 0.0..1.0f64,
        ) {
            let point = |(column, row): (i32, i32)| FixedPoint { column, row };
            // Half the cases are short edges, as in a CAD model.
            let b = if near { (a.0 + b.0 % 9000, a.1 + b.1 % 9000) } else { b };
            let ends = [point(a), point(b)];
            let edge = Edge::new(ends);
            let rows = rows_between(ends, 1 << 17);
            prop_assume!(!rows.is_empty());
            let row = rows.start + (fraction * rows.len() as f64) as usize;
            let ((x, y), (to_x, to_y)) = if a.1 <= b.1 { (a, b) } else { (b, a) };
            let (down, right) = (i128::from(to_y) - i128::from(y), i128::from(to_x) - i128::from(x));
            for (row, column) in edge.columns(row..rows.end.min(row + 200)) {
                let centre = row as i128 * i128::from(ONE) + i128::from(HALF) - i128::from(y);
                let numerator = (i128::from(x) - i128::from(HALF)) * down + right * centre;
                let exact = -(-numerator).div_euclid(down * i128::from(ONE));
                prop_assert_eq!(i128::from(column), exact, "row {}", row);
            }
        }
    }
}
