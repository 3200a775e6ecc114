//! Uncompressed samples: where a frame's bytes are, and their numbers.

use std::borrow::Cow;
use std::ops::Range;

use super::attributes::Attributes;
use super::problem::damaged;
use crate::error::Problem;

/// All frames one after the other.
pub(super) struct Native {
    range: Range<usize>,
    /// Stored as 16-bit words with the high byte first, whatever a sample's bits.
    swapped: bool,
}

impl Native {
    /// Where the frames are, if they are all there.
    pub(super) fn new(
        range: Range<usize>,
        words: bool,
        big_endian: bool,
        attributes: &Attributes,
    ) -> Result<Self, Problem> {
        let needed = (attributes.native_frame_bits() * attributes.frames as u64).div_ceil(8);
        let found = range.len() as u64;
        match found < needed {
            true => Err(damaged(format!(
                "its frames need {needed} bytes of pixels and it holds {found}"
            ))),
            false => Ok(Self {
                range,
                swapped: big_endian && (words || attributes.bits_allocated > 8),
            }),
        }
    }

    /// The bytes of a frame in little endian order, and how many bits of the first are another frame's.
    pub(super) fn frame<'a>(
        &self,
        bytes: &'a [u8],
        index: usize,
        attributes: &Attributes,
    ) -> (Cow<'a, [u8]>, u32) {
        let bits = attributes.native_frame_bits();
        let first = bits * index as u64;
        // Within the pixels, whose number of bytes was checked.
        let (start, end) = ((first / 8) as usize, (first + bits).div_ceil(8) as usize);
        let pixels = bytes.get(self.range.clone()).unwrap_or_default();
        let skipped = (first % 8) as u32;
        if !self.swapped {
            return (
                Cow::Borrowed(pixels.get(start..end).unwrap_or_default()),
                skipped,
            );
        }
        let unit = if attributes.bits_allocated == 32 {
            4
        } else {
            2
        };
        // Frames of an odd number of bytes share a word with the next.
        let (from, to) = (
            start / unit * unit,
            end.next_multiple_of(unit).min(pixels.len()),
        );
        let mut ordered = pixels.get(from..to).unwrap_or_default().to_vec();
        ordered.chunks_exact_mut(unit).for_each(<[u8]>::reverse);
        ordered.drain(..start - from);
        ordered.truncate(end - start);
        (Cow::Owned(ordered), skipped)
    }
}

/// The single bits of some bytes, the lowest first, without the first `skipped`.
pub(super) fn bits(stored: &[u8], skipped: u32, count: usize) -> impl Iterator<Item = u32> {
    let all = stored
        .iter()
        .flat_map(|&byte| (0..8).map(move |bit| u32::from(byte >> bit & 1)));
    all.skip(skipped as usize).take(count)
}

/// Samples of two bytes.
pub(super) fn words(stored: &[u8]) -> impl Iterator<Item = u32> {
    stored
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&word| u16::from_le_bytes(word).into())
}

/// Samples of four bytes.
pub(super) fn long_words(stored: &[u8]) -> impl Iterator<Item = u32> {
    stored
        .as_chunks::<4>()
        .0
        .iter()
        .map(|&word| u32::from_le_bytes(word))
}
