//! Grey values against the background, so that one threshold serves where light scatters or soft tissue grows thicker.
//!
//! The background is the window without its dark things: a closing with a square that is larger than the implant (Serra, Image
//! Analysis and Mathematical Morphology, 1982). It changes slowly, so it is found from the brightest pixel of each cell of a coarse
//! grid.

/// Cells along the longer side of a window.
const CELLS: usize = 32;
/// Numbers of working memory: a grid, and one of squares.
pub(crate) const BACKGROUND: usize = 2 * CELLS * CELLS;

/// Subtracts the background from the 16-bit grey values of a window of this width, row by row: dark things remain dark, and all else
/// is as bright as can be. `side` is that of the square, pixels; `memory` are [`BACKGROUND`] numbers.
pub(super) fn subtract_background(grey: &mut [u16], width: usize, side: f64, memory: &mut [u32]) {
    let height = grey.len() / width;
    let cell = width.max(height).div_ceil(CELLS);
    let grid = Grid {
        columns: width.div_ceil(cell),
        rows: height.div_ceil(cell),
    };
    // Those beside the window's border are cut off there.
    let reach = ((side / (2.0 * cell as f64)) as usize).max(1);
    let Some((brightest, rest)) = memory.split_at_mut_checked(grid.cells()) else {
        return;
    };
    let Some(most) = rest.get_mut(..grid.cells()) else {
        return;
    };
    brightest.fill(0);
    for (index, &value) in grey.iter().enumerate() {
        let (column, row) = (index % width, index / width);
        let brightest = &mut brightest[row / cell * grid.columns + column / cell];
        *brightest = (*brightest).max(u32::from(value));
    }
    // Of the cells of each square the brightest, and of the squares that a cell is in the darkest.
    grid.gather(brightest, most, reach, u32::max);
    grid.gather(most, brightest, reach, u32::min);
    for (index, value) in grey.iter_mut().enumerate() {
        let (column, row) = (index % width, index / width);
        let background = grid.between(brightest, cell, column, row);
        *value = u16::MAX - background.saturating_sub(*value);
    }
}

/// Cells in rows.
struct Grid {
    columns: usize,
    rows: usize,
}

impl Grid {
    fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// Writes to each cell the extreme of those within `reach` of it.
    fn gather(&self, from: &[u32], to: &mut [u32], reach: usize, extreme: fn(u32, u32) -> u32) {
        let near = |at: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
        for (at, to) in to.iter_mut().enumerate().take(self.cells()) {
            let columns = near(at % self.columns, self.columns);
            let values = near(at / self.columns, self.rows).flat_map(|row| {
                let line = &from[row * self.columns..][..self.columns];
                line[columns.clone()].iter().copied()
            });
            *to = values.reduce(extreme).unwrap_or(0);
        }
    }

    /// The value at a pixel, between the middles of cells.
    fn between(&self, values: &[u32], cell: usize, column: usize, row: usize) -> u16 {
        let place = |at: usize, count: usize| {
            let along = ((at as f64 + 0.5) / cell as f64 - 0.5).max(0.0);
            let low = (along as usize).min(count - 1);
            (low, (low + 1).min(count - 1), along - low as f64)
        };
        let (left, right, x) = place(column, self.columns);
        let (top, bottom, y) = place(row, self.rows);
        let at = |column: usize, row: usize| f64::from(values[row * self.columns + column]);
        let line = |row: usize| at(left, row) + x * (at(right, row) - at(left, row));
        (line(top) + y * (line(bottom) - line(top))) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_the_middles_of_cells_a_plane_is_itself_and_beyond_them_the_outermost() {
        let grid = Grid {
            columns: 6,
            rows: 5,
        };
        let plane = |column: f64, row: f64| 1000.0 + 400.0 * column + 4000.0 * row;
        let values: std::vec::Vec<u32> = (0..grid.cells())
            .map(|k| plane((k % 6) as f64, (k / 6) as f64) as u32)
            .collect();
        for (column, row) in [(12, 20), (15, 9), (33, 28), (5, 31)] {
            let [x, y] = [column, row].map(|at| (at as f64 + 0.5) / 8.0 - 0.5);
            let between = f64::from(grid.between(&values, 8, column, row));
            assert!((between - plane(x, y)).abs() <= 1.0, "{between}");
        }
        assert_eq!(grid.between(&values, 8, 0, 0), 1000);
        assert_eq!(grid.between(&values, 8, 47, 39), 19_000);
    }

    /// Oracle: every cell for every other.
    #[test]
    fn a_cell_gathers_those_of_its_square() {
        let (columns, rows) = (7, 5);
        let grid = Grid { columns, rows };
        let values: std::vec::Vec<u32> = (0..35).map(|k| k * k * 31 % 97).collect();
        for reach in 0..4 {
            for extreme in [u32::max, u32::min] {
                let mut found = [0; 35];
                grid.gather(&values, &mut found, reach, extreme);
                for (at, &found) in found.iter().enumerate() {
                    let is_near = |&other: &usize| {
                        (at % columns).abs_diff(other % columns) <= reach
                            && (at / columns).abs_diff(other / columns) <= reach
                    };
                    let near = (0..35).filter(is_near).map(|other| values[other]);
                    assert_eq!(near.reduce(extreme), Some(found), "{at} {reach}");
                }
            }
        }
    }

    #[test]
    fn a_dark_thing_before_a_background_that_changes_has_one_depth() {
        let (width, height) = (400, 320);
        let background = |column: usize, row: usize| 20_000 + 60 * column + 30 * row;
        let inside =
            |column: usize, row: usize| (160..240).contains(&column) && (145..175).contains(&row);
        // Beside the border a square reaches farther to the one side.
        let beside =
            |column: usize, row: usize| (120..280).contains(&column) && (120..200).contains(&row);
        let mut grey: std::vec::Vec<u16> = (0..width * height)
            .map(|k| {
                let (column, row) = (k % width, k / width);
                let metal = if inside(column, row) { 4000 } else { 0 };
                (background(column, row) - metal) as u16
            })
            .collect();
        // No threshold parts it from what is beside it: its bright end is brighter than the background's dark one.
        assert!(grey[160 * width + 239] > grey[120 * width + 120]);
        subtract_background(&mut grey, width, 100.0, &mut [0; BACKGROUND]);
        let depths = |wanted: fn(bool, bool) -> bool| {
            let place = |k: usize| (k % width, k / width);
            let all = grey
                .iter()
                .enumerate()
                .map(move |(k, &value)| (place(k), value));
            all.filter(move |&((x, y), _)| wanted(inside(x, y), beside(x, y)))
                .map(|(_, value)| u16::MAX - value)
        };
        let least = depths(|inside, _| inside).min();
        let most = depths(|inside, beside| beside && !inside).max();
        assert!(least > most, "{least:?} {most:?}");
    }
}
