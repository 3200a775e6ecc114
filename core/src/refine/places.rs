//! Which pixels of a frame are samples of an outline, and which sample each is.
//!
//! A bit for each pixel, and beside each word how many samples come before it: most of what is drawn passes no sample, and a
//! look at one word says so.

use core::ops::Range;

use crate::image::mask::{WORD_BITS, Word, row_words};

/// Places of samples in the rows of a frame.
pub(super) struct Places<'p> {
    /// Of each word of the rows: its samples, and the number of the first.
    words: &'p mut [[Word; 2]],
    rows: Range<usize>,
    row_words: usize,
}

impl<'p> Places<'p> {
    /// No sample yet in some rows of a frame of this width. `memory` has a pair for each word of a mask of the frame.
    pub(super) fn new(memory: &'p mut [[Word; 2]], width: usize, rows: Range<usize>) -> Self {
        let row_words = row_words(width);
        let words = memory.get_mut(rows.start * row_words..rows.end * row_words);
        let words = words.unwrap_or_default();
        words.fill([0; 2]);
        Self {
            words,
            rows,
            row_words,
        }
    }

    /// Adds a sample to the right of, or below, all that were added before it; those have numbers below its own.
    pub(super) fn add(&mut self, column: usize, row: usize, number: usize) {
        let at = row
            .wrapping_sub(self.rows.start)
            .wrapping_mul(self.row_words);
        if let Some([samples, before]) = self.words.get_mut(at.wrapping_add(column / WORD_BITS)) {
            if *samples == 0 {
                *before = number as Word;
            }
            *samples |= 1 << (column % WORD_BITS);
        }
    }

    /// The words of a row; none of a row without samples.
    fn row(&self, row: usize) -> &[[Word; 2]] {
        if !self.rows.contains(&row) {
            return &[];
        }
        let first = (row - self.rows.start) * self.row_words;
        self.words
            .get(first..first + self.row_words)
            .unwrap_or_default()
    }

    /// Calls `visit` with the numbers of the samples in a row's columns.
    #[inline]
    pub(super) fn within(&self, row: usize, columns: Range<usize>, mut visit: impl FnMut(usize)) {
        let words = self.row(row);
        let mut first = columns.start;
        while first < columns.end {
            let at = first / WORD_BITS;
            let next = ((at + 1) * WORD_BITS).min(columns.end);
            if let Some(&[samples, before]) = words.get(at)
                && samples != 0
            {
                let wanted = below(next - at * WORD_BITS) & !below(first % WORD_BITS);
                let mut left = samples & wanted;
                while left != 0 {
                    let bit = left & left.wrapping_neg();
                    left ^= bit;
                    visit(before as usize + (samples & (bit - 1)).count_ones() as usize);
                }
            }
            first = next;
        }
    }
}

/// A word's bits below a number of them.
fn below(bits: usize) -> Word {
    match bits {
        WORD_BITS.. => Word::MAX,
        _ => (1 << bits) - 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WIDTH: usize = 100;
    const HEIGHT: usize = 9;

    proptest! {
        #[test]
        fn samples_are_those_that_a_list_has(
            mut samples in proptest::collection::btree_set((2..7usize, 0..WIDTH), 0..300),
            row in 0..HEIGHT, from in 0..WIDTH, length in 0..WIDTH,
        ) {
            // What the memory held before does not matter.
            let mut memory = [[Word::MAX; 2]; HEIGHT * row_words(WIDTH)];
            let mut places = Places::new(&mut memory, WIDTH, 2..7);
            samples.insert((6, WIDTH - 1));
            for (number, &(row, column)) in samples.iter().enumerate() {
                places.add(column, row, number);
            }
            let columns = from..(from + length).min(WIDTH);
            let mut found = std::vec::Vec::new();
            places.within(row, columns.clone(), |number| found.push(number));
            let numbered = samples.iter().enumerate();
            let wanted = numbered.filter(|(_, at)| at.0 == row && columns.contains(&at.1));
            let wanted: std::vec::Vec<usize> = wanted.map(|(number, _)| number).collect();
            prop_assert_eq!(found, wanted);
        }
    }
}
