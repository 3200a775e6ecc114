//! Masks written as PNG images.

use png::{BitDepth, ColorType, Encoder};

use crate::error::{DecodeError, Problem};
use crate::frame::checked_area;

/// A grey PNG of 8 bits from `width * height` pixels, row by row from the top: 255 where `inside` is not 0, else 0.
/// That is the form of masks that programs of this field read.
///
/// # Errors
/// [`DecodeError`] when the number of pixels is not that of the size, or the size is beyond the [limits](crate::limits).
pub fn encode_mask(inside: Vec<u8>, width: u32, height: u32) -> Result<Vec<u8>, DecodeError> {
    encode(inside, width, height).map_err(|problem| problem.of("mask"))
}

fn encode(mut inside: Vec<u8>, width: u32, height: u32) -> Result<Vec<u8>, Problem> {
    let area = checked_area(width.into(), height.into())?;
    if inside.len() != area {
        return Err(Problem::damaged(
            "mask",
            format!("it has {} pixels for {width} x {height}", inside.len()),
        ));
    }
    for pixel in &mut inside {
        *pixel = if *pixel == 0 { 0 } else { 255 };
    }
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    let failed = |error: png::EncodingError| Problem::damaged("PNG", error.to_string());
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&inside).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}
