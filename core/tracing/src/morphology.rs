//! Masks dilated and eroded by one pixel a step, 32 pixels at a time.

use fluoropose::image::mask::{Mask, MaskMut, WORD_BITS, Word, tail_mask};

/// Which neighbours a step takes. Steps of both kinds in alternation make an octagon, which is nearly a disc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbours {
    /// Left, right, above and below.
    Four,
    /// Those and the four that touch by a corner.
    Eight,
}

impl Neighbours {
    /// The neighbours of step `number`, from 0, of an octagon.
    #[must_use]
    pub fn of_step(number: usize) -> Self {
        if number.is_multiple_of(2) {
            Self::Four
        } else {
            Self::Eight
        }
    }
}

/// Sets in `wide` every pixel within `by` columns and rows of one that is set in `mask`; others stay as they are.
pub fn widen(mask: &Mask<'_>, by: usize, wide: &mut MaskMut<'_>) {
    for row in 0..mask.height() {
        let rows = row.saturating_sub(by)..(row + by + 1).min(mask.height());
        for run in mask.runs(row) {
            let (from, to) = (run.start as i64 - by as i64, (run.end + by) as i64);
            rows.clone().for_each(|row| wide.fill_span(row, from, to));
        }
    }
}

/// Dilates: writes to `out` the pixels of `mask` and those with a neighbour in it. Nothing is written where the two masks
/// differ in size.
pub fn grow(mask: &Mask<'_>, neighbours: Neighbours, out: &mut MaskMut<'_>) {
    step(mask, neighbours, false, out);
}

/// Erodes: writes to `out` the pixels of `mask` whose neighbours inside the frame all belong to it, so that nothing is
/// lost at the frame's border. Nothing is written where the two masks differ in size.
pub fn shrink(mask: &Mask<'_>, neighbours: Neighbours, out: &mut MaskMut<'_>) {
    step(mask, neighbours, true, out);
}

/// Dilates the mask, or its complement.
fn step(mask: &Mask<'_>, neighbours: Neighbours, complement: bool, out: &mut MaskMut<'_>) {
    out.clear();
    if (mask.width(), mask.height()) != (out.width(), out.height()) {
        return;
    }
    let flip = if complement { Word::MAX } else { 0 };
    let tail = tail_mask(mask.width());
    for row in 0..mask.height() {
        let above = row.checked_sub(1).map_or(&[][..], |above| mask.row(above));
        let rows = [above, mask.row(row), mask.row(row + 1)].map(|words| Row { words, flip, tail });
        out.replace_row(row, |index, _| {
            let [above, here, below] = &rows;
            let grown = match neighbours {
                Neighbours::Four => above.word(index) | here.widened(index) | below.word(index),
                Neighbours::Eight => {
                    above.widened(index) | here.widened(index) | below.widened(index)
                }
            };
            grown ^ flip
        });
    }
}

/// A row of a mask or of its complement; beyond the frame nothing is set in either.
struct Row<'a> {
    words: &'a [Word],
    flip: Word,
    tail: Word,
}

impl Row<'_> {
    fn word(&self, index: usize) -> Word {
        let Some(word) = self.words.get(index) else {
            return 0;
        };
        let last = index + 1 == self.words.len();
        (word ^ self.flip) & if last { self.tail } else { Word::MAX }
    }

    /// A word with its neighbours to the left and the right.
    fn widened(&self, index: usize) -> Word {
        let word = self.word(index);
        let before = index.checked_sub(1).map_or(0, |before| self.word(before));
        let after = self.word(index + 1);
        word | word << 1 | before >> (WORD_BITS - 1) | word >> 1 | after << (WORD_BITS - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::words_needed;
    use proptest::prelude::*;

    const WIDTH: usize = 70;
    const HEIGHT: usize = 6;
    const WORDS: usize = words_needed(WIDTH, HEIGHT);

    fn naive(
        mask: &Mask<'_>,
        neighbours: Neighbours,
        shrink: bool,
        column: usize,
        row: usize,
    ) -> bool {
        let mut grown = false;
        for (right, down) in
            (-1..=1isize).flat_map(|right| (-1..=1isize).map(move |down| (right, down)))
        {
            let corner = right != 0 && down != 0;
            let Some((c, r)) = column
                .checked_add_signed(right)
                .zip(row.checked_add_signed(down))
            else {
                continue;
            };
            if c < WIDTH && r < HEIGHT && !(corner && neighbours == Neighbours::Four) {
                grown |= mask.get(c, r) != shrink;
            }
        }
        grown != shrink
    }

    proptest! {
        #[test]
        fn words_do_what_pixels_would(
            words in proptest::collection::vec(any::<u32>(), WORDS), dense in any::<bool>()
        ) {
            let tail = tail_mask(WIDTH);
            let mut words: std::vec::Vec<u32> = words
                .iter()
                .map(|word| if dense { word | word << 7 | word >> 9 } else { word & word << 7 })
                .collect();
            words.iter_mut().skip(2).step_by(3).for_each(|last| *last &= tail);
            let mask = Mask::new(&words, WIDTH, HEIGHT).expect("valid");
            for neighbours in [Neighbours::Four, Neighbours::Eight] {
                for shrinking in [false, true] {
                    let mut memory = [0; WORDS];
                    let mut out = MaskMut::new(&mut memory, WIDTH, HEIGHT).expect("fits");
                    step(&mask, neighbours, shrinking, &mut out);
                    let out = out.into_mask();
                    prop_assert!(Mask::new(out.words(), WIDTH, HEIGHT).is_ok());
                    for (column, row) in (0..WIDTH).flat_map(|c| (0..HEIGHT).map(move |r| (c, r))) {
                        let wanted = naive(&mask, neighbours, shrinking, column, row);
                        prop_assert_eq!(out.get(column, row), wanted);
                    }
                }
            }
        }
    }
}
