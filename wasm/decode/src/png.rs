//! PNG: 1 to 16 bits, grey, colour or palette, with or without transparency.
//!
//! Grey values of fewer than 8 bits are spread over 0 to 255 (a 1-bit image has the values 0 and 255). Transparency is left
//! out, not blended. Only the still image of an animation is read.

use std::io::Cursor;

use png::{BitDepth, Decoder, DecodingError, Limits, Reader, Transformations};

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, can_hold, checked_area};
use crate::limits::MAX_SIDE;
use crate::luminance::{grey_from_u8, grey_from_u16};

const FORMAT: &str = "PNG";

/// What the decoder may reserve apart from the pixels: a row or two, text and colour profiles.
const SIDE_BYTES: usize = 64 << 20;

fn damaged(error: DecodingError) -> Problem {
    match error {
        DecodingError::LimitsExceeded => {
            Problem::damaged(FORMAT, "it asks for more memory than any real frame needs")
        }
        other => Problem::damaged(FORMAT, in_words(other.to_string())),
    }
}

/// The decoder names chunks by all of their fields, which tells nobody anything.
fn in_words(told: String) -> String {
    match told.contains("ChunkType {") {
        true => "a part of it is damaged, or stands where it must not".to_owned(),
        false => told,
    }
}

/// Reads everything up to the first pixel and checks the size.
fn open(bytes: &[u8]) -> Result<Reader<Cursor<&[u8]>>, Problem> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: SIDE_BYTES });
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(damaged)?;
    let area = checked_area(header.width.into(), header.height.into())?;
    let bits = header.color_type.samples() * header.bit_depth as usize;
    if !can_hold(bytes.len(), area, bits as u64) {
        return Err(Problem::damaged(
            FORMAT,
            "it is too short for its stated size",
        ));
    }
    decoder.read_info().map_err(damaged)
}

/// Checks the header: whether this is one frame of a size that is read. Width and height.
pub(crate) fn check(bytes: &[u8]) -> Result<(u32, u32), Problem> {
    Ok(open(bytes)?.info().size())
}

/// Decodes the still image.
pub(crate) fn decode(bytes: &[u8]) -> Result<GreyFrame, Problem> {
    let mut reader = open(bytes)?;
    let (width, height) = reader.info().size();
    // At most 8 bytes a pixel (colour with transparency, 16 bits).
    let most = 8 * (MAX_SIDE as usize).pow(2);
    let size = reader
        .output_buffer_size()
        .filter(|&size| size <= most)
        .ok_or_else(|| Problem::damaged(FORMAT, "its size does not fit memory"))?;
    let mut samples = vec![0; size];
    let output = reader.next_frame(&mut samples).map_err(damaged)?;
    // Reads to the end mark, so that a file cut after its last pixel is noticed too.
    reader.finish().map_err(damaged)?;

    let channels = output.color_type.samples();
    let pixels = match output.bit_depth {
        BitDepth::Sixteen => {
            let wide = samples.as_chunks::<2>().0.iter().copied();
            Pixels::U16(grey_from_u16(wide.map(u16::from_be_bytes), channels))
        }
        _ if channels == 1 => Pixels::U8(samples),
        _ => Pixels::U8(grey_from_u8(&samples, channels)),
    };
    Ok(GreyFrame::plain(width, height, pixels))
}
