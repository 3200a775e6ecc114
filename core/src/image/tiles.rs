//! Square tiles over a few pixels of a frame: most of what is drawn meets none that has any of them.

use core::ops::Range;

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
    pub(crate) fn under(&self, [columns, rows]: [Range<i32>; 2]) -> Option<[Range<usize>; 2]> {
        if columns.is_empty() || rows.is_empty() {
            return None;
        }
        let tile = |pixel: i32, first: i32| (pixel - first) >> self.places;
        let (left, right) = (
            tile(columns.start, self.column),
            tile(columns.end - 1, self.column),
        );
        let (top, bottom) = (tile(rows.start, self.row), tile(rows.end - 1, self.row));
        if right < 0 || bottom < 0 || left > LAST || top > LAST {
            return None;
        }
        let (left, right) = (left.max(0) as usize, right.min(LAST) as usize);
        let (top, bottom) = (top.max(0) as usize, bottom.min(LAST) as usize);
        let wanted = (u128::MAX >> (TILES - 1 - (right - left))) << left;
        let rows = self.marked.get(top..=bottom).unwrap_or_default();
        let meets = rows.iter().any(|row| row & wanted != 0);
        meets.then_some([left..right + 1, top..bottom + 1])
    }
}

const LAST: i32 = TILES as i32 - 1;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
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
