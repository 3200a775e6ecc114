//! TIFF: 1 to 16 bits grey, 8 and 16 bits colour, floating point; several pages.
//!
//! Pages without compression, and with deflate, LZW and PackBits. White-is-zero pages are returned with black at 0. Signed
//! pixels are moved up by half their range. Floating point pixels are mapped linearly from the page's own smallest and
//! largest finite value to 0 and 65535 (NaN becomes 0), and the frame's notes say so. Thumbnails (reduced pages) are left
//! out.

mod directory;
mod problem;

use std::io::Cursor;

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, can_hold, checked_area};
use crate::limits::MAX_SIDE;
use crate::luminance::{grey_from_u8, grey_from_u16};
use problem::{FORMAT, damaged};

const REMEDY: &str = "Save it as 8- or 16-bit grey";

/// Most bytes of one decoded page: colour of 16 bits with transparency.
const MAX_PAGE_BYTES: usize = 8 * (MAX_SIDE as usize).pow(2);

/// Value of the PlanarConfiguration field: all of the first colour, then all of the second.
const SEPARATE_PLANES: u16 = 2;

/// Bit of the NewSubfileType field: a smaller copy of another page.
const REDUCED_COPY: u32 = 1;

type Reader<'a> = Decoder<Cursor<&'a [u8]>>;

fn failed(page: usize, error: tiff::TiffError) -> Problem {
    match error {
        tiff::TiffError::UnsupportedError(what) => {
            let what = format!("a rare variant on page {} ({what})", page + 1);
            Problem::unsupported(FORMAT, what, REMEDY)
        }
        other => damaged(page, other),
    }
}

fn open(bytes: &[u8]) -> Result<Reader<'_>, Problem> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_PAGE_BYTES;
    limits.intermediate_buffer_size = MAX_PAGE_BYTES;
    let decoder = Decoder::new(Cursor::new(bytes)).map_err(|e| failed(0, e))?;
    Ok(decoder.with_limits(limits))
}

/// The directories that hold frames, in the file's order; each has been checked for its size.
pub(crate) fn pages(bytes: &[u8]) -> Result<Vec<usize>, Problem> {
    directory::check(bytes)?;
    let mut decoder = open(bytes)?;
    let mut pages = Vec::new();
    for index in 0.. {
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType);
        let reduced = kind.map_err(|e| failed(index, e))?.unwrap_or(0) & REDUCED_COPY != 0;
        if !reduced {
            let (width, height) = decoder.dimensions().map_err(|e| failed(index, e))?;
            checked_area(width.into(), height.into())?;
            pages.push(index);
        }
        if !decoder.more_images() {
            break;
        }
        decoder.next_image().map_err(|e| failed(index + 1, e))?;
    }
    match pages.is_empty() {
        true => Err(Problem::damaged(FORMAT, "it has no full-size page")),
        false => Ok(pages),
    }
}

/// Whether every strip or tile lies inside the file: the decoder may otherwise pass over a missing end.
fn check_extents(decoder: &mut Reader<'_>, page: usize, file: usize) -> Result<(), Problem> {
    let pairs = [
        (Tag::StripOffsets, Tag::StripByteCounts),
        (Tag::TileOffsets, Tag::TileByteCounts),
    ];
    for (offsets, counts) in pairs {
        let mut list = |tag| {
            decoder
                .find_tag_unsigned_vec::<u64>(tag)
                .map_err(|e| failed(page, e))
        };
        let (Some(offsets), Some(counts)) = (list(offsets)?, list(counts)?) else {
            continue;
        };
        let fits = |(&offset, &count): (&u64, &u64)| {
            offset
                .checked_add(count)
                .is_some_and(|end| end <= file as u64)
        };
        if !offsets.iter().zip(&counts).all(fits) {
            return Err(damaged(page, "its pixels lie beyond the end of the file"));
        }
    }
    Ok(())
}

/// Decodes the directory with this index (one of [`pages`]).
pub(crate) fn decode(bytes: &[u8], page: usize) -> Result<GreyFrame, Problem> {
    let mut decoder = open(bytes)?;
    decoder.seek_to_image(page).map_err(|e| failed(page, e))?;
    let (width, height) = decoder.dimensions().map_err(|e| failed(page, e))?;
    let area = checked_area(width.into(), height.into())?;
    let color = decoder.colortype().map_err(|e| failed(page, e))?;
    let bits = u64::from(color.bit_depth()) * u64::from(color.num_samples());
    if !can_hold(bytes.len(), area, bits) {
        return Err(damaged(page, "the file is too short for its stated size"));
    }
    let layout = channels(color)?;
    check_extents(&mut decoder, page, bytes.len())?;
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration);
    if color.num_samples() > 1 && planes.map_err(|e| failed(page, e))? == Some(SEPARATE_PLANES) {
        let what = "colours stored one after the other";
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    let samples = decoder.read_image().map_err(|e| failed(page, e))?;

    let mut notes = Vec::new();
    let pixels = grey(samples, layout, width as usize, &mut notes)?;
    if pixels.len() != area {
        return Err(damaged(page, "its pixels do not fill its stated size"));
    }
    let mut frame = GreyFrame::plain(width, height, pixels);
    let orientation = decoder.find_tag_unsigned::<u32>(Tag::Orientation);
    if let Some(orientation @ 2..=8) = orientation.map_err(|e| failed(page, e))? {
        notes.push(format!(
            "The file asks to be shown rotated or mirrored (orientation {orientation}); it is shown as stored."
        ));
    }
    frame.notes = notes;
    Ok(frame)
}

/// How the samples of a page are stored.
#[derive(Clone, Copy)]
enum Layout {
    /// Grey of 1, 2 or 4 bits, packed, each row beginning at a byte.
    Packed(u8),
    /// This number of whole samples for each pixel.
    Channels(usize),
}

fn channels(color: ColorType) -> Result<Layout, Problem> {
    match color {
        ColorType::Gray(bits @ (1 | 2 | 4)) => Ok(Layout::Packed(bits)),
        ColorType::Gray(8 | 16 | 32 | 64) => Ok(Layout::Channels(1)),
        ColorType::GrayA(8 | 16) => Ok(Layout::Channels(2)),
        ColorType::RGB(8 | 16) => Ok(Layout::Channels(3)),
        ColorType::RGBA(8 | 16) => Ok(Layout::Channels(4)),
        other => {
            let what = format!("pixels of the kind {other:?}");
            Err(Problem::unsupported(FORMAT, what, REMEDY))
        }
    }
}

fn grey(
    samples: DecodingResult,
    layout: Layout,
    width: usize,
    notes: &mut Vec<String>,
) -> Result<Pixels, Problem> {
    let channels = match layout {
        Layout::Packed(bits) => {
            let DecodingResult::U8(packed) = samples else {
                return Err(Problem::damaged(
                    FORMAT,
                    "its bits are packed in an unknown way",
                ));
            };
            return Ok(Pixels::U8(unpack(&packed, bits, width)));
        }
        Layout::Channels(channels) => channels,
    };
    Ok(match samples {
        DecodingResult::U8(s) => Pixels::U8(grey_from_u8(&s, channels)),
        DecodingResult::U16(s) => Pixels::U16(grey_from_u16(s.into_iter(), channels)),
        DecodingResult::I8(s) => {
            notes.push("Signed pixels were moved up by 128.".to_owned());
            let moved: Vec<u8> = s.iter().map(|v| v.cast_unsigned() ^ 0x80).collect();
            Pixels::U8(grey_from_u8(&moved, channels))
        }
        DecodingResult::I16(s) => {
            notes.push("Signed pixels were moved up by 32768.".to_owned());
            let moved = s.into_iter().map(|v| v.cast_unsigned() ^ 0x8000);
            Pixels::U16(grey_from_u16(moved, channels))
        }
        DecodingResult::F32(s) => floats(s.iter().map(|&v| f64::from(v)), notes),
        DecodingResult::F64(s) => floats(s.iter().copied(), notes),
        _ => {
            let what = "whole numbers of more than 16 bits or half-precision pixels";
            return Err(Problem::unsupported(FORMAT, what, REMEDY));
        }
    })
}

/// Grey of fewer than 8 bits, spread over 0 to 255.
fn unpack(packed: &[u8], bits: u8, width: usize) -> Vec<u8> {
    let each = 8 / usize::from(bits);
    let most = (1u16 << bits) - 1;
    let row = |row: &[u8]| -> Vec<u8> {
        let value = |i: usize| {
            let shift = 8 - usize::from(bits) * (i % each + 1);
            (u16::from(row[i / each] >> shift) & most) * 255 / most
        };
        (0..width).map(|i| value(i) as u8).collect()
    };
    packed
        .chunks_exact(width.div_ceil(each))
        .flat_map(row)
        .collect()
}

/// Maps smallest to largest finite value linearly onto 0 to 65535, and says so.
fn floats(values: impl Iterator<Item = f64> + Clone, notes: &mut Vec<String>) -> Pixels {
    let finite = values.clone().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let scale = match high > low {
        // Halves first: the difference of two finite numbers may be infinite.
        true => 65535.0 / 2.0 / (high / 2.0 - low / 2.0),
        false => 0.0,
    };
    notes.push(format!(
        "Floating point pixels from {low} to {high} were mapped linearly to 0 to 65535."
    ));
    // A float to integer cast saturates and takes NaN to 0.
    let map = |v: f64| ((v - low) * scale).round() as u16;
    Pixels::U16(values.map(map).collect())
}
