//! Files that contradict themselves or are not read.

use fluoropose_decode::decode_frames;

use crate::samples::dicom::{Builder, EXPLICIT, JPEG_BASELINE, RLE, run_lengths};
use crate::samples::{jpeg, pattern};

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
        Builder::image(EXPLICIT, 2, 2, 24, 1).octets(&[0; 16]),
        "24-bit grey pixels",
    );
    refused(
        Builder::image_with(EXPLICIT, 2, 2, 1, "RGB", [32, 32, 31, 0]).octets(&[0; 48]),
        "32-bit colour pixels",
    );
    let bits = Builder::image_with(EXPLICIT, 2, 2, 1, "MONOCHROME2", [8, 12, 11, 0]);
    refused(
        bits.octets(&[0; 4]),
        "12 bits stored with high bit 11 do not fit 8",
    );
    let palette = Builder::image_with(EXPLICIT, 2, 2, 1, "PALETTE COLOR", [8, 8, 7, 0]);
    refused(palette.octets(&[0; 4]), "the shape of its palette");
    let strange = Builder::image_with(EXPLICIT, 2, 2, 1, "HSV", [8, 8, 7, 0]);
    refused(strange.octets(&[0; 12]), "of the kind HSV");
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
