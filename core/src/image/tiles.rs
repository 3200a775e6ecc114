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

    /// The tiles that a box of columns and rows meets; `None` where it meets none with a pixel of the list.
    pub(crate) fn under(&self, place: [Range<i32>; 2]) -> Option<[Range<usize>; 2]> {
        let tiles = |place: Range<i32>, first: i32| {
            let [low, high] =
                [place.start, place.end - 1].map(|pixel| (pixel - first) >> self.places);
            let is_met = low <= high && high >= 0 && low <= LAST;
            is_met.then(|| low.max(0) as usize..high.min(LAST) as usize + 1)
        };
        let [columns, rows] = place;
        let [columns, rows] = tiles(columns, self.column)
            .zip(tiles(rows, self.row))
            .map(<[_; 2]>::from)?;
        let wanted = (u128::MAX >> (TILES - columns.len())) << columns.start;
        let marked = self.marked.get(rows.clone()).unwrap_or_default();
        let meets = marked.iter().any(|row| row & wanted != 0);
        meets.then_some([columns, rows])
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
            let [columns, rows] = tiles.under(around).expect("it holds one");
            let [at, down] = tiles.tile([column, row]);
            prop_assert!(columns.contains(&at) && rows.contains(&down));
            prop_assert!(tiles.under([-900..-800, row..row + 1]).is_none());
        }
    }
}
