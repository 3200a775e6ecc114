use fluoropose_decode::{Problem, decode_frames};

use crate::samples::{bytes_of, jpeg, jpeg_of, lossless, only_frame, pattern, words_of};

/// A smooth picture, which best-quality coding keeps within rounding.
fn ramp(width: usize, height: usize) -> Vec<u8> {
    (0..width * height)
        .map(|i| (20 + 2 * (i % width) + 3 * (i / width)) as u8)
        .collect()
}

fn worst(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

#[test]
fn baseline_and_progressive_are_read() {
    let pixels = ramp(37, 21);
    for progressive in [false, true] {
        let frame = only_frame(&jpeg(37, 21, &pixels, progressive), "a.jpg");
        assert_eq!((frame.width, frame.height), (37, 21));
        assert!(worst(bytes_of(&frame), &pixels) <= 1);
    }
}

#[test]
fn colour_becomes_luminance() {
    // Red throughout: 0.299 of 255.
    let red = [255, 0, 0].repeat(64);
    let frame = only_frame(
        &jpeg_of(8, 8, &red, jpeg_encoder::ColorType::Rgb, false),
        "a.jpg",
    );
    assert!(worst(bytes_of(&frame), &[76; 64]) <= 1);
}

#[test]
fn lossless_comes_back_exactly() {
    let bytes = pattern(9, 5);
    let wide: Vec<u16> = bytes.iter().map(|&b| b.into()).collect();
    assert_eq!(
        bytes_of(&only_frame(&lossless::jpeg(9, 5, 8, &wide), "a.jpg")),
        bytes
    );

    let words: Vec<u16> = (0..45u16).map(|i| i.wrapping_mul(2909) % 4096).collect();
    let frame = only_frame(&lossless::jpeg(9, 5, 12, &words), "a.jpg");
    assert_eq!(frame.bits, 12);
    assert_eq!(words_of(&frame), words);

    let full: Vec<u16> = (0..45u16).map(|i| i.wrapping_mul(40503)).collect();
    assert_eq!(
        words_of(&only_frame(&lossless::jpeg(9, 5, 16, &full), "a.jpg")),
        full
    );
}

#[test]
fn every_predictor_restart_and_shift_comes_back_exactly() {
    for precision in [2u8, 5, 8, 10, 12, 16] {
        let most = u16::MAX >> (16 - precision);
        let words: Vec<u16> = (0..99u16)
            .map(|i| i.wrapping_mul(40503) >> 3 & most)
            .collect();
        for predictor in 1..=7 {
            for (shift, restart_rows) in [(0, 0), (0, 1), (0, 4), (1, 0), (1, 3)] {
                let coding = lossless::Coding {
                    precision,
                    predictor,
                    shift,
                    restart_rows,
                };
                let frame = only_frame(&lossless::coded(11, 9, &[&words], coding), "a.jpg");
                let kept: Vec<u16> = words.iter().map(|w| w >> shift << shift).collect();
                let found: Vec<u16> = (0..99).map(|at| frame.pixels.get(at).unwrap()).collect();
                assert_eq!(
                    found, kept,
                    "{precision} bits, predictor {predictor}, shift {shift}, restart {restart_rows}"
                );
                assert_eq!(frame.bits, precision);
            }
        }
    }
}

#[test]
fn lossless_colours_become_luminance() {
    let red: Vec<u16> = vec![255; 12];
    let dark = vec![0; 12];
    let coding = lossless::Coding {
        precision: 8,
        predictor: 4,
        shift: 0,
        restart_rows: 0,
    };
    let frame = only_frame(
        &lossless::coded(4, 3, &[&red, &dark, &dark], coding),
        "a.jpg",
    );
    assert_eq!(bytes_of(&frame), [76; 12]);
}

#[test]
fn restart_marks_that_are_missing_are_refused() {
    let words: Vec<u16> = (0..40).collect();
    let coding = lossless::Coding {
        precision: 8,
        predictor: 1,
        shift: 0,
        restart_rows: 2,
    };
    let mut file = lossless::coded(5, 8, &[&words], coding);
    let mark = file
        .windows(2)
        .position(|pair| pair == [0xFF, 0xD1])
        .unwrap();
    file.drain(mark..mark + 2);
    let error = decode_frames(&file, "a.jpg").unwrap_err().to_string();
    assert!(error.contains("damaged"), "{error}");
}

#[test]
fn four_colour_channels_are_refused_in_words() {
    let file = jpeg_of(8, 8, &[0; 256], jpeg_encoder::ColorType::Cmyk, false);
    let error = decode_frames(&file, "print.jpg").unwrap_err();
    assert!(matches!(error.problem, Problem::Unsupported { .. }));
    assert_eq!(
        error.to_string(),
        "print.jpg: this JPEG file holds 4 colour channels, which is not read. Export it as an ordinary JPEG, PNG \
         or TIFF."
    );
}
