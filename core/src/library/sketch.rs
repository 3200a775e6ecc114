//! Sketches: the set pixels of each block of 16 x 16 pixels, at most 255 of 256.
//!
//! The sum of the differences of two sketches is a lower bound on the unmatched pixels of what
//! they are sketches of. Blocks of 16 were measured against others on the built-in implants: the
//! bound is 0.96 to 0.98 of the unmatched pixels and leaves 1 to 5 views of 1271 to compare. Blocks
//! of 8 (0.99) take three times the bytes for one view less; blocks of 32 (0.88 to 0.92) need two
//! bytes each.

use super::runs::WIDEST_FRAME;
use crate::canonical::CanonicalSpec;
use crate::image::mask::{Mask, Word};

/// Side of a block, pixels. Canonical frames are whole blocks.
pub(crate) const BLOCK: usize = 16;
/// Blocks across the widest canonical frame.
const WIDEST: usize = WIDEST_FRAME / BLOCK;
/// Most blocks of a canonical frame.
pub(super) const MOST_BLOCKS: usize = WIDEST * WIDEST;
/// Sketches are padded with empty blocks to a multiple of this many, so that kernels need no tail.
pub(crate) const STRIDE: usize = 32;

/// Blocks of a canonical frame.
#[must_use]
pub(crate) const fn blocks(spec: &CanonicalSpec) -> usize {
    (spec.size() / BLOCK) * (spec.size() / BLOCK)
}

/// A count as a sketch has it: a full block has 255 pixels, which keeps the bound a bound.
pub(crate) fn at_most_255(count: u16) -> u8 {
    count.min(255) as u8
}

/// Set pixels of the blocks of one row of blocks, gathered from runs: each changes four numbers, however long it is.
pub(super) struct BlockRow {
    /// Runs that begin in a block less those that end there, and the pixels before these places in the block; both modulo 2^16, which no
    /// count of pixels reaches.
    begun: [u16; WIDEST + 1],
    before: [u16; WIDEST + 1],
}

impl BlockRow {
    /// Nothing is set.
    pub(super) const EMPTY: Self = Self {
        begun: [0; WIDEST + 1],
        before: [0; WIDEST + 1],
    };

    /// Adds the pixels of a run.
    #[inline(always)]
    pub(super) fn add(&mut self, start: usize, end: usize) {
        self.turn(start, 1);
        self.turn(end, u16::MAX);
    }

    #[inline(always)]
    fn turn(&mut self, at: usize, sign: u16) {
        let (begun, before) = (
            self.begun.get_mut(at / BLOCK),
            self.before.get_mut(at / BLOCK),
        );
        if let (Some(begun), Some(before)) = (begun, before) {
            *begun = begun.wrapping_add(sign);
            *before = before.wrapping_add(sign.wrapping_mul((at % BLOCK) as u16));
        }
    }

    /// The set pixels of the first `across` blocks, left to right, and nothing is set afterwards.
    pub(super) fn take(&mut self, across: usize) -> impl Iterator<Item = u16> {
        // Runs that end with the frame end there.
        for beyond in [&mut self.begun, &mut self.before] {
            beyond
                .iter_mut()
                .skip(across)
                .take(1)
                .for_each(|number| *number = 0);
        }
        let mut open = 0u16;
        let blocks = self.begun.iter_mut().zip(&mut self.before).take(across);
        blocks.map(move |(begun, before)| {
            open = open.wrapping_add(*begun);
            let count = (BLOCK as u16).wrapping_mul(open).wrapping_sub(*before);
            (*begun, *before) = (0, 0);
            count
        })
    }
}

/// The blocks of a canonical silhouette, row by row, into a byte each.
pub(super) fn count_blocks(canonical: &Mask<'_>, out: &mut [u8]) {
    let across = canonical.width() / BLOCK;
    let filled = canonical.rows();
    for (row, out) in out.chunks_exact_mut(across).enumerate() {
        let mut counts = [0u16; WIDEST];
        let first = (row * BLOCK).max(filled.start);
        for row in first..((row + 1) * BLOCK).min(filled.end) {
            let two_each = counts.as_chunks_mut().0.iter_mut();
            for ([left, right], &word) in two_each.zip(canonical.row(row)) {
                let ones = ones_of_halves(word);
                *left += ones as u16;
                *right += (ones >> BLOCK) as u16;
            }
        }
        for (out, count) in out.iter_mut().zip(counts) {
            *out = at_most_255(count);
        }
    }
}

/// Set pixels of either half of a word, in that half (Warren, *Hacker's Delight*, 5-1, one step short).
fn ones_of_halves(word: Word) -> Word {
    let twos = word - (word >> 1 & 0x5555_5555);
    let fours = (twos & 0x3333_3333) + (twos >> 2 & 0x3333_3333);
    let eights = (fours + (fours >> 4)) & 0x0f0f_0f0f;
    (eights + (eights >> 8)) & 0x00ff_00ff
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn runs_fill_the_blocks_that_their_pixels_are_in(
            rows in proptest::collection::vec(proptest::collection::vec(0..=1024usize, 0..40), 0..16),
            across in 1..=WIDEST,
        ) {
            let (mut row_of_blocks, mut naive) = (BlockRow::EMPTY, [0u16; WIDEST]);
            for ends in rows {
                let mut ends: std::vec::Vec<usize> = ends.iter().map(|&end| end.min(across * BLOCK)).collect();
                ends.sort_unstable();
                for &[start, end] in ends.as_chunks::<2>().0 {
                    row_of_blocks.add(start, end);
                    (start..end).for_each(|pixel| naive[pixel / BLOCK] += 1);
                }
            }
            for empty in [false, true] {
                let counts: std::vec::Vec<u16> = row_of_blocks.take(across).collect();
                let expected = if empty { [0; WIDEST] } else { naive };
                prop_assert_eq!(&counts[..across], &expected[..across]);
            }
        }
    }
}
