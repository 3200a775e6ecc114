//! Pictures as PNG files.

use anyhow::{Context, Result};
use fluoropose::image::mask::Mask;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use std::path::Path;

use crate::whole;

/// Columns and rows of a picture.
pub type Size = (usize, usize);

/// Writes 8-bit grey pixels, row by row.
///
/// # Errors
/// Names the file; also where there are not as many pixels as the size says.
pub fn write_grey(path: &Path, size: Size, pixels: &[u8]) -> Result<()> {
    write(path, size, (ColorType::Grayscale, BitDepth::Eight), pixels)
}

/// Writes a mask: white where it is set, black elsewhere.
///
/// # Errors
/// Those of [`write_grey`].
pub fn write_mask(path: &Path, mask: &Mask<'_>) -> Result<()> {
    let (width, height) = (mask.width(), mask.height());
    let pixels: Vec<u8> = (0..width * height)
        .map(|k| 255 * u8::from(mask.get(k % width, k / width)))
        .collect();
    write_grey(path, (width, height), &pixels)
}

/// Writes 16-bit grey pixels, row by row.
///
/// # Errors
/// Those of [`write_grey`].
pub fn write_grey_16(path: &Path, size: Size, pixels: &[u16]) -> Result<()> {
    let bytes: Vec<u8> = pixels
        .iter()
        .flat_map(|pixel| pixel.to_be_bytes())
        .collect();
    write(
        path,
        size,
        (ColorType::Grayscale, BitDepth::Sixteen),
        &bytes,
    )
}

/// Writes pixels of red, green and blue, row by row.
///
/// # Errors
/// Those of [`write_grey`].
pub fn write_colour(path: &Path, size: Size, pixels: &[[u8; 3]]) -> Result<()> {
    let kind = (ColorType::Rgb, BitDepth::Eight);
    write(path, size, kind, pixels.as_flattened())
}

fn write(path: &Path, size: Size, kind: (ColorType, BitDepth), bytes: &[u8]) -> Result<()> {
    let encoded = || -> Result<Vec<u8>> {
        let mut file = Vec::new();
        let (width, height) = (u32::try_from(size.0)?, u32::try_from(size.1)?);
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(kind.0);
        encoder.set_depth(kind.1);
        encoder.set_compression(Compression::Balanced);
        encoder.set_filter(Filter::Adaptive);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        writer.finish()?;
        Ok(file)
    };
    let file = encoded().with_context(|| format!("cannot write {}", path.display()))?;
    whole::write(path, file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_read_back_as_they_were_written() {
        let path = std::env::temp_dir().join(format!("fluoropose-png-{}.png", std::process::id()));
        let read = || {
            let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
            let mut reader = png::Decoder::new(file).read_info().unwrap();
            let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
            let info = reader.next_frame(&mut bytes).unwrap();
            bytes.truncate(info.buffer_size());
            (info.width, info.height, bytes)
        };
        write_grey(&path, (3, 2), &[1, 2, 3, 4, 5, 6]).unwrap();
        assert_eq!(read(), (3, 2, vec![1, 2, 3, 4, 5, 6]));
        write_grey_16(&path, (2, 1), &[258, 772]).unwrap();
        assert_eq!(read(), (2, 1, vec![1, 2, 3, 4]));
        write_colour(&path, (1, 1), &[[7, 8, 9]]).unwrap();
        assert_eq!(read(), (1, 1, vec![7, 8, 9]));
        let error = write_grey(&path, (3, 2), &[1]).unwrap_err().to_string();
        assert!(error.starts_with("cannot write"), "{error}");
        std::fs::remove_file(path).unwrap();
    }
}
