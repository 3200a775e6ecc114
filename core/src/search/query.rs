//! A canonical silhouette made ready for searching libraries.

use crate::canonical::CanonicalSpec;
use crate::image::mask::{WORD_BITS, Word};
use crate::library::runs::{Band, bands};
use crate::library::sketch::{BLOCK, STRIDE, at_most_255, blocks};
use crate::library::{Library, Sketches};
use crate::memory::{TooLittleMemory, check_length, first};
use crate::search::kernels::Kernels;
use crate::search::scores::MatchError;

/// A canonical silhouette, and the same rotated by 180 degrees, made ready for searching.
///
/// A view of runs is compared by looking up how many pixels of the silhouette are set before
/// each run's start and end: two numbers a run, whatever its length.
#[derive(Clone, Copy, Debug)]
pub struct Query<'m> {
    spec: CanonicalSpec,
    /// Pixels set.
    area: u32,
    straight: &'m [Word],
    rotated: &'m [Word],
    /// Pixels set before each pixel of the frame, row by row, modulo 256: no run has more
    /// than 255 pixels. One number more than there are pixels.
    before: &'m [u8],
    /// Set pixels of each block of the silhouette as it is and rotated by 180 degrees.
    blocks: [&'m [u8]; 2],
}

/// Bytes of working memory of [`Query::new`].
#[must_use]
pub const fn query_bytes_needed(spec: &CanonicalSpec) -> usize {
    spec.size() * spec.size() + 1 + 2 * blocks(spec)
}

impl<'m> Query<'m> {
    /// Makes `straight` ready, a canonical silhouette from [`crate::canonical::canonicalise`] with
    /// the libraries' own `spec`. `rotated` is the same rotated by 180 degrees
    /// ([`crate::canonical::reverse`]). `bytes` is working memory, [`query_bytes_needed`] of it.
    ///
    /// # Errors
    /// [`MatchError::Memory`] for a wrong length.
    pub fn new(
        spec: &CanonicalSpec,
        straight: &'m [Word],
        rotated: &'m [Word],
        bytes: &'m mut [u8],
    ) -> Result<Self, MatchError> {
        let words = spec.words_needed();
        let (straight, rotated) = (first_of(words, straight)?, first_of(words, rotated)?);
        let needed = query_bytes_needed(spec);
        let bytes = first("bytes of working memory", needed, bytes)?;
        let (before, sketches) = bytes
            .split_at_mut_checked(needed - 2 * blocks(spec))
            .unwrap_or_default();
        count_before(straight.iter().copied(), before);
        Ok(Self {
            spec: *spec,
            area: straight.iter().map(|word| word.count_ones()).sum(),
            straight,
            rotated,
            before,
            blocks: sketch(spec, straight, sketches),
        })
    }

    /// The canonical frame.
    #[must_use]
    pub fn spec(&self) -> &CanonicalSpec {
        &self.spec
    }

    /// The silhouette in one direction of its principal axis.
    #[must_use]
    pub fn canonical(&self, reversed: bool) -> &'m [Word] {
        if reversed {
            self.rotated
        } else {
            self.straight
        }
    }

    /// Pixels that are set in the silhouette or in a view and not in both; exactly.
    ///
    /// The library's canonical frame must be the query's own; this is not checked, and another one gives a wrong count.
    #[must_use]
    pub fn unmatched(
        &self,
        library: &Library<'_>,
        view: usize,
        reversed: bool,
        kernels: &Kernels,
    ) -> u32 {
        if library.sketches().is_none() {
            return (kernels.unmatched)(self.canonical(reversed), library.bits(view));
        }
        let runs = library.runs(view);
        let Covered { pixels, common } = if reversed {
            self.covered::<true>(runs)
        } else {
            self.covered::<false>(runs)
        };
        self.area + pixels - 2 * common
    }

    /// Pixels of the runs, and how many of them are the silhouette's.
    fn covered<const REVERSED: bool>(&self, runs: &[u8]) -> Covered {
        let size = self.spec.size();
        let mut all = Covered::default();
        for band in bands(runs) {
            let rows = Counts {
                before: self.before,
                first: band.first_row * size,
                size,
            };
            // Nearly all rows of nearly all views have one or two runs.
            let own = match band.per_row {
                1 => rows.of_single_runs::<REVERSED>(band.pieces.as_chunks().0),
                2 => rows.of_double_runs::<REVERSED>(band.pieces.as_chunks().0),
                _ => None,
            };
            let own = own.unwrap_or_else(|| rows.of_any_runs::<REVERSED>(band));
            all.pixels += own.pixels;
            all.common += own.common;
        }
        all
    }

    /// The blocks that a library's sketches have; returns what the others differ by in every view. `out` gets the
    /// set pixels of each block and has the length of a sketch.
    pub(super) fn sketch_for(
        &self,
        sketches: &Sketches<'_>,
        reversed: bool,
        kernels: &Kernels,
        out: &mut [u8],
    ) -> u32 {
        self.gather(sketches.places(), sketches.common, reversed, kernels, out)
    }

    /// The same of any choice of blocks; `common` has what the others are in every view, and 0 at `places`.
    pub(super) fn gather(
        &self,
        places: impl Iterator<Item = usize>,
        common: &[u8],
        reversed: bool,
        kernels: &Kernels,
        out: &mut [u8],
    ) -> u32 {
        let blocks = self.blocks[usize::from(reversed)];
        let mut base = (kernels.gap)([blocks; 2], [common; 2]);
        let mut places = places;
        for out in out {
            // Nothing behind the last.
            let own = places.next().and_then(|place| blocks.get(place));
            *out = own.copied().unwrap_or(0);
            // There the common block is 0, and the gap was the silhouette's own count.
            base -= u32::from(*out);
        }
        base
    }
}

/// Pixels of runs, and how many of them are set.
#[derive(Default)]
struct Covered {
    pixels: u32,
    common: u32,
}

/// How many pixels are set before each, from a row on. In the reversed direction pixels are counted from the end.
#[derive(Clone, Copy)]
struct Counts<'a> {
    before: &'a [u8],
    /// The first pixel of the row that is looked at.
    first: usize,
    size: usize,
}

/// More pixels than a row of one run, or of two, reaches: where so many are left, none has to be asked whether it is there.
const SINGLE: usize = 2 * 255 + 1;
const DOUBLE: usize = 4 * 255 + 1;

impl<'a> Counts<'a> {
    /// Of rows of one run each; `None` where that has to be asked.
    #[cfg_attr(target_os = "none", inline(never))]
    fn of_single_runs<const REVERSED: bool>(mut self, rows: &[[[u8; 2]; 1]]) -> Option<Covered> {
        let (mut pixels, mut common) = (0, 0);
        for &[[gap, length]] in rows {
            let counts = self.next::<REVERSED, SINGLE>()?;
            let start = usize::from(gap);
            pixels += u32::from(length);
            common += set_within::<REVERSED>(counts, start, start + usize::from(length));
        }
        Some(Covered { pixels, common })
    }

    /// The same of two.
    #[cfg_attr(target_os = "none", inline(never))]
    fn of_double_runs<const REVERSED: bool>(mut self, rows: &[[[u8; 2]; 2]]) -> Option<Covered> {
        let (mut pixels, mut common) = (0, 0);
        for &[[gap, length], [next_gap, next_length]] in rows {
            let counts = self.next::<REVERSED, DOUBLE>()?;
            let start = usize::from(gap);
            let end = start + usize::from(length);
            let next_start = end + usize::from(next_gap);
            pixels += u32::from(length) + u32::from(next_length);
            common += set_within::<REVERSED>(counts, start, end);
            let next_end = next_start + usize::from(next_length);
            common += set_within::<REVERSED>(counts, next_start, next_end);
        }
        Some(Covered { pixels, common })
    }

    /// Of rows of any number of runs.
    #[cfg_attr(target_os = "none", inline(never))]
    fn of_any_runs<const REVERSED: bool>(self, band: Band<'_>) -> Covered {
        let (mut pixels, mut common) = (0, 0);
        let mut first = self.first;
        for row in band.rows_of_pieces() {
            let mut at = first;
            for &[gap, length] in row {
                let start = at + usize::from(gap);
                at = start + usize::from(length);
                pixels += u32::from(length);
                common += set_within::<REVERSED>(self.before, start, at);
            }
            first += self.size;
        }
        Covered { pixels, common }
    }

    /// The counts from the row's beginning on, and on to the next row.
    #[inline(always)]
    fn next<const REVERSED: bool, const AHEAD: usize>(&mut self) -> Option<&'a [u8; AHEAD]> {
        let start = if REVERSED {
            self.before.len().checked_sub(self.first + AHEAD)?
        } else {
            self.first
        };
        let counts = self.before.get(start..)?.first_chunk()?;
        self.first += self.size;
        Some(counts)
    }
}

/// Set pixels from one to before another.
#[inline(always)]
fn set_within<const REVERSED: bool>(counts: &[u8], start: usize, end: usize) -> u32 {
    let (from, to) = (
        count::<REVERSED>(counts, start),
        count::<REVERSED>(counts, end),
    );
    let set = if REVERSED {
        from.wrapping_sub(to)
    } else {
        to.wrapping_sub(from)
    };
    u32::from(set)
}

#[inline(always)]
fn count<const REVERSED: bool>(counts: &[u8], at: usize) -> u8 {
    let at = if REVERSED {
        counts.len().wrapping_sub(at + 1)
    } else {
        at
    };
    counts.get(at).copied().unwrap_or(0)
}

/// The words of one canonical mask.
fn first_of(words: usize, mask: &[Word]) -> Result<&[Word], TooLittleMemory> {
    check_length("words of canonical mask", words, mask.len())?;
    Ok(mask.get(..words).unwrap_or_default())
}

/// A one in each of eight lanes of a number.
const ONES: u64 = 0x0101_0101_0101_0101;

/// Writes how many bits are set before each bit, modulo 256, and once more for all.
fn count_before(words: impl Iterator<Item = Word>, out: &mut [u8]) {
    let Some((first, rest)) = out.split_first_mut() else {
        return;
    };
    *first = 0;
    let mut count = 0u8;
    for (word, out) in words.zip(rest.as_chunks_mut::<WORD_BITS>().0) {
        if word == 0 {
            // Eight at a time, lest they become a call: a function for bytes is linked for nothing else.
            let same = (ONES * u64::from(count)).to_le_bytes();
            out.as_chunks_mut()
                .0
                .iter_mut()
                .for_each(|eight| *eight = same);
            continue;
        }
        for (eight, byte) in out
            .as_chunks_mut::<8>()
            .0
            .iter_mut()
            .zip(word.to_le_bytes())
        {
            *eight = counts_up_to(byte, count);
            count = eight[7];
        }
    }
}

/// `count` plus the bits set up to and including each bit of a byte, modulo 256, in eight lanes of
/// one number.
fn counts_up_to(byte: u8, count: u8) -> [u8; 8] {
    const TOPS: u64 = ONES << 7;
    // Lane k keeps bit k; adding 0x80 minus that bit carries it to the lane's top.
    let bits = (ONES * u64::from(byte)) & 0x8040_2010_0804_0201;
    let ones = (bits + 0x0040_6070_787c_7e7f) >> 7 & ONES;
    let sums = ones.wrapping_mul(ONES);
    // Sums are at most 8, so only the tops of `count` could carry into the next lane.
    let start = ONES * u64::from(count);
    ((sums + (start & !TOPS)) ^ (start & TOPS)).to_le_bytes()
}

/// Set pixels of the blocks of a silhouette, as it is and rotated by 180 degrees.
fn sketch<'m>(spec: &CanonicalSpec, words: &[Word], out: &'m mut [u8]) -> [&'m [u8]; 2] {
    let (straight, rotated) = out.split_at_mut_checked(blocks(spec)).unwrap_or_default();
    let row_words = spec.size() / WORD_BITS;
    // Words of a row of blocks, and bytes: a word is two blocks wide.
    let (step, width) = (BLOCK * row_words, 2 * row_words);
    for row in 0..spec.size() / BLOCK {
        let rows = |length: usize| row * length..(row + 1) * length;
        let (words, counts) = (words.get(rows(step)), straight.get_mut(rows(width)));
        let (Some(words), Some(counts)) = (words, counts) else {
            break;
        };
        for (column, two) in counts.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            *two = counts_of_two(words, column, row_words).map(at_most_255);
        }
    }
    for (to, from) in rotated.iter_mut().zip(straight.iter().rev()) {
        *to = *from;
    }
    [straight, rotated]
}

/// Set pixels of two blocks beside each other: of the words of a row of blocks, one column.
#[inline(always)]
fn counts_of_two(words: &[Word], column: usize, row_words: usize) -> [u16; 2] {
    let column = words.iter().skip(column).step_by(row_words.max(1));
    let halves: Word = column.map(|&word| ones_of_halves(word)).sum();
    [halves as u16, (halves >> 16) as u16]
}

/// Bits set in the lower and in the upper half of a word, in its lower and upper half.
fn ones_of_halves(word: Word) -> Word {
    let twos = word - (word >> 1 & 0x5555_5555);
    let fours = (twos & 0x3333_3333) + (twos >> 2 & 0x3333_3333);
    let eights = (fours + (fours >> 4)) & 0x0f0f_0f0f;
    (eights + (eights >> 8)) & 0x00ff_00ff
}

/// Bounds of views whose sketches follow one another, `stride` bytes each: `base` and how far they are from what
/// [`Query::sketch_for`] gathered.
pub(super) fn bound(
    gathered: &[u8],
    sketches: &[u8],
    stride: usize,
    base: u32,
    kernels: &Kernels,
    bounds: &mut [u32],
) {
    if gathered.is_empty() {
        bounds.fill(base);
    } else {
        (kernels.distances)(gathered, sketches, stride, base, bounds);
    }
}

/// Bytes of a gathered sketch at most.
pub(super) const fn longest_sketch(spec: &CanonicalSpec) -> usize {
    blocks(spec).next_multiple_of(STRIDE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn pixels_before_are_counted(words in proptest::collection::vec(
            prop_oneof![Just(0), Just(Word::MAX), any::<Word>()], 1..40
        )) {
            let mut table = std::vec![9; words.len() * WORD_BITS + 1];
            count_before(words.iter().copied(), &mut table);
            let mut count = 0u8;
            for (at, &before) in table.iter().enumerate() {
                prop_assert_eq!(before, count, "{}", at);
                let bit = words.get(at / WORD_BITS).map_or(0, |word| word >> (at % WORD_BITS) & 1);
                count = count.wrapping_add(bit as u8);
            }
        }

        #[test]
        fn halves_are_counted(word in any::<Word>()) {
            let counts = ones_of_halves(word);
            prop_assert_eq!(counts & 0xffff, (word & 0xffff).count_ones());
            prop_assert_eq!(counts >> 16, (word >> 16).count_ones());
        }
    }
}
