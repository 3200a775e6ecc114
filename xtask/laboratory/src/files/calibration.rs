//! Calibrations and the cameras that they are of.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose_decode::{Kind, sniff};

use super::stated_geometry::stated_by;
use super::text::{read, text_of};
use crate::options::Pair;

/// Reads a calibration in any form that the core reads.
///
/// # Errors
/// Names the file and the line.
pub fn read_calibration(path: &Path) -> Result<Calibration> {
    let bytes = read(path)?;
    if matches!(sniff(&bytes, ""), Kind::Dicom) {
        let stated =
            stated_by(path).unwrap_or_else(|| "it states nothing of its camera".to_owned());
        bail!(
            "{} is a DICOM file, and a calibration is text: {stated}",
            path.display()
        );
    }
    let read = text_of(bytes).and_then(|text| Ok(Calibration::parse(&text)?));
    read.with_context(|| format!("in {}", path.display()))
}

/// The camera of frames of a size, and what is unusual of it, a sentence each: most often the calibration is wrong then.
///
/// # Errors
/// Those of [`Calibration::camera`].
pub fn camera_of_frames(
    calibration: &Calibration,
    (width, height): (usize, usize),
) -> Result<(Camera, Vec<String>)> {
    let camera = calibration.camera(width, height)?;
    let doubts = calibration
        .doubts(&camera)
        .map(|doubt| format!("camera: {doubt}"));
    Ok((camera, doubts.collect()))
}

/// What is taken for granted of frames of a size where the calibration states none: a sentence that tells frames and masks which were
/// scaled or cut, without its full stop.
pub fn size_taken(calibration: &Calibration, (width, height): (usize, usize)) -> Option<String> {
    let &Calibration::PrincipalDistance { pitch, .. } = calibration else {
        return None;
    };
    let [wide, high] = [width, height].map(|side| side as f64 * pitch);
    Some(format!(
        "camera: the calibration states no frame size; {width} x {height} pixels are taken for the whole frame, {wide:.0} x {high:.0} mm of the detector"
    ))
}

/// Frames are as large as this where nobody says more, pixels.
const USUAL_SIZE: (usize, usize) = (1024, 1024);

/// The camera of a calibration for frames of a size; a camera matrix has its own.
///
/// # Errors
/// Those of [`Calibration::camera`]; a size that is not in whole pixels, or is another than that of the camera matrix.
pub fn camera_for(calibration: &Calibration, frame: Option<Pair>) -> Result<Camera> {
    let given = frame.map(whole_sides).transpose()?;
    let (width, height) = match *calibration {
        Calibration::CameraMatrix { size, .. } => {
            let (width, height) = given.unwrap_or(size);
            ensure!(
                (width, height) == size,
                "--frame says {width} x {height} pixels, and the calibration is a camera matrix of frames of {} x {}: leave --frame out, or give the calibration of those frames",
                size.0,
                size.1
            );
            size
        }
        _ => given.unwrap_or(USUAL_SIZE),
    };
    Ok(calibration.camera(width, height)?)
}

fn whole_sides(Pair([width, height]): Pair) -> Result<(usize, usize)> {
    let are_whole = [width, height].iter().all(|side| side.fract() == 0.0);
    ensure!(
        are_whole,
        "a frame of {width},{height} pixels has no whole sides"
    );
    Ok((width as usize, height as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_has_whole_sides() {
        let calibration = Calibration::parse("JT_INTCALIB\n1000\n0\n0\n0.3\n").expect("valid");
        let of = |width| camera_for(&calibration, Some(Pair([width, 48.0])));
        assert_eq!(of(64.0).expect("whole").width(), 64);
        for width in [64.5, f64::NAN, f64::INFINITY, -64.0] {
            assert!(of(width).is_err(), "{width}");
        }
        assert_eq!(camera_for(&calibration, None).expect("usual").width(), 1024);
    }

    #[test]
    fn a_camera_matrix_is_of_frames_of_its_own_size() {
        let text = "image size\n640,480\n\ncamera matrix\n2000,0,320\n0,2000,240\n0,0,1\n";
        let calibration = Calibration::parse(text).expect("valid");
        let of = |frame: Option<[f64; 2]>| camera_for(&calibration, frame.map(Pair));
        for frame in [None, Some([640.0, 480.0])] {
            let camera = of(frame).expect("its own");
            assert_eq!((camera.width(), camera.height()), (640, 480));
        }
        let told = of(Some([1024.0, 1024.0])).expect_err("other frames");
        assert!(told.to_string().contains("640 x 480"), "{told}");
    }
}
