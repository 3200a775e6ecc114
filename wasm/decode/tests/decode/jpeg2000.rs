use fluoropose_decode::{Kind, Problem, decode_frames, sniff};

use crate::samples::dicom::{Builder, JPEG_2000};
use crate::samples::jpeg2000::{COLOUR, EIGHT, JP2, LOSSY, SIGNED, SIXTEEN, TWELVE, bytes};
use crate::samples::{bytes_of, only_frame, pattern, words_of};

fn times(factor: u16) -> Vec<u16> {
    pattern(12, 9)
        .iter()
        .map(|&grey| u16::from(grey) * factor)
        .collect()
}

#[test]
fn lossless_comes_back_exactly() {
    for file in [EIGHT, JP2] {
        assert_eq!(sniff(&bytes(file), "x.bin"), Kind::Jpeg2000);
        let frame = only_frame(&bytes(file), "a.jp2");
        assert_eq!((frame.width, frame.height, frame.bits), (12, 9, 8));
        assert_eq!(bytes_of(&frame), pattern(12, 9));
    }
    let frame = only_frame(&bytes(TWELVE), "a.j2k");
    assert_eq!(frame.bits, 12);
    assert_eq!(words_of(&frame), times(16));
    assert_eq!(words_of(&only_frame(&bytes(SIXTEEN), "a.j2k")), times(257));
}

#[test]
fn loss_stays_small() {
    let frame = only_frame(&bytes(LOSSY), "a.j2k");
    let worst = bytes_of(&frame)
        .iter()
        .zip(pattern(12, 9))
        .map(|(a, b)| a.abs_diff(b))
        .max();
    // What the encoder's own decoder gives.
    assert_eq!(worst, Some(4));
}

#[test]
fn signed_pixels_are_moved_up_by_half_their_range() {
    let frame = only_frame(&bytes(SIGNED), "a.j2k");
    assert_eq!(words_of(&frame), times(16));
    assert_eq!(frame.notes.len(), 1);
}

#[test]
fn colour_becomes_luminance() {
    let frame = only_frame(&bytes(COLOUR), "a.j2k");
    for (&grey, value) in bytes_of(&frame).iter().zip(pattern(12, 9)) {
        let [r, g, b] = [value, 255 - value, value / 2].map(u32::from);
        assert_eq!(u32::from(grey), (299 * r + 587 * g + 114 * b + 500) / 1000);
    }
}

#[test]
fn frames_of_a_dicom_file_are_read() {
    let image = |photometric, signed| {
        Builder::image_with(JPEG_2000, 12, 9, 2, photometric, [16, 12, 11, signed])
    };
    let (twelve, signed) = (bytes(TWELVE), bytes(SIGNED));
    for frame in decode_frames(
        &image("MONOCHROME2", 0).fragments(&[], &[&twelve, &twelve]),
        "a.dcm",
    )
    .unwrap()
    {
        assert_eq!(words_of(&frame), times(16));
    }
    for frame in decode_frames(
        &image("MONOCHROME2", 1).fragments(&[], &[&signed, &signed]),
        "a.dcm",
    )
    .unwrap()
    {
        assert_eq!(words_of(&frame), times(16));
    }
    // Fragments without a table: each frame from its start mark on.
    let split: Vec<&[u8]> = vec![&twelve[..100], &twelve[100..], &twelve];
    for frame in decode_frames(&image("MONOCHROME1", 0).fragments(&[], &split), "a.dcm").unwrap() {
        let inverted: Vec<u16> = times(16).iter().map(|grey| 4095 - grey).collect();
        assert_eq!(words_of(&frame), inverted);
    }
    let colour = Builder::image_with(JPEG_2000, 12, 9, 1, "YBR_RCT", [8, 8, 7, 0]);
    let frame = only_frame(&colour.fragments(&[], &[&bytes(COLOUR)]), "a.dcm");
    assert_eq!(
        bytes_of(&frame),
        bytes_of(&only_frame(&bytes(COLOUR), "a.j2k"))
    );
}

#[test]
fn what_is_missing_or_not_read_is_said() {
    let whole = bytes(EIGHT);
    let error = decode_frames(&whole[..whole.len() - 2], "a.j2k").unwrap_err();
    assert!(
        error.to_string().contains("ends before its end mark"),
        "{error}"
    );
    let mut deep = whole.clone();
    deep[42] = 23;
    let error = decode_frames(&deep, "a.j2k").unwrap_err();
    assert!(
        matches!(error.problem, Problem::Unsupported { .. }),
        "{error}"
    );
    let mut large = whole;
    large[8..12].copy_from_slice(&9000u32.to_be_bytes());
    assert!(matches!(
        decode_frames(&large, "a.j2k").unwrap_err().problem,
        Problem::FrameSize { .. }
    ));
}
