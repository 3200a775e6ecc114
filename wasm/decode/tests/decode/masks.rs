use fluoropose_decode::{MaskRule, Problem, decode_mask, decode_mask_by, encode_mask};
use png::{BitDepth, ColorType};
use tiff::encoder::{Compression, colortype::Gray8};

use crate::samples::{jpeg, png, tiff};

#[test]
fn anything_but_zero_is_inside() {
    let labels = png(4, 1, ColorType::Grayscale, BitDepth::Eight, &[0, 1, 2, 255]);
    let mask = decode_mask(&labels, "m.png").unwrap();
    assert_eq!((mask.width, mask.height), (4, 1));
    assert_eq!(mask.pixels, [0, 1, 1, 1]);
    assert_eq!(mask.area(), 3);
    let words = png(2, 1, ColorType::Grayscale, BitDepth::Sixteen, &[0, 1, 0, 0]);
    assert_eq!(decode_mask(&words, "m.png").unwrap().pixels, [1, 0]);
}

#[test]
fn a_threshold_may_be_given() {
    let file = png(
        4,
        1,
        ColorType::Grayscale,
        BitDepth::Eight,
        &[0, 99, 100, 255],
    );
    let mask = decode_mask_by(&file, "m.png", MaskRule::AtLeast(100)).unwrap();
    assert_eq!(mask.pixels, [0, 0, 1, 1]);
}

#[test]
fn ripples_of_jpeg_are_not_inside() {
    let pixels: Vec<u8> = (0..32 * 32)
        .map(|i| if i % 32 > 13 && i / 32 > 9 { 255 } else { 0 })
        .collect();
    let mask = decode_mask(&jpeg(32, 32, &pixels, false), "m.jpg").unwrap();
    let due: Vec<u8> = pixels.iter().map(|&p| p / 255).collect();
    assert_eq!(mask.pixels, due);
}

/// The outline of a network's probabilities, and of edges that a program smoothed, is where they are a half.
#[test]
fn half_the_largest_of_graded_values_is_inside() {
    let ramp: Vec<u8> = (0..32)
        .map(|at| 255 * at / 31)
        .map(|v: u32| v as u8)
        .collect();
    let due = |at: usize| u8::from(at >= 16);
    let mask = |pixels: &[u8]| {
        let file = png(32, 1, ColorType::Grayscale, BitDepth::Eight, pixels);
        decode_mask(&file, "m.png").unwrap().pixels
    };
    assert_eq!(mask(&ramp), (0..32).map(due).collect::<Vec<_>>());
    // A network that is never sure, and words in place of bytes.
    let weak: Vec<u8> = ramp.iter().map(|v| v / 3).collect();
    assert_eq!(mask(&weak), (0..32).map(due).collect::<Vec<_>>());
    let words: Vec<u8> = ramp.iter().flat_map(|&v| [v, v]).collect();
    let file = png(32, 1, ColorType::Grayscale, BitDepth::Sixteen, &words);
    let words = decode_mask(&file, "m.png").unwrap().pixels;
    assert_eq!(words, (0..32).map(due).collect::<Vec<_>>());
    // Labels are few.
    let labels: Vec<u8> = (0..32).map(|at| at % 7).collect();
    let labelled: Vec<u8> = labels.iter().map(|&label| label.min(1)).collect();
    assert_eq!(mask(&labels), labelled);
}

#[test]
fn several_pages_are_refused() {
    let file = tiff(Compression::Uncompressed, |encoder| {
        encoder.write_image::<Gray8>(1, 1, &[1]).unwrap();
        encoder.write_image::<Gray8>(1, 1, &[1]).unwrap();
    });
    let error = decode_mask(&file, "m.tif").unwrap_err();
    assert_eq!(error.problem, Problem::SeveralMasks { count: 2 });
}

#[test]
fn a_written_mask_is_read_back() {
    let inside: Vec<u8> = (0..37 * 11).map(|at| u8::from(at % 3 == 0) * 7).collect();
    let bytes = encode_mask(inside.clone(), 37, 11).unwrap();
    let again = decode_mask(&bytes, "m.png").unwrap();
    assert_eq!((again.width, again.height), (37, 11));
    let same = |(&a, &b): (&u8, &u8)| (a != 0) == (b != 0);
    assert!(again.pixels.iter().zip(&inside).all(same));
}

#[test]
fn too_few_pixels_are_refused() {
    let sentence = encode_mask(vec![1, 0, 1], 2, 2).unwrap_err().to_string();
    assert!(sentence.contains("3 pixels for 2 x 2"), "{sentence}");
}
