//! DICOM: X-ray frames, one or several.
//!
//! Read: uncompressed little endian (implicit and explicit), big endian and deflated; RLE; JPEG baseline,
//! extended (8 bits) and lossless; JPEG 2000 with and without loss. MONOCHROME1 and 2 of 8 to 16 bits, RGB and full YBR
//! of 8 bits.
//!
//! # What happens to pixel values
//! * Stored values are kept: rescale slope and intercept are **not** applied to pixels. They are applied backwards
//!   to the window, which the file states in rescaled units, so that [`Window`](crate::Window) is in units of the
//!   pixels that are handed out.
//! * Signed pixels are moved up by half their range, the window with them.
//! * MONOCHROME1 (high is dark) is inverted within its bits stored, the window with it; a negative rescale slope
//!   inverts once more, since it is the rescaled value that is shown.
//! * Bits above the stored ones (overlays, padding) are masked off; 8 or fewer bits stored give bytes.
//!
//! In enhanced multi-frame objects windows, rescaling and geometry stand in functional groups: a frame's own counts
//! first, then what all frames share, then the top level.
//!
//! # Where the bytes are trusted
//! [`structure`] walks the data set and checks each length against the bytes that are there. Only the few small
//! elements of [`attributes`] reach the library, which reserves what a length field says; pixel data is read in
//! place.

// In the order of the data.
mod problem;
mod tags;

mod syntax;

mod element;
mod functional;
mod structure;

mod attributes;

mod encapsulated;
mod pixels;
mod rle;

use std::borrow::Cow;
use std::ops::Range;

use crate::error::Problem;
use crate::frame::GreyFrame;
use attributes::Attributes;
use problem::damaged;
use structure::PixelData;
use syntax::{Coding, Syntax};

/// A DICOM file whose structure and attributes have been checked; frames are decoded when asked for.
pub(crate) struct Dicom {
    attributes: Attributes,
    /// Attributes of each frame, where functional groups state them.
    per_frame: Vec<Attributes>,
    coding: Coding,
    big_endian: bool,
    source: Source,
}

/// Where the frames' bytes are.
enum Source {
    /// All frames one after the other in this range.
    Native { range: Range<usize>, words: bool },
    /// A list of fragments for each frame.
    Encapsulated(Vec<Vec<Range<usize>>>),
}

impl Dicom {
    /// Checks a whole file. A deflated data set replaces `bytes` by what it grows to.
    pub(crate) fn open(bytes: &mut Cow<'_, [u8]>) -> Result<Self, Problem> {
        let meta = structure::read_meta(bytes)?;
        let syntax = Syntax::of(&meta.transfer_syntax)?;
        let start = match syntax.deflated {
            true => {
                *bytes = Cow::Owned(structure::inflate(&bytes[meta.end..])?);
                0
            }
            false => meta.end,
        };
        let data_set = structure::walk(bytes, start, &syntax)?;
        let attributes = Attributes::read(&data_set.wanted, &syntax)?;
        attributes.check(syntax.coding)?;
        let per_frame = attributes.of_frames(&data_set.shared, &data_set.per_frame, &syntax)?;
        let source = match data_set.pixels {
            PixelData::Native { range, words } => {
                Source::native(range, words, &attributes, syntax.coding)?
            }
            PixelData::Fragments { offsets, fragments } => Source::Encapsulated(
                encapsulated::frames(bytes, &offsets, fragments, &attributes, syntax.coding)?,
            ),
        };
        Ok(Self {
            attributes,
            per_frame,
            coding: syntax.coding,
            big_endian: syntax.big_endian,
            source,
        })
    }

    /// How many frames there are.
    pub(crate) fn count(&self) -> usize {
        self.attributes.frames
    }

    /// Frames a second, where the file states them and they are even.
    pub(crate) fn frames_per_s(&self) -> Option<f64> {
        self.attributes.frames_per_s
    }

    /// Decodes frame `index`, below [`Self::count`]; `bytes` are those that [`Self::open`] left.
    pub(crate) fn frame(&self, bytes: &[u8], index: usize) -> Result<GreyFrame, Problem> {
        let attributes = self.per_frame.get(index).unwrap_or(&self.attributes);
        match &self.source {
            Source::Native { range, words } => {
                let size = attributes.native_frame_bytes();
                let start = range.start + index * size;
                let stored = bytes.get(start..start + size).unwrap_or_default();
                let ordered = native_order(stored, self.big_endian, *words, attributes);
                pixels::frame_from_stored(&ordered, attributes)
            }
            Source::Encapsulated(frames) => {
                let fragments = frames.get(index).map(Vec::as_slice).unwrap_or_default();
                let coded = join(bytes, fragments);
                encapsulated::decode(&coded, attributes, self.coding)
            }
        }
    }
}

impl Source {
    /// Uncompressed frames, if they are all there.
    fn native(
        range: Range<usize>,
        words: bool,
        attributes: &Attributes,
        coding: Coding,
    ) -> Result<Self, Problem> {
        if coding != Coding::Native {
            return Err(damaged(
                "it says its pixels are compressed and they are not",
            ));
        }
        let needed = attributes.native_frame_bytes() as u64 * attributes.frames as u64;
        let found = range.len() as u64;
        if found < needed {
            return Err(damaged(format!(
                "its frames need {needed} bytes of pixels and it holds {found}"
            )));
        }
        Ok(Self::Native { range, words })
    }
}

/// The bytes of some fragments, copied only if there are several.
fn join<'a>(bytes: &'a [u8], fragments: &[Range<usize>]) -> Cow<'a, [u8]> {
    let part = |range: &Range<usize>| bytes.get(range.clone()).unwrap_or_default();
    match fragments {
        [one] => Cow::Borrowed(part(one)),
        several => Cow::Owned(
            several
                .iter()
                .flat_map(|r| part(r).iter().copied())
                .collect(),
        ),
    }
}

/// Uncompressed pixels in little endian order. Big endian files store words, also those that hold two 8-bit
/// pixels.
fn native_order<'a>(
    stored: &'a [u8],
    big_endian: bool,
    words: bool,
    attributes: &Attributes,
) -> Cow<'a, [u8]> {
    if !big_endian || (attributes.bits_allocated == 8 && !words) {
        return Cow::Borrowed(stored);
    }
    let mut swapped = stored.to_vec();
    swapped
        .as_chunks_mut::<2>()
        .0
        .iter_mut()
        .for_each(|w| w.reverse());
    Cow::Owned(swapped)
}
