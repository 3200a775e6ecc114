//! The structure of JPEG 2000 images: boxes, segments and tile-parts.

use super::problem::{FORMAT, REMEDY, damaged};
use crate::error::Problem;

/// Begins a codestream: its start mark, then the mark of the image's size.
pub(crate) const CODESTREAM: [u8; 4] = [0xFF, 0x4F, 0xFF, 0x51];
/// Begins a JP2 file.
pub(crate) const JP2: [u8; 12] = *b"\0\0\0\x0CjP  \r\n\x87\n";

const TILE_PART: u16 = 0xFF90;
/// Bytes of the segment that begins a tile-part, with its mark.
const TILE_PART_LENGTH: usize = 12;
const DATA: u16 = 0xFF93;
const STYLE: u16 = 0xFF52;
const STYLE_OF_COMPONENT: u16 = 0xFF53;
const END: u16 = 0xFFD9;

/// Most tiles: one of 256 x 256 pixels each at the largest frame is 1024.
const MAX_TILES: u64 = 4096;
/// Bytes of the size segment before its components, without its mark.
const SIZE_FIXED: usize = 36;

/// What the size segment says.
pub(super) struct Size {
    pub width: u32,
    pub height: u32,
    pub components: u16,
    pub bits: u8,
    pub signed: bool,
    /// Where the image begins and ends, where tiles begin, and how large they are: across, then down.
    pub sides: [Side; 2],
}

/// One direction of the grid that image and tiles lie on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub start: u32,
    pub end: u32,
    pub tiles_start: u32,
    pub tile: u32,
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// The codestream of a file: all of it, or the box `jp2c`.
pub(super) fn codestream(bytes: &[u8]) -> Result<&[u8], Problem> {
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

/// The grid of image and tiles, if it is cut into an allowed number of them.
fn sides(stream: &[u8]) -> Result<[Side; 2], Problem> {
    let at = |at: usize| u32_at(stream, at).ok_or_else(cut_short);
    let side = |first: usize| {
        Ok(Side {
            end: at(first)?,
            start: at(first + 8)?,
            tile: at(first + 16)?,
            tiles_start: at(first + 24)?,
        })
    };
    let sides = [side(8)?, side(12)?];
    if sides
        .iter()
        .any(|side| side.tile == 0 || side.tiles_start > side.start)
    {
        return Err(damaged("its tiles have no size or leave the image"));
    }
    let count =
        |side: &Side| u64::from(side.end.saturating_sub(side.start)).div_ceil(side.tile.into()) + 1;
    if count(&sides[0]) * count(&sides[1]) > MAX_TILES {
        return Err(damaged("it is cut into more tiles than any frame needs"));
    }
    Ok(sides)
}

/// Reads the size segment.
pub(super) fn size(stream: &[u8]) -> Result<Size, Problem> {
    if !stream.starts_with(&CODESTREAM) {
        return Err(damaged("its codestream does not begin with its mark"));
    }
    let sides = sides(stream)?;
    let [width, height] = sides.map(|side| side.end.saturating_sub(side.start));
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
        sides,
    })
}

/// How pixels are coded, as the segments of coding styles say.
#[derive(Default)]
pub(super) struct Styles<'a> {
    /// Most layers of any segment.
    pub layers: u16,
    /// The part of each segment that is alike for all components and for one: from the number of decomposition levels on,
    /// and whether precincts follow.
    pub components: Vec<(&'a [u8], bool)>,
}

impl<'a> Styles<'a> {
    /// Takes in a segment if it is one of coding styles.
    fn take(&mut self, marker: u16, segment: &'a [u8]) {
        let (flags, rest) = match (marker, segment) {
            (STYLE, [flags, _, high, low, _, rest @ ..]) => {
                self.layers = self.layers.max(u16::from_be_bytes([*high, *low]));
                (flags, rest)
            }
            // At most three components are read, so that one byte names them.
            (STYLE_OF_COMPONENT, [_, flags, rest @ ..]) => (flags, rest),
            _ => return,
        };
        self.components.push((rest, flags & 1 != 0));
    }
}

/// Follows the segments of the main header, and the tile-parts and the segments of theirs, to the end mark.
pub(super) fn walk(stream: &[u8]) -> Result<Styles<'_>, Problem> {
    let ends = || damaged("it ends before its end mark");
    let mut styles = Styles::default();
    let mut at = 2;
    loop {
        match u16_at(stream, at).ok_or_else(ends)? {
            END => return Ok(styles),
            TILE_PART => {
                let length = u32_at(stream, at + 6).ok_or_else(ends)? as usize;
                segments(stream, at + TILE_PART_LENGTH, &mut styles)?;
                at = match length {
                    // The last one reaches to the end mark.
                    0 if unpadded(stream).ends_with(&END.to_be_bytes()) => return Ok(styles),
                    0 => return Err(ends()),
                    1..14 => {
                        return Err(damaged(format!("the tile-part at byte {at} has no length")));
                    }
                    length => at.saturating_add(length),
                };
            }
            DATA => return Err(damaged("its pixels begin before its first tile-part")),
            _ => at = segments(stream, at, &mut styles)?,
        }
    }
}

/// Follows segments from `at` to the mark of a tile-part, of its data or of the end; gives where that is.
fn segments<'a>(
    stream: &'a [u8],
    mut at: usize,
    styles: &mut Styles<'a>,
) -> Result<usize, Problem> {
    let ends = || damaged("it ends before its end mark");
    loop {
        match u16_at(stream, at).ok_or_else(ends)? {
            TILE_PART | DATA | END => return Ok(at),
            marker if marker >> 8 == 0xFF => {
                let length = u16_at(stream, at + 2).filter(|&length| length >= 2);
                let end = at + 2 + usize::from(length.ok_or_else(ends)?);
                styles.take(marker, stream.get(at + 4..end).ok_or_else(ends)?);
                at = end;
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
