//! What DICOM frames state of their camera: told where no calibration is there, and never taken by itself, as in the page.

use std::path::Path;

use fluoropose::camera::Camera;
use fluoropose_decode::{FrameFile, Geometry, GreyFrame};

use super::listing::files_in;
use super::text::{name_of, read};

/// Pixels whose sides differ by more than this part are not square.
const SQUARE: f64 = 1e-3;

/// A sentence of what the first file of frames states of its camera, without its full stop, and what to write of it; nothing where it states nothing.
pub(super) fn stated_by(frames: &Path) -> Option<String> {
    let first = files_in(frames).ok()?.into_iter().next()?;
    let file = FrameFile::open(read(&first).ok()?, &name_of(&first)).ok()?;
    let stated = words(&file.frame(0).ok()?.geometry)?;
    Some(format!("{} states {stated}", first.display()))
}

/// Whether the camera is another than that which a frame's file states: a sentence without its full stop.
pub fn doubt_beside(camera: &Camera, frame: &GreyFrame) -> Option<String> {
    let Geometry {
        source_to_detector_mm: distance,
        detector_spacing_mm: spacing,
        ..
    } = frame.geometry;
    let doubt = camera.doubt_beside(distance?, spacing?)?;
    Some(format!("camera: {doubt}"))
}

fn words(geometry: &Geometry) -> Option<String> {
    let distance = geometry.source_to_detector_mm;
    Some(match (distance, geometry.detector_spacing_mm) {
        (Some(distance), Some([across, along])) if (across - along).abs() <= SQUARE * across => {
            format!(
                "{distance} mm from source to detector and pixels of {across} mm there: write the line JT_INTCALIB {distance} 0 0 {across} into a text file and name it, if the beam's axis meets the detector in the frame's middle and the frames were neither cut nor scaled"
            )
        }
        (Some(distance), Some([across, along])) => format!(
            "{distance} mm from source to detector and pixels of {across} x {along} mm there, which are not square: write a camera matrix"
        ),
        (Some(distance), None) => format!(
            "{distance} mm from source to detector but no Imager Pixel Spacing, the size of its pixels at the detector, which a calibration needs too"
        ),
        (None, Some([across, _])) => format!(
            "pixels of {across} mm at the detector but no Distance Source to Detector, which a calibration needs too"
        ),
        (None, None) => return None,
    })
}
