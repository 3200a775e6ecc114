//! BMP: 1 to 32 bits, grey, colour or palette, not compressed.
//!
//! A fourth channel is left out, as transparency is elsewhere. Runs are refused: what they leave out has no value.

use embedded_graphics::geometry::Point;
use embedded_graphics::image::GetPixel;
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use tinybmp::{Bmp, CompressionMethod, Header, ParseError};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, checked_area};
use crate::luminance::luminance;

const FORMAT: &str = "BMP";
const REMEDY: &str = "Save it without compression, or as PNG or TIFF";

/// Where the header states width, height and the number of colours, and the most of these.
const SIZE_AT: usize = 18;
const COLOURS_AT: usize = 46;
const MOST_COLOURS: i32 = 256;

/// Checks the header and that all pixels are there. Width and height.
pub(crate) fn check(bytes: &[u8]) -> Result<(u32, u32), Problem> {
    let size = open(bytes)?.as_raw().header().image_size;
    Ok((size.width, size.height))
}

/// Decodes the image, pixel by pixel: what goes through all of them in the library (0.7) has the rows upside down.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    let bmp = open(bytes)?;
    let size = bmp.as_raw().header().image_size;
    // Within `i32`, as sides are.
    let [columns, rows] = [size.width as i32, size.height as i32];
    let places = (0..rows).flat_map(|y| (0..columns).map(move |x| Point::new(x, y)));
    let grey: Option<Vec<u8>> = places.map(|at| bmp.pixel(at).map(grey_of)).collect();
    // All rows are there.
    let grey = grey
        .ok_or_else(|| Problem::damaged(FORMAT, "a pixel has a colour that is not in its table"))?;
    Ok(GreyFrame::plain(size.width, size.height, Pixels::U8(grey)))
}

fn grey_of(colour: Rgb888) -> u8 {
    let [red, green, blue] = [colour.r(), colour.g(), colour.b()].map(u16::from);
    luminance(red, green, blue) as u8
}

/// The library multiplies what the header states before it looks how many bytes there are, so that this is looked at here.
fn open(bytes: &[u8]) -> Result<Bmp<'_, Rgb888>, Problem> {
    let stated = |at: usize| {
        let four = bytes.get(at..).and_then(<[u8]>::first_chunk::<4>);
        four.map(|&four| i32::from_le_bytes(four)).ok_or_else(cut)
    };
    let [width, height] = [stated(SIZE_AT)?.max(0), stated(SIZE_AT + 4)?].map(i32::unsigned_abs);
    checked_area(width.into(), height.into())?;
    if !(0..=MOST_COLOURS).contains(&stated(COLOURS_AT)?) {
        return Err(Problem::damaged(
            FORMAT,
            "it states more colours than a table has",
        ));
    }
    let bmp = Bmp::from_slice(bytes).map_err(problem)?;
    let header = bmp.as_raw().header();
    match header.compression_method {
        CompressionMethod::Rle8 | CompressionMethod::Rle4 => Err(not_read("pixels in runs")),
        _ if bmp.as_raw().image_data().len() < length(header) => Err(cut()),
        _ => Ok(bmp),
    }
}

/// Bytes of all rows, each of whole words. Of pixels with masks the library believes what the header says of it.
fn length(header: &Header) -> usize {
    let row_bits = header.image_size.width as usize * usize::from(header.bpp.bits());
    row_bits.div_ceil(32) * 4 * header.image_size.height as usize
}

fn problem(error: ParseError) -> Problem {
    match error {
        ParseError::UnexpectedEndOfFile => cut(),
        ParseError::UnsupportedBpp(bits) => not_read(&format!("{bits} bits a pixel")),
        ParseError::UnsupportedCompressionMethod(_) => not_read("compressed pixels"),
        ParseError::UnsupportedHeaderLength(length) => {
            not_read(&format!("a header of {length} bytes"))
        }
        ParseError::UnsupportedChannelMasks => not_read("colours in unusual bits"),
        _ => Problem::damaged(FORMAT, "its header is not one of such files"),
    }
}

fn cut() -> Problem {
    Problem::damaged(FORMAT, "it is too short for its stated size")
}

fn not_read(detail: &str) -> Problem {
    Problem::Unsupported {
        format: FORMAT,
        detail: detail.to_owned(),
        remedy: REMEDY,
    }
}
