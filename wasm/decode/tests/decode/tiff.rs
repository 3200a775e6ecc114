use tiff::encoder::colortype::{
    ColorType, Gray8, Gray16, Gray32Float, GrayI16, RGB8, RGB16, RGBA8,
};
use tiff::encoder::{Compression, DeflateLevel, TiffValue};
use tiff::tags::Tag;

use fluoropose_decode::{FrameFile, Problem, decode_frames};

use crate::samples::{
    big_tiff, bytes_of, grey_fields, only_frame, pattern, predicted_tiff, raw_tiff, tiff,
    tiled_tiff, words_of,
};

/// One uncompressed page.
fn page<C: ColorType>(width: u32, height: u32, data: &[C::Inner]) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    tiff(Compression::Uncompressed, |encoder| {
        encoder.write_image::<C>(width, height, data).unwrap();
    })
}

#[test]
fn every_compression_and_depth_gives_the_same_pixels() {
    let pixels = pattern(19, 11);
    let words: Vec<u16> = pixels.iter().map(|&p| u16::from(p) * 251).collect();
    let compressions = [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Deflate(DeflateLevel::Balanced),
        Compression::Packbits,
    ];
    for compression in compressions {
        let file = tiff(compression, |encoder| {
            encoder.write_image::<Gray8>(19, 11, &pixels).unwrap();
            encoder.write_image::<Gray16>(19, 11, &words).unwrap();
        });
        let frames = decode_frames(&file, "run.tif").unwrap();
        assert_eq!(frames.len(), 2);
        assert_eq!(bytes_of(&frames[0]), pixels);
        assert_eq!(words_of(&frames[1]), words);
    }
}

#[test]
fn tiles_and_big_files_are_read() {
    let tile: [u8; 256] = std::array::from_fn(|i| (i * 3) as u8);
    let frame = only_frame(&tiled_tiff(11, 7, &tile), "a.tif");
    let due: Vec<u8> = tile
        .chunks(16)
        .take(7)
        .flat_map(|row| &row[..11])
        .copied()
        .collect();
    assert_eq!(bytes_of(&frame), due);
    let pixels = pattern(12, 9);
    assert_eq!(
        bytes_of(&only_frame(&big_tiff(12, 9, &pixels), "a.tif")),
        pixels
    );
}

#[test]
fn predicted_rows_are_read() {
    let (pixels, words) = (pattern(19, 11), [5u16, 500, 40_000, 3]);
    let file = predicted_tiff(|encoder| {
        encoder.write_image::<Gray8>(19, 11, &pixels).unwrap();
        encoder.write_image::<Gray16>(2, 2, &words).unwrap();
    });
    let frames = decode_frames(&file, "a.tif").unwrap();
    assert_eq!(bytes_of(&frames[0]), pixels);
    assert_eq!(words_of(&frames[1]), words);
}

#[test]
fn pages_in_a_circle_are_refused() {
    let mut file = raw_tiff(&grey_fields(2, 1, 8, 1), &[1, 2]);
    let end = file.len();
    // The next directory is this one, which begins after the header and the strip.
    file[end - 4..].copy_from_slice(&10u32.to_le_bytes());
    let error = decode_frames(&file, "a.tif").unwrap_err();
    assert!(error.to_string().contains("circle"), "{error}");
}

#[test]
fn pages_are_decoded_in_any_order() {
    let file = tiff(Compression::Uncompressed, |encoder| {
        for value in 0..5 {
            encoder
                .write_image::<Gray8>(2, 1, &[value, 255 - value])
                .unwrap();
        }
    });
    let file = FrameFile::open(file, "run.tif").unwrap();
    assert_eq!(file.count(), 5);
    for index in [4, 0, 3, 3, 1] {
        let value = index as u8;
        assert_eq!(bytes_of(&file.frame(index).unwrap()), [value, 255 - value]);
    }
    let error = file.frame(5).unwrap_err();
    assert_eq!(error.problem, Problem::NoSuchFrame { index: 5, count: 5 });
    assert_eq!(
        error.to_string(),
        "run.tif: there is no frame 6 in a file of 5. Ask for 1 to 5."
    );
}

#[test]
fn thumbnails_are_left_out() {
    let file = tiff(Compression::Uncompressed, |encoder| {
        encoder.write_image::<Gray8>(2, 1, &[1, 2]).unwrap();
        let mut small = encoder.new_image::<Gray8>(1, 1).unwrap();
        small
            .encoder()
            .write_tag(Tag::NewSubfileType, 1u32)
            .unwrap();
        small.write_data(&[9]).unwrap();
        encoder.write_image::<Gray8>(2, 1, &[3, 4]).unwrap();
    });
    let frames = decode_frames(&file, "run.tif").unwrap();
    let pixels: Vec<_> = frames.iter().map(bytes_of).collect();
    assert_eq!(pixels, [[1, 2], [3, 4]]);
}

#[test]
fn white_at_zero_is_inverted() {
    let eight = raw_tiff(&grey_fields(3, 2, 8, 0), &[0, 1, 2, 253, 254, 255]);
    assert_eq!(
        bytes_of(&only_frame(&eight, "a.tif")),
        [255, 254, 253, 2, 1, 0]
    );
    let strip: Vec<u8> = [0u16, 1, 40_000, 65_535]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let sixteen = raw_tiff(&grey_fields(2, 2, 16, 0), &strip);
    assert_eq!(
        words_of(&only_frame(&sixteen, "a.tif")),
        [65_535, 65_534, 25_535, 0]
    );
}

#[test]
fn few_bits_are_spread_over_a_byte() {
    let rows = [0b1010_0000, 0b0100_0000, 0b0000_0000, 0b1100_0000];
    let black_at_zero = raw_tiff(&grey_fields(10, 2, 1, 1), &rows);
    let expected = [
        [255, 0, 255, 0, 0, 0, 0, 0, 0, 255],
        [0, 0, 0, 0, 0, 0, 0, 0, 255, 255],
    ];
    assert_eq!(
        bytes_of(&only_frame(&black_at_zero, "a.tif")),
        expected.as_flattened()
    );
    let white_at_zero = raw_tiff(&grey_fields(10, 2, 1, 0), &rows);
    let inverted: Vec<u8> = expected.as_flattened().iter().map(|v| 255 - v).collect();
    assert_eq!(bytes_of(&only_frame(&white_at_zero, "a.tif")), inverted);
    let four = raw_tiff(&grey_fields(3, 1, 4, 1), &[0x0F, 0x70]);
    assert_eq!(bytes_of(&only_frame(&four, "a.tif")), [0, 255, 7 * 17]);
    let two = raw_tiff(&grey_fields(4, 1, 2, 1), &[0b00_01_10_11]);
    assert_eq!(bytes_of(&only_frame(&two, "a.tif")), [0, 85, 170, 255]);
}

#[test]
fn colour_becomes_luminance() {
    let file = page::<RGB8>(2, 2, &[255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9]);
    assert_eq!(bytes_of(&only_frame(&file, "a.tif")), [76, 150, 29, 9]);
    let file = page::<RGB16>(2, 1, &[65535, 0, 0, 500, 500, 500]);
    assert_eq!(words_of(&only_frame(&file, "a.tif")), [19595, 500]);
    let file = page::<RGBA8>(2, 1, &[255, 0, 0, 0, 8, 8, 8, 255]);
    assert_eq!(bytes_of(&only_frame(&file, "a.tif")), [76, 8]);
}

#[test]
fn floating_point_is_mapped_and_the_frame_says_so() {
    let file = page::<Gray32Float>(5, 1, &[-1.0, 0.0, f32::NAN, 0.5, 1.0]);
    let frame = only_frame(&file, "a.tif");
    assert_eq!(words_of(&frame), [0, 32768, 0, 49151, 65535]);
    assert_eq!(
        frame.notes,
        ["Floating point pixels from -1 to 1 were mapped linearly to 0 to 65535."]
    );
    let flat = page::<Gray32Float>(2, 1, &[3.0, 3.0]);
    assert_eq!(words_of(&only_frame(&flat, "a.tif")), [0, 0]);
    let extreme = page::<Gray32Float>(3, 1, &[f32::MIN, f32::MAX, f32::INFINITY]);
    assert_eq!(words_of(&only_frame(&extreme, "a.tif")), [0, 65535, 65535]);
}

#[test]
fn signed_pixels_are_moved_up() {
    let frame = only_frame(&page::<GrayI16>(3, 1, &[-32768, 0, 32767]), "a.tif");
    assert_eq!(words_of(&frame), [0, 32768, 65535]);
    assert_eq!(frame.notes, ["Signed pixels were moved up by 32768."]);
}

#[test]
fn a_page_that_asks_to_be_turned_says_so() {
    let mut fields = grey_fields(2, 1, 8, 1);
    fields.push((274, 3, 6));
    let frame = only_frame(&raw_tiff(&fields, &[1, 2]), "a.tif");
    assert_eq!(bytes_of(&frame), [1, 2]);
    assert_eq!(frame.notes.len(), 1);
    assert!(frame.notes[0].contains("orientation 6"));
}

#[test]
fn what_is_not_read_is_refused_in_words() {
    let palette = raw_tiff(&grey_fields(2, 1, 8, 3), &[1, 2]);
    let error = decode_frames(&palette, "a.tif").unwrap_err();
    assert!(
        matches!(error.problem, Problem::Unsupported { .. }),
        "{error}"
    );
    let planar = planar_tiff();
    let error = decode_frames(&planar, "a.tif").unwrap_err();
    assert!(error.to_string().contains("one after the other"), "{error}");
    let mut fax = grey_fields(2, 1, 1, 1);
    fax[3].2 = 4;
    let error = decode_frames(&raw_tiff(&fax, &[1, 2]), "a.tif").unwrap_err();
    assert!(
        matches!(error.problem, Problem::Unsupported { .. }),
        "{error}"
    );
}

#[test]
fn pixels_beyond_the_end_are_noticed() {
    let mut file = raw_tiff(&grey_fields(4, 1, 8, 1), &[1, 2, 3, 4]);
    // The strip's offset field is the one with tag 273.
    let field = file.windows(4).position(|w| w == [17, 1, 4, 0]).unwrap();
    let end = file.len() as u32 - 2;
    file[field + 8..field + 12].copy_from_slice(&end.to_le_bytes());
    let error = decode_frames(&file, "a.tif").unwrap_err();
    assert!(
        error.to_string().contains("beyond the end of the file"),
        "{error}"
    );
}

/// Two pixels of three colours, a strip each: the lists of strips lie after the directory.
fn planar_tiff() -> Vec<u8> {
    let fields: [(u16, u16, u32, u32); 9] = [
        (256, 3, 1, 2),
        (257, 3, 1, 1),
        (258, 3, 1, 8),
        (262, 3, 1, 2),
        (273, 4, 3, 128),
        (277, 3, 1, 3),
        (278, 3, 1, 1),
        (279, 4, 3, 140),
        (284, 3, 1, 2),
    ];
    let mut file = b"II*\0\x08\0\0\0\x09\0".to_vec();
    for (tag, kind, count, value) in fields {
        file.extend([tag.to_le_bytes(), kind.to_le_bytes()].as_flattened());
        file.extend([count.to_le_bytes(), value.to_le_bytes()].as_flattened());
    }
    file.resize(128, 0);
    for number in [152u32, 154, 156, 2, 2, 2] {
        file.extend(number.to_le_bytes());
    }
    file.extend([1, 2, 3, 4, 5, 6]);
    file
}
