//! DICOM: X-ray frames, one or several.
//!
//! Read: uncompressed little endian (implicit and explicit), big endian and deflated; RLE; JPEG baseline, extended (8 and
//! 12 bits) and lossless; JPEG-LS and JPEG 2000 with and without loss. MONOCHROME1 and 2 of 1 and of 8 to 32 bits,
//! palettes, RGB and full YBR of 8 and 16 bits. With and without preamble, and without the group that names the syntax
//! where the content proves it ([`start`]).
//!
//! # What happens to pixel values
//! * Stored values are kept: rescale slope and intercept are **not** applied to pixels. They are applied backwards
//!   to the window, which the file states in rescaled units, so that [`Window`](crate::Window) is in units of the
//!   pixels that are handed out.
//! * Signed pixels are moved up by half their range, the window with them.
//! * MONOCHROME1 (high is dark) is inverted within its bits stored, the window with it; a negative rescale slope
//!   inverts once more, since it is the rescaled value that is shown.
//! * Bits above the stored ones (overlays, padding) are masked off; 8 or fewer bits stored give bytes. Overlays of their
//!   own and tables of meaningful values (modality LUT) are not applied; a note tells of the latter.
//! * Behind a shutter pixels are as stored; [`GreyFrame::shutter`] tells where that is.
//! * Of more than 16 bits, the highest 16 that the values of the file's frames use are kept, the same in all frames.
//!
//! In enhanced multi-frame objects windows, rescaling and geometry stand in functional groups: a frame's own counts
//! first, then what all frames share, then the top level.
//!
//! # Where the bytes are trusted
//! [`structure`] walks the data set and checks each length against the bytes that are there. Values and pixels are read
//! where they lie, so that nothing is reserved for what a length field says.

// In the order of the data.
mod problem;
mod tags;

mod element;
mod syntax;

mod start;

mod values;

mod functional;
mod structure;

mod palette;
mod shutter;

mod attributes;
mod rate;

mod shown;

mod native;
mod pixels;
mod rle;

mod encapsulated;

use std::borrow::Cow;
use std::ops::Range;

use crate::error::Problem;
use crate::frame::GreyFrame;
use attributes::{Attributes, Narrowing};
use native::Native;
use pixels::Stored;
use problem::damaged;
pub(crate) use start::is_dicom;
use structure::{DataSet, PixelData};
use syntax::Coding;
use values::Values;

/// A DICOM file whose structure and attributes have been checked; frames are decoded when asked for.
pub(crate) struct Dicom {
    attributes: Attributes,
    /// Attributes of each frame, where functional groups state them.
    per_frame: Vec<Attributes>,
    frames_per_s: Option<f64>,
    instance_number: Option<f64>,
    coding: Coding,
    source: Source,
}

/// Where the frames' bytes are.
enum Source {
    Native(Native),
    /// A list of fragments for each frame.
    Encapsulated(Vec<Vec<Range<usize>>>),
}

impl Dicom {
    /// Checks a whole file. A deflated data set replaces `bytes` by what it grows to.
    pub(crate) fn open(bytes: &mut Cow<'_, [u8]>) -> Result<Self, Problem> {
        let mut start = start::of(bytes)?;
        if start.syntax.deflated {
            *bytes = Cow::Owned(structure::inflate(&bytes[start.at..])?);
            start.at = 0;
        }
        let data_set = structure::walk(bytes, start.at, &start.syntax)?;
        let coding = encapsulated::coding(bytes, &data_set.pixels, start.syntax.coding);
        let attributes = Attributes::read(bytes, &data_set, coding)?;
        attributes.check(coding)?;
        let mut dicom = Self {
            per_frame: attributes.of_frames(bytes, &data_set),
            frames_per_s: rate::frames_per_s(bytes, &data_set),
            instance_number: Values {
                bytes,
                found: &data_set.wanted,
            }
            .finite(tags::INSTANCE_NUMBER),
            source: Source::of(
                bytes,
                data_set,
                &attributes,
                coding,
                start.syntax.big_endian,
            )?,
            attributes,
            coding,
        };
        dicom.narrow(bytes)?;
        Ok(dicom)
    }

    /// How many frames there are.
    pub(crate) fn count(&self) -> usize {
        self.attributes.frames
    }

    /// Frames a second, where the file states them and they are even.
    pub(crate) fn frames_per_s(&self) -> Option<f64> {
        self.frames_per_s
    }

    /// The place in its series, where the file states it.
    pub(crate) fn instance_number(&self) -> Option<f64> {
        self.instance_number
    }

    /// Width and height of frame `index`, pixels.
    pub(crate) fn size(&self, index: usize) -> (u32, u32) {
        let attributes = self.per_frame.get(index).unwrap_or(&self.attributes);
        (attributes.width, attributes.height)
    }

    /// Decodes frame `index`, below [`Self::count`]; `bytes` are those that [`Self::open`] left.
    pub(crate) fn frame(&self, bytes: &[u8], index: usize) -> Result<GreyFrame, Problem> {
        let attributes = self.per_frame.get(index).unwrap_or(&self.attributes);
        match (&self.source, self.coding) {
            (Source::Encapsulated(frames), Coding::Jpeg | Coding::Jpeg2000) => {
                let coded = join(bytes, frames.get(index));
                encapsulated::decode(&coded, attributes, self.coding)
            }
            (Source::Encapsulated(_), _) => {
                // Run lengths give interleaved samples whatever the file says of its planes.
                let interleaved = Attributes {
                    planar: false,
                    ..attributes.clone()
                };
                pixels::frame_from_stored(&self.stored(bytes, index)?, &interleaved)
            }
            (Source::Native(_), _) => {
                pixels::frame_from_stored(&self.stored(bytes, index)?, attributes)
            }
        }
    }

    /// The samples of a frame that are uncompressed or in run lengths.
    fn stored<'a>(&self, bytes: &'a [u8], index: usize) -> Result<Stored<'a>, Problem> {
        let (bytes, skipped) = match &self.source {
            Source::Native(native) => native.frame(bytes, index, &self.attributes),
            Source::Encapsulated(frames) => {
                let coded = join(bytes, frames.get(index));
                (rle::decode_frame(&coded, &self.attributes)?.into(), 0)
            }
        };
        Ok(Stored { bytes, skipped })
    }

    /// Chooses which bits of greys of more than 16 are handed out: those that the values of all frames use.
    fn narrow(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        if self.attributes.bits_stored <= 16 {
            return Ok(());
        }
        let (mut low, mut high) = (u32::MAX, 0);
        for index in 0..self.count() {
            let extent = pixels::extent(&self.stored(bytes, index)?, &self.attributes);
            (low, high) = (low.min(extent.0), high.max(extent.1));
        }
        // Values without sign are kept as they are, as far as they fit.
        let low = if self.attributes.signed { low } else { 0 };
        let used = 32 - high.saturating_sub(low).leading_zeros();
        let narrowing = Narrowing {
            low,
            shift: used.saturating_sub(16),
        };
        for attributes in self.per_frame.iter_mut().chain([&mut self.attributes]) {
            attributes.narrowing = narrowing;
            attributes.depth = used.clamp(1, 16) as u16;
        }
        Ok(())
    }
}

impl Source {
    fn of(
        bytes: &[u8],
        data_set: DataSet,
        attributes: &Attributes,
        coding: Coding,
        big_endian: bool,
    ) -> Result<Self, Problem> {
        match data_set.pixels {
            PixelData::Native { .. } if coding != Coding::Native => Err(damaged(
                "it says its pixels are compressed and they are not",
            )),
            PixelData::Native { range, words } => {
                Native::new(range, words, big_endian, attributes).map(Self::Native)
            }
            PixelData::Fragments { offsets, fragments } => {
                encapsulated::frames(bytes, &offsets, fragments, attributes, coding)
                    .map(Self::Encapsulated)
            }
        }
    }
}

/// The bytes of some fragments, copied only if there are several.
fn join<'a>(bytes: &'a [u8], fragments: Option<&Vec<Range<usize>>>) -> Cow<'a, [u8]> {
    let part = |range: &Range<usize>| bytes.get(range.clone()).unwrap_or_default();
    match fragments.map(Vec::as_slice).unwrap_or_default() {
        [one] => Cow::Borrowed(part(one)),
        several => Cow::Owned(
            several
                .iter()
                .flat_map(|r| part(r).iter().copied())
                .collect(),
        ),
    }
}
