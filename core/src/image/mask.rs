//! Silhouettes as bits: one bit a pixel, rows on word borders, moments in whole numbers.

mod fill;

pub use fill::MaskMut;

use bitvec::{order::Lsb0, slice::BitSlice};
use thiserror::Error;

use crate::memory::TooLittleMemory;

/// The unit of storage. Bit 0 is the leftmost pixel of its word.
pub type Word = u32;
/// Pixels in a word.
pub const WORD_BITS: usize = Word::BITS as usize;
/// Largest width and height, in pixels: keeps fixed-point positions in 32 bits and moments in 64.
pub const MAX_SIDE: usize = 16_384;

/// Why a buffer is not a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MaskError {
    /// The shape is empty or larger than [`MAX_SIDE`].
    #[error(
        "a mask of {width} x {height} pixels is not possible; each side must be 1 to {MAX_SIDE}"
    )]
    Shape {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// A mask's bits have the wrong number of words.
    #[error("a mask of this shape has exactly {needed} words but {given} were given")]
    Words {
        /// Words that the shape takes.
        needed: usize,
        /// Words that were given.
        given: usize,
    },
    /// Bits are set beyond a row's last pixel.
    #[error("row {0} of the mask has bits set beyond its last pixel")]
    Padding(usize),
    /// No pixel is set.
    #[error("the mask is empty: no pixel belongs to the silhouette")]
    Empty,
    /// A silhouette reaches the side of a part of the frame that is to hold all of it.
    #[error("the silhouette reaches beyond the part of the frame that is to hold all of it")]
    Cropped,
    /// Two masks of one frame differ in size.
    #[error("two masks of one frame differ in size")]
    Sizes,
}

/// Words of one row of `width` pixels.
#[must_use]
pub(crate) const fn row_words(width: usize) -> usize {
    width.div_ceil(WORD_BITS)
}

/// Words of a mask of `width` x `height` pixels.
#[must_use]
pub const fn words_needed(width: usize, height: usize) -> usize {
    row_words(width) * height
}

/// Where the words of a row are; nowhere for a row below the mask, whose place no number may hold.
#[inline(always)]
fn row_place(width: usize, height: usize, row: usize) -> core::ops::Range<usize> {
    if row >= height {
        return 0..0;
    }
    let length = row_words(width);
    row * length..(row + 1) * length
}

/// A borrowed silhouette. Bits beyond a row's last pixel are zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mask<'a> {
    words: &'a [Word],
    width: usize,
    height: usize,
}

/// The words of a mask of a possible shape.
fn checked_words(width: usize, height: usize) -> Result<usize, MaskError> {
    if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
        return Err(MaskError::Shape { width, height });
    }
    Ok(words_needed(width, height))
}

impl<'a> Mask<'a> {
    /// A mask over `words`, row by row.
    ///
    /// # Errors
    /// [`MaskError`] for an impossible shape, a wrong length, or bits beyond the last column.
    pub fn new(words: &'a [Word], width: usize, height: usize) -> Result<Self, MaskError> {
        let (needed, given) = (checked_words(width, height)?, words.len());
        if given != needed {
            return Err(MaskError::Words { needed, given });
        }
        let tail = tail_mask(width);
        let padded = words
            .chunks_exact(row_words(width).max(1))
            .position(|row| row.last().is_some_and(|word| word & !tail != 0));
        match padded {
            Some(row) => Err(MaskError::Padding(row)),
            None => Ok(Self {
                words,
                width,
                height,
            }),
        }
    }

    /// A mask over words that were found to be one.
    pub(crate) fn of_checked(words: &'a [Word], width: usize, height: usize) -> Self {
        Self {
            words,
            width,
            height,
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

    /// All words, row by row.
    #[must_use]
    pub fn words(&self) -> &'a [Word] {
        self.words
    }

    /// The words of one row; empty below the mask.
    #[must_use]
    #[inline]
    pub fn row(&self, row: usize) -> &'a [Word] {
        let place = row_place(self.width, self.height, row);
        self.words.get(place).unwrap_or_default()
    }

    /// One row as a slice of bits, for reading; loops that must be fast run on words.
    #[must_use]
    pub fn row_bits(&self, row: usize) -> &'a BitSlice<Word, Lsb0> {
        let bits = BitSlice::from_slice(self.row(row));
        bits.get(..self.width).unwrap_or_default()
    }

    /// Whether a pixel is set; outside the mask none is.
    #[must_use]
    pub fn get(&self, column: usize, row: usize) -> bool {
        if column >= self.width || row >= self.height {
            return false;
        }
        let word = self
            .words
            .get(row * row_words(self.width) + column / WORD_BITS);
        word.is_some_and(|word| word >> (column % WORD_BITS) & 1 == 1)
    }

    /// A pixel, the one to its right, and the two below them, from the lowest bit; outside the mask
    /// none is set.
    pub(crate) fn square(&self, column: usize, row: usize) -> u32 {
        match column < self.width && row < self.height {
            true => self.square_within(column, row),
            false => 0,
        }
    }

    /// The same of a pixel of the mask, without a call: it is asked for some times for each sample of an outline.
    #[inline(always)]
    pub(crate) fn square_within(&self, column: usize, row: usize) -> u32 {
        let stride = row_words(self.width);
        let (at, shift) = (column / WORD_BITS, column % WORD_BITS);
        let word = |place: usize| self.words.get(place).copied().unwrap_or(0);
        let place = row * stride + at;
        let (above, below) = (word(place) >> shift, word(place + stride) >> shift);
        // In the last bit of a word the pixels to the right are the next one's.
        let (right_above, right_below) = match shift == WORD_BITS - 1 && at + 1 < stride {
            true => (word(place + 1) << 1, word(place + stride + 1) << 1),
            false => (0, 0),
        };
        (above | right_above) & 3 | ((below | right_below) & 3) << 2
    }

    /// Number of pixels set.
    #[must_use]
    pub fn area(&self) -> u64 {
        self.words.iter().map(|w| u64::from(w.count_ones())).sum()
    }

    /// Number of pixels set in one of two masks and not in the other; `None` where their shapes
    /// differ.
    #[must_use]
    pub fn unmatched(&self, other: &Mask<'_>) -> Option<u64> {
        ((self.width, self.height) == (other.width, other.height)).then(|| {
            let pairs = self.words.iter().zip(other.words);
            pairs.map(|(a, b)| u64::from((a ^ b).count_ones())).sum()
        })
    }

    /// The runs of set pixels of one row, as half-open ranges of columns, left to right.
    pub fn runs(&self, row: usize) -> impl Iterator<Item = core::ops::Range<usize>> + use<'a> {
        runs_of(self.row(row), 0)
    }

    /// The same of some words of the row: runs are cut where those begin and end.
    pub(crate) fn runs_within(
        &self,
        row: usize,
        words: core::ops::Range<usize>,
    ) -> impl Iterator<Item = core::ops::Range<usize>> + use<'a> {
        let first = words.start;
        runs_of(self.row(row).get(words).unwrap_or_default(), first)
    }

    /// The smallest rectangle that holds every set pixel, as ranges of columns and rows; empty
    /// ranges for an empty mask.
    #[must_use]
    pub fn bounds(&self) -> (core::ops::Range<usize>, core::ops::Range<usize>) {
        let rows = self.rows();
        let stride = row_words(self.width);
        let own = self.words.get(rows.start * stride..rows.end * stride);
        let own = own.unwrap_or_default();
        // Of all rows together, where the first and the last word that has a pixel are.
        let together = |at: usize| {
            let words = own.chunks_exact(stride.max(1));
            let any = words.fold(0, |sum, row| sum | row.get(at).copied().unwrap_or(0));
            (any != 0).then_some((at * WORD_BITS, any))
        };
        let first = (0..stride).find_map(together);
        let last = (0..stride).rev().find_map(together);
        let columns = first.zip(last).map_or(0..0, |((first, own), (last, end))| {
            let after = last + WORD_BITS - end.leading_zeros() as usize;
            first + own.trailing_zeros() as usize..after
        });
        (columns, rows)
    }

    /// The rows from the first to the last that has a pixel.
    pub(crate) fn rows(&self) -> core::ops::Range<usize> {
        // All words of a row at once: wide instructions.
        let any = |row: &[Word]| row.iter().fold(0, |sum, word| sum | word) != 0;
        let mut rows = self.words.chunks_exact(row_words(self.width).max(1));
        let first = rows.clone().position(any);
        let last = rows.rposition(any);
        first
            .zip(last)
            .map_or(0..0, |(first, last)| first..last + 1)
    }
}

/// The runs of set pixels in words of a row, of which the first is number `first`.
#[inline(always)]
pub(crate) fn runs_of(
    words: &[Word],
    first: usize,
) -> impl Iterator<Item = core::ops::Range<usize>> {
    // The present word and those of its set pixels that have not been passed yet.
    let (mut at, mut left) = (0, words.first().copied().unwrap_or(0));
    core::iter::from_fn(move || {
        while left == 0 {
            at += 1;
            left = *words.get(at)?;
        }
        let start = (first + at) * WORD_BITS + left.trailing_zeros() as usize;
        // As if the run began with the word.
        left |= left - 1;
        while left == Word::MAX {
            at += 1;
            left = words.get(at).copied().unwrap_or(0);
        }
        let ones = left.trailing_ones();
        left = left >> ones << ones;
        Some(start..(first + at) * WORD_BITS + ones as usize)
    })
}

/// Index of the first bit at or after `from` that equals `wanted`; the number of bits if none.
pub(crate) fn next_bit(words: &[Word], from: usize, wanted: bool) -> usize {
    let flip = if wanted { 0 } else { Word::MAX };
    let mut skip = from % WORD_BITS;
    for (index, word) in words.iter().enumerate().skip(from / WORD_BITS) {
        let left = (word ^ flip) >> skip << skip;
        if left != 0 {
            return index * WORD_BITS + left.trailing_zeros() as usize;
        }
        skip = 0;
    }
    words.len() * WORD_BITS
}

/// The bits of a row's last word that are pixels.
#[must_use]
pub const fn tail_mask(width: usize) -> Word {
    match width % WORD_BITS {
        0 => Word::MAX,
        used => (1 << used) - 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::moments::Moments;

    const W: usize = 70;
    const H: usize = 40;

    fn speckled(words: &mut [Word]) -> Mask<'_> {
        let mut mask = MaskMut::new(words, W, H).expect("fits");
        let mut seed = 7u32;
        for row in 0..H {
            for column in 0..W {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                mask.set(column, row, seed >> 30 == 0);
            }
        }
        mask.into_mask()
    }

    #[test]
    fn squares_are_four_pixels() {
        let mut words = [0; words_needed(W, H)];
        let mask = speckled(&mut words);
        for (row, column) in (0..H + 2).flat_map(|row| (0..W + 40).map(move |c| (row, c))) {
            let pixels = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let bits = pixels
                .iter()
                .enumerate()
                .map(|(bit, (right, down))| u32::from(mask.get(column + right, row + down)) << bit);
            assert_eq!(mask.square(column, row), bits.sum(), "{column}, {row}");
        }
    }

    #[test]
    fn moments_equal_sums_over_readable_bits() {
        let mut words = [0; words_needed(W, H)];
        let mask = speckled(&mut words);
        let mut sum = Moments::default();
        for row in 0..H {
            for column in mask.row_bits(row).iter_ones() {
                let (x, y) = (column as u64, row as u64);
                sum.area += 1;
                sum.column += x;
                sum.row += y;
                sum.column_column += x * x;
                sum.column_row += x * y;
                sum.row_row += y * y;
            }
        }
        assert_eq!(mask.moments(), sum);
        let set = |column: usize, row: usize| mask.get(column, row);
        let (columns, rows) = mask.bounds();
        for row in 0..H {
            for column in 0..W {
                let inside = columns.contains(&column) && rows.contains(&row);
                assert!(inside || !set(column, row));
            }
        }
        assert!(rows.clone().any(|row| set(columns.start, row)));
        assert!(rows.clone().any(|row| set(columns.end - 1, row)));
        assert!(columns.clone().any(|column| set(column, rows.start)));
        assert!(columns.clone().any(|column| set(column, rows.end - 1)));
        assert_eq!(mask.area(), sum.area);
    }

    #[test]
    fn there_is_nothing_below_the_mask_however_far() {
        let mut words = [0; words_needed(W, H)];
        for row in [
            H,
            H + 1,
            usize::MAX / 4,
            usize::MAX / 3 + 1,
            usize::MAX - 1,
            usize::MAX,
        ] {
            let mut mask = MaskMut::new(&mut words, W, H).expect("fits");
            mask.set(3, row, true);
            mask.toggle(3, row);
            mask.fill_span(row, 0, 9);
            mask.replace_row(row, |_, _| Word::MAX);
            let mask = mask.into_mask();
            assert_eq!(mask.area(), 0);
            assert!(mask.row(row).is_empty() && mask.row_bits(row).is_empty());
            assert!(!mask.get(3, row) && mask.runs(row).next().is_none());
            assert_eq!(mask.square(3, row), 0);
        }
    }

    #[test]
    fn wrong_buffers_are_refused() {
        assert!(matches!(
            Mask::new(&[0; 3], 33, 1),
            Err(MaskError::Words { needed: 2, .. })
        ));
        assert_eq!(Mask::new(&[0, 2], 33, 1), Err(MaskError::Padding(0)));
        assert!(Mask::new(&[0, 1], 33, 1).is_ok());
        assert!(Mask::new(&[], 0, 0).is_err());
    }
}
