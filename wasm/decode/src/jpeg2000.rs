//! JPEG 2000: bare codestreams, as DICOM files hold them, and JP2 files; lossless and lossy, 1 to 16 bits.
//!
//! The tile-parts are walked before the library sees a byte: the library fills what is missing from a cut file, and a wrong
//! measurement is worse than none.

use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, can_hold, checked_area};
use crate::luminance::{ComponentColours, luminance};

const FORMAT: &str = "JPEG 2000";
const REMEDY: &str = "Export it as PNG, TIFF or uncompressed DICOM";

/// Begins a codestream: its start mark, then the mark of the image's size.
pub(crate) const CODESTREAM: [u8; 4] = [0xFF, 0x4F, 0xFF, 0x51];
/// Begins a JP2 file.
pub(crate) const JP2: [u8; 12] = *b"\0\0\0\x0CjP  \r\n\x87\n";

const TILE_PART: u16 = 0xFF90;
const END: u16 = 0xFFD9;

/// Most tiles: one of 256 x 256 pixels each at the largest frame is 1024.
const MAX_TILES: u64 = 4096;
/// Bytes of the size segment before its components, without its mark.
const SIZE_FIXED: usize = 36;

/// What the size segment says.
struct Size {
    width: u32,
    height: u32,
    components: u16,
    bits: u8,
    signed: bool,
}

fn damaged(detail: impl Into<String>) -> Problem {
    Problem::damaged(FORMAT, detail)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// The codestream of a file: all of it, or the box `jp2c`.
fn codestream(bytes: &[u8]) -> Result<&[u8], Problem> {
    if bytes.starts_with(&CODESTREAM) {
        return Ok(bytes);
    }
    let mut at = 0;
    while let (Some(length), Some(kind)) = (u32_at(bytes, at), u32_at(bytes, at + 4)) {
        let (head, length) = match length {
            0 => (8, bytes.len() - at),
            1 => (16, u32_at(bytes, at + 12).unwrap_or(0) as usize),
            length => (8, length as usize),
        };
        let end = at.saturating_add(length);
        if length < head || end > bytes.len() {
            return Err(damaged(format!(
                "the box at byte {at} reaches beyond the end of the file"
            )));
        }
        if kind.to_be_bytes() == *b"jp2c" {
            return bytes
                .get(at + head..end)
                .ok_or_else(|| damaged("it holds no codestream"));
        }
        at = end;
    }
    Err(damaged("it holds no codestream"))
}

fn cut_short() -> Problem {
    damaged("the segment of its size is cut short")
}

/// Width and height of the image, pixels, if it is cut into an allowed number of tiles.
fn image_size(stream: &[u8]) -> Result<(u32, u32), Problem> {
    let [
        right,
        bottom,
        left,
        top,
        tile_width,
        tile_height,
        tile_left,
        tile_top,
    ] = [8, 12, 16, 20, 24, 28, 32, 36].map(|at| u32_at(stream, at));
    let all = |value: Option<u32>| value.ok_or_else(cut_short);
    let (width, height) = (
        all(right)?.saturating_sub(all(left)?),
        all(bottom)?.saturating_sub(all(top)?),
    );
    let (tile_width, tile_height) = (all(tile_width)?, all(tile_height)?);
    if tile_width == 0
        || tile_height == 0
        || all(tile_left)? > all(left)?
        || all(tile_top)? > all(top)?
    {
        return Err(damaged("its tiles have no size or leave the image"));
    }
    let count = |side: u32, tile: u32| u64::from(side).div_ceil(tile.into()) + 1;
    if count(width, tile_width) * count(height, tile_height) > MAX_TILES {
        return Err(damaged("it is cut into more tiles than any frame needs"));
    }
    Ok((width, height))
}

/// Reads the size segment.
fn size(stream: &[u8]) -> Result<Size, Problem> {
    if !stream.starts_with(&CODESTREAM) {
        return Err(damaged("its codestream does not begin with its mark"));
    }
    let (width, height) = image_size(stream)?;
    let components = u16_at(stream, 40).ok_or_else(cut_short)?;
    let specifications = stream
        .get(42..42 + 3 * usize::from(components))
        .ok_or_else(cut_short)?
        .as_chunks::<3>()
        .0;
    let [depth, ..] = *specifications.first().ok_or_else(cut_short)?;
    let alike = specifications
        .iter()
        .all(|[other, across, down]| *other == depth && (*across, *down) == (1, 1));
    if !alike {
        return Err(Problem::unsupported(
            FORMAT,
            "components of different depths or resolutions",
            REMEDY,
        ));
    }
    if usize::from(u16_at(stream, 4).ok_or_else(cut_short)?)
        != SIZE_FIXED + 2 + 3 * usize::from(components)
    {
        return Err(cut_short());
    }
    Ok(Size {
        width,
        height,
        components,
        bits: (depth & 0x7F) + 1,
        signed: depth & 0x80 != 0,
    })
}

/// Follows the segments of the main header and the tile-parts to the end mark.
fn walk(stream: &[u8]) -> Result<(), Problem> {
    let ends = || damaged("it ends before its end mark");
    let mut at = 2;
    loop {
        match u16_at(stream, at).ok_or_else(ends)? {
            END => return Ok(()),
            TILE_PART => {
                let length = u32_at(stream, at + 6).ok_or_else(ends)? as usize;
                at = match length {
                    // The last one reaches to the end mark.
                    0 if unpadded(stream).ends_with(&END.to_be_bytes()) => return Ok(()),
                    0 => return Err(ends()),
                    1..14 => {
                        return Err(damaged(format!("the tile-part at byte {at} has no length")));
                    }
                    length => at.saturating_add(length),
                };
            }
            marker if marker >> 8 == 0xFF => {
                at += 2 + usize::from(
                    u16_at(stream, at + 2)
                        .filter(|&length| length >= 2)
                        .ok_or_else(ends)?,
                );
            }
            _ => {
                return Err(damaged(format!(
                    "there is no marker at byte {at} where one must be"
                )));
            }
        }
    }
}

/// Without the padding of DICOM's even lengths.
fn unpadded(stream: &[u8]) -> &[u8] {
    stream.strip_suffix(&[0]).unwrap_or(stream)
}

fn checked(bytes: &[u8]) -> Result<Size, Problem> {
    let stream = codestream(bytes)?;
    let size = size(stream)?;
    let area = checked_area(size.width.into(), size.height.into())?;
    if !matches!(size.components, 1 | 3) {
        return Err(Problem::unsupported(
            FORMAT,
            format!("{} colour channels", size.components),
            REMEDY,
        ));
    }
    if !(1..=16).contains(&size.bits) {
        return Err(Problem::unsupported(
            FORMAT,
            format!("{}-bit pixels", size.bits),
            REMEDY,
        ));
    }
    if !can_hold(bytes.len(), area, u64::from(size.bits)) {
        return Err(damaged("it is too short for its stated size"));
    }
    walk(stream)?;
    Ok(size)
}

/// Checks the structure: whether this is one whole image of a kind and size that is read.
pub(crate) fn check(bytes: &[u8]) -> Result<(), Problem> {
    checked(bytes).map(drop)
}

/// Decodes an image file.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    decode_as(bytes, ComponentColours::Rgb, false)
}

/// Decodes the image of a DICOM file. `colour` says what three components are. Signed samples are moved up by half their
/// range, or with `two_s_complement` returned as stored. Of a JP2 file, against the standard, the codestream alone counts.
pub(crate) fn decode_with(
    bytes: &[u8],
    colour: ComponentColours,
    two_s_complement: bool,
) -> Result<GreyFrame, Problem> {
    decode_as(codestream(bytes)?, colour, two_s_complement)
}

fn decode_as(
    bytes: &[u8],
    colour: ComponentColours,
    two_s_complement: bool,
) -> Result<GreyFrame, Problem> {
    let size = checked(bytes)?;
    let area = checked_area(size.width.into(), size.height.into())?;
    let failed = |e: hayro_jpeg2000::error::DecodeError| damaged(e.to_string());
    let settings = DecodeSettings {
        resolve_palette_indices: false,
        strict: true,
        target_resolution: None,
    };
    let image = Image::new(bytes, &settings).map_err(failed)?;
    let mut context = DecoderContext::default();
    let decoded = image.decode(&mut context).map_err(failed)?;
    let most = u16::MAX >> (16 - size.bits);
    let flipped = if size.signed && two_s_complement {
        most / 2 + 1
    } else {
        0
    };
    let whole = |sample: &f32| (sample.round().clamp(0.0, f32::from(most)) as u16) ^ flipped;
    let grey: Vec<u16> = match (decoded.components(), colour) {
        ([red, green, blue], ComponentColours::Rgb) => {
            let channels = red
                .samples()
                .iter()
                .zip(green.samples())
                .zip(blue.samples());
            channels
                .map(|((r, g), b)| luminance(whole(r), whole(g), whole(b)))
                .collect()
        }
        ([first, ..], _) => first.samples().iter().map(whole).collect(),
        ([], _) => Vec::new(),
    };
    if grey.len() != area {
        return Err(damaged("its pixels do not fill its stated size"));
    }
    let pixels = match size.bits {
        ..=8 => Pixels::U8(grey.into_iter().map(|value| value as u8).collect()),
        _ => Pixels::U16(grey),
    };
    let mut frame = GreyFrame::plain(size.width, size.height, pixels);
    frame.bits = size.bits;
    if size.signed && !two_s_complement {
        frame
            .notes
            .push("Signed pixels were moved up by half their range.".to_owned());
    }
    Ok(frame)
}
