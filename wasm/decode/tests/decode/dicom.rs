use fluoropose_decode::{FrameFile, Problem, SpacingCalibration, Window, decode_frames};

use crate::samples::dicom::{
    BIG_ENDIAN, Builder, DEFLATED, EXPLICIT, IMPLICIT, JPEG_BASELINE, JPEG_LOSSLESS, RLE,
    run_lengths,
};
use crate::samples::{bytes_of, jpeg, lossless, only_frame, pattern, words_of};

const UNCOMPRESSED: [&str; 4] = [IMPLICIT, EXPLICIT, DEFLATED, BIG_ENDIAN];

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

fn with_window(mut file: Builder, centre: &str, width: &str) -> Builder {
    file.text(0x0028_1050, b"DS", centre);
    file.text(0x0028_1051, b"DS", width);
    file
}

/// What a pixel value is shown as, 0 black to 1 white, by the sentence of `Window`.
fn shown(window: Window, value: f64) -> f64 {
    ((value - window.centre) / window.width + 0.5).clamp(0.0, 1.0)
}

/// What PS3.3 C.11.2.1.2.1 shows of a rescaled value.
fn standard(centre: f64, width: f64, value: f64) -> f64 {
    ((value - (centre - 0.5)) / (width - 1.0) + 0.5).clamp(0.0, 1.0)
}

/// Checks the window of a file against the standard's formula for every given stored value.
fn check_window(file: Builder, pixels: &[u16], rescaled: impl Fn(u16) -> f64, dark: bool) {
    let frame = only_frame(&with_window(file, "100", "81").words(pixels), "a.dcm");
    let window = frame.window.unwrap();
    for (&stored, &value) in pixels.iter().zip(words_of(&frame)) {
        let due = standard(100.0, 81.0, rescaled(stored));
        let due = if dark { 1.0 - due } else { due };
        let got = shown(window, value.into());
        assert!(
            (got - due).abs() < 1e-12,
            "stored {stored}: {got} for {due}"
        );
    }
}

#[test]
fn the_window_is_in_units_of_the_pixels() {
    let stored = [0, 59, 60, 75, 99, 100, 101, 125, 140, 141, 4095];
    let image = |photometric, signed| {
        Builder::image_with(EXPLICIT, 11, 1, 1, photometric, [16, 12, 11, signed])
    };
    check_window(image("MONOCHROME2", 0), &stored, f64::from, false);
    check_window(image("MONOCHROME1", 0), &stored, f64::from, true);
    // As 12-bit two's complement, 4095 is -1.
    let signed = |v: u16| {
        if v >= 2048 {
            f64::from(v) - 4096.0
        } else {
            f64::from(v)
        }
    };
    check_window(image("MONOCHROME2", 1), &stored, signed, false);
    check_window(image("MONOCHROME1", 1), &stored, signed, true);
    for (slope, intercept) in [(2.0, -20.0), (0.25, 80.0), (-0.5, 150.0)] {
        let mut file = image("MONOCHROME2", 0);
        file.text(0x0028_1052, b"DS", &intercept.to_string());
        file.text(0x0028_1053, b"DS", &slope.to_string());
        // The window's elements come after these; readers do not depend on the order.
        check_window(file, &stored, |v| slope * f64::from(v) + intercept, false);
    }
}

#[test]
fn an_exact_linear_window_is_taken_as_it_is() {
    let mut file = Builder::image(EXPLICIT, 2, 1, 8, 1);
    file.text(0x0028_1050, b"DS", "100\\50");
    file.text(0x0028_1051, b"DS", "80\\20");
    file.text(0x0028_1056, b"CS", "LINEAR_EXACT");
    let frame = only_frame(&file.octets(&[1, 2]), "a.dcm");
    assert_eq!(
        frame.window,
        Some(Window {
            centre: 100.0,
            width: 80.0
        })
    );
}

#[test]
fn a_window_of_no_width_is_none() {
    for (centre, width) in [("100", "0"), ("100", "-5"), ("nonsense", "10"), ("", "")] {
        let file = with_window(Builder::image(EXPLICIT, 2, 1, 8, 1), centre, width);
        assert_eq!(
            only_frame(&file.octets(&[1, 2]), "a.dcm").window,
            None,
            "{centre} {width}"
        );
    }
}

#[test]
fn monochrome_1_is_inverted_within_its_bits() {
    let file = Builder::image_with(EXPLICIT, 3, 1, 1, "MONOCHROME1", [16, 10, 9, 0]);
    let frame = only_frame(&file.words(&[0, 1, 1023]), "a.dcm");
    assert_eq!(words_of(&frame), [1023, 1022, 0]);
    assert_eq!(frame.notes.len(), 1);
}

#[test]
fn signed_pixels_are_moved_up_by_half_their_range() {
    let file = Builder::image_with(EXPLICIT, 4, 1, 1, "MONOCHROME2", [16, 12, 11, 1]);
    let frame = only_frame(&file.words(&[0x800, 0xFFF, 0, 0x7FF]), "a.dcm");
    assert_eq!(words_of(&frame), [0, 2047, 2048, 4095]);
}

/// A sequence of a functional group with one item; lengths stated or not.
fn group(syntax: &str, tag: u32, stated: bool, elements: &[(u32, &[u8; 2], &str)]) -> Vec<u8> {
    let mut content = Builder::new(syntax);
    for &(tag, representation, value) in elements {
        content.text(tag, representation, value);
    }
    nested(syntax, tag, stated, &[content.into_data_set()])
}

/// A sequence of items.
fn nested(syntax: &str, tag: u32, stated: bool, items: &[Vec<u8>]) -> Vec<u8> {
    let mut file = Builder::new(syntax);
    let length: usize = items.iter().map(|item| 8 + item.len()).sum();
    file.header(tag, b"SQ", if stated { length as u32 } else { u32::MAX });
    for item in items {
        file.item(
            0xFFFE_E000,
            if stated { item.len() as u32 } else { u32::MAX },
        );
        file.verbatim(item);
        if !stated {
            file.item(0xFFFE_E00D, 0);
        }
    }
    if !stated {
        file.item(0xFFFE_E0DD, 0);
    }
    file.into_data_set()
}

#[test]
fn functional_groups_tell_windows_rescaling_and_geometry_of_each_frame() {
    for syntax in UNCOMPRESSED {
        for stated in [false, true] {
            let window = |centre: &str, width: &str| {
                group(
                    syntax,
                    0x0028_9132,
                    stated,
                    &[(0x0028_1050, b"DS", centre), (0x0028_1051, b"DS", width)],
                )
            };
            let rescale = group(
                syntax,
                0x0028_9145,
                stated,
                &[(0x0028_1052, b"DS", "10"), (0x0028_1053, b"DS", "2")],
            );
            let mut distances = Builder::new(syntax);
            distances.text(0x0018_1110, b"DS", "1200");
            let isocentre = match distances.is_big_endian() {
                true => 800f32.to_be_bytes(),
                false => 800f32.to_le_bytes(),
            };
            distances.bytes(0x0018_9402, b"FL", &isocentre);
            let distances = nested(syntax, 0x0018_9476, stated, &[distances.into_data_set()]);
            let spacing = group(
                syntax,
                0x0028_9443,
                stated,
                &[(0x0018_1164, b"DS", "0.2\\0.2")],
            );
            let shared = [window("100", "81"), distances, spacing].concat();
            let mut file = Builder::image(syntax, 2, 1, 16, 3);
            file.verbatim(&nested(syntax, 0x5200_9229, stated, &[shared]));
            file.verbatim(&nested(
                syntax,
                0x5200_9230,
                stated,
                &[window("50", "21"), rescale, Vec::new()],
            ));
            let frames = decode_frames(&file.words(&[1, 2, 3, 4, 5, 6]), "enhanced.dcm")
                .unwrap_or_else(|e| panic!("{syntax} {stated}: {e}"));
            let windows: Vec<_> = frames
                .iter()
                .map(|frame| frame.window.unwrap())
                .map(|w| (w.centre, w.width))
                .collect();
            // The second frame's own rescaling is undone: (99.5 - 10) / 2.
            assert_eq!(
                windows,
                [(49.5, 20.0), (44.75, 40.0), (99.5, 80.0)],
                "{syntax} {stated}"
            );
            for frame in &frames {
                assert_eq!(frame.geometry.source_to_detector_mm, Some(1200.0));
                assert_eq!(frame.geometry.source_to_isocentre_mm, Some(800.0));
                assert_eq!(frame.geometry.detector_spacing_mm, Some([0.2, 0.2]));
            }
            assert_eq!(words_of(&frames[1]), [3, 4]);
        }
    }
}

#[test]
fn geometry_is_reported() {
    let mut file = Builder::new(EXPLICIT);
    file.text(0x0018_1110, b"DS", "1198.5");
    file.text(0x0018_1111, b"DS", "900");
    file.text(0x0018_1164, b"DS", "0.4\\0.25");
    file.text(0x0018_1114, b"DS", "1.3");
    file.text(0x0018_2010, b"DS", "0.1\\0.1");
    file.text(0x0028_0030, b"DS", "0.3\\0.2");
    file.text(0x0028_0A02, b"CS", "FIDUCIAL");
    let mut image = Builder::image(EXPLICIT, 2, 1, 8, 1);
    image.text(0x0028_0034, b"IS", "8\\5");
    let geometry = only_frame(&join(file, image).octets(&[1, 2]), "a.dcm").geometry;
    assert_eq!(geometry.detector_spacing_mm, Some([0.25, 0.4]));
    assert_eq!(geometry.source_to_detector_mm, Some(1198.5));
    assert_eq!(geometry.source_to_patient_mm, Some(900.0));
    assert_eq!(geometry.pixel_aspect, Some(1.6));
    assert_eq!(geometry.magnification, Some(1.3));
    assert_eq!(geometry.scanned_spacing_mm, Some([0.1, 0.1]));
    assert_eq!(geometry.pixel_spacing_mm, Some([0.2, 0.3]));
    assert_eq!(
        geometry.pixel_spacing_calibration,
        Some(SpacingCalibration::Fiducial)
    );
}

/// Of what a file says of times the most exact counts, and uneven ones are no rate.
#[test]
fn frames_a_second_come_from_times_or_rate() {
    let rate = |stated: &[(u32, &[u8; 2], &str)]| {
        let mut file = Builder::new(EXPLICIT);
        for &(tag, kind, value) in stated {
            file.text(tag, kind, value);
        }
        let image = Builder::image(EXPLICIT, 1, 1, 8, 4);
        let bytes = join(file, image).octets(&[1, 2, 3, 4]);
        FrameFile::open(bytes, "a.dcm").unwrap().frames_per_s()
    };
    let cine = (0x0018_0040, b"IS", "25");
    let time = |ms| (0x0018_1063, b"DS", ms);
    let times = |ms| (0x0018_1065, b"DS", ms);
    assert_eq!(rate(&[]), None);
    assert_eq!(rate(&[cine]), Some(25.0));
    assert_eq!(rate(&[cine, time("66.67")]), Some(15.0));
    let ntsc = rate(&[time("33.367")]).unwrap();
    assert!((ntsc - 29.97).abs() < 1e-3, "{ntsc}");
    assert_eq!(rate(&[cine, time("0")]), Some(25.0));
    assert_eq!(rate(&[time("40"), times("0\\133\\134\\133")]), Some(7.5));
    assert_eq!(rate(&[cine, times("0\\33\\66\\33")]), None);
    assert_eq!(rate(&[cine, times("0")]), Some(25.0));
    // Of a long film.
    let long = ["0"]
        .into_iter()
        .chain(vec!["33.333"; 3000])
        .collect::<Vec<_>>();
    assert_eq!(rate(&[times(&long.join("\\"))]), Some(30.0));
}

/// Elements of one builder before those of another.
fn join(mut first: Builder, second: Builder) -> Builder {
    first.verbatim(&second.into_data_set());
    first
}

#[test]
fn sequences_before_the_pixels_are_passed_over() {
    for syntax in UNCOMPRESSED {
        let mut file = Builder::new(syntax);
        // Undefined lengths inside one another, then a sequence of a stated length.
        file.header(0x0008_1115, b"SQ", u32::MAX);
        file.item(0xFFFE_E000, u32::MAX);
        file.header(0x0008_1199, b"SQ", u32::MAX);
        file.item(0xFFFE_E000, 0);
        file.item(0xFFFE_E0DD, 0);
        file.text(0x0020_000E, b"UI", "1.2.3");
        file.item(0xFFFE_E00D, 0);
        file.item(0xFFFE_E0DD, 0);
        file.header(0x0008_1140, b"SQ", 8);
        file.item(0xFFFE_E000, 0);
        let file = join(file, Builder::image(syntax, 2, 2, 8, 1)).octets(&[1, 2, 3, 4]);
        assert_eq!(
            bytes_of(&only_frame(&file, "a.dcm")),
            [1, 2, 3, 4],
            "{syntax}"
        );
    }
}

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
fn colour_run_lengths_are_read() {
    let planes = [vec![255, 9, 0], vec![0, 9, 0], vec![0, 9, 255]];
    let mut file = Builder::image_with(RLE, 3, 1, 1, "RGB", [8, 8, 7, 0]);
    file.short(0x0028_0006, 1);
    let file = file.fragments(&[], &[&run_lengths(&planes)]);
    assert_eq!(bytes_of(&only_frame(&file, "a.dcm")), [76, 9, 29]);
}

#[test]
fn codings_that_are_not_read_are_named() {
    let file = Builder::image("1.2.840.10008.1.2.4.81", 2, 1, 8, 1).fragments(&[], &[&[1, 2]]);
    let error = decode_frames(&file, "run.dcm").unwrap_err();
    assert_eq!(
        error.to_string(),
        "run.dcm: this DICOM file holds JPEG-LS near-lossless pixels (transfer syntax 1.2.840.10008.1.2.4.81), which \
         is not read. Export it from the viewer or archive uncompressed (Explicit VR Little Endian), or as lossless \
         JPEG, JPEG 2000 or RLE; gdcmconv --raw converts files, too."
    );
    for (uid, word) in [
        ("1.2.840.10008.1.2.4.80", "JPEG-LS"),
        ("1.2.840.10008.1.2.4.201", "high-throughput"),
        ("1.2.840.10008.1.2.4.102", "video"),
        ("9.9", "'9.9'"),
    ] {
        let file = Builder::image(uid, 2, 1, 8, 1).fragments(&[], &[&[1, 2]]);
        let error = decode_frames(&file, "run.dcm").unwrap_err();
        assert!(matches!(error.problem, Problem::Unsupported { .. }));
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn lies_are_found_out() {
    let refused = |file: Vec<u8>, words: &str| {
        let error = decode_frames(&file, "a.dcm").unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(
        Builder::image(EXPLICIT, 4, 4, 8, 2).octets(&[0; 31]),
        "need 32 bytes of pixels and it holds 31",
    );
    refused(
        Builder::image(EXPLICIT, 9000, 4, 8, 1).octets(&[0; 31]),
        "9000 x 4 pixels",
    );
    refused(
        Builder::image(EXPLICIT, 0, 4, 8, 1).octets(&[]),
        "0 x 4 pixels",
    );
    refused(
        Builder::image(EXPLICIT, 4, 4, 8, 0).octets(&[0; 16]),
        "states 0 frames",
    );
    refused(
        Builder::image(EXPLICIT, 2, 2, 32, 1).octets(&[0; 16]),
        "32-bit grey pixels",
    );
    let bits = Builder::image_with(EXPLICIT, 2, 2, 1, "MONOCHROME2", [8, 12, 11, 0]);
    refused(
        bits.octets(&[0; 4]),
        "12 bits stored with high bit 11 do not fit 8",
    );
    let palette = Builder::image_with(EXPLICIT, 2, 2, 1, "PALETTE COLOR", [8, 8, 7, 0]);
    refused(palette.octets(&[0; 12]), "PALETTE COLOR");
    refused(
        Builder::image(RLE, 2, 2, 8, 3).fragments(&[], &[&[0; 70]]),
        "3 frames and holds 1 fragments",
    );
    refused(
        Builder::image(RLE, 2, 2, 8, 1).octets(&[0; 4]),
        "compressed and they are not",
    );
    refused(Builder::image(EXPLICIT, 2, 2, 8, 1).finish(), "no pixels");
    let image = jpeg(8, 8, &[1; 64], false);
    refused(
        Builder::image(JPEG_BASELINE, 8, 9, 8, 1).fragments(&[], &[&image]),
        "8 x 9 pixels and its compressed image has 8 x 8",
    );
    refused(
        Builder::image(RLE, 80, 80, 8, 1).fragments(&[], &[&run_lengths(&[vec![1, 2]])]),
        "too short",
    );
    refused(
        Builder::image(RLE, 80, 80, 8, 1).fragments(&[], &[&run_lengths(&[pattern(10, 60)])]),
        "ends too early",
    );
}
