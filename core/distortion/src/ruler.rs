//! The pixel pitch from two marks of known distance.

use crate::error::{DistortionError, above_zero};
use fluoropose::math::sqrt;

/// What a ruler says about the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RulerScale {
    /// Distance between the marks, px.
    pub length_px: f64,
    /// Distance between pixels at the detector, mm.
    pub pitch_mm: f64,
    /// Focal length, that is principal distance divided by pitch, px. The distance to the detector cancels in it.
    pub focal_px: f64,
}

/// The pixel pitch from two marks (column, row), px, that are `length_mm` apart on a ruler parallel to the detector.
///
/// Both distances are from the X-ray source along the axis, mm; for a ruler on the detector they are equal.
///
/// # Errors
/// [`DistortionError::Marks`] for marks less than 2 px apart, [`DistortionError::Length`] and [`DistortionError::Order`]
/// for impossible lengths.
pub fn scale(
    marks: [[f64; 2]; 2],
    length_mm: f64,
    source_to_detector_mm: f64,
    source_to_ruler_mm: f64,
) -> Result<RulerScale, DistortionError> {
    let length = above_zero("length", length_mm)?;
    let (detector, object) = distances(source_to_detector_mm, source_to_ruler_mm)?;
    let [a, b] = marks;
    let (right, down) = (b[0] - a[0], b[1] - a[1]);
    let length_px = sqrt(right * right + down * down);
    if length_px.is_nan() || length_px < 2.0 {
        return Err(DistortionError::Marks(length_px));
    }
    let focal_px = length_px * object / length;
    Ok(RulerScale {
        length_px,
        pitch_mm: detector / focal_px,
        focal_px,
    })
}

/// Checks the distances from the source to the detector and to the object.
pub(crate) fn distances(detector: f64, object: f64) -> Result<(f64, f64), DistortionError> {
    above_zero("distance from source to detector", detector)?;
    above_zero("distance from source to object", object)?;
    match object <= detector {
        true => Ok((detector, object)),
        false => Err(DistortionError::Order { object, detector }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ruler_in_front_of_the_detector_is_magnified() {
        // 100 mm at 900 of 1200 mm are 133.3 mm on the detector, 400 pixels of a third of a millimetre.
        let found = scale([[10.0, 20.0], [250.0, 340.0]], 100.0, 1200.0, 900.0).expect("possible");
        assert!((found.length_px - 400.0).abs() < 1e-12);
        assert!((found.pitch_mm - 1.0 / 3.0).abs() < 1e-12);
        assert!((found.focal_px - 3600.0).abs() < 1e-9);
        // On the detector itself, length over pixels.
        let flat = scale([[0.0, 0.0], [0.0, 50.0]], 20.0, 1000.0, 1000.0).expect("possible");
        assert!((flat.pitch_mm - 0.4).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_is_named() {
        let marks = [[0.0, 0.0], [10.0, 0.0]];
        assert_eq!(
            scale([[1.0, 1.0], [2.0, 1.0]], 10.0, 1000.0, 900.0),
            Err(DistortionError::Marks(1.0))
        );
        assert!(matches!(
            scale(marks, f64::NAN, 1000.0, 900.0),
            Err(DistortionError::Length { name: "length", .. })
        ));
        assert!(matches!(
            scale(marks, 10.0, -1.0, 900.0),
            Err(DistortionError::Length { .. })
        ));
        assert_eq!(
            scale(marks, 10.0, 900.0, 1000.0),
            Err(DistortionError::Order {
                object: 1000.0,
                detector: 900.0
            })
        );
    }
}
