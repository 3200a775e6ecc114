//! Pages whose strips or tiles are JPEG images.

use tiff::tags::Tag;

use super::overlay::Reader;
use super::problem::{FORMAT, REMEDY, damaged, failed};
use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels};
use crate::jpeg;
use crate::luminance::ComponentColours;

/// Value of the Compression field.
pub(super) const JPEG: u16 = 7;
/// Value of the field that says what colours are: luminance first.
const LUMINANCE_FIRST: u16 = 6;

/// Value of the same field: the larger a number, the darker it is shown.
const WHITE_IS_ZERO: u16 = 0;

/// Most bytes of tables that all images share: there are no more of them than fit.
const MAX_TABLES: usize = 16_384;

/// Length of the marks that begin and end an image.
const MARK: usize = 2;

/// Greys of a page of 8 bits of so many pixels; the places of its strips or tiles have been checked.
pub(super) fn grey(
    decoder: &mut Reader<'_>,
    bytes: &[u8],
    page: usize,
    (width, height): (usize, usize),
) -> Result<Pixels, Problem> {
    let list = |decoder: &mut Reader<'_>, tags: [Tag; 2]| {
        let values = tags.map(|tag| {
            decoder
                .find_tag_unsigned_vec::<u64>(tag)
                .map_err(|e| failed(page, e))
        });
        let [first, second] = values;
        Ok(first?.or(second?).unwrap_or_default())
    };
    let offsets = list(decoder, [Tag::TileOffsets, Tag::StripOffsets])?;
    let counts = list(decoder, [Tag::TileByteCounts, Tag::StripByteCounts])?;
    let tables = tables_of(decoder, page)?;
    let photometric = decoder.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation);
    let photometric = photometric.map_err(|e| failed(page, e))?;
    let colour = match photometric {
        Some(LUMINANCE_FIRST) => ComponentColours::LuminanceFirst,
        _ => ComponentColours::Rgb,
    };
    let (across, down) = decoder.chunk_dimensions();
    let (across, down) = (across.max(1) as usize, down.max(1) as usize);
    let mut pixels = vec![0; width * height];
    let per_row = width.div_ceil(across);
    if offsets.len() < per_row * height.div_ceil(down) {
        return Err(damaged(page, "not all of its strips or tiles are there"));
    }
    for (index, (&offset, &count)) in offsets.iter().zip(&counts).enumerate() {
        let coded = bytes
            .get(offset as usize..(offset + count) as usize)
            .unwrap_or_default();
        let image = jpeg::decode_with(&with_tables(&tables, coded), Some(colour))?;
        let (left, top) = (index % per_row * across, index / per_row * down);
        let visible = [(across, width, left), (down, height, top)]
            .map(|(part, whole, at)| part.min(whole.saturating_sub(at)));
        if [image.width, image.height]
            .iter()
            .zip(visible)
            .any(|(&own, seen)| (own as usize) < seen)
        {
            let part = index + 1;
            return Err(damaged(
                page,
                format!("the image of its strip or tile {part} is smaller than that"),
            ));
        }
        place(&image, &mut pixels, width, (left, top))?;
    }
    if photometric == Some(WHITE_IS_ZERO) {
        pixels
            .iter_mut()
            .for_each(|pixel| *pixel = u8::MAX - *pixel);
    }
    Ok(Pixels::U8(pixels))
}

/// What the images of a page share.
fn tables_of(decoder: &mut Reader<'_>, page: usize) -> Result<Vec<u8>, Problem> {
    let tables = decoder
        .find_tag(Tag::JPEGTables)
        .map_err(|e| failed(page, e))?;
    let tables = match tables {
        Some(value) => value.into_u8_vec().map_err(|e| failed(page, e))?,
        None => Vec::new(),
    };
    if tables.len() > MAX_TABLES {
        return Err(damaged(page, "its JPEG tables are longer than any can be"));
    }
    Ok(tables)
}

/// The tables that all images of a page share, put into one after its first mark.
fn with_tables(tables: &[u8], coded: &[u8]) -> Vec<u8> {
    let inner = tables
        .get(MARK..tables.len().saturating_sub(MARK))
        .unwrap_or_default();
    let (start, rest) = coded.split_at(coded.len().min(MARK));
    [start, inner, rest].concat()
}

/// Copies what of an image lies inside the page.
fn place(
    image: &GreyFrame,
    pixels: &mut [u8],
    width: usize,
    (left, top): (usize, usize),
) -> Result<(), Problem> {
    let Pixels::U8(source) = &image.pixels else {
        return Err(Problem::unsupported(
            FORMAT,
            "JPEG pixels of more than 8 bits",
            REMEDY,
        ));
    };
    let rows = source.chunks_exact(image.width as usize);
    for (row, line) in pixels.chunks_exact_mut(width).skip(top).zip(rows) {
        for (pixel, value) in row.iter_mut().skip(left).zip(line) {
            *pixel = *value;
        }
    }
    Ok(())
}
