//! Shutters: what is open, and what is said.

use fluoropose_decode::{GreyFrame, decode_frames};

use super::{UNCOMPRESSED, join, nested};
use crate::samples::dicom::{Builder, EXPLICIT};
use crate::samples::{bytes_of, only_frame};

const WIDTH: u16 = 9;
const HEIGHT: u16 = 7;

const LEFT: u32 = 0x0018_1602;
const RIGHT: u32 = 0x0018_1604;
const TOP: u32 = 0x0018_1606;
const BOTTOM: u32 = 0x0018_1608;
const CENTRE: u32 = 0x0018_1610;
const RADIUS: u32 = 0x0018_1612;
const CORNERS: u32 = 0x0018_1620;

fn elements(syntax: &str, shape: &str, numbers: &[(u32, &str)]) -> Builder {
    let mut file = Builder::new(syntax);
    file.text(0x0018_1600, b"CS", shape);
    for &(tag, value) in numbers {
        file.text(tag, b"IS", value);
    }
    file
}

fn decoded(syntax: &str, shape: &str, numbers: &[(u32, &str)]) -> GreyFrame {
    let image = Builder::image(syntax, WIDTH, HEIGHT, 8, 1);
    let pixels: Vec<u8> = (0..63).collect();
    let file = join(elements(syntax, shape, numbers), image).octets(&pixels);
    let frame = only_frame(&file, "a.dcm");
    assert_eq!(bytes_of(&frame), pixels, "pixels stay as stored");
    frame
}

/// A letter for each pixel, O where it is open.
fn picture(frame: &GreyFrame) -> Vec<String> {
    let shutter = frame.shutter.as_ref().expect("a shutter");
    let row = |row: u32| {
        let open = shutter.open(row, frame.width);
        let letter = |column: u32| match open.iter().any(|span| span.contains(&column)) {
            true => 'O',
            false => '.',
        };
        (0..frame.width).map(letter).collect()
    };
    (0..frame.height).map(row).collect()
}

#[test]
fn edges_count_from_one_and_are_open() {
    let edges = [(LEFT, "3"), (RIGHT, "6"), (TOP, "2"), (BOTTOM, "4")];
    for syntax in UNCOMPRESSED {
        let frame = decoded(syntax, "RECTANGULAR", &edges);
        let due = [
            ".........",
            "..OOOO...",
            "..OOOO...",
            "..OOOO...",
            ".........",
            ".........",
            ".........",
        ];
        assert_eq!(picture(&frame), due, "{syntax}");
        assert_eq!(
            frame.notes,
            ["The file's shutter covers 81 % of the picture; nothing is read there."]
        );
    }
}

#[test]
fn rows_come_first_and_what_is_open_lies_in_all_shapes() {
    let circle = [(CENTRE, "3\\5"), (RADIUS, "2")];
    let due = [
        "....O....",
        "...OOO...",
        "..OOOOO..",
        "...OOO...",
        "....O....",
        ".........",
        ".........",
    ];
    assert_eq!(picture(&decoded(EXPLICIT, "CIRCULAR", &circle)), due);
    let corners = [(CORNERS, "1\\1\\1\\9\\5\\5")];
    let due = [
        "OOOOOOOOO",
        ".OOOOOOO.",
        "..OOOOO..",
        "...OOO...",
        "....O....",
        ".........",
        ".........",
    ];
    assert_eq!(picture(&decoded(EXPLICIT, "POLYGONAL", &corners)), due);
    let both = [circle.as_slice(), &corners].concat();
    let due = [
        "....O....",
        "...OOO...",
        "..OOOOO..",
        "...OOO...",
        "....O....",
        ".........",
        ".........",
    ];
    let frame = decoded(EXPLICIT, "CIRCULAR\\POLYGONAL", &both);
    assert_eq!(picture(&frame), due);
}

#[test]
fn each_frame_may_have_its_own() {
    let shutter = |left: &str| {
        let edges = [(LEFT, left), (RIGHT, "9"), (TOP, "1"), (BOTTOM, "7")];
        let item = elements(EXPLICIT, "RECTANGULAR", &edges).into_data_set();
        nested(EXPLICIT, 0x0018_9472, true, &[item])
    };
    let mut file = Builder::image(EXPLICIT, WIDTH, HEIGHT, 8, 2);
    file.verbatim(&nested(EXPLICIT, 0x5200_9229, true, &[shutter("2")]));
    let own = [shutter("8"), Vec::new()];
    file.verbatim(&nested(EXPLICIT, 0x5200_9230, true, &own));
    let frames = decode_frames(&file.octets(&[7; 126]), "a.dcm").expect("two frames");
    let rows: Vec<String> = frames
        .iter()
        .map(|frame| picture(frame).swap_remove(0))
        .collect();
    assert_eq!(rows, [".......OO", ".OOOOOOOO"]);
}

#[test]
fn one_that_is_not_known_covers_nothing_or_covers_all_is_not_used() {
    let whole = [(LEFT, "0"), (RIGHT, "10"), (TOP, "0"), (BOTTOM, "8")];
    let frame = decoded(EXPLICIT, "RECTANGULAR", &whole);
    assert_eq!((frame.shutter, frame.notes), (None, Vec::new()));

    let none = [(LEFT, "6"), (RIGHT, "3"), (TOP, "0"), (BOTTOM, "8")];
    let frame = decoded(EXPLICIT, "RECTANGULAR", &none);
    assert_eq!(frame.shutter, None);
    assert!(frame.notes[0].contains("cover all"), "{:?}", frame.notes);

    // One corner more than is used, and two numbers of two rows.
    let many = ["1\\1"; fluoropose_decode::MAX_CORNERS + 1].join("\\");
    let unknown: [(&str, &[(u32, &str)]); 7] = [
        ("RECTANGULAR", &whole[..3]),
        ("CIRCULAR", &[(CENTRE, "3"), (RADIUS, "2")]),
        ("CIRCULAR", &[(CENTRE, "3\\4"), (RADIUS, "-2")]),
        ("POLYGONAL", &[(CORNERS, "1\\1\\1\\9\\5")]),
        ("POLYGONAL", &[(CORNERS, "1\\1\\1\\9\\5\\x")]),
        ("POLYGONAL", &[(CORNERS, &many)]),
        ("BITMAP", &[]),
    ];
    for (shape, numbers) in unknown {
        let frame = decoded(EXPLICIT, shape, numbers);
        assert_eq!(frame.shutter, None, "{shape} {numbers:?}");
        assert!(frame.notes[0].contains("not used"), "{:?}", frame.notes);
    }
}

#[test]
fn that_of_a_colour_picture_is_kept() {
    let edges = [(LEFT, "3"), (RIGHT, "6"), (TOP, "2"), (BOTTOM, "4")];
    let mut image = Builder::image_with(EXPLICIT, WIDTH, HEIGHT, 1, "RGB", [8, 8, 7, 0]);
    image.short(0x0028_0006, 0);
    let pixels: Vec<u8> = (0..63).flat_map(|k| [k; 3]).collect();
    let file = join(elements(EXPLICIT, "RECTANGULAR", &edges), image).octets(&pixels);
    let frame = only_frame(&file, "a.dcm");
    assert_eq!(picture(&frame)[1], "..OOOO...");
    assert_eq!(frame.notes.len(), 1);
}
