//! The loops in which matching spends its time, behind one table of functions.
//!
//! The table here is portable. A crate that may look at the machine makes others of the same
//! functions, compiled for what it finds there; every table gives the same numbers.

use crate::image::mask::Word;

/// The kind of [`distances`].
pub type Distances = fn(&[u8], &[u8], usize, u32, &mut [u32]);
/// The kind of [`gap`].
pub type Gap = fn([&[u8]; 2], [&[u8]; 2]) -> u32;

/// The loops. All of them take slices of any length and look at the common part.
#[derive(Clone, Copy, Debug)]
pub struct Kernels {
    /// What they were compiled for.
    pub name: &'static str,
    /// See [`unmatched`].
    pub unmatched: fn(&[Word], &[u8]) -> u32,
    /// See [`distances`].
    pub distances: Distances,
    /// See [`gap`].
    pub gap: Gap,
}

impl Kernels {
    /// Compiled for every machine of the target.
    pub const PORTABLE: Self = Self {
        name: "portable",
        unmatched,
        distances,
        gap,
    };
}

impl Default for Kernels {
    fn default() -> Self {
        Self::PORTABLE
    }
}

/// Number of bits in which words and little-endian bytes differ, two words at a time.
#[inline(always)]
#[must_use]
pub fn unmatched(words: &[Word], bytes: &[u8]) -> u32 {
    let pairs = words
        .as_chunks::<2>()
        .0
        .iter()
        .zip(bytes.as_chunks::<8>().0);
    let differ = pairs.map(|(&[low, high], &eight)| {
        let ours = u64::from(high) << Word::BITS | u64::from(low);
        (ours ^ u64::from_le_bytes(eight)).count_ones()
    });
    differ.sum()
}

/// Bytes that are compared at a time: with their number known, compilers make one instruction of
/// eight differences and their sum where the machine has it. One loop over all bytes took five times
/// as long on x86-64, and blocks of 16 nine times as long with AVX2; written out by hand in AVX2 it was
/// a fifth faster.
const LANES: usize = 32;

/// Writes `base` and the sum of the bytes' differences between `sketch` and the beginning of each of the `sketches`,
/// which are `stride` bytes apart.
#[inline(always)]
pub fn distances(sketch: &[u8], sketches: &[u8], stride: usize, base: u32, out: &mut [u32]) {
    let ours = sketch.as_chunks::<LANES>();
    for (out, other) in out.iter_mut().zip(sketches.chunks_exact(stride.max(1))) {
        let other = other.get(..sketch.len()).unwrap_or_default();
        if cfg!(target_os = "none") {
            // A machine without wide instructions has nothing of blocks.
            *out = base + difference(sketch, other);
            continue;
        }
        let theirs = other.as_chunks::<LANES>();
        let lanes = ours.0.iter().zip(theirs.0).map(|(a, b)| difference(a, b));
        *out = base + lanes.sum::<u32>() + difference(ours.1, theirs.1);
    }
}

#[inline(always)]
fn difference(a: &[u8], b: &[u8]) -> u32 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
}

/// Sum over the bytes of the gap between two intervals, each `[low, high]`; 0 where they meet.
#[inline(always)]
#[must_use]
pub fn gap([low, high]: [&[u8]; 2], [other_low, other_high]: [&[u8]; 2]) -> u32 {
    if cfg!(target_os = "none") {
        return excess(low, high, other_low, other_high);
    }
    let (a, b) = (low.as_chunks::<LANES>(), high.as_chunks::<LANES>());
    let (c, d) = (
        other_low.as_chunks::<LANES>(),
        other_high.as_chunks::<LANES>(),
    );
    let lanes = a.0.iter().zip(b.0).zip(c.0.iter().zip(d.0));
    let lanes = lanes.map(|((a, b), (c, d))| excess(a, b, c, d));
    lanes.sum::<u32>() + excess(a.1, b.1, c.1, d.1)
}

/// What the higher of two lows exceeds the lower of two highs by; as a difference, for the same
/// instruction.
#[inline(always)]
fn excess(low: &[u8], high: &[u8], other_low: &[u8], other_high: &[u8]) -> u32 {
    let intervals = low.iter().zip(high).zip(other_low.iter().zip(other_high));
    let gaps = intervals.map(|((&low, &high), (&other_low, &other_high))| {
        let (low, high) = (low.max(other_low), high.min(other_high));
        u32::from(low.max(high).abs_diff(high))
    });
    gaps.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bitvec::prelude::{BitSlice, Lsb0};
    use proptest::prelude::*;

    properties! {
        #[test]
        fn words_count_what_bits_count(
            words in proptest::collection::vec(any::<u32>(), 64),
            bytes in proptest::collection::vec(any::<u8>(), 256)
        ) {
            let ours = BitSlice::<u32, Lsb0>::from_slice(&words);
            let theirs = BitSlice::<u8, Lsb0>::from_slice(&bytes);
            let naive = ours.iter().zip(theirs).filter(|(a, b)| **a != **b).count();
            prop_assert_eq!(unmatched(&words, &bytes) as usize, naive);
        }

        #[test]
        fn distances_are_sums_of_differences(
            length in 1..100usize,
            padding in 0..30usize,
            bytes in proptest::collection::vec(any::<u8>(), 500)
        ) {
            let (sketch, sketches) = bytes.split_at(length);
            let stride = length + padding;
            let mut out = [u32::MAX; 3];
            distances(sketch, sketches, stride, 7, &mut out);
            for (out, other) in out.iter().zip(sketches.chunks(stride)) {
                let naive: i32 = sketch
                    .iter()
                    .zip(other)
                    .map(|(&a, &b)| (i32::from(a) - i32::from(b)).abs())
                    .sum();
                prop_assert_eq!(*out, naive as u32 + 7);
            }
        }

        #[test]
        fn gaps_are_what_lies_between_intervals(
            intervals in proptest::collection::vec((any::<[u8; 2]>(), any::<[u8; 2]>()), 0..100)
        ) {
            let mut columns = [const { std::vec::Vec::new() }; 4];
            let mut naive = 0;
            for ([a, b], [c, d]) in intervals {
                let (ours, theirs) = ([a.min(b), a.max(b)], [c.min(d), c.max(d)]);
                let nearest = (ours[0]..=ours[1])
                    .flat_map(|x| [x.abs_diff(theirs[0]), x.abs_diff(theirs[1])])
                    .min();
                let meet = ours[0] <= theirs[1] && theirs[0] <= ours[1];
                naive += if meet { 0 } else { u32::from(nearest.expect("not empty")) };
                for (column, value) in columns.iter_mut().zip([ours, theirs].concat()) {
                    column.push(value);
                }
            }
            let [a, b, c, d] = &columns;
            prop_assert_eq!(gap([a, b], [c, d]), naive);
        }
    }
}
