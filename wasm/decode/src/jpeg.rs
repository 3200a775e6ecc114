//! JPEG: baseline, progressive and lossless, grey or colour.
//!
//! [`lossless`] is decoded here, the other processes by a library.
//!
//! The markers are walked before the decoder sees a byte: it fills what is missing from a cut file with grey, and
//! a wrong measure is worse here than no measure. A camera's wish to have its picture turned (Exif) is not followed:
//! pixels are as stored.

mod lossless;

use jpeg_decoder::{Decoder, PixelFormat};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, checked_area};
use crate::luminance::{grey_from_u8, luminance};

const FORMAT: &str = "JPEG";
const REMEDY: &str = "Export it as an ordinary JPEG, PNG or TIFF";

/// Most scans of one image. Encoders write about ten; a file of thousands would keep the decoder busy for hours.
const MAX_SCANS: usize = 100;

/// Process number of lossless coding: at least a bit a pixel.
const LOSSLESS: u8 = 3;

/// Pixels of a block of the other codings: at least a bit a block.
const BLOCK: usize = 64;

const START_OF_IMAGE: u8 = 0xD8;
const END_OF_IMAGE: u8 = 0xD9;
const START_OF_SCAN: u8 = 0xDA;

/// What the frame header of a JPEG image says.
struct Header {
    /// Which coding: 0 baseline, 1 extended, 2 progressive, 3 lossless, others.
    process: u8,
    precision: u8,
    width: u16,
    height: u16,
    components: u8,
}

/// Whether `marker` starts a frame: C0 to CF without the tables C4, C8 and CC.
fn starts_frame(marker: u8) -> bool {
    (0xC0..=0xCF).contains(&marker) && !matches!(marker, 0xC4 | 0xC8 | 0xCC)
}

/// The position of the next marker's `0xFF` at or after `at`, over entropy-coded bytes: stuffed zeros and restart
/// markers belong to the scan.
fn end_of_scan(bytes: &[u8], mut at: usize) -> Option<usize> {
    loop {
        at += bytes.get(at..)?.iter().position(|&b| b == 0xFF)?;
        match *bytes.get(at + 1)? {
            0x00 | 0xD0..=0xD7 => at += 2,
            0xFF => at += 1,
            _ => return Some(at),
        }
    }
}

/// The body of the segment whose length field is at `at`.
fn segment(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let length = u16::from_be_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]);
    bytes.get(at + 2..at + usize::from(length))
}

fn frame_header(marker: u8, body: &[u8]) -> Option<Header> {
    let [precision, h1, h0, w1, w0, components, ..] = *body else {
        return None;
    };
    Some(Header {
        process: marker & 0x0F,
        precision,
        width: u16::from_be_bytes([w1, w0]),
        height: u16::from_be_bytes([h1, h0]),
        components,
    })
}

fn cut(what: &str) -> Problem {
    Problem::damaged(FORMAT, what)
}

/// Follows the markers from the start to the end-of-image mark.
fn walk(bytes: &[u8]) -> Result<Header, Problem> {
    if !bytes.starts_with(&[0xFF, START_OF_IMAGE]) {
        return Err(cut("it does not begin with the JPEG mark"));
    }
    let ends = || cut("it ends before the end-of-image mark");
    let (mut at, mut header, mut scans) = (2, None, 0);
    loop {
        if bytes.get(at) != Some(&0xFF) {
            return Err(bytes.get(at).map_or_else(ends, |_| {
                cut(&format!(
                    "there is no marker at byte {at} where one must be"
                ))
            }));
        }
        match *bytes.get(at + 1).ok_or_else(ends)? {
            0xFF => at += 1,
            END_OF_IMAGE => break,
            marker => {
                let body = segment(bytes, at + 2).ok_or_else(ends)?;
                at += 4 + body.len();
                if starts_frame(marker) {
                    if header.is_some() {
                        return Err(cut("it holds a second image inside the first"));
                    }
                    header = frame_header(marker, body);
                } else if marker == START_OF_SCAN {
                    scans += 1;
                    at = end_of_scan(bytes, at).ok_or_else(ends)?;
                }
                if scans > MAX_SCANS {
                    return Err(cut(&format!("it has more than {MAX_SCANS} scans")));
                }
            }
        }
    }
    header
        .filter(|_| scans > 0)
        .ok_or_else(|| cut("it has no image between its marks"))
}

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

/// What the colours of a lossless image are: its own markers do not tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LosslessColour {
    /// Red, green, blue.
    Rgb,
    /// Luminance first.
    LuminanceFirst,
}

/// Decodes the image.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    decode_with(bytes, LosslessColour::Rgb)
}

/// Decodes the image; what the colours are if it is lossless, the caller knows.
pub(crate) fn decode_with(bytes: &[u8], colour: LosslessColour) -> Result<GreyFrame, Problem> {
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
        _ => Err(cut("its colours cannot be told")),
    }
}

fn lossless_pixels(bytes: &[u8], precision: u8, colour: LosslessColour) -> Result<Pixels, Problem> {
    let mut planes = lossless::decode(bytes)?.planes;
    let grey = match (planes.as_slice(), colour) {
        ([red, green, blue], LosslessColour::Rgb) => {
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
