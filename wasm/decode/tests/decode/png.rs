use fluoropose_decode::FrameFile;
use png::{BitDepth, ColorType};

use crate::samples::{bytes_of, only_frame, pattern, png, png_with, words_of};

#[test]
fn eight_bit_grey_comes_back_exactly() {
    let pixels = pattern(13, 7);
    let frame = only_frame(
        &png(13, 7, ColorType::Grayscale, BitDepth::Eight, &pixels),
        "a.png",
    );
    assert_eq!((frame.width, frame.height, frame.bits), (13, 7, 8));
    assert_eq!(bytes_of(&frame), pixels);
    assert_eq!(frame.window, None);
}

#[test]
fn sixteen_bit_grey_comes_back_exactly() {
    let pixels: Vec<u16> = (0..35).map(|i| i * 1871).collect();
    let data: Vec<u8> = pixels.iter().flat_map(|p| p.to_be_bytes()).collect();
    let frame = only_frame(
        &png(5, 7, ColorType::Grayscale, BitDepth::Sixteen, &data),
        "a.png",
    );
    assert_eq!(frame.bits, 16);
    assert_eq!(words_of(&frame), pixels);
}

#[test]
fn few_bits_are_spread_over_a_byte() {
    let one = png(
        10,
        1,
        ColorType::Grayscale,
        BitDepth::One,
        &[0b1010_0000, 0b0100_0000],
    );
    assert_eq!(
        bytes_of(&only_frame(&one, "")),
        [255, 0, 255, 0, 0, 0, 0, 0, 0, 255]
    );
    let two = png(4, 1, ColorType::Grayscale, BitDepth::Two, &[0b00_01_10_11]);
    assert_eq!(bytes_of(&only_frame(&two, "")), [0, 85, 170, 255]);
    let four = png(3, 1, ColorType::Grayscale, BitDepth::Four, &[0x0F, 0x70]);
    assert_eq!(bytes_of(&only_frame(&four, "")), [0, 255, 7 * 17]);
}

#[test]
fn transparency_is_left_out() {
    let grey = png(
        2,
        1,
        ColorType::GrayscaleAlpha,
        BitDepth::Eight,
        &[9, 0, 200, 255],
    );
    assert_eq!(bytes_of(&only_frame(&grey, "")), [9, 200]);
    let colour = png(
        1,
        2,
        ColorType::Rgba,
        BitDepth::Eight,
        &[50, 50, 50, 0, 255, 0, 0, 9],
    );
    assert_eq!(bytes_of(&only_frame(&colour, "")), [50, 76]);
}

#[test]
fn colour_becomes_luminance() {
    let data = [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 1, 1, 1];
    let frame = only_frame(&png(5, 1, ColorType::Rgb, BitDepth::Eight, &data), "");
    // 0.299, 0.587 and 0.114 of 255, rounded.
    assert_eq!(bytes_of(&frame), [76, 150, 29, 255, 1]);
    let wide: Vec<u8> = [65535u16, 0, 0, 65535, 65535, 65535, 0, 300, 0]
        .iter()
        .flat_map(|v| v.to_be_bytes())
        .collect();
    let frame = only_frame(&png(3, 1, ColorType::Rgb, BitDepth::Sixteen, &wide), "");
    assert_eq!(words_of(&frame), [19595, 65535, 176]);
}

#[test]
fn a_palette_is_looked_up() {
    let file = png_with(
        3,
        1,
        ColorType::Indexed,
        BitDepth::Eight,
        &[2, 0, 1],
        |encoder| {
            encoder.set_palette(vec![0, 0, 0, 255, 255, 255, 255, 0, 0]);
        },
    );
    assert_eq!(bytes_of(&only_frame(&file, "")), [76, 0, 255]);
}

/// Whichever byte is broken: what is said is of words, and shows no fields of the decoder's.
#[test]
fn damage_is_told_in_words() {
    let sound = png(
        13,
        7,
        ColorType::Grayscale,
        BitDepth::Eight,
        &pattern(13, 7),
    );
    let mut told = std::collections::BTreeSet::new();
    for at in 8..sound.len() {
        let mut broken = sound.clone();
        broken[at] ^= 0x5A;
        let frame = FrameFile::open(broken, "a.png").and_then(|file| file.frame(0));
        if let Err(error) = frame {
            told.insert(error.to_string());
        }
    }
    assert!(told.len() > 2, "{told:?}");
    assert!(
        told.iter().all(|words| !words.contains(['{', '}'])),
        "{told:#?}"
    );
}
