//! Where a data set begins, and what is passed over in it.

use fluoropose_decode::{Kind, decode_frames, sniff, sniff_head};

use super::{UNCOMPRESSED, join};
use crate::samples::dicom::{
    BIG_ENDIAN, Builder, EXPLICIT, IMPLICIT, JPEG_BASELINE, RLE, run_lengths,
};
use crate::samples::{bytes_of, jpeg, only_frame, pattern, words_of};

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

/// A file of two 12-bit pixels, and their values.
fn small(syntax: &str) -> (Builder, [u16; 2]) {
    let mut file = Builder::new(syntax);
    file.text(0x0008_0016, b"UI", "1.2.840.10008.5.1.4.1.1.12.1");
    file.text(0x0008_0060, b"CS", "XA");
    let image = Builder::image_with(syntax, 2, 1, 1, "MONOCHROME2", [16, 12, 11, 0]);
    (join(file, image), [4000, 77])
}

/// Scanners and archives put the header of a TIFF file, or of another, where DICOM has no use for the bytes.
#[test]
fn the_preamble_may_hold_the_header_of_another_format() {
    let headers: [&[u8]; 6] = [
        b"II*\0\x08\0\0\0",
        b"MM\0*\0\0\0\x08",
        b"\x89PNG\r\n\x1a\n",
        b"\xFF\xD8\xFF\xE0",
        b"ply\nformat ascii 1.0",
        b"solid",
    ];
    for header in headers {
        let (file, pixels) = small(EXPLICIT);
        let mut bytes = file.words(&pixels);
        bytes[..header.len()].copy_from_slice(header);
        assert_eq!(sniff(&bytes, "frame.tif"), Kind::Dicom);
        assert_eq!(words_of(&only_frame(&bytes, "frame.tif")), pixels);
    }
}

#[test]
fn data_sets_without_preamble_are_read_where_their_content_proves_them() {
    for syntax in [IMPLICIT, EXPLICIT, BIG_ENDIAN] {
        let (mut file, pixels) = small(syntax);
        let stored = pixels.map(|pixel| file.u16(pixel));
        file.bytes(0x7FE0_0010, b"OW", stored.as_flattened());
        let bytes = file.into_data_set();
        assert_eq!(sniff(&bytes, ""), Kind::Dicom, "{syntax}");
        assert_eq!(words_of(&only_frame(&bytes, "")), pixels, "{syntax}");
    }
}

/// As a page does, which reads the beginning alone.
#[test]
fn the_beginning_of_a_data_set_proves_it() {
    for syntax in [IMPLICIT, EXPLICIT, BIG_ENDIAN] {
        let bytes = join(small(syntax).0, Builder::new(syntax)).into_data_set();
        assert_eq!(
            sniff_head(&bytes[..60], 1 << 20, ""),
            Kind::Dicom,
            "{syntax}"
        );
        // Elements that would reach beyond the end of the file prove nothing.
        assert_eq!(sniff_head(&bytes[..12], 12, ""), Kind::Unknown, "{syntax}");
    }
}

#[test]
fn the_group_that_names_the_syntax_may_stand_alone_or_say_nothing() {
    let (file, pixels) = small(EXPLICIT);
    let whole = file.words(&pixels);
    assert_eq!(words_of(&only_frame(&whole[132..], "")), pixels);
    for syntax in [IMPLICIT, EXPLICIT, BIG_ENDIAN] {
        let (mut file, pixels) = small(syntax);
        let stored = pixels.map(|pixel| file.u16(pixel));
        file.bytes(0x7FE0_0010, b"OW", stored.as_flattened());
        let mut silent = Builder::new(EXPLICIT);
        silent.bytes(0x0002_0001, b"OB", &[0, 1]);
        let bytes = file.finish_after(silent);
        assert_eq!(words_of(&only_frame(&bytes, "a.dcm")), pixels, "{syntax}");
    }
}

#[test]
fn compressed_pixels_without_a_syntax_are_known_by_how_they_begin() {
    let silent = || Builder::new(EXPLICIT);
    let image = jpeg(16, 8, &[90; 128], false);
    let mut file = Builder::image(JPEG_BASELINE, 16, 8, 8, 1);
    file.push_fragments(&[], &[&image]);
    let frame = only_frame(&file.finish_after(silent()), "a.dcm");
    assert!(bytes_of(&frame).iter().all(|pixel| pixel.abs_diff(90) <= 1));

    let pixels = pattern(6, 4);
    let mut file = Builder::image(RLE, 6, 4, 8, 1);
    file.push_fragments(&[], &[&run_lengths(std::slice::from_ref(&pixels))]);
    assert_eq!(
        bytes_of(&only_frame(&file.finish_after(silent()), "a.dcm")),
        pixels
    );
}

/// Some programs write the elements of a compressed image without representations, against the standard.
#[test]
fn elements_without_the_representations_that_are_promised_are_read() {
    let image = jpeg(16, 8, &[90; 128], false);
    let mut file = Builder::image(IMPLICIT, 16, 8, 8, 1);
    file.push_fragments(&[], &[&image]);
    let mut meta = Builder::new(EXPLICIT);
    meta.text(0x0002_0010, b"UI", JPEG_BASELINE);
    let frame = only_frame(&file.finish_after(meta), "a.dcm");
    assert_eq!((frame.width, frame.height), (16, 8));
}

#[test]
fn what_is_no_data_set_is_said_to_be_none() {
    let error = decode_frames(&[7; 300], "a.dcm").unwrap_err().to_string();
    assert!(error.contains("DICM is missing"), "{error}");
}
