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
}

/// More than blocks across: where a run ends that is none is told afterwards, and until then its number is cut off.
const PLACES: usize = 2 * WIDEST;
/// Beside a sum of columns the number of them: within one block runs begin and end by turns, so that neither of the
/// two sums passes 15 bits.
const TURN: u32 = 1 << 16;

impl BlockRow {
    /// Nothing is set.
    pub(super) const EMPTY: Self = Self { turns: [0; PLACES] };

    /// Adds the pixels of rows within the row of blocks and gives where the run ends that goes furthest.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn add(&mut self, band: &Band<'_>) -> usize {
        let mut furthest = TURN;
        // Most rows have one run or two, and their number is known here: for small code no loop is unrolled.
        match band.per_row {
            1 => {
                for &run in band.pieces {
                    furthest = furthest.max(self.add_run(TURN, run));
                }
            }
            2 => {
                for &[first, second] in band.pieces.as_chunks().0 {
                    let between = self.add_run(TURN, first);
                    furthest = furthest.max(self.add_run(between, second));
                }
            }
            _ => {
                for (_, row) in band.rows() {
                    let end = row.iter().fold(TURN, |at, &run| self.add_run(at, run));
                    furthest = furthest.max(end);
                }
            }
        }
        (furthest - TURN) as usize
    }

    /// Adds the run behind a place of a row, and gives where it ends.
    #[inline(always)]
    fn add_run(&mut self, at: u32, [gap, pixels]: [u8; 2]) -> u32 {
        let start = at + u32::from(gap);
        let begun = self.at(start);
        *begun = begun.wrapping_add(start);
        let end = start + u32::from(pixels);
        let ended = self.at(end);
        *ended = ended.wrapping_sub(end);
        end
    }

    #[inline(always)]
    fn at(&mut self, at: u32) -> &mut u32 {
        &mut self.turns[at as usize / BLOCK % PLACES]
    }

    /// Whether the set pixels of blocks, at most 255, are those of a sketch, or where it has none those that all views have in
    /// `common`; nothing is set afterwards.
    pub(super) fn is(&mut self, common: &[u8], sketch: &mut Sketch<'_>) -> bool {
        let Sketch { places, counts, .. } = *sketch;
        let place = |at: usize| {
            places
                .get(at)
                .map_or(NOWHERE, |&two| u16::from_le_bytes(two).into())
        };
        let (mut at, mut block) = (sketch.at, sketch.block);
        let mut next = place(at);
        // How many runs go on from the block before, and where the block ends.
        let (mut open, mut end, mut differs) = (0u32, TURN, 0);
        for (&common, turns) in common.iter().zip(&mut self.turns) {
            let sum = core::mem::take(turns);
            // A negative sum of columns has borrowed one.
            let begun = ((sum.wrapping_add(TURN / 2) as i32) >> 16) as u32;
            end += BLOCK as u32;
            let before = open.wrapping_mul(BLOCK as u32);
            open = open.wrapping_add(begun);
            // Each that begins has the pixels from its column to the block's end.
            let pixels = before.wrapping_add(begun.wrapping_mul(end));
            let count = at_most_255(pixels.wrapping_sub(sum) as u16);
            let mut expected = common;
            if block == next {
                // What the sketch has of a block is nothing that all views have in common.
                differs |= common;
                expected = counts.get(at).copied().unwrap_or(0);
                at += 1;
                next = place(at);
            }
            differs |= count ^ expected;
            block += 1;
        }
        (sketch.at, sketch.block) = (at, block);
        // Runs that end with the frame end there.
        if let Some(beyond) = self.turns.get_mut(common.len()) {
            *beyond = 0;
        }
        differs == 0 && common.len() <= WIDEST
    }
}

/// What a sketch has of the blocks that follow.
#[derive(Clone, Copy)]
pub(super) struct Sketch<'a> {
    places: &'a [[u8; 2]],
    counts: &'a [u8],
    /// The first of its counts that is of them, and the first of them.
    at: usize,
    block: u32,
}

/// No block has this number.
const NOWHERE: u32 = u32::MAX;

impl<'a> Sketch<'a> {
    /// Of blocks at these places, which rise, all counts.
    pub(super) fn of(places: &'a [[u8; 2]], counts: &'a [u8]) -> Self {
        Self {
            places,
            counts,
            at: 0,
            block: 0,
        }
    }

    /// Whether all of it was compared.
    pub(super) fn is_over(&self) -> bool {
        self.at == self.places.len()
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
                .prop_flat_map(|(across, per_row)| (Just(across), Just(per_row), rows(across, per_row))),
            is_sketched in proptest::collection::vec(any::<bool>(), WIDEST),
            other in any::<prop::sample::Index>(),
            bit in 0u32..8,
        ) {
            let naive: Vec<u8> = counts.into_iter().map(at_most_255).collect();
            let places: Vec<usize> = (0..across).filter(|&block| is_sketched[block]).collect();
            let mut sketch: Vec<u8> = places.iter().map(|&block| naive[block]).collect();
            let numbers: Vec<[u8; 2]> = places.iter().map(|&block| (block as u16).to_le_bytes()).collect();
            let mut common = naive;
            places.iter().for_each(|&block| common[block] = 0);
            let mut row_of_blocks = BlockRow::EMPTY;
            let mut is_same = |common: &[u8], sketch: &[u8]| {
                row_of_blocks.add(&Band { first_row: 0, per_row, pieces: &pieces });
                let mut said = Sketch::of(&numbers, sketch);
                let is_same = row_of_blocks.is(common, &mut said);
                assert!(said.is_over());
                // Nothing is left.
                assert!(row_of_blocks.is(&std::vec![0; across], &mut Sketch::of(&[], &[])));
                is_same
            };
            prop_assert!(is_same(&common, &sketch));
            // What all views have in common is nowhere else.
            let other = other.index(across);
            common[other] ^= 1u8 << bit;
            prop_assert!(!is_same(&common, &sketch));
            common[other] ^= 1u8 << bit;
            if let Ok(own) = places.binary_search(&other) {
                sketch[own] ^= 1u8 << bit;
                prop_assert!(!is_same(&common, &sketch));
            }
        }
    }
}
