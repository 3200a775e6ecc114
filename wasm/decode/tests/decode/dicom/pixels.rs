//! Stored samples become greys.

use fluoropose_decode::{MaskRule, decode_frames, mask_of};

use super::UNCOMPRESSED;
use crate::samples::dicom::{BIG_ENDIAN, Builder, EXPLICIT, RLE, run_lengths};
use crate::samples::{bytes_of, only_frame, pattern, words_of};

#[test]
fn sixteen_bits_come_back_in_every_syntax() {
    let words: Vec<u16> = (0..2 * 15u16).map(|i| i * 2111).collect();
    for syntax in UNCOMPRESSED {
        let file = Builder::image(syntax, 5, 3, 16, 2).words(&words);
        let frames = decode_frames(&file, "run.dcm").unwrap_or_else(|e| panic!("{syntax}: {e}"));
        assert_eq!(frames.len(), 2);
        assert_eq!(
            (frames[0].width, frames[0].height, frames[0].bits),
            (5, 3, 16)
        );
        assert_eq!(words_of(&frames[0]), &words[..15]);
        assert_eq!(words_of(&frames[1]), &words[15..]);
    }
}

#[test]
fn eight_bits_come_back_in_every_syntax() {
    let pixels = pattern(6, 4);
    for syntax in UNCOMPRESSED {
        let file = Builder::image(syntax, 6, 4, 8, 1).octets(&pixels);
        assert_eq!(bytes_of(&only_frame(&file, "a.dcm")), pixels, "{syntax}");
    }
    // Big endian words hold two pixels, the first in the low byte.
    let mut words = Builder::image(BIG_ENDIAN, 4, 1, 8, 1);
    words.bytes(0x7FE0_0010, b"OW", &[2, 1, 4, 3]);
    assert_eq!(
        bytes_of(&only_frame(&words.finish(), "a.dcm")),
        [1, 2, 3, 4]
    );
}

#[test]
fn stored_bits_are_taken_out_of_allocated_ones() {
    let low = Builder::image_with(EXPLICIT, 3, 1, 1, "MONOCHROME2", [16, 12, 11, 0]);
    let frame = only_frame(&low.words(&[0xF123, 0x0FFF, 0x8000]), "a.dcm");
    assert_eq!(frame.bits, 12);
    assert_eq!(words_of(&frame), [0x123, 0xFFF, 0]);
    let high = Builder::image_with(EXPLICIT, 2, 1, 1, "MONOCHROME2", [16, 10, 15, 0]);
    assert_eq!(
        words_of(&only_frame(&high.words(&[0xFFC0, 0x007F]), "a.dcm")),
        [1023, 1]
    );
    let narrow = Builder::image_with(EXPLICIT, 2, 1, 1, "MONOCHROME2", [16, 8, 7, 0]);
    assert_eq!(
        bytes_of(&only_frame(&narrow.words(&[0xAB12, 0x00FF]), "a.dcm")),
        [0x12, 0xFF]
    );
}

#[test]
fn signed_pixels_are_moved_up_by_half_their_range() {
    let file = Builder::image_with(EXPLICIT, 4, 1, 1, "MONOCHROME2", [16, 12, 11, 1]);
    let frame = only_frame(&file.words(&[0x800, 0xFFF, 0, 0x7FF]), "a.dcm");
    assert_eq!(words_of(&frame), [0, 2047, 2048, 4095]);
}

#[test]
fn colour_becomes_luminance() {
    let image = |photometric, planar: u16| {
        let mut file = Builder::image_with(EXPLICIT, 2, 1, 1, photometric, [8, 8, 7, 0]);
        file.short(0x0028_0006, planar);
        file
    };
    let rgb = image("RGB", 0).octets(&[255, 0, 0, 9, 9, 9]);
    assert_eq!(bytes_of(&only_frame(&rgb, "a.dcm")), [76, 9]);
    let planes = image("RGB", 1).octets(&[255, 9, 0, 9, 0, 9]);
    assert_eq!(bytes_of(&only_frame(&planes, "a.dcm")), [76, 9]);
    let ybr = image("YBR_FULL", 0).octets(&[50, 1, 2, 60, 3, 4]);
    assert_eq!(bytes_of(&only_frame(&ybr, "a.dcm")), [50, 60]);
    let planes = image("YBR_FULL", 1).octets(&[50, 60, 1, 2, 3, 4]);
    assert_eq!(bytes_of(&only_frame(&planes, "a.dcm")), [50, 60]);
    let shared = image("YBR_FULL_422", 0).octets(&[50, 60, 1, 2]);
    assert_eq!(bytes_of(&only_frame(&shared, "a.dcm")), [50, 60]);
}

#[test]
fn colours_of_sixteen_bits_become_luminance() {
    for syntax in UNCOMPRESSED {
        let image = |photometric, planar: u16| {
            let mut file = Builder::image_with(syntax, 2, 1, 1, photometric, [16, 16, 15, 0]);
            file.short(0x0028_0006, planar);
            file
        };
        let rgb = image("RGB", 0).words(&[65535, 0, 0, 900, 900, 900]);
        assert_eq!(words_of(&only_frame(&rgb, "a.dcm")), [19595, 900]);
        let planes = image("RGB", 1).words(&[65535, 900, 0, 900, 0, 900]);
        assert_eq!(words_of(&only_frame(&planes, "a.dcm")), [19595, 900]);
        let ybr = image("YBR_FULL", 0).words(&[5000, 1, 2, 6000, 3, 4]);
        assert_eq!(words_of(&only_frame(&ybr, "a.dcm")), [5000, 6000]);
    }
}

/// A palette of three entries, of which the first has the number 10.
fn palette(syntax: &str, bits: u16, tables: [&[u8]; 3]) -> Builder {
    let mut file = Builder::image_with(syntax, 5, 1, 1, "PALETTE COLOR", [8, 8, 7, 0]);
    for colour in 0..3 {
        let shape = [3, 10, bits].map(|value| file.u16(value));
        file.bytes(0x0028_1101 + colour, b"US", shape.as_flattened());
    }
    for (colour, table) in (0..3).zip(tables) {
        file.bytes(0x0028_1201 + colour, b"OW", table);
    }
    file
}

/// Lower numbers have the colour of the first entry, and higher ones that of the last.
#[test]
fn palettes_become_luminance() {
    let numbers = [9, 10, 11, 12, 200];
    for syntax in UNCOMPRESSED {
        // Bytes come in words, the first in the low one.
        let packed = |bytes: [u8; 4]| match syntax == BIG_ENDIAN {
            true => [bytes[1], bytes[0], bytes[3], bytes[2]],
            false => bytes,
        };
        let tables = [[0, 255, 9, 0], [0, 0, 9, 0], [0, 0, 9, 0]].map(packed);
        let file = palette(syntax, 8, tables.each_ref().map(|table| table.as_slice()));
        assert_eq!(
            bytes_of(&only_frame(&file.octets(&numbers), "a.dcm")),
            [0, 0, 76, 9, 9]
        );

        let order = Builder::new(syntax);
        let table = |values: [u16; 3]| values.map(|value| order.u16(value)).concat();
        let tables = [
            table([0, 65535, 900]),
            table([0, 0, 900]),
            table([0, 0, 900]),
        ];
        let file = palette(syntax, 16, tables.each_ref().map(Vec::as_slice));
        let frame = only_frame(&file.octets(&numbers), "a.dcm");
        assert_eq!(words_of(&frame), [0, 0, 19595, 900, 900], "{syntax}");
    }
}

/// Frames of single bits follow each other without padding, the lowest bit first.
#[test]
fn single_bits_are_masks() {
    for syntax in UNCOMPRESSED {
        let file = Builder::image_with(syntax, 3, 2, 2, "MONOCHROME2", [1, 1, 0, 0]);
        // 101 010 and 011 111, lowest bit first, and padding.
        let frames = decode_frames(&file.octets(&[0b1001_0101, 0b1111]), "seg.dcm").unwrap();
        assert_eq!(bytes_of(&frames[0]), [1, 0, 1, 0, 1, 0], "{syntax}");
        assert_eq!(bytes_of(&frames[1]), [0, 1, 1, 1, 1, 1], "{syntax}");
        assert_eq!(frames[0].bits, 1);
        assert_eq!(
            mask_of(&frames[0], MaskRule::NonZero).pixels,
            [1, 0, 1, 0, 1, 0]
        );
    }
    let words = Builder::image_with(BIG_ENDIAN, 8, 2, 1, "MONOCHROME2", [1, 1, 0, 0]);
    let frame = only_frame(&words.words(&[0x0201]), "seg.dcm");
    assert_eq!(
        bytes_of(&frame),
        [1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    );
}

/// The highest 16 bits that the values use are kept, the same in all frames; what fits stays as it is.
#[test]
fn of_thirty_two_bits_the_highest_that_are_used_are_kept() {
    let read =
        |file: Builder, pixels: &[u32]| decode_frames(&file.long_words(pixels), "a.dcm").unwrap();
    for syntax in UNCOMPRESSED {
        let image = |photometric, signed| {
            Builder::image_with(syntax, 2, 1, 2, photometric, [32, 32, 31, signed])
        };
        let few = read(image("MONOCHROME2", 0), &[0, 40_000, 7, 300]);
        assert_eq!(
            (words_of(&few[0]), words_of(&few[1])),
            (&[0, 40_000][..], &[7, 300][..])
        );
        let many = read(image("MONOCHROME2", 0), &[0, 1 << 20, 15, 16 * 77 + 3]);
        // 21 bits are used, so that 5 are left out.
        assert_eq!(
            (words_of(&many[0]), words_of(&many[1])),
            (&[0, 1 << 15][..], &[0, 38][..])
        );
        assert_eq!(many[0].bits, 16);
        let dark = read(image("MONOCHROME1", 0), &[0, 3, 1, 2]);
        assert_eq!((bytes_of(&dark[0]), dark[0].bits), (&[3, 0][..], 2));
        let signed = read(image("MONOCHROME2", 1), &[u32::MAX, 300, 0, 5]);
        assert_eq!(
            (words_of(&signed[0]), words_of(&signed[1])),
            (&[0, 301][..], &[1, 6][..])
        );
    }
    let planes = [vec![0, 0], vec![0, 16], vec![1, 2], vec![3, 4]];
    let file = Builder::image_with(RLE, 2, 1, 1, "MONOCHROME2", [32, 32, 31, 0]);
    let frame = only_frame(&file.fragments(&[], &[&run_lengths(&planes)]), "a.dcm");
    assert_eq!(words_of(&frame), [0x103 >> 5, (0x10_0204u32 >> 5) as u16]);
}

/// In files that put the high byte first an odd frame shares a word with the next.
#[test]
fn frames_of_an_odd_number_of_bytes_come_back() {
    let mut file = Builder::image(BIG_ENDIAN, 3, 1, 8, 2);
    file.bytes(0x7FE0_0010, b"OW", &[2, 1, 4, 3, 6, 5]);
    let frames = decode_frames(&file.finish(), "a.dcm").unwrap();
    assert_eq!(
        (bytes_of(&frames[0]), bytes_of(&frames[1])),
        (&[1, 2, 3][..], &[4, 5, 6][..])
    );
}
