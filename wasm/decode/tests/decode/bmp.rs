use fluoropose_decode::{FrameFile, Pixels, Problem, decode_mask};

use crate::samples::bmp::{Picture, bmp, grey};
use crate::samples::pattern;

fn pixels(file: &[u8]) -> Vec<u8> {
    let frame = FrameFile::open(file, "x.bmp").unwrap().frame(0).unwrap();
    let Pixels::U8(pixels) = frame.pixels else {
        panic!("8 bits");
    };
    assert_eq!(pixels.len(), (frame.width * frame.height) as usize);
    pixels
}

fn problem(file: &[u8]) -> Problem {
    FrameFile::open(file, "x.bmp").err().unwrap().problem
}

const BLACK_AND_WHITE: [[u8; 4]; 2] = [[0; 4], [255, 255, 255, 0]];

#[test]
fn greys_come_back_as_they_were_from_either_end() {
    let greys = pattern(11, 7);
    assert_eq!(pixels(&grey(11, 7, &greys)), greys);
    let rows: Vec<&[u8]> = greys.chunks(11).collect();
    let palette = crate::samples::bmp::greys();
    let down = Picture {
        width: 11,
        height: -7,
        bits: 8,
        compression: 0,
        palette: &palette,
        rows: &rows,
    };
    assert_eq!(pixels(&bmp(&down)), greys);
}

#[test]
fn rows_of_bits_end_with_their_words() {
    // 35 pixels take five octets, which are filled to eight.
    let rows: [&[u8]; 2] = [
        &[0b1000_0000, 0, 0, 0, 0b0010_0000],
        &[0, 0, 0, 0, 0b0100_0000],
    ];
    let one = Picture {
        width: 35,
        height: 2,
        bits: 1,
        compression: 0,
        palette: &BLACK_AND_WHITE,
        rows: &rows,
    };
    let mut expected = vec![0; 70];
    (expected[33], expected[35], expected[69]) = (255, 255, 255);
    assert_eq!(pixels(&bmp(&one)), expected);
    let mask = decode_mask(&bmp(&one), "x.bmp").unwrap();
    assert_eq!(mask.pixels.iter().filter(|&&inside| inside != 0).count(), 3);
    let four = [[9u8, 9, 9, 0], [80, 80, 80, 0], [200, 200, 200, 0]];
    let nibbles = Picture {
        width: 3,
        height: 1,
        bits: 4,
        compression: 0,
        palette: &four,
        rows: &[&[0x21, 0x00]],
    };
    assert_eq!(pixels(&bmp(&nibbles)), [200, 80, 9]);
    let beyond = bmp(&Picture {
        rows: &[&[0x31, 0x00]],
        ..nibbles
    });
    let file = FrameFile::open(&beyond[..], "x.bmp").unwrap();
    let told = file.frame(0).unwrap_err().to_string();
    assert!(told.contains("not in its table"), "{told}");
}

#[test]
fn colours_become_their_luminance() {
    let plain = |bits: u16, rows: &[&[u8]]| {
        pixels(&bmp(&Picture {
            width: 2,
            height: 1,
            bits,
            compression: 0,
            palette: &[],
            rows,
        }))
    };
    // Blue, green, red; red and 7 of all.
    assert_eq!(plain(24, &[&[0, 0, 255, 7, 7, 7]]), [76, 7]);
    assert_eq!(plain(32, &[&[0, 0, 255, 0, 7, 7, 7, 99]]), [76, 7]);
    // Five bits each: white, and green.
    assert_eq!(plain(16, &[&[0xFF, 0x7F, 0xE0, 0x03]]), [255, 150]);
}

#[test]
fn what_is_not_read_is_told_with_what_to_do() {
    let file = |bits: u16, compression: u32| {
        problem(&bmp(&Picture {
            width: 2,
            height: 1,
            bits,
            compression,
            palette: &crate::samples::bmp::greys(),
            rows: &[&[2, 7, 0, 1]],
        }))
    };
    for (told, words) in [
        (file(8, 1), "pixels in runs"),
        (file(8, 9), "compressed pixels"),
        (file(64, 0), "64 bits a pixel"),
    ] {
        let sentence = told.to_string();
        assert!(
            sentence.contains(words) && sentence.contains("PNG or TIFF"),
            "{sentence}"
        );
    }
}

#[test]
fn sizes_that_are_none_are_refused_before_memory_is_reserved() {
    let mut file = grey(4, 4, &pattern(4, 4));
    let stated = |file: &mut Vec<u8>, at: usize, value: i32| {
        file[at..at + 4].copy_from_slice(&value.to_le_bytes());
    };
    for (width, height) in [(i32::MAX, 4), (4, i32::MIN), (0, 4), (-4, 4), (4, 0)] {
        stated(&mut file, 18, width);
        stated(&mut file, 22, height);
        assert!(
            matches!(problem(&file), Problem::FrameSize { .. }),
            "{width} x {height}"
        );
    }
    stated(&mut file, 18, 8000);
    stated(&mut file, 22, 8000);
    assert!(matches!(problem(&file), Problem::Damaged { .. }));
    let mut colours = grey(4, 4, &pattern(4, 4));
    stated(&mut colours, 46, i32::MAX);
    assert!(matches!(problem(&colours), Problem::Damaged { .. }));
}
