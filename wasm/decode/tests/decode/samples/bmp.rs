//! BMP files, put together by hand.

/// What a file is made of.
pub(crate) struct Picture<'a> {
    pub width: u32,
    /// From the top down where it is negative.
    pub height: i32,
    pub bits: u16,
    pub compression: u32,
    /// Blue, green, red, nothing.
    pub palette: &'a [[u8; 4]],
    /// As they stand in the file, without their filling.
    pub rows: &'a [&'a [u8]],
}

pub(crate) fn bmp(picture: &Picture) -> Vec<u8> {
    let colours: Vec<u8> = picture.palette.iter().flatten().copied().collect();
    let mut pixels = Vec::new();
    for row in picture.rows {
        pixels.extend_from_slice(row);
        pixels.resize(pixels.len().next_multiple_of(4), 0xAA);
    }
    let start = 54 + colours.len() as u32;
    let mut file = b"BM".to_vec();
    for word in [start + pixels.len() as u32, 0, start, 40, picture.width] {
        file.extend(word.to_le_bytes());
    }
    file.extend(picture.height.to_le_bytes());
    file.extend(1u16.to_le_bytes());
    file.extend(picture.bits.to_le_bytes());
    let colour_count = picture.palette.len() as u32;
    for word in [
        picture.compression,
        pixels.len() as u32,
        2835,
        2835,
        colour_count,
        0,
    ] {
        file.extend(word.to_le_bytes());
    }
    file.extend(colours);
    file.extend(pixels);
    file
}

/// A palette in which every colour is its own number.
pub(crate) fn greys() -> Vec<[u8; 4]> {
    (0..=255).map(|grey| [grey, grey, grey, 0]).collect()
}

/// 8 bits, from the bottom up, as most programs write greys.
pub(crate) fn grey(width: u32, height: i32, pixels: &[u8]) -> Vec<u8> {
    let rows: Vec<&[u8]> = pixels.chunks(width as usize).rev().collect();
    bmp(&Picture {
        width,
        height,
        bits: 8,
        compression: 0,
        palette: &greys(),
        rows: &rows,
    })
}
