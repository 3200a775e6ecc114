//! JPEG: baseline, progressive, 12-bit, lossless and JPEG-LS, grey or colour.
//!
//! [`lossless`], [`extended`] and [`ls`] are decoded here, the other processes by a library.
//!
//! The [`markers`] are walked before the decoder sees a byte: the decoder fills what is missing from a cut file with grey,
//! and a wrong measurement is worse than none. A rotation that the camera asks for (Exif) is not followed: pixels are as
//! stored.

mod markers;

mod huffman;

mod extended;
mod lossless;
mod ls;

use jpeg_decoder::{ColorTransform, Decoder, PixelFormat};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, checked_area};
use crate::luminance::{ComponentColours, grey_from_u8, luminance};
use markers::{FORMAT, Header, Process, REMEDY, cut, walk};

/// Pixels of a block of cosines, which take at least a bit for each block.
const BLOCK: usize = 64;

/// Most bits of a sample of cosines.
const DEEP: u8 = 12;

/// Walks the markers and refuses what the decoder does not do.
fn checked_header(bytes: &[u8]) -> Result<Header, Problem> {
    let header = walk(bytes)?;
    let area = checked_area(header.width.into(), header.height.into())?;
    if header.process == Process::Rare {
        let what = "a rare coding (hierarchical or arithmetic)";
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    let deep = header.process == Process::Sequential && header.components == 1;
    let cosines = matches!(header.process, Process::Sequential | Process::Progressive);
    if cosines && header.precision != 8 && !(deep && header.precision == DEEP) {
        let what = format!(
            "{}-bit lossy pixels in several scans or colours",
            header.precision
        );
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    if !matches!(header.components, 1 | 3) {
        let what = format!("{} colour channels", header.components);
        return Err(Problem::unsupported(FORMAT, what, REMEDY));
    }
    let least_bits = match header.process {
        Process::Lossless => area,
        // A bit is a run of up to 32 768 pixels, and a row's last.
        Process::Ls => header.height.into(),
        _ => area / BLOCK,
    };
    match least_bits / 8 > bytes.len() {
        true => Err(cut("it is too short for its stated size")),
        false => Ok(header),
    }
}

/// Checks the markers: whether this is one whole image of a kind and size that is read. Width and height.
pub(crate) fn check(bytes: &[u8]) -> Result<(u32, u32), Problem> {
    let header = checked_header(bytes)?;
    Ok((header.width.into(), header.height.into()))
}

/// Decodes the image.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    decode_with(bytes, None)
}

/// Decodes the image. `colour` says what its three components are where its markers do not; without it those of a
/// lossless image are red, green and blue, and of another what is usual.
pub(crate) fn decode_with(
    bytes: &[u8],
    colour: Option<ComponentColours>,
) -> Result<GreyFrame, Problem> {
    let header = checked_header(bytes)?;
    let (width, height) = (u32::from(header.width), u32::from(header.height));
    let area = checked_area(width.into(), height.into())?;
    let pixels = match header.process {
        Process::Lossless => {
            exact_pixels(lossless::decode(bytes)?.planes, header.precision, colour)
        }
        Process::Ls => exact_pixels(ls::decode(bytes)?, header.precision, colour),
        _ if header.precision == DEEP => Pixels::U16(extended::decode(bytes)?),
        _ => lossy_pixels(bytes, area, colour.filter(|_| !header.tells_colours))?,
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

fn lossy_pixels(
    bytes: &[u8],
    area: usize,
    colour: Option<ComponentColours>,
) -> Result<Pixels, Problem> {
    let mut decoder = Decoder::new(bytes);
    decoder.set_max_decoding_buffer_size(3 * 2 * area);
    decoder.read_info().map_err(|e| cut(&e.to_string()))?;
    let format = decoder.info().map(|info| info.pixel_format);
    match colour {
        Some(ComponentColours::Rgb) if format == Some(PixelFormat::RGB24) => {
            decoder.set_color_transform(ColorTransform::RGB);
        }
        Some(ComponentColours::LuminanceFirst) if format == Some(PixelFormat::RGB24) => {
            decoder.set_color_transform(ColorTransform::YCbCr);
        }
        _ => {}
    }
    let samples = decoder.decode().map_err(|e| cut(&e.to_string()))?;
    match format {
        Some(PixelFormat::L8) => Ok(Pixels::U8(samples)),
        Some(PixelFormat::RGB24) => Ok(Pixels::U8(grey_from_u8(&samples, 3))),
        _ => Err(cut("its colours are of an unknown kind")),
    }
}

/// Grey of planes that were coded without loss, or nearly.
fn exact_pixels(
    mut planes: Vec<Vec<u16>>,
    precision: u8,
    colour: Option<ComponentColours>,
) -> Pixels {
    let grey = match (planes.as_slice(), colour.unwrap_or(ComponentColours::Rgb)) {
        ([red, green, blue], ComponentColours::Rgb) => {
            let channels = red.iter().zip(green).zip(blue);
            channels.map(|((&r, &g), &b)| luminance(r, g, b)).collect()
        }
        _ => planes.swap_remove(0),
    };
    match precision {
        ..=8 => Pixels::U8(grey.into_iter().map(|value| value as u8).collect()),
        _ => Pixels::U16(grey),
    }
}
