use fluoropose_decode::{FrameFile, GreyFrame, Pixels, Problem, decode_mask};

use crate::samples::numpy::{npy, with_header};
use crate::samples::pattern;

fn frames(file: &[u8]) -> Vec<GreyFrame> {
    let file = FrameFile::open(file, "x.npy").unwrap();
    let sizes: Vec<_> = (0..file.count()).map(|index| file.size(index)).collect();
    let frames: Vec<_> = (0..file.count())
        .map(|index| file.frame(index).unwrap())
        .collect();
    let held: Vec<_> = frames.iter().map(|f| Some((f.width, f.height))).collect();
    assert_eq!(sizes, held);
    frames
}

fn told(file: &[u8]) -> String {
    let problem: Problem = FrameFile::open(file, "x.npy").err().unwrap().problem;
    problem.to_string()
}

fn octets(pixels: &[u8]) -> Pixels {
    Pixels::U8(pixels.to_vec())
}

#[test]
fn greys_come_back_as_they_were() {
    let greys = pattern(5, 4);
    let [frame] = &frames(&npy("|u1", "False", "(4, 5)", &greys))[..] else {
        panic!("one frame");
    };
    assert_eq!((frame.width, frame.height), (5, 4));
    assert_eq!(frame.pixels, octets(&greys));
    let words: Vec<u16> = greys.iter().map(|&grey| 257 * u16::from(grey)).collect();
    for (descr, bytes) in [
        (
            "<u2",
            words
                .iter()
                .flat_map(|w| w.to_le_bytes())
                .collect::<Vec<u8>>(),
        ),
        (">u2", words.iter().flat_map(|w| w.to_be_bytes()).collect()),
        (
            "<i8",
            words
                .iter()
                .flat_map(|&w| i64::from(w).to_le_bytes())
                .collect(),
        ),
        (
            "<f4",
            words
                .iter()
                .flat_map(|&w| f32::from(w).to_le_bytes())
                .collect(),
        ),
    ] {
        let frames = frames(&npy(descr, "False", "(4, 5)", &bytes));
        assert_eq!(frames[0].pixels, Pixels::U16(words.clone()), "{descr}");
        assert!(frames[0].notes.is_empty());
    }
}

#[test]
fn a_film_is_frames_first_whichever_axis_goes_fastest() {
    let greys = pattern(5, 12);
    let by_rows = frames(&npy("|u1", "False", "(3, 4, 5)", &greys));
    let turned: Vec<u8> = (0..60)
        .map(|at| greys[at % 3 * 20 + at / 3 % 4 * 5 + at / 12])
        .collect();
    let by_columns = frames(&npy("|u1", "True", "(3, 4, 5)", &turned));
    assert_eq!(by_rows, by_columns);
    let expected: Vec<Pixels> = greys.chunks(20).map(octets).collect();
    let held: Vec<Pixels> = by_rows.into_iter().map(|frame| frame.pixels).collect();
    assert_eq!(held, expected);
    assert_eq!(
        frames(&npy("|u1", "False", "(3, 1, 4, 5)", &greys)).len(),
        3
    );
}

#[test]
fn colours_become_grey_and_what_is_true_is_white() {
    let colours = [[9, 9, 9], [1, 0, 2], [0, 0, 255], [255, 0, 0]];
    let numbers = colours.as_flattened();
    let grey = octets(&[9, 1, 29, 76]);
    assert_eq!(
        frames(&npy("|u1", "False", "(1, 2, 2, 3)", numbers))[0].pixels,
        grey
    );
    let mask = npy("|b1", "False", "(2, 3)", &[0, 1, 1, 0, 0, 1]);
    assert_eq!(frames(&mask)[0].pixels, octets(&[0, 255, 255, 0, 0, 255]));
    assert_eq!(
        decode_mask(&mask, "x.npy").unwrap().pixels,
        [0, 1, 1, 0, 0, 1]
    );
}

/// A frame of nothing but small numbers would be noise from black to white.
#[test]
fn all_frames_are_mapped_alike() {
    let numbers = [0.0, 0.5, 1.0, 0.25, 0.0, 0.01, 0.0, f32::NAN];
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let frames = frames(&npy("<f4", "False", "(2, 2, 2)", &bytes));
    assert_eq!(frames[0].pixels, Pixels::U16(vec![0, 32768, 65535, 16384]));
    assert_eq!(frames[1].pixels, Pixels::U16(vec![0, 655, 0, 0]));
    assert_eq!(
        frames[1].notes,
        ["Pixels from 0 to 1 were mapped linearly to 0 to 65535."]
    );
}

#[test]
fn other_versions_and_ways_to_write_a_header_are_read() {
    let greys = pattern(3, 2);
    let plain = frames(&npy("|u1", "False", "(2, 3)", &greys));
    let header = "{\"shape\": (2L, 3L), \"fortran_order\": False, \"descr\": \"|u1\"}";
    for version in [[1, 0], [2, 0], [3, 0]] {
        assert_eq!(frames(&with_header(&version, header, &greys)), plain);
    }
}

#[test]
fn what_is_no_film_is_told() {
    let short = told(&npy("<u2", "False", "(4, 5)", &[0; 39]));
    assert!(
        short.contains("it is too short for its stated shape"),
        "{short}"
    );
    let complex = told(&npy("<c8", "False", "(1, 1)", &[0; 8]));
    assert!(
        complex.contains("holds values of the type <c8, which is not read"),
        "{complex}"
    );
    let records = "{'descr': [('a', '<u2')], 'fortran_order': False, 'shape': (1, 1), }";
    let records = told(&with_header(&[1, 0], records, &[0; 8]));
    assert!(records.contains("holds records"), "{records}");
    let line = told(&npy("|u1", "False", "(9,)", &[0; 9]));
    assert!(
        line.contains("an array of shape (9), which is not read. Save frames as"),
        "{line}"
    );
    let none = told(&npy("|u1", "False", "(0, 4, 5)", &[]));
    assert!(none.contains("0 frames"), "{none}");
    let wide = told(&npy("|u1", "False", "(4, 9000)", &[0; 36000]));
    assert!(
        wide.contains("a frame of 9000 x 4 pixels cannot be opened"),
        "{wide}"
    );
    let huge = told(&npy("<f8", "False", "(4, 18446744073709551615)", &[]));
    assert!(huge.contains("cannot be opened"), "{huge}");
    let many = told(&npy("<f8", "False", "(9999, 8192, 8192)", &[0; 64]));
    assert!(many.contains("too short"), "{many}");
    let no_shape = told(&with_header(
        &[1, 0],
        "{'descr': '|u1', 'fortran_order': False}",
        &[],
    ));
    assert!(
        no_shape.contains("its header has no \"shape\""),
        "{no_shape}"
    );
    let cut = npy("|u1", "False", "(2, 3)", &pattern(3, 2));
    for length in 6..cut.len() {
        assert!(
            FrameFile::open(&cut[..length], "x.npy").is_err(),
            "{length}"
        );
    }
}
