//! Drawing into a mask: pixels, spans and whole outlines.

use core::hint::black_box;
use core::ops::Range;

use super::{Mask, MaskError, WORD_BITS, Word, checked_words, row_place, row_words, tail_mask};
use crate::image::contour::Outline;
use crate::image::scan::{Edge, FixedPoint, rows_between};
use crate::memory::first;

/// A mask that can be drawn into, over borrowed words.
#[derive(Debug)]
pub struct MaskMut<'a> {
    words: &'a mut [Word],
    width: usize,
    height: usize,
}

impl<'a> MaskMut<'a> {
    /// An empty mask over `words`, which are cleared.
    ///
    /// # Errors
    /// [`MaskError`] for an impossible shape or too few words.
    pub fn new(words: &'a mut [Word], width: usize, height: usize) -> Result<Self, MaskError> {
        let needed = checked_words(width, height)?;
        let words = first("words", needed, words)?;
        words.fill(0);
        Ok(Self {
            words,
            width,
            height,
        })
    }

    /// A mask that goes on from what `words` hold.
    ///
    /// # Errors
    /// Those of [`Mask::new`].
    pub fn onto(words: &'a mut [Word], width: usize, height: usize) -> Result<Self, MaskError> {
        Mask::new(words, width, height)?;
        let words = first("words", checked_words(width, height)?, words)?;
        Ok(Self {
            words,
            width,
            height,
        })
    }

    /// What has been drawn.
    #[must_use]
    pub fn as_mask(&self) -> Mask<'_> {
        Mask {
            words: self.words,
            width: self.width,
            height: self.height,
        }
    }

    /// What has been drawn, for as long as the words are borrowed.
    #[must_use]
    pub fn into_mask(self) -> Mask<'a> {
        Mask {
            words: self.words,
            width: self.width,
            height: self.height,
        }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Clears every pixel.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Takes over the pixels of a mask of the same shape.
    pub(crate) fn copy_from(&mut self, mask: &Mask<'_>) {
        for row in 0..self.height {
            for (to, from) in self.row_mut(row).iter_mut().zip(mask.row(row)) {
                *to = *from;
            }
        }
    }

    /// Sets or clears one pixel; outside the mask nothing happens.
    pub fn set(&mut self, column: usize, row: usize, value: bool) {
        if column >= self.width {
            return;
        }
        if let Some(word) = self.row_mut(row).get_mut(column / WORD_BITS) {
            let bit = 1 << (column % WORD_BITS);
            *word = if value { *word | bit } else { *word & !bit };
        }
    }

    /// Replaces each word of a row by what `replace` makes of its number and its value. Bits beyond
    /// the last column stay zero, whatever it makes of them. Nothing where there is no such row.
    pub fn replace_row(&mut self, row: usize, mut replace: impl FnMut(usize, Word) -> Word) {
        let tail = tail_mask(self.width);
        let words = self.row_mut(row);
        for (index, word) in words.iter_mut().enumerate() {
            *word = replace(index, *word);
        }
        if let Some(last) = words.last_mut() {
            *last &= tail;
        }
    }

    /// A row's words. The bits beyond the last column must stay zero: every count relies on that.
    pub(crate) fn row_mut(&mut self, row: usize) -> &mut [Word] {
        let place = row_place(self.width, self.height, row);
        self.words.get_mut(place).unwrap_or_default()
    }

    /// Sets the columns `from..to` of a row, cut to the mask.
    pub fn fill_span(&mut self, row: usize, from: i64, to: i64) {
        let cut = |column: i64| column.clamp(0, self.width as i64) as usize;
        let (from, to) = (cut(from), cut(to));
        if from >= to {
            return;
        }
        let (first, last) = (from / WORD_BITS, (to - 1) / WORD_BITS);
        let head = Word::MAX << (from % WORD_BITS);
        let tail = tail_mask(to);
        match self.row_mut(row).get_mut(first..=last) {
            Some([only]) => *only |= head & tail,
            Some([start, middle @ .., end]) => {
                *start |= head;
                // Hidden, lest a few words become a call: in WASM one takes longer than a row.
                let ones = black_box(Word::MAX);
                middle.iter_mut().for_each(|word| *word = ones);
                *end |= tail;
            }
            _ => {}
        }
    }

    /// Sets a box of at most as many columns as a word has pixels, none beyond the mask.
    pub(crate) fn fill_box(&mut self, columns: &Range<usize>, rows: Range<usize>) {
        let bits = ((1u64 << columns.len()) - 1) << (columns.start % WORD_BITS);
        let (here, next) = (bits as Word, (bits >> WORD_BITS) as Word);
        let stride = row_words(self.width);
        let first = columns.start / WORD_BITS;
        for place in rows.map(|row| row * stride + first) {
            if let Some(word) = self.words.get_mut(place) {
                *word |= here;
            }
            if next != 0
                && let Some(word) = self.words.get_mut(place + 1)
            {
                *word |= next;
            }
        }
    }

    /// Replaces the mask by the pixels whose centre is inside `outline`, exactly.
    ///
    /// Each side toggles the first pixel to its right on every row it crosses; a running XOR
    /// along the row then gives even-odd parity without any list of crossings (Ackland and
    /// Weste, *The edge flag algorithm*, IEEE Trans. Computers C-30, 1981).
    pub fn fill_outline(&mut self, outline: &Outline<'_>) {
        self.fill_outline_from(outline, [0; 2]);
    }

    /// The same of a mask whose first pixel is that of a column and row of the outline's frame.
    pub(crate) fn fill_outline_from(&mut self, outline: &Outline<'_>, first: [usize; 2]) {
        self.clear();
        let place = |point| FixedPoint::from_point(point).map(|point| point.counted_from(first));
        for (a, b) in outline.sides() {
            if let (Some(a), Some(b)) = (place(a), place(b)) {
                self.toggle_edge([a, b]);
            }
        }
        self.fill_parity();
    }

    pub(crate) fn toggle_edge(&mut self, ends: [FixedPoint; 2]) {
        let edge = Edge::new(ends);
        for (row, column) in edge.columns(rows_between(ends, self.height)) {
            self.toggle(column.max(0) as usize, row);
        }
    }

    /// Sets a clear pixel and clears a set one; outside the mask nothing happens.
    pub fn toggle(&mut self, column: usize, row: usize) {
        if column < self.width
            && let Some(word) = self.row_mut(row).get_mut(column / WORD_BITS)
        {
            *word ^= 1 << (column % WORD_BITS);
        }
    }

    /// Replaces each pixel by the parity of those set up to it in its row.
    pub fn fill_parity(&mut self) {
        for row in 0..self.height {
            self.fill_parity_within(row, 0..row_words(self.width));
        }
    }

    /// The same within some words of one row.
    pub(crate) fn fill_parity_within(&mut self, row: usize, words: Range<usize>) {
        let last = words.end == row_words(self.width);
        let tail = if last {
            tail_mask(self.width)
        } else {
            Word::MAX
        };
        if let Some(words) = self.row_mut(row).get_mut(words) {
            prefix_parity(words, tail);
        }
    }
}

/// Replaces each bit by the XOR of all bits up to and including it.
fn prefix_parity(row: &mut [Word], tail: Word) {
    let mut carry = 0;
    for word in row.iter_mut() {
        let mut parity = *word;
        for shift in [1, 2, 4, 8, 16] {
            parity ^= parity << shift;
        }
        *word = parity ^ carry;
        carry = if *word >> (WORD_BITS - 1) == 1 {
            Word::MAX
        } else {
            0
        };
    }
    if let Some(last) = row.last_mut() {
        *last &= tail;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::contour::Point;
    use crate::image::mask::words_needed;

    const W: usize = 70;
    const H: usize = 40;

    #[test]
    fn spans_set_exactly_their_columns() {
        for (from, to) in [(0, 1), (31, 33), (3, 69), (-5, 90), (64, 64), (68, 200)] {
            let mut words = [0; words_needed(W, H)];
            let mut mask = MaskMut::new(&mut words, W, H).expect("fits");
            mask.fill_span(3, from, to);
            for column in 0..W {
                let inside = (from..to).contains(&(column as i64));
                assert_eq!(mask.as_mask().get(column, 3), inside, "{from}..{to}");
            }
        }
    }

    #[test]
    fn an_outline_fills_the_centres_inside_it() {
        let points = [
            (3.2, 2.1),
            (60.7, 8.4),
            (69.9, 39.0),
            (30.0, 20.3),
            (5.5, 35.5),
        ]
        .map(|(column, row)| Point::new(column, row));
        let outline = Outline::new(&points, W, H).expect("simple");
        let mut words = [0; words_needed(W, H)];
        let mut mask = MaskMut::new(&mut words, W, H).expect("fits");
        mask.fill_outline(&outline);
        for row in 0..H {
            for column in 0..W {
                // Oracle: parity of crossings of a ray to the left (W. R. Franklin's test).
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let inside = outline.sides().fold(false, |inside, (a, b)| {
                    let crosses = (a.row > y) != (b.row > y);
                    let at = a.column + (y - a.row) / (b.row - a.row) * (b.column - a.column);
                    inside ^ (crosses && at < x)
                });
                assert_eq!(mask.as_mask().get(column, row), inside, "{column}, {row}");
            }
        }
    }

    #[test]
    fn whole_pixels_are_filled_whole() {
        let points = [(2.0, 1.0), (66.0, 1.0), (66.0, 5.0), (2.0, 5.0)]
            .map(|(column, row)| Point::new(column, row));
        let mut words = [0; words_needed(W, H)];
        let mut mask = MaskMut::new(&mut words, W, H).expect("fits");
        mask.fill_outline(&Outline::new(&points, W, H).expect("simple"));
        assert_eq!(mask.as_mask().area(), 64 * 4);
        assert!(mask.as_mask().get(2, 1) && mask.as_mask().get(65, 4));
    }

    #[test]
    fn a_row_is_replaced_word_by_word_and_nothing_beyond_its_last_column() {
        for width in [1, 31, 32, 33, 64, 70] {
            let mut words = std::vec![0; words_needed(width, 3)];
            let mut mask = MaskMut::new(&mut words, width, 3).expect("fits");
            mask.fill_span(0, 0, width as i64);
            mask.fill_span(1, 0, 20);
            let made: [Word; 3] = [0xffff_00ff, 0x8000_0001, 0xdead_beef];
            let mut seen = std::vec::Vec::new();
            mask.replace_row(1, |index, word| {
                seen.push(word);
                made[index] | word
            });
            let first = ((1u64 << width.min(20)) - 1) as Word;
            assert_eq!(seen.first(), Some(&first));
            assert_eq!(seen.len(), width.div_ceil(WORD_BITS));
            mask.replace_row(3, |_, _| Word::MAX);
            let mask = mask.into_mask();
            let mut set = width;
            for column in 0..width {
                let word = made[column / WORD_BITS] | if column < 32 { first } else { 0 };
                let expected = word >> (column % WORD_BITS) & 1 == 1;
                assert_eq!(mask.get(column, 1), expected, "{width} {column}");
                assert!(mask.get(column, 0) && !mask.get(column, 2));
                set += usize::from(expected);
            }
            // Bits beyond the last column would be counted.
            assert_eq!(mask.area(), set as u64, "{width}");
        }
    }
}
