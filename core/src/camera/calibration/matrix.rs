//! The nine numbers of a camera matrix, whoever wrote them.

use super::error::CalibrationError;
use crate::camera::{Camera, CameraError};
use crate::math::Matrix3;

/// What a camera matrix says of frames of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Intrinsics {
    /// Width and height, pixels.
    pub(super) size: (usize, usize),
    /// Focal lengths, pixels.
    pub(super) focal: [f64; 2],
    /// Principal point: pixel indices, whole numbers at pixel centres.
    pub(super) centre: [f64; 2],
}

impl Intrinsics {
    /// Checks all of it.
    ///
    /// # Errors
    /// For a matrix of another form, or not in pixels.
    pub(super) fn of(k: &Matrix3, size: (usize, usize)) -> Result<Self, CalibrationError> {
        if is_transposed(k) {
            return Err(CalibrationError::Transposed([k[2][0], k[2][1]]));
        }
        if k[2] != [0.0, 0.0, 1.0] {
            return Err(CalibrationError::LastRow(k[2]));
        }
        if k[0][1] != 0.0 || k[1][0] != 0.0 {
            return Err(CalibrationError::Matrix);
        }
        for (focal, axis, row) in [(k[0][0], "x", "first"), (k[1][1], "y", "second")] {
            if focal < 0.0 {
                return Err(CalibrationError::Negative { focal, axis, row });
            }
        }
        let (focal, centre) = ([k[0][0], k[1][1]], [k[0][2], k[1][2]]);
        let camera = Camera::new(size.0, size.1, focal, centre.map(|c| c + 0.5))?;
        in_pixels(&camera)?;
        Ok(Self {
            size,
            focal,
            centre,
        })
    }
}

/// Whether the principal point stands in the last row, and the last column is that of a whole matrix.
pub(super) fn is_transposed(k: &Matrix3) -> bool {
    let last = [k[0][2], k[1][2], k[2][2]];
    last == [0.0, 0.0, 1.0] && [k[2][0], k[2][1]] != [0.0; 2]
}

/// Refuses a matrix that is not in pixels but in parts of the frame, or in metres: no source shines on all that is before it.
fn in_pixels(camera: &Camera) -> Result<(), CameraError> {
    const LEAST: f64 = 0.1;
    let ([fx, fy], [width, height]) = (camera.focal(), [camera.width(), camera.height()]);
    for (name, value, side) in [
        ("horizontal focal length", fx, width),
        ("vertical focal length", fy, height),
    ] {
        if value < LEAST * side as f64 {
            let rule = "at least a tenth of the frame's side, in pixels";
            return Err(CameraError::Value { name, value, rule });
        }
    }
    Ok(())
}
