//! Sketches: the set pixels of each block of 16 x 16 pixels, at most 255 of 256.
//!
//! The sum of the differences of two sketches is a lower bound on the unmatched pixels of what
//! they are sketches of. Blocks of 16 were measured against others on the built-in implants: the
//! bound is 0.96 to 0.98 of the unmatched pixels and leaves 1 to 5 views of 1271 to compare. Blocks
//! of 8 (0.99) take three times the bytes for one view less; blocks of 32 (0.88 to 0.92) need two
//! bytes each.

use super::runs::{Band, WIDEST_FRAME, bands, spans};
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

/// Set pixels of the blocks of one row of blocks, left to right.
pub(super) type BlockRow = [u16; WIDEST];

/// The blocks of one row of blocks of a view's runs.
pub(super) fn block_row_of_runs(runs: &[u8], row_of_blocks: usize) -> BlockRow {
    let mut counts = [0; WIDEST];
    let wanted = row_of_blocks * BLOCK..(row_of_blocks + 1) * BLOCK;
    let near = bands(runs).skip_while(|band| {
        let rows = band.pieces.len() / band.per_row;
        band.first_row + rows <= wanted.start
    });
    let rows = near.flat_map(Band::rows);
    let rows = rows.skip_while(|(row, _)| *row < wanted.start);
    for (_, pieces) in rows.take_while(|(row, _)| *row < wanted.end) {
        for (start, end) in spans(pieces) {
            add_span(&mut counts, start, end);
        }
    }
    counts
}

fn add_span(counts: &mut BlockRow, start: usize, end: usize) {
    for (block, count) in counts
        .iter_mut()
        .enumerate()
        .take(end.div_ceil(BLOCK))
        .skip(start / BLOCK)
    {
        let from = start.max(block * BLOCK);
        let to = end.min((block + 1) * BLOCK);
        *count += to.saturating_sub(from) as u16;
    }
}

/// The blocks of a canonical silhouette, row by row, into a byte each.
pub(super) fn count_blocks(canonical: &Mask<'_>, out: &mut [u8]) {
    let across = canonical.width() / BLOCK;
    let filled = canonical.rows();
    for (row, out) in out.chunks_exact_mut(across).enumerate() {
        let mut counts: BlockRow = [0; WIDEST];
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
