//! Which point of the known outline is nearest, for any place in the frame.

use super::outline::OutlinePoint;

/// Cells along the longer side of the box around the outline.
const SIDE: usize = 256;
/// Cells that a [`Field`] borrows.
pub(super) const FIELD_CELLS: usize = SIDE * SIDE;

/// No point at all.
const NONE: u16 = u16::MAX;

/// The number of the nearest point of an outline for each cell of a grid over a box around it.
pub(super) struct Field<'a> {
    cells: &'a [u16],
    grid: CellGrid,
}

/// Square cells over a box.
#[derive(Clone, Copy)]
struct CellGrid {
    columns: usize,
    rows: usize,
    /// Least x and y.
    corner: [f32; 2],
    /// Side of a cell.
    cell: f32,
}

impl<'a> Field<'a> {
    /// The field of `points` over the box that holds them and all that is nearer than `margin`.
    /// `cells` has [`FIELD_CELLS`] places; points beyond the first 65 535 are left out.
    ///
    /// Points are handed on from cell to cell in two sweeps (Danielsson, *Euclidean distance
    /// mapping*, 1980): what is found is the point nearest to the middle of the cell but for rare
    /// cases in which it is one nearly as near.
    pub(super) fn new(points: &[OutlinePoint], margin: f64, cells: &'a mut [u16]) -> Self {
        let grid = CellGrid::around(points, margin as f32);
        let cells = cells
            .get_mut(..grid.columns * grid.rows)
            .unwrap_or_default();
        cells.fill(NONE);
        if !cells.is_empty() {
            let mut transform = DistanceTransform {
                points,
                grid,
                cells,
            };
            transform.seed();
            transform.sweep();
        }
        Self { cells, grid }
    }

    /// Number of the point nearest to a place; `None` beyond the box.
    pub(super) fn nearest(&self, place: [f64; 2]) -> Option<usize> {
        let (column, row) = self.grid.cell_at(place.map(|v| v as f32))?;
        let point = self.cells.get(row * self.grid.columns + column)?;
        (*point != NONE).then_some(usize::from(*point))
    }
}

impl CellGrid {
    fn around(points: &[OutlinePoint], margin: f32) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for point in points {
            for k in 0..2 {
                low[k] = low[k].min(point.at[k] - margin);
                high[k] = high[k].max(point.at[k] + margin);
            }
        }
        let size = [0, 1].map(|k| (high[k] - low[k]).max(1.0));
        // One cell less than there is room for: rounding may take another.
        let cell = size[0].max(size[1]) / (SIDE - 1) as f32;
        let count = |size: f32| ((size / cell) as usize + 1).min(SIDE);
        Self {
            columns: count(size[0]),
            rows: count(size[1]),
            corner: low,
            cell,
        }
    }

    fn cell_at(&self, [x, y]: [f32; 2]) -> Option<(usize, usize)> {
        let column = (x - self.corner[0]) / self.cell;
        let row = (y - self.corner[1]) / self.cell;
        // A negative number would be cast to 0; a NaN fails too.
        let inside = column >= 0.0 && row >= 0.0;
        let (column, row) = (column as usize, row as usize);
        (inside && column < self.columns && row < self.rows).then_some((column, row))
    }

    /// The middle of a cell.
    fn middle(&self, column: usize, row: usize) -> [f32; 2] {
        [
            self.corner[0] + (column as f32 + 0.5) * self.cell,
            self.corner[1] + (row as f32 + 0.5) * self.cell,
        ]
    }
}

struct DistanceTransform<'a> {
    points: &'a [OutlinePoint],
    grid: CellGrid,
    cells: &'a mut [u16],
}

/// Neighbours to the left and the right, and those in the row before and the row after.
const LEFT: [(isize, isize); 1] = [(-1, 0)];
const RIGHT: [(isize, isize); 1] = [(1, 0)];
const BEFORE: [(isize, isize); 4] = [(-1, 0), (-1, -1), (0, -1), (1, -1)];
const AFTER: [(isize, isize); 4] = [(1, 0), (1, 1), (0, 1), (-1, 1)];

impl DistanceTransform<'_> {
    fn seed(&mut self) {
        for (number, point) in self.points.iter().take(usize::from(NONE)).enumerate() {
            if let Some((column, row)) = self.grid.cell_at(point.at) {
                self.offer(column, row, number as u16);
            }
        }
    }

    /// Hands points on forwards, then backwards.
    fn sweep(&mut self) {
        let CellGrid { columns, rows, .. } = self.grid;
        for row in 0..rows {
            for column in 0..columns {
                self.take(column, row, &BEFORE);
            }
            for column in (0..columns).rev() {
                self.take(column, row, &RIGHT);
            }
        }
        for row in (0..rows).rev() {
            for column in (0..columns).rev() {
                self.take(column, row, &AFTER);
            }
            for column in 0..columns {
                self.take(column, row, &LEFT);
            }
        }
    }

    /// Offers a cell the points of its neighbours.
    fn take(&mut self, column: usize, row: usize, neighbours: &[(isize, isize)]) {
        let CellGrid { columns, rows, .. } = self.grid;
        for &(right, up) in neighbours {
            let neighbour = column
                .checked_add_signed(right)
                .zip(row.checked_add_signed(up))
                .filter(|&(column, row)| column < columns && row < rows);
            if let Some((c, r)) = neighbour {
                let theirs = self.number(c, r);
                if theirs != NONE && theirs != self.number(column, row) {
                    self.offer(column, row, theirs);
                }
            }
        }
    }

    /// Puts a point into a cell where it is nearer to the cell's middle than the one there.
    fn offer(&mut self, column: usize, row: usize, number: u16) {
        let own = self.number(column, row);
        if own == NONE || self.distance(column, row, number) < self.distance(column, row, own) {
            let place = row * self.grid.columns + column;
            if let Some(cell) = self.cells.get_mut(place) {
                *cell = number;
            }
        }
    }

    /// The number of the point in a cell.
    fn number(&self, column: usize, row: usize) -> u16 {
        let place = row * self.grid.columns + column;
        self.cells.get(place).copied().unwrap_or(NONE)
    }

    /// Squared distance of a point from the middle of a cell.
    fn distance(&self, column: usize, row: usize, number: u16) -> f32 {
        let middle = self.grid.middle(column, row);
        let Some(OutlinePoint { at, .. }) = self.points.get(usize::from(number)) else {
            return f32::INFINITY;
        };
        let (x, y) = (middle[0] - at[0], middle[1] - at[1]);
        x * x + y * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distance(point: &OutlinePoint, place: [f64; 2]) -> f64 {
        let [x, y] = point.at.map(f64::from);
        libm::hypot(x - place[0], y - place[1])
    }

    properties! {
        /// Oracle: all points. A cell's point may be off by what the place is off its middle.
        #[test]
        fn the_point_found_is_nearly_the_nearest(
            points in proptest::collection::vec((-90.0..90.0f32, -40.0..40.0f32), 1..60),
            places in proptest::collection::vec((-110.0..110.0f64, -60.0..60.0f64), 40)
        ) {
            let points: std::vec::Vec<_> = points
                .iter()
                .map(|&(x, y)| OutlinePoint { at: [x, y], normal: [1.0, 0.0] })
                .collect();
            let mut cells = std::vec![0; FIELD_CELLS];
            let field = Field::new(&points, 12.0, &mut cells);
            for (x, y) in places {
                let nearest = points
                    .iter()
                    .map(|point| distance(point, [x, y]))
                    .fold(f64::INFINITY, f64::min);
                match field.nearest([x, y]) {
                    Some(found) => {
                        let found = distance(&points[found], [x, y]);
                        let cell = f64::from(field.grid.cell);
                        prop_assert!(found <= nearest + 1.6 * cell, "{found} {nearest} {cell}");
                    }
                    None => prop_assert!(nearest > 11.9, "{nearest}"),
                }
            }
        }
    }

    #[test]
    fn without_points_nothing_is_near() {
        let mut cells = std::vec![0; FIELD_CELLS];
        assert_eq!(Field::new(&[], 12.0, &mut cells).nearest([0.0, 0.0]), None);
        let one = [OutlinePoint::default()];
        assert_eq!(Field::new(&one, 1.0, &mut []).nearest([0.0, 0.0]), None);
    }
}
