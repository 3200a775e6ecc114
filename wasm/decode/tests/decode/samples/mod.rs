//! Small files made in code, by encoders that are not part of what is tested, or by hand.

pub(crate) mod bmp;
pub(crate) mod dicom;
pub(crate) mod every;
pub(crate) mod foreign;
pub(crate) mod jpeg2000;
pub(crate) mod lossless;
pub(crate) mod models;
pub(crate) mod numpy;
pub(crate) mod tiffs;

use std::io::Cursor;

use fluoropose_decode::{GreyFrame, Pixels, decode_frames};
use tiff::encoder::{Compression, Predictor, TiffEncoder};

/// A PNG of raw rows.
pub(crate) fn png(
    width: u32,
    height: u32,
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
) -> Vec<u8> {
    png_with(width, height, color, depth, data, |_| {})
}

/// A PNG whose encoder is set up further.
pub(crate) fn png_with(
    width: u32,
    height: u32,
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
    set_up: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    set_up(&mut encoder);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    file
}

/// A grey JPEG of the best quality.
pub(crate) fn jpeg(width: u16, height: u16, pixels: &[u8], progressive: bool) -> Vec<u8> {
    jpeg_of(
        width,
        height,
        pixels,
        jpeg_encoder::ColorType::Luma,
        progressive,
    )
}

/// A JPEG of the best quality.
pub(crate) fn jpeg_of(
    width: u16,
    height: u16,
    samples: &[u8],
    color: jpeg_encoder::ColorType,
    progressive: bool,
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = jpeg_encoder::Encoder::new(&mut file, 100);
    encoder.set_progressive(progressive);
    encoder.encode(samples, width, height, color).unwrap();
    file
}

/// A TIFF in this compression whose pages a closure writes.
pub(crate) fn tiff(
    compression: Compression,
    write: impl FnOnce(&mut TiffEncoder<Cursor<&mut Vec<u8>>>),
) -> Vec<u8> {
    let mut file = Vec::new();
    let encoder = TiffEncoder::new(Cursor::new(&mut file)).unwrap();
    write(&mut encoder.with_compression(compression));
    file
}

/// A TIFF whose rows are stored as differences, in LZW.
pub(crate) fn predicted_tiff(
    write: impl FnOnce(&mut TiffEncoder<Cursor<&mut Vec<u8>>>),
) -> Vec<u8> {
    let mut file = Vec::new();
    let encoder = TiffEncoder::new(Cursor::new(&mut file)).unwrap();
    write(
        &mut encoder
            .with_compression(Compression::Lzw)
            .with_predictor(Predictor::Horizontal),
    );
    file
}

/// A TIFF by hand: little endian, one strip, these fields (tag, type, value) besides the strip's own.
pub(crate) fn raw_tiff(fields: &[(u16, u16, u32)], strip: &[u8]) -> Vec<u8> {
    raw_tiff_in(fields, strip, [273, 279])
}

/// The same with the tags of the place and length of its data: of a strip or of a tile.
pub(crate) fn raw_tiff_in(fields: &[(u16, u16, u32)], data: &[u8], tags: [u16; 2]) -> Vec<u8> {
    let mut fields = fields.to_vec();
    fields.extend([(tags[0], 4, 8), (tags[1], 4, data.len() as u32)]);
    fields.sort_unstable();
    let directory = 8 + data.len().next_multiple_of(2) as u32;
    let mut file = b"II*\0".to_vec();
    file.extend(directory.to_le_bytes());
    file.extend(data);
    file.resize(directory as usize, 0);
    file.extend((fields.len() as u16).to_le_bytes());
    for (tag, kind, value) in fields {
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(1u32.to_le_bytes());
        file.extend(value.to_le_bytes());
    }
    file.extend(0u32.to_le_bytes());
    file
}

/// The fields of a grey TIFF page of so many bits, without rows per strip; photometric 0 is white at zero.
pub(crate) fn grey_fields(
    width: u32,
    height: u32,
    bits: u32,
    photometric: u32,
) -> Vec<(u16, u16, u32)> {
    vec![
        (256, 3, width),
        (257, 3, height),
        (258, 3, bits),
        (259, 3, 1),
        (262, 3, photometric),
        (277, 3, 1),
    ]
}

/// A grey TIFF page in one tile of 16 x 16.
pub(crate) fn tiled_tiff(width: u32, height: u32, tile: &[u8; 256]) -> Vec<u8> {
    let mut fields = grey_fields(width, height, 8, 1);
    fields.extend([(322, 3, 16), (323, 3, 16)]);
    raw_tiff_in(&fields, tile, [324, 325])
}

/// A BigTIFF of one grey page.
pub(crate) fn big_tiff(width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = TiffEncoder::new_big(Cursor::new(&mut file)).unwrap();
    encoder
        .write_image::<tiff::encoder::colortype::Gray8>(width, height, pixels)
        .unwrap();
    file
}

/// A grey pattern without symmetry.
pub(crate) fn pattern(width: usize, height: usize) -> Vec<u8> {
    let value = |i: usize| (i % width * 7 + i / width * 31 + i * i % 5) as u8;
    (0..width * height).map(value).collect()
}

/// The single frame of a file.
pub(crate) fn only_frame(bytes: &[u8], name: &str) -> GreyFrame {
    let mut frames = decode_frames(bytes, name).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(frames.len(), 1);
    frames.remove(0)
}

/// Pixels that must be bytes.
pub(crate) fn bytes_of(frame: &GreyFrame) -> &[u8] {
    match &frame.pixels {
        Pixels::U8(pixels) => pixels,
        Pixels::U16(_) => panic!("words where bytes are due"),
    }
}

/// Pixels that must be words.
pub(crate) fn words_of(frame: &GreyFrame) -> &[u16] {
    match &frame.pixels {
        Pixels::U16(pixels) => pixels,
        Pixels::U8(_) => panic!("bytes where words are due"),
    }
}
