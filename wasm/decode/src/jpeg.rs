//! JPEG: baseline, progressive and lossless, grey or colour.
//!
//! [`lossless`] is decoded here, the other processes by a library.
//!
//! The [`markers`] are walked before the decoder sees a byte: the decoder fills what is missing from a cut file with grey,
//! and a wrong measurement is worse than none. A rotation that the camera asks for (Exif) is not followed: pixels are as
//! stored.

mod lossless;
mod markers;

use jpeg_decoder::{Decoder, PixelFormat};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, checked_area};
use crate::luminance::{ComponentColours, grey_from_u8, luminance};
use markers::{FORMAT, Header, REMEDY, cut, walk};

/// Process number of lossless coding, which takes at least a bit for each pixel.
const LOSSLESS: u8 = 3;

/// Pixels of a block of the other codings, which take at least a bit for each block.
const BLOCK: usize = 64;

/// Walks the markers and refuses what the decoder does not do.
fn checked_header(bytes: &[u8]) -> Result<Header, Problem> {
    let header = walk(bytes)?;
    let area = checked_area(header.width.into(), header.height.into())?;
    if header.process > LOSSLESS {
        let what = "a rare coding (hierarchical or arithmetic)";
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    if header.process != LOSSLESS && header.precision != 8 {
        let what = format!("{}-bit lossy pixels", header.precision);
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    if !matches!(header.components, 1 | 3) {
        let what = format!("{} colour channels", header.components);
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    let least_bits = match header.process {
        LOSSLESS => area,
        _ => area / BLOCK,
    };
    match least_bits / 8 > bytes.len() {
        true => Err(cut("it is too short for its stated size")),
        false => Ok(header),
    }
}

/// Checks the markers: whether this is one whole image of a kind and size that is read.
pub(crate) fn check(bytes: &[u8]) -> Result<(), Problem> {
    checked_header(bytes).map(drop)
}

/// Decodes the image.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    decode_with(bytes, ComponentColours::Rgb)
}

/// Decodes the image. `colour` says what the three components of a lossless image are, which its markers do not.
pub(crate) fn decode_with(bytes: &[u8], colour: ComponentColours) -> Result<GreyFrame, Problem> {
    let header = checked_header(bytes)?;
    let (width, height) = (u32::from(header.width), u32::from(header.height));
    let area = checked_area(width.into(), height.into())?;
    let pixels = match header.process {
        LOSSLESS => lossless_pixels(bytes, header.precision, colour)?,
        _ => lossy_pixels(bytes, area)?,
    };
    if pixels.len() != area {
        return Err(cut("its pixels do not fill its stated size"));
    }
    let mut frame = GreyFrame::plain(width, height, pixels);
    frame.bits = match frame.pixels {
        Pixels::U8(_) => header.precision.min(8),
        Pixels::U16(_) => header.precision.clamp(9, 16),
    };
    Ok(frame)
}

fn lossy_pixels(bytes: &[u8], area: usize) -> Result<Pixels, Problem> {
    let mut decoder = Decoder::new(bytes);
    decoder.set_max_decoding_buffer_size(3 * 2 * area);
    let samples = decoder.decode().map_err(|e| cut(&e.to_string()))?;
    match decoder.info().map(|info| info.pixel_format) {
        Some(PixelFormat::L8) => Ok(Pixels::U8(samples)),
        Some(PixelFormat::RGB24) => Ok(Pixels::U8(grey_from_u8(&samples, 3))),
        _ => Err(cut("its colours are of an unknown kind")),
    }
}

fn lossless_pixels(
    bytes: &[u8],
    precision: u8,
    colour: ComponentColours,
) -> Result<Pixels, Problem> {
    let mut planes = lossless::decode(bytes)?.planes;
    let grey = match (planes.as_slice(), colour) {
        ([red, green, blue], ComponentColours::Rgb) => {
            let channels = red.iter().zip(green).zip(blue);
            channels.map(|((&r, &g), &b)| luminance(r, g, b)).collect()
        }
        _ => planes.swap_remove(0),
    };
    Ok(match precision {
        ..=8 => Pixels::U8(grey.into_iter().map(|value| value as u8).collect()),
        _ => Pixels::U16(grey),
    })
}
