//! Compressed pixels.

use fluoropose_decode::{FrameFile, Problem, decode_frames};

use crate::samples::dicom::{
    Builder, JPEG_BASELINE, JPEG_EXTENDED, JPEG_LOSSLESS, JPEG_LS, RLE, run_lengths,
};
use crate::samples::{bytes_of, foreign, jpeg, jpeg_of, lossless, only_frame, pattern, words_of};

#[test]
fn run_lengths_are_read() {
    let mut first = vec![7; 150];
    first.extend(pattern(10, 10));
    let second: Vec<u8> = first.iter().rev().copied().collect();
    let frames = [
        run_lengths(&[first.clone()]),
        run_lengths(std::slice::from_ref(&second)),
    ];
    let file = Builder::image(RLE, 25, 10, 8, 2).fragments(&[], &[&frames[0], &frames[1]]);
    let decoded = decode_frames(&file, "a.dcm").unwrap();
    assert_eq!(bytes_of(&decoded[0]), first);
    assert_eq!(bytes_of(&decoded[1]), second);

    let words: Vec<u16> = first
        .iter()
        .zip(&second)
        .map(|(&h, &l)| u16::from_be_bytes([h, l]))
        .collect();
    let frame = run_lengths(&[first, second]);
    let file = Builder::image(RLE, 25, 10, 16, 1).fragments(&[0], &[&frame]);
    assert_eq!(words_of(&only_frame(&file, "a.dcm")), words);
}

#[test]
fn jpeg_frames_are_split_by_fragment_table_or_mark() {
    let images: Vec<Vec<u8>> = [40u8, 120, 200]
        .iter()
        .map(|&level| jpeg(16, 8, &[level; 128], false))
        .collect();
    let whole: Vec<&[u8]> = images.iter().map(Vec::as_slice).collect();
    let (head, tail) = images[1].split_at(images[1].len() / 4 * 2);
    let split = [whole[0], head, tail, whole[2]];
    let even = |n: usize| (n.next_multiple_of(2) + 8) as u32;
    let second = even(whole[0].len());
    let third = second + even(head.len()) + even(tail.len());
    let builder = || Builder::image(JPEG_BASELINE, 16, 8, 8, 3);
    let files = [
        builder().fragments(&[], &whole),
        builder().fragments(&[0, second, third], &split),
        builder().fragments(&[], &split),
    ];
    for file in files {
        let file = FrameFile::open(file, "run.dcm").unwrap();
        for (index, level) in [(2, 200), (0, 40), (1, 120)] {
            let frame = file.frame(index).unwrap();
            assert!(bytes_of(&frame).iter().all(|p| p.abs_diff(level) <= 1));
        }
    }
}

#[test]
fn lossless_jpeg_comes_back_exactly() {
    let words: Vec<u16> = (0..48u16).map(|i| i.wrapping_mul(1777) % 4096).collect();
    let image = lossless::jpeg(8, 6, 12, &words);
    let grey = Builder::image_with(JPEG_LOSSLESS, 8, 6, 1, "MONOCHROME2", [16, 12, 11, 0]);
    let frame = only_frame(&grey.fragments(&[], &[&image]), "a.dcm");
    assert_eq!(words_of(&frame), words);
    let dark = Builder::image_with(JPEG_LOSSLESS, 8, 6, 1, "MONOCHROME1", [16, 12, 11, 0]);
    let frame = only_frame(
        &dark.fragments(&[], &[&image[..100], &image[100..]]),
        "a.dcm",
    );
    let inverted: Vec<u16> = words.iter().map(|w| 4095 - w).collect();
    assert_eq!(words_of(&frame), inverted);
}

#[test]
fn colour_run_lengths_are_read() {
    let planes = [vec![255, 9, 0], vec![0, 9, 0], vec![0, 9, 255]];
    let mut file = Builder::image_with(RLE, 3, 1, 1, "RGB", [8, 8, 7, 0]);
    file.short(0x0028_0006, 1);
    let file = file.fragments(&[], &[&run_lengths(&planes)]);
    assert_eq!(bytes_of(&only_frame(&file, "a.dcm")), [76, 9, 29]);
}

#[test]
fn codings_that_are_not_read_are_named() {
    let file = Builder::image("1.2.840.10008.1.2.4.110", 2, 1, 8, 1).fragments(&[], &[&[1, 2]]);
    let error = decode_frames(&file, "run.dcm").unwrap_err();
    assert_eq!(
        error.to_string(),
        "run.dcm: this DICOM file holds JPEG XL lossless pixels (transfer syntax 1.2.840.10008.1.2.4.110), which is \
         not read. Export it from the viewer or archive uncompressed (Explicit VR Little Endian), or as lossless JPEG, \
         JPEG-LS, JPEG 2000 or RLE; gdcmconv --raw converts files, too."
    );
    for (uid, word) in [
        ("1.2.840.10008.1.2.4.92", "part 2"),
        ("1.2.840.10008.1.2.4.201", "high-throughput"),
        ("1.2.840.10008.1.2.4.203", "pydicom"),
        ("1.2.840.10008.1.2.4.102", "video"),
        ("9.9", "'9.9'"),
    ] {
        let file = Builder::image(uid, 2, 1, 8, 1).fragments(&[], &[&[1, 2]]);
        let error = decode_frames(&file, "run.dcm").unwrap_err();
        assert!(matches!(error.problem, Problem::Unsupported { .. }));
        assert!(error.to_string().contains(word), "{error}");
    }
}

/// The frame of a file with one coded image.
fn coded(
    syntax: &str,
    (width, height): (u16, u16),
    kind: &str,
    bits: [u16; 4],
    image: &[u8],
) -> Vec<u8> {
    Builder::image_with(syntax, width, height, 1, kind, bits).fragments(&[], &[image])
}

#[test]
fn jpeg_ls_is_read() {
    let grey = |bits: u16, image| {
        let bits = [bits, bits, bits - 1, 0];
        only_frame(
            &coded(JPEG_LS, foreign::GREY, "MONOCHROME2", bits, image),
            "a.dcm",
        )
    };
    let picture = foreign::textured(foreign::GREY, (12, 3));
    assert_eq!(bytes_of(&grey(8, foreign::LS_8)), picture);
    let near = grey(8, foreign::LS_8_NEAR_3);
    assert!(
        bytes_of(&near)
            .iter()
            .zip(&picture)
            .all(|(a, b)| a.abs_diff(*b) <= 3)
    );
    assert_ne!(bytes_of(&near), picture);
    let wide = grey(16, foreign::LS_16_NEAR_2);
    let due = picture.iter().map(|&pixel| 13 * u16::from(pixel) + 5);
    assert!(
        words_of(&wide)
            .iter()
            .zip(due)
            .all(|(a, b)| a.abs_diff(b) <= 2)
    );
}

#[test]
fn jpeg_ls_in_colour_becomes_luminance() {
    let due = foreign::colour_luminance();
    for image in [
        foreign::LS_COLOUR_PLANES,
        foreign::LS_COLOUR_LINES,
        foreign::LS_COLOUR_SAMPLES,
    ] {
        let file = coded(JPEG_LS, foreign::COLOUR, "RGB", [8, 8, 7, 0], image);
        assert_eq!(bytes_of(&only_frame(&file, "a.dcm")), due);
    }
}

#[test]
fn twelve_bits_in_cosines_are_read() {
    let bits = [16, 12, 11, 0];
    let file = coded(
        JPEG_EXTENDED,
        foreign::GREY,
        "MONOCHROME2",
        bits,
        foreign::COSINES_12,
    );
    let frame = only_frame(&file, "a.dcm");
    assert_eq!(frame.bits, 12);
    let due = foreign::ramp();
    // As far as the encoder's factors allow; it was within 1 with the decoder of its own library.
    assert!(
        words_of(&frame)
            .iter()
            .zip(&due)
            .all(|(a, b)| a.abs_diff(*b) <= 2)
    );
}

/// Of three components whose image does not tell what they are the file's own word counts.
#[test]
fn colours_of_a_jpeg_that_does_not_tell_are_what_the_file_says() {
    let image = jpeg_of(
        16,
        8,
        &[200, 90, 30].repeat(128),
        jpeg_encoder::ColorType::Rgb,
        false,
    );
    let luminance = |kind| {
        // The markers that tell it are taken out, and so are the names of the components.
        let mut image = image.clone();
        let segment = 2 + usize::from(u16::from_be_bytes([image[4], image[5]]));
        assert_eq!(image[2..4], [0xFF, 0xE0]);
        image.drain(2..2 + segment);
        let frame = image
            .windows(2)
            .position(|pair| pair == [0xFF, 0xC0])
            .unwrap();
        let scan = image
            .windows(2)
            .position(|pair| pair == [0xFF, 0xDA])
            .unwrap();
        for component in 0..3 {
            image[frame + 10 + 3 * component] = component as u8;
            image[scan + 5 + 2 * component] = component as u8;
        }
        let file = coded(JPEG_BASELINE, (16, 8), kind, [8, 8, 7, 0], &image);
        bytes_of(&only_frame(&file, "a.dcm"))[0]
    };
    // 0.299, 0.587 and 0.114 of 200, 90 and 30 are 116; taken as colours, luminance and differences are another grey.
    assert!(luminance("YBR_FULL_422").abs_diff(116) <= 2);
    assert!(luminance("RGB").abs_diff(116) > 5);
}
