use fluoropose_decode::{
    FrameFile, MaskRule, Problem, decode_mask, decode_mask_by, decode_masks, encode_mask,
    graded_mask,
};
use png::{BitDepth, ColorType};
use tiff::encoder::{Compression, colortype::Gray8};

use crate::samples::numpy::npy;
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

/// Of a picture of 100 x 100 with the values that are given for each distance from its middle: how many pixels its mask has.
fn area_of_graded(value: impl Fn(f64, usize) -> f64) -> Option<usize> {
    let at = |k: usize| {
        let off = |x: usize| x as f64 - 49.5;
        value(off(k % 100).hypot(off(k / 100)), k) as u8
    };
    let pixels: Vec<u8> = (0..10_000).map(at).collect();
    let file = png(100, 100, ColorType::Grayscale, BitDepth::Eight, &pixels);
    let frame = FrameFile::open(&file, "m.png").unwrap().frame(0).unwrap();
    let mask = graded_mask(&frame)?;
    assert_eq!(mask, decode_mask(&file, "m.png").unwrap());
    Some(mask.area())
}

#[test]
fn a_picture_is_a_graded_mask_where_nearly_all_of_it_is_decided() {
    // A disc of 30 pixels whose border is so many wide; a network's noise besides.
    let disc = |wide: f64, most: f64, noise: usize| {
        let edge = move |r: f64| ((30.0 - r) / wide + 0.5).clamp(0.0, 1.0);
        move |r: f64, k: usize| {
            let noise = (k * 7 % (noise + 1)) as f64;
            (most - noise).mul_add(edge(r), noise * (1.0 - edge(r)))
        }
    };
    let due = std::f64::consts::PI * 900.0;
    for (wide, most, noise) in [(2.0, 255.0, 0), (4.0, 255.0, 9), (3.0, 120.0, 4)] {
        let area = area_of_graded(disc(wide, most, noise)).expect("a mask") as f64;
        assert!((area - due).abs() < 0.01 * due, "{area} {due}");
    }
    // Blurred until the border is most of it; two greys; a collimated film; one that is dark but for a spot.
    assert_eq!(area_of_graded(disc(12.0, 255.0, 0)), None);
    assert_eq!(area_of_graded(|r, _| f64::from(r < 30.0) * 255.0), None);
    let film = |r: f64, k: usize| {
        if r < 45.0 {
            60.0 + (k % 140) as f64
        } else {
            0.0
        }
    };
    assert_eq!(area_of_graded(film), None);
    let spot = |r: f64, k: usize| if r < 1.0 { 255.0 } else { (k % 12) as f64 };
    assert_eq!(area_of_graded(spot), None);
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

/// Of a film the frames without an implant hold what a network is nearly sure of not being one.
#[test]
fn a_film_of_masks_has_one_rule() {
    let shown: Vec<f32> = (0..=20u8).map(|part| f32::from(part) / 20.0).collect();
    let not_shown = vec![0.02; 21];
    let bytes: Vec<u8> = [shown, not_shown]
        .concat()
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    let masks = |bytes: &[u8], name| decode_masks(&FrameFile::open(bytes, name).unwrap()).unwrap();
    let film = masks(&npy("<f4", "False", "(2, 3, 7)", &bytes), "m.npy");
    assert_eq!([film[0].area(), film[1].area()], [11, 0]);
    let alone = png(4, 1, ColorType::Grayscale, BitDepth::Eight, &[0, 1, 2, 255]);
    assert_eq!(
        masks(&alone, "m.png"),
        [decode_mask(&alone, "m.png").unwrap()]
    );
}
