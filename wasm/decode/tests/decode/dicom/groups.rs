//! Geometry, of all frames or in functional groups.

use fluoropose_decode::{SpacingCalibration, decode_frames};

use super::{UNCOMPRESSED, join, nested};
use crate::samples::dicom::{Builder, EXPLICIT};
use crate::samples::{only_frame, words_of};

/// A sequence of a functional group with one item; lengths stated or not.
fn group(syntax: &str, tag: u32, stated: bool, elements: &[(u32, &[u8; 2], &str)]) -> Vec<u8> {
    let mut content = Builder::new(syntax);
    for &(tag, representation, value) in elements {
        content.text(tag, representation, value);
    }
    nested(syntax, tag, stated, &[content.into_data_set()])
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
