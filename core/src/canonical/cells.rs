//! The cells in which a silhouette's border lies.

use core::ops::ControlFlow;

use crate::image::mask::{MAX_SIDE, Mask, WORD_BITS, Word, row_words};

/// Calls `visit(column, row)` for each cell whose four pixels are not alike, until it breaks. A cell is the square between
/// the centres of a pixel, the one to its right and the two below them; it is numbered as the first of these. Pixels
/// outside the mask are unset, so cells of column and row -1 count too.
pub(super) fn for_each_mixed(
    mask: &Mask<'_>,
    mut visit: impl FnMut(i32, i32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let rows = mask.rows();
    for row in rows.start as i32 - 1..rows.end as i32 {
        let mut scan = Scan::default();
        let (above, last_above) = pixels(mask, row).as_chunks::<2>();
        let (below, last_below) = pixels(mask, row + 1).as_chunks::<2>();
        for (&above, &below) in above.iter().zip(below) {
            scan.look(two(above), two(below), row, &mut visit)?;
        }
        for (&above, &below) in last_above.iter().zip(last_below) {
            scan.look(above.into(), below.into(), row, &mut visit)?;
        }
        // The cell of the last column, where it is the last of its words.
        if scan.any {
            visit(scan.columns as i32 - 1, row)?;
        }
    }
    ControlFlow::Continue(())
}

/// The pixels of two rows, some at a time.
#[derive(Default)]
struct Scan {
    /// Columns that have been passed, and whether the last pixel is set in either row, and in both.
    columns: u32,
    any: bool,
    all: bool,
}

impl Scan {
    #[inline(always)]
    fn look(
        &mut self,
        above: u64,
        below: u64,
        row: i32,
        visit: &mut impl FnMut(i32, i32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (any, all) = (above | below, above & below);
        let either = any | any << 1 | u64::from(self.any);
        let both = all & (all << 1 | u64::from(self.all));
        for bit in ones(either & !both) {
            visit((self.columns + bit) as i32 - 1, row)?;
        }
        (self.any, self.all) = (any >> 63 != 0, all >> 63 != 0);
        self.columns += u64::BITS;
        ControlFlow::Continue(())
    }
}

/// A row without pixels, as long as any.
static NOTHING: [Word; row_words(MAX_SIDE)] = [0; row_words(MAX_SIDE)];

/// The words of a row, whether the mask has it or not.
fn pixels<'m>(mask: &Mask<'m>, row: i32) -> &'m [Word] {
    let row = usize::try_from(row).map_or(&[][..], |row| mask.row(row));
    let length = row_words(mask.width());
    if row.len() == length {
        row
    } else {
        NOTHING.get(..length).unwrap_or_default()
    }
}

fn two([low, high]: [Word; 2]) -> u64 {
    u64::from(high) << WORD_BITS | u64::from(low)
}

/// The numbers of the bits that are set, rising.
pub(super) fn ones(mut word: u64) -> impl Iterator<Item = u32> {
    core::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < u64::BITS).then_some(bit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{MaskMut, words_needed};
    use proptest::prelude::*;

    properties! {
        #[test]
        fn cells_are_mixed_where_their_pixels_differ(
            width in 1..100usize,
            height in 1..20usize,
            pixels in proptest::collection::vec((0..100usize, 0..20usize), 0..200),
            solid in any::<bool>(),
        ) {
            let mut words = std::vec![0; words_needed(width, height)];
            let mut mask = MaskMut::new(&mut words, width, height).expect("fits");
            for row in 0..if solid { height } else { 0 } {
                mask.fill_span(row, 0, width as i64);
            }
            for (column, row) in pixels {
                mask.set(column, row, !solid);
            }
            let mask = mask.into_mask();
            let mut found = std::vec::Vec::new();
            let _ = for_each_mixed(&mask, |column, row| {
                found.push((column, row));
                ControlFlow::Continue(())
            });
            let set = |column: i32, row: i32| {
                column >= 0 && row >= 0 && mask.get(column as usize, row as usize)
            };
            let mut naive = std::vec::Vec::new();
            for row in -1..height as i32 {
                for column in -1..width as i32 {
                    let four = [(0, 0), (1, 0), (0, 1), (1, 1)];
                    let count = four.iter().filter(|(x, y)| set(column + x, row + y)).count();
                    if count % 4 != 0 {
                        naive.push((column, row));
                    }
                }
            }
            prop_assert_eq!(found, naive);
        }
    }

    #[test]
    fn a_visit_can_end_it() {
        let words = [1; 3];
        let mask = Mask::new(&words, 4, 3).expect("valid");
        let mut count = 0;
        let flow = for_each_mixed(&mask, |_, _| {
            count += 1;
            if count == 2 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!((flow, count), (ControlFlow::Break(()), 2));
    }
}
