//! Square tiles over a few pixels of a frame: most of what is drawn meets none that has any of them.

use core::ops::Range;

use crate::image::scan::{FixedPoint, PLACES, touched};

/// Tiles to a side.
pub(crate) const TILES: usize = u128::BITS as usize;

/// Tiles of one side that cover all pixels of a list.
pub(crate) struct Tiles {
    /// Of the first tile.
    column: i32,
    row: i32,
    /// Binary logarithm of the side.
    places: u32,
    /// For each row of tiles, which have a pixel of the list.
    marked: [u128; TILES],
}

impl Tiles {
    /// Tiles over pixels, given as column and row, whose side is at least two to the power of `least_places`.
    pub(crate) fn of(pixels: impl Iterator<Item = [i32; 2]> + Clone, least_places: u32) -> Self {
        let mut tiles = Self::around(pixels.clone(), least_places);
        for pixel in pixels {
            tiles.mark(pixel);
        }
        tiles
    }

    /// Tiles over all pixels between some, none of which is marked.
    pub(crate) fn around(ends: impl Iterator<Item = [i32; 2]>, least_places: u32) -> Self {
        let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
        for end in ends {
            for ((low, high), end) in low.iter_mut().zip(&mut high).zip(end) {
                (*low, *high) = ((*low).min(end), (*high).max(end));
            }
        }
        let side = |axis: usize| i64::from(high[axis]) - i64::from(low[axis]);
        let sides = [side(0), side(1)];
        let longest = sides.into_iter().max().unwrap_or(0).max(0) as usize;
        let places = (longest / TILES).checked_ilog2();
        let first = low.map(|least| if least == i32::MAX { 0 } else { least });
        Self {
            column: first[0],
            row: first[1],
            places: places.map_or(0, |log| log + 1).max(least_places),
            marked: [0; TILES],
        }
    }

    /// Marks the tile of a pixel.
    pub(crate) fn mark(&mut self, pixel: [i32; 2]) -> [usize; 2] {
        let tile = self.tile(pixel);
        self.marked[tile[1]] |= 1 << tile[0];
        tile
    }

    /// The tile of a pixel of the list: its number in its row, and that of the row.
    pub(crate) fn tile(&self, [column, row]: [i32; 2]) -> [usize; 2] {
        let at = |pixel: i32, first: i32| ((pixel - first) >> self.places).clamp(0, LAST) as usize;
        [at(column, self.column), at(row, self.row)]
    }

    /// Whether a box of columns and rows meets a tile with a pixel of the list. Most of what is asked is smaller than a tile.
    #[inline]
    pub(crate) fn meets(&self, [columns, rows]: &[Range<i32>; 2]) -> bool {
        if columns.is_empty() | rows.is_empty() {
            return false;
        }
        let tile = |pixel: i32, first: i32| (pixel - first) >> self.places;
        let [left, top] = [tile(columns.start, self.column), tile(rows.start, self.row)];
        let [right, bottom] = [
            tile(columns.end - 1, self.column),
            tile(rows.end - 1, self.row),
        ];
        if (right < 0) | (bottom < 0) | (left > LAST) | (top > LAST) {
            return false;
        }
        let [left, right] = [left.max(0) as usize, right.min(LAST) as usize];
        if (left == right) & (top == bottom) {
            let row = self.marked.get(top as usize).copied().unwrap_or_default();
            return row >> left & 1 != 0;
        }
        let wanted = (u128::MAX >> (LAST as usize + left - right)) << left;
        let rows = top.max(0) as usize..bottom.min(LAST) as usize + 1;
        let marked = self.marked.get(rows).unwrap_or_default();
        marked.iter().any(|row| row & wanted != 0)
    }

    /// The tiles that the box of a triangle meets, marked or not, as columns and rows from one on and up to another; `None` where it lies
    /// beside all of them.
    #[inline(always)]
    pub(crate) fn met(&self, corners: &[FixedPoint; 3]) -> Option<[[usize; 2]; 2]> {
        let [low, high] = touched(corners);
        let tile = |unit: i32, first: i32| ((unit >> PLACES) - first) >> self.places;
        let [left, top] = [tile(low[0], self.column), tile(low[1], self.row)];
        let [right, bottom] = [tile(high[0], self.column), tile(high[1], self.row)];
        if (right < 0) | (bottom < 0) | (left > LAST) | (top > LAST) {
            return None;
        }
        let from = |tile: i32| tile.max(0) as usize;
        let to = |tile: i32| tile.min(LAST) as usize + 1;
        Some([[from(left), to(right)], [from(top), to(bottom)]])
    }
}

const LAST: i32 = TILES as i32 - 1;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn a_box_that_holds_a_pixel_of_the_list_meets_its_tile(
            pixels in proptest::collection::vec(proptest::array::uniform2(-5..3000i32), 1..40),
            pick in any::<prop::sample::Index>(),
            [left, up, right, down] in proptest::array::uniform4(0..30i32),
        ) {
            let tiles = Tiles::of(pixels.iter().copied(), 2);
            let [column, row] = *pick.get(&pixels);
            let around = [column - left..column + right + 1, row - up..row + down + 1];
            prop_assert!(tiles.meets(&around));
            prop_assert!(!tiles.meets(&[-900..-800, row..row + 1]));
            prop_assert!(!tiles.meets(&[column..column, row..row + 1]));
        }

        #[test]
        fn a_box_meets_what_one_of_its_tiles_holds(
            pixels in proptest::collection::vec(proptest::array::uniform2(-5..3000i32), 1..40),
            [column, row] in proptest::array::uniform2(-60..3060i32),
            [wide, high] in proptest::array::uniform2(0..120i32),
        ) {
            let tiles = Tiles::of(pixels.iter().copied(), 2);
            let (columns, rows) = (column..column + wide, row..row + high);
            let at = |pixel: i32, first: i32| (pixel - first) >> tiles.places;
            let holds = |range: &Range<i32>, pixel: i32, first: i32| {
                range.clone().any(|inside| at(inside, first) == at(pixel, first))
            };
            let naive = pixels.iter().any(|&[x, y]| {
                holds(&columns, x, tiles.column) && holds(&rows, y, tiles.row)
            });
            prop_assert_eq!(tiles.meets(&[columns, rows]), naive);
        }

        /// The same where tiles of four pixels reach just from the first to the last, and boxes lie about these.
        #[test]
        fn a_box_meets_what_the_outermost_tiles_hold(
            pixels in proptest::collection::vec(proptest::array::uniform2(prop_oneof![0..9i32, 503..512i32]), 1..9),
            [column, row] in proptest::array::uniform2(prop_oneof![-9..9i32, 495..520i32]),
            [wide, high] in proptest::array::uniform2(0..12i32),
        ) {
            let ends = [[0, 0], [511, 511]];
            let mut tiles = Tiles::around(ends.into_iter(), 2);
            prop_assert_eq!(tiles.places, 2);
            for &pixel in &pixels {
                let tile = tiles.mark(pixel);
                prop_assert_eq!(tile, pixel.map(|at| at as usize / 4));
            }
            let holds = |from: i32, length: i32, pixel: i32| {
                (from..from + length).any(|inside| inside >> 2 == pixel >> 2)
            };
            let naive = pixels.iter().any(|&[x, y]| holds(column, wide, x) && holds(row, high, y));
            prop_assert_eq!(tiles.meets(&[column..column + wide, row..row + high]), naive);
        }
    }
}
