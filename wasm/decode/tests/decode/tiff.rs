use tiff::encoder::colortype::{
    ColorType, Gray8, Gray16, Gray32Float, GrayI16, RGB8, RGB16, RGBA8,
};
use tiff::encoder::{Compression, DeflateLevel, TiffValue};
use tiff::tags::Tag;

use fluoropose_decode::{FrameFile, Problem, decode_frames};

use crate::samples::{
    big_tiff, bytes_of, foreign, grey_fields, jpeg, only_frame, pattern, predicted_tiff, raw_tiff,
    tiff, tiffs, tiled_tiff, words_of,
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
fn sizes_of_pages_are_told_before_they_are_decoded() {
    let file = tiff(Compression::Uncompressed, |encoder| {
        encoder.write_image::<Gray8>(2, 1, &[1, 2]).unwrap();
        encoder.write_image::<Gray8>(1, 3, &[1, 2, 3]).unwrap();
    });
    let file = FrameFile::open(file, "run.tif").unwrap();
    let sizes = [0, 1, 2].map(|page| file.size(page));
    assert_eq!(sizes, [Some((2, 1)), Some((1, 3)), None]);
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
        ["Pixels from -1 to 1 were mapped linearly to 0 to 65535."]
    );
    let flat = page::<Gray32Float>(2, 1, &[3.5, 3.5]);
    assert_eq!(words_of(&only_frame(&flat, "a.tif")), [0, 0]);
    let extreme = page::<Gray32Float>(3, 1, &[f32::MIN, f32::MAX, f32::INFINITY]);
    assert_eq!(words_of(&only_frame(&extreme, "a.tif")), [0, 65535, 65535]);
    let whole = only_frame(&page::<Gray32Float>(2, 1, &[3.0, 65535.0]), "a.tif");
    assert_eq!(words_of(&whole), [3, 65535]);
    assert!(whole.notes.is_empty());
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
    let mut lzma = grey_fields(2, 1, 8, 1);
    lzma[3].2 = 34_925;
    let error = decode_frames(&raw_tiff(&lzma, &[1, 2]), "a.tif").unwrap_err();
    assert!(
        matches!(error.problem, Problem::Unsupported { .. }),
        "{error}"
    );
    let mut tiles: Vec<_> = tiffs::fields(16, 16, &[8, 8, 8], 2);
    tiles.extend([(284, 3, vec![2]), (322, 3, vec![16]), (323, 3, vec![16])]);
    let mut file = tiffs::of_strips(&tiles, &[&[1; 256], &[2; 256], &[3; 256]]);
    // Strips become tiles by their tags alone.
    for (strip, tile) in [(273u16, 324u16), (279, 325)] {
        let field = strip.to_le_bytes();
        let at = file
            .windows(4)
            .rposition(|w| w == [field[0], field[1], 4, 0])
            .unwrap();
        file[at..at + 2].copy_from_slice(&tile.to_le_bytes());
    }
    let error = decode_frames(&file, "a.tif").unwrap_err();
    assert!(
        error.to_string().contains("one after the other in tiles"),
        "{error}"
    );
}

/// Entries of 8 bits, once or twice in 16, give 8 bits, and others 16; the page's numbers have any depth.
#[test]
fn palettes_become_luminance() {
    let palette = |entries: [u32; 12], bits: u32, strip: &[u8]| {
        let mut map = vec![0; 3 << bits];
        for (colour, entries) in entries.as_chunks::<4>().0.iter().enumerate() {
            map[colour << bits..][..entries.len().min(1 << bits)]
                .copy_from_slice(&entries[..entries.len().min(1 << bits)]);
        }
        let mut fields = tiffs::fields(4, 1, &[bits], 3);
        fields.push((320, 3, map));
        only_frame(&tiffs::of_strips(&fields, &[strip]), "a.tif")
    };
    let few = [0, 255, 0, 9, 0, 0, 0, 9, 0, 0, 255, 9];
    let due = [0, 76, 29, 9];
    assert_eq!(bytes_of(&palette(few, 8, &[0, 1, 2, 3])), due);
    assert_eq!(bytes_of(&palette(few, 4, &[0x01, 0x23])), due);
    assert_eq!(bytes_of(&palette(few, 2, &[0b0001_1011])), due);
    assert_eq!(
        bytes_of(&palette(few.map(|v| v * 257), 8, &[3, 2, 1, 0])),
        [9, 29, 76, 0]
    );
    let wide = [0, 65535, 0, 900, 0, 0, 0, 900, 0, 0, 65535, 900];
    assert_eq!(
        words_of(&palette(wide, 8, &[0, 1, 2, 3])),
        [0, 19595, 7471, 900]
    );
}

#[test]
fn a_number_beyond_the_palette_is_refused() {
    let mut fields = tiffs::fields(2, 1, &[8], 3);
    fields.push((320, 3, vec![0; 6]));
    let error = decode_frames(&tiffs::of_strips(&fields, &[&[1, 2]]), "a.tif").unwrap_err();
    assert!(error.to_string().contains("not in the palette"), "{error}");
}

#[test]
fn colours_that_are_stored_one_after_the_other_become_luminance() {
    let mut fields = tiffs::fields(2, 1, &[8, 8, 8], 2);
    fields.push((284, 3, vec![2]));
    let file = tiffs::of_strips(&fields, &[&[255, 9], &[0, 9], &[0, 9]]);
    assert_eq!(bytes_of(&only_frame(&file, "a.tif")), [76, 9]);
}

/// What is beside grey is transparency and left out.
#[test]
fn grey_may_have_another_channel() {
    let mut fields = tiffs::fields(2, 1, &[8, 8], 1);
    fields.push((338, 3, vec![2]));
    let file = tiffs::of_strips(&fields, &[&[7, 200, 8, 100]]);
    assert_eq!(bytes_of(&only_frame(&file, "a.tif")), [7, 8]);
}

#[test]
fn wide_whole_numbers_stay_where_they_fit_and_are_mapped_where_not() {
    let read = |values: [u32; 3]| {
        let strip = values.map(u32::to_le_bytes);
        let file = tiffs::of_strips(&tiffs::fields(3, 1, &[32], 1), &[strip.as_flattened()]);
        only_frame(&file, "a.tif")
    };
    let fits = read([0, 65535, 7]);
    assert_eq!((words_of(&fits), fits.notes.len()), (&[0, 65535, 7][..], 0));
    let wide = read([100_000, 300_000, 200_000]);
    assert_eq!(words_of(&wide), [0, 65535, 32768]);
    assert!(
        wide.notes[0].contains("from 100000 to 300000"),
        "{:?}",
        wide.notes
    );
}

#[test]
fn colours_of_floating_point_become_luminance() {
    let values = [1.0f32, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0].map(f32::to_le_bytes);
    let mut fields = tiffs::fields(3, 1, &[32, 32, 32], 2);
    fields.push((339, 3, vec![3, 3, 3]));
    let file = tiffs::of_strips(&fields, &[values.as_flattened()]);
    assert_eq!(words_of(&only_frame(&file, "a.tif")), [19595, 0, 65535]);
}

#[test]
fn fax_codes_are_read() {
    let mut fields = tiffs::fields(foreign::GREY.0.into(), foreign::GREY.1.into(), &[1], 1);
    fields[3].2 = vec![4];
    let file = tiffs::of_strips(&fields, &[foreign::FAX]);
    assert_eq!(bytes_of(&only_frame(&file, "mask.tif")), foreign::disc());
}

/// Each strip is an image of its own; tables that they share stand apart.
#[test]
fn strips_of_jpeg_are_read() {
    let images = [40, 200].map(|level| jpeg(16, 8, &[level; 128], false));
    // Everything between the marks that begin the image and its frame: tables, and a word of who wrote it.
    let frame = images[0]
        .windows(2)
        .position(|pair| pair == [0xFF, 0xC0])
        .unwrap();
    let tables = [&images[0][..frame], &[0xFF, 0xD9]].concat();
    let bare: Vec<Vec<u8>> = images
        .iter()
        .map(|image| [&image[..2], &image[frame..]].concat())
        .collect();
    let mut fields = tiffs::fields(16, 14, &[8], 1);
    fields[3].2 = vec![7];
    fields[6].2 = vec![8];
    fields.push((347, 7, tables.iter().map(|&byte| byte.into()).collect()));
    let file = tiffs::of_strips(&fields, &[&bare[0], &bare[1]]);
    let decoded = only_frame(&file, "a.tif");
    let (first, second) = bytes_of(&decoded).split_at(128);
    assert!(first.iter().all(|pixel| pixel.abs_diff(40) <= 1));
    assert!(second.iter().all(|pixel| pixel.abs_diff(200) <= 1));
}

/// A small file could otherwise be decoded again and again.
#[test]
fn strips_that_lie_upon_each_other_are_refused() {
    let mut fields = tiffs::fields(100, 4, &[8], 1);
    fields[6].2 = vec![1];
    let strip = [7; 100];
    let mut file = tiffs::of_strips(&fields, &[&strip[..]; 4]);
    let offsets: Vec<u8> = (0..4).flat_map(|_| 8u32.to_le_bytes()).collect();
    let listed: Vec<u8> = (0..4u32)
        .flat_map(|strip| (8 + 100 * strip).to_le_bytes())
        .collect();
    let at = file.windows(16).position(|w| w == listed).unwrap();
    file[at..at + 16].copy_from_slice(&offsets);
    // All of the page's strips together still fit the file; of a larger part of it they do not.
    assert!(decode_frames(&file, "a.tif").is_ok());
    let mut counts: Vec<u8> = (0..4).flat_map(|_| 100u32.to_le_bytes()).collect();
    let at = file.windows(16).position(|w| w == counts).unwrap();
    counts = (0..4).flat_map(|_| 300u32.to_le_bytes()).collect();
    file[at..at + 16].copy_from_slice(&counts);
    let error = decode_frames(&file, "a.tif").unwrap_err();
    assert!(error.to_string().contains("upon each other"), "{error}");
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

/// The picture in the files of fax codes, which another library wrote (tests/corpus/frames).
fn faxed() -> Vec<u8> {
    let pixel = |k: i32| {
        let (x, y) = (k % 77, k / 77);
        let white = (x - 30).pow(2) + (y - 15).pow(2) < 120 || (3 * x + 7 * y) % 23 < 4;
        if (white && y != 5) || y == 4 { 255 } else { 0 }
    };
    (0..77 * 31).map(pixel).collect()
}

const FAXED: [&[u8]; 3] = [
    include_bytes!("../../../../tests/corpus/frames/fax-2.tif"),
    include_bytes!("../../../../tests/corpus/frames/fax-3.tif"),
    include_bytes!("../../../../tests/corpus/frames/fax-3-rows-above.tif"),
];

#[test]
fn fax_codes_of_group_3_are_read() {
    for file in FAXED {
        let frame = only_frame(file, "a.tif");
        assert_eq!((frame.width, frame.height), (77, 31));
        assert_eq!(bytes_of(&frame), faxed());
    }
}

#[test]
fn fax_codes_that_mean_nothing_are_refused() {
    let mut refused = 0;
    for file in FAXED {
        for at in 8..file.len() {
            for change in [0x01, 0x80, 0xFF] {
                let mut changed = file.to_vec();
                changed[at] ^= change;
                // Whatever comes out, it is as large as is said.
                match decode_frames(&changed, "a.tif") {
                    Ok(frames) => frames.iter().for_each(|frame| {
                        let size = (frame.width * frame.height) as usize;
                        assert_eq!(frame.pixels.len(), size);
                    }),
                    Err(_) => refused += 1,
                }
            }
        }
    }
    assert!(refused > 100, "{refused}");
}

/// A page of 16 x 14 pixels in one strip of this many rows.
fn jpeg_strip(photometric: u64, image: &[u8]) -> Vec<u8> {
    let mut fields = tiffs::fields(16, 14, &[8], 1);
    for (tag, value) in [(259, 7), (262, photometric), (278, 14)] {
        let field = fields.iter_mut().find(|field| field.0 == tag);
        field.expect("a field of every page").2 = vec![value as _];
    }
    tiffs::of_strips(&fields, &[image])
}

#[test]
fn a_jpeg_page_with_white_at_0_has_black_there() {
    let image = jpeg(16, 14, &[40; 16 * 14], false);
    let shown = |photometric| bytes_of(&only_frame(&jpeg_strip(photometric, &image), "a.tif"))[0];
    assert!(shown(0).abs_diff(215) <= 1 && shown(1).abs_diff(40) <= 1);
}

#[test]
fn an_image_smaller_than_its_strip_is_refused() {
    let image = jpeg(16, 4, &[200; 16 * 4], false);
    let error = decode_frames(&jpeg_strip(1, &image), "a.tif").unwrap_err();
    assert!(
        error.to_string().contains("strip or tile 1 is smaller"),
        "{error}"
    );
}
