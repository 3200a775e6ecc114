//! TIFF: grey and palettes of 1 to 64 bits, colour of 8 bits and more, whole numbers and floating point; several pages.
//!
//! Pages without compression, and with deflate, LZW, PackBits, fax codes of groups 3 and 4 and JPEG. White-is-zero pages are returned with
//! black at 0. Signed pixels are moved up by half their range. Pages of floating point or more than 16 bits with
//! numbers that are not whole or do not fit 16 bits are mapped linearly from their own smallest and largest finite value to 0 and 65535 (NaN becomes
//! 0), and the frame's notes say so. Palettes become luminance. Thumbnails (reduced pages) are left out.

mod problem;

mod directory;

mod overlay;

mod samples;

mod jpeg_pages;

mod fax_pages;

use tiff::ColorType;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, can_hold, checked_area};
use crate::limits::MAX_SIDE;
pub(crate) use directory::Page;
use overlay::{Overlaid, Reader};
use problem::{FORMAT, REMEDY, damaged, failed};
use samples::Layout;

/// Most bytes of one decoded page: colour of 16 bits with transparency.
const MAX_PAGE_BYTES: usize = 8 * (MAX_SIDE as usize).pow(2);

/// Value of the PlanarConfiguration field: all of the first colour, then all of the second.
const SEPARATE_PLANES: u16 = 2;

fn open<'a>(bytes: &'a [u8], page: &Page) -> Result<Reader<'a>, Problem> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_PAGE_BYTES;
    limits.intermediate_buffer_size = MAX_PAGE_BYTES;
    let decoder = Decoder::new(Overlaid::new(bytes, page)).map_err(|e| failed(page.number, e))?;
    Ok(decoder.with_limits(limits))
}

/// The directories that hold frames, in the file's order; each has been checked for its size.
pub(crate) fn pages(bytes: &[u8]) -> Result<Vec<Page>, Problem> {
    directory::pages(bytes)
}

/// Whether every strip or tile lies inside the file, because the decoder may otherwise pass over a missing end, and on
/// bytes of its own, because a small file would otherwise take long.
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
        // Each lies in the file, so that the sum of fewer than it has bytes does not overflow.
        if counts.iter().sum::<u64>() > file as u64 {
            return Err(damaged(page, "its strips or tiles lie upon each other"));
        }
    }
    Ok(())
}

/// Decodes one of the [`pages`].
pub(crate) fn decode(bytes: &[u8], page: &Page) -> Result<GreyFrame, Problem> {
    let number = page.number;
    let mut decoder = open(bytes, page)?;
    let (width, height) = decoder.dimensions().map_err(|e| failed(number, e))?;
    let area = checked_area(width.into(), height.into())?;
    let color = decoder.colortype().map_err(|e| failed(number, e))?;
    let bits = u64::from(color.bit_depth()) * u64::from(color.num_samples());
    if !can_hold(bytes.len(), area, bits) {
        return Err(damaged(number, "the file is too short for its stated size"));
    }
    check_extents(&mut decoder, number, bytes.len())?;
    let mut notes = Vec::new();
    let compression = decoder.find_tag_unsigned::<u16>(Tag::Compression);
    let pixels = match compression.map_err(|e| failed(number, e))? {
        Some(jpeg_pages::JPEG) => {
            let size = (width as usize, height as usize);
            jpeg_pages::grey(&mut decoder, bytes, number, size)?
        }
        Some(fax_pages::RUN_LENGTHS | fax_pages::GROUP_3) if is_fax(&mut decoder, color) => {
            let size = (width as usize, height as usize);
            fax_pages::grey(&mut decoder, bytes, number, size)?
        }
        _ if page.palette_as_grey.is_some() => {
            of_palette(&mut decoder, number, color, width as usize)?
        }
        _ => {
            let (samples, layout) = stored(&mut decoder, number, color, area)?;
            samples::grey(samples, layout, width as usize, &mut notes)?
        }
    };
    if pixels.len() != area {
        return Err(damaged(number, "its pixels do not fill its stated size"));
    }
    let mut frame = GreyFrame::plain(width, height, pixels);
    let orientation = decoder.find_tag_unsigned::<u32>(Tag::Orientation);
    if let Some(orientation @ 2..=8) = orientation.map_err(|e| failed(number, e))? {
        notes.push(format!(
            "The file asks to be shown rotated or mirrored (orientation {orientation}); it is shown as stored."
        ));
    }
    frame.notes = notes;
    Ok(frame)
}

/// Whether a page is one that fax codes are for: black and white, in strips.
fn is_fax(decoder: &mut Reader<'_>, color: ColorType) -> bool {
    color == ColorType::Gray(1) && decoder.get_chunk_type() == ChunkType::Strip
}

/// The samples of a page, and how they are stored.
fn stored(
    decoder: &mut Reader<'_>,
    page: usize,
    color: ColorType,
    area: usize,
) -> Result<(DecodingResult, Layout), Problem> {
    let layout = channels(color)?;
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration);
    let separate = planes.map_err(|e| failed(page, e))? == Some(SEPARATE_PLANES);
    match layout {
        // The library ends the program at some of them.
        Layout::Channels(2..) if separate && decoder.get_chunk_type() == ChunkType::Tile => {
            let what = "colours stored one after the other in tiles";
            Err(Problem::unsupported(FORMAT, what, REMEDY))
        }
        Layout::Channels(channels @ 2..) if separate => {
            let mut samples = DecodingResult::U8(Vec::new());
            decoder
                .read_image_to_buffer(&mut samples)
                .map_err(|e| failed(page, e))?;
            Ok((samples, Layout::Planes(channels, area)))
        }
        _ => Ok((decoder.read_image().map_err(|e| failed(page, e))?, layout)),
    }
}

/// Greys of a page of numbers of colours.
fn of_palette(
    decoder: &mut Reader<'_>,
    page: usize,
    color: ColorType,
    width: usize,
) -> Result<Pixels, Problem> {
    let palette = decoder.find_tag_unsigned_vec::<u16>(Tag::ColorMap);
    let palette = palette.map_err(|e| failed(page, e))?.unwrap_or_default();
    let samples = decoder.read_image().map_err(|e| failed(page, e))?;
    let numbers = match (color, samples) {
        (ColorType::Gray(bits @ (1 | 2 | 4)), DecodingResult::U8(packed)) => {
            Pixels::U8(samples::unpack(&packed, bits, width))
        }
        (ColorType::Gray(8), DecodingResult::U8(numbers)) => Pixels::U8(numbers),
        (ColorType::Gray(16), DecodingResult::U16(numbers)) => Pixels::U16(numbers),
        _ => {
            return Err(Problem::unsupported(
                FORMAT,
                "a palette of a rare kind",
                REMEDY,
            ));
        }
    };
    samples::colours(&numbers, &palette)
}

fn channels(color: ColorType) -> Result<Layout, Problem> {
    match color {
        ColorType::Gray(bits @ (1 | 2 | 4)) => Ok(Layout::Packed(bits)),
        ColorType::Gray(8 | 16 | 32 | 64) => Ok(Layout::Channels(1)),
        ColorType::GrayA(8 | 16 | 32 | 64) => Ok(Layout::Channels(2)),
        ColorType::RGB(8 | 16 | 32 | 64) => Ok(Layout::Channels(3)),
        ColorType::RGBA(8 | 16 | 32 | 64) => Ok(Layout::Channels(4)),
        // Grey and what is beside it, mostly transparency.
        ColorType::Multiband {
            bit_depth: 8 | 16 | 32 | 64,
            num_samples: 2,
        } => Ok(Layout::Channels(2)),
        other => {
            let what = format!("pixels of the kind {other:?}");
            Err(Problem::unsupported(FORMAT, what, REMEDY))
        }
    }
}
