//! Sketches: the set pixels of each block of 16 x 16 pixels, at most 255 of 256.
//!
//! The sum of the differences of two sketches is a lower bound on the unmatched pixels of what
//! they are sketches of. Blocks of 16 were measured against others on the built-in implants: the
//! bound is 0.96 to 0.98 of the unmatched pixels and leaves 1 to 5 views of 1271 to compare. Blocks
//! of 8 (0.99) take three times the bytes for one view less; blocks of 32 (0.88 to 0.92) need two
//! bytes each.

use super::runs::{Band, WIDEST_FRAME};
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

/// Set pixels of the blocks of one row of blocks, gathered from runs: each changes two numbers, however long it is.
pub(super) struct BlockRow {
    /// For each block the columns at which runs begin in it less those at which runs end, and as many times [`TURN`]; modulo 2^32.
    turns: [u32; PLACES],
    /// What was taken last.
    counts: [u8; WIDEST],
}

/// More than blocks across: where a run ends that is none is told afterwards, and until then its number is cut off.
const PLACES: usize = 2 * WIDEST;
/// Beside a sum of columns the number of them: within one block runs begin and end by turns, so that neither of the
/// two sums passes 15 bits.
const TURN: u32 = 1 << 16;

impl BlockRow {
    /// Nothing is set.
    pub(super) const EMPTY: Self = Self {
        turns: [0; PLACES],
        counts: [0; WIDEST],
    };

    /// Adds the pixels of rows within the row of blocks and gives where the run ends that goes furthest.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn add(&mut self, band: &Band<'_>) -> usize {
        let mut furthest = TURN;
        for (_, row) in band.rows() {
            let mut at = TURN;
            for &[gap, pixels] in row {
                at += u32::from(gap);
                let begun = self.at(at);
                *begun = begun.wrapping_add(at);
                at += u32::from(pixels);
                let ended = self.at(at);
                *ended = ended.wrapping_sub(at);
            }
            furthest = furthest.max(at);
        }
        (furthest - TURN) as usize
    }

    #[inline(always)]
    fn at(&mut self, at: u32) -> &mut u32 {
        &mut self.turns[at as usize / BLOCK % PLACES]
    }

    /// The set pixels of the first `across` blocks, left to right, at most 255; and nothing is set afterwards.
    pub(super) fn take(&mut self, across: usize) -> &mut [u8] {
        let counts = self.counts.get_mut(..across).unwrap_or_default();
        // How many runs go on from the block before, and where the block ends.
        let (mut open, mut end) = (0u32, TURN);
        for (count, turns) in counts.iter_mut().zip(&mut self.turns) {
            let sum = core::mem::take(turns);
            // A negative sum of columns has borrowed one.
            let begun = ((sum.wrapping_add(TURN / 2) as i32) >> 16) as u32;
            end += BLOCK as u32;
            let before = open.wrapping_mul(BLOCK as u32);
            open = open.wrapping_add(begun);
            // Each that begins has the pixels from its column to the block's end.
            let pixels = before.wrapping_add(begun.wrapping_mul(end));
            *count = at_most_255(pixels.wrapping_sub(sum) as u16);
        }
        // Runs that end with the frame end there.
        if let Some(beyond) = self.turns.get_mut(across) {
            *beyond = 0;
        }
        counts
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
    use std::vec::Vec;

    /// Rows of runs that end within `across` blocks, and the set pixels of each block.
    fn rows(across: usize, per_row: usize) -> impl Strategy<Value = (Vec<[u8; 2]>, Vec<u16>)> {
        let ends = proptest::collection::vec(0..=across * BLOCK, 2 * per_row);
        proptest::collection::vec(ends, 0..BLOCK).prop_map(move |rows| {
            let (mut pieces, mut counts) = (Vec::new(), std::vec![0u16; across]);
            for mut ends in rows {
                ends.sort_unstable();
                let mut at = 0;
                for &[start, end] in ends.as_chunks::<2>().0 {
                    // What a byte holds.
                    let start = start.min(at + 255);
                    let end = end.clamp(start, start + 255);
                    pieces.push([(start - at) as u8, (end - start) as u8]);
                    (start..end).for_each(|pixel| counts[pixel / BLOCK] += 1);
                    at = end;
                }
            }
            (pieces, counts)
        })
    }

    properties! {
        #[test]
        fn runs_fill_the_blocks_that_their_pixels_are_in(
            (across, per_row, (pieces, counts)) in (1..=WIDEST, 1..6usize)
                .prop_flat_map(|(across, per_row)| (Just(across), Just(per_row), rows(across, per_row)))
        ) {
            let mut row_of_blocks = BlockRow::EMPTY;
            row_of_blocks.add(&Band { first_row: 0, per_row, pieces: &pieces });
            let naive: Vec<u8> = counts.into_iter().map(at_most_255).collect();
            prop_assert_eq!(&*row_of_blocks.take(across), &naive[..]);
            prop_assert_eq!(&*row_of_blocks.take(across), &std::vec![0; across][..]);
        }
    }
}
