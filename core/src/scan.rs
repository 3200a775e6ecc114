//! Exact scan conversion: which pixel centres a polygon or triangle covers.
//!
//! Vertices are rounded to 1/4096 pixel and everything after that is integer arithmetic, so two
//! triangles that share an edge neither overlap nor leave a gap, and every target fills the
//! same pixels. A pixel belongs to a shape when its centre does; a centre exactly on an edge
//! belongs to the shape below or to the right of it (Foley et al., *Computer Graphics*, 3.6).

use crate::contour::Point;

/// Binary places of a fixed-point coordinate.
const PLACES: u32 = 12;
const ONE: i64 = 1 << PLACES;
const HALF: i64 = ONE / 2;

/// Coordinates beyond this many pixels are refused: products of two must stay in 64 bits.
pub const MAX_COORDINATE: f64 = 131_072.0;

/// An image point in units of 1/4096 pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedPoint {
    column: i32,
    row: i32,
}

impl FixedPoint {
    /// The nearest fixed point; `None` beyond [`MAX_COORDINATE`] or for a NaN.
    #[must_use]
    pub fn from_point(point: Point) -> Option<Self> {
        let fix = |value: f64| {
            let inside = (-MAX_COORDINATE..=MAX_COORDINATE).contains(&value);
            inside.then(|| crate::math::floor(value * ONE as f64 + 0.5) as i32)
        };
        Some(Self {
            column: fix(point.column)?,
            row: fix(point.row)?,
        })
    }
}

/// Index of the first pixel whose centre is at or beyond a coordinate.
fn first_centre(coordinate: i32) -> i32 {
    // ceil((coordinate - HALF) / ONE)
    (coordinate + HALF as i32 - 1) >> PLACES
}

/// A polygon side, ordered downwards, so that its crossings do not depend on who asks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    from: FixedPoint,
    to: FixedPoint,
}

impl Edge {
    pub(crate) fn new(a: FixedPoint, b: FixedPoint) -> Self {
        let (from, to) = if a.row <= b.row { (a, b) } else { (b, a) };
        Self { from, to }
    }

    /// The rows whose centre line the edge crosses, cut to `0..height`.
    pub(crate) fn rows(&self, height: usize) -> core::ops::Range<usize> {
        let cut = |row: i32| usize::try_from(row).unwrap_or(0).min(height);
        cut(first_centre(self.from.row))..cut(first_centre(self.to.row))
    }

    /// The first column whose centre is at or to the right of the edge on a row that it crosses.
    pub(crate) fn column_at(&self, row: usize) -> i64 {
        let down = i64::from(self.to.row) - i64::from(self.from.row);
        let right = i64::from(self.to.column) - i64::from(self.from.column);
        let centre = row as i64 * ONE + HALF - i64::from(self.from.row);
        let numerator = (i64::from(self.from.column) - HALF) * down + right * centre;
        -(-numerator).div_euclid(down * ONE)
    }
}

/// Calls `fill(row, from, to)` for each row of the triangle that has pixel centres: columns
/// `from..to`, not yet cut to a frame's width.
pub(crate) fn triangle_spans(
    corners: [FixedPoint; 3],
    height: usize,
    mut fill: impl FnMut(usize, i64, i64),
) {
    let columns = corners.map(|p| first_centre(p.column));
    let rows = corners.map(|p| first_centre(p.row));
    let all_equal = |v: [i32; 3]| v[0] == v[1] && v[1] == v[2];
    // Most triangles of a CAD model are smaller than a pixel: no centre, nothing to do.
    if all_equal(columns) || all_equal(rows) {
        return;
    }
    let [a, b, c] = sorted_by_row(corners);
    let (long, upper, lower) = (Edge::new(a, c), Edge::new(a, b), Edge::new(b, c));
    for short in [upper, lower] {
        for row in short.rows(height) {
            let (x, y) = (long.column_at(row), short.column_at(row));
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
