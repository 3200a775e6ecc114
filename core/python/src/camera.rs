//! Calibrations.

use fluoropose::camera::calibration;
use fluoropose_laboratory::files::camera_of_frames;
use pyo3::prelude::*;

use crate::failure::python_error;

/// A calibration as a file says it.
#[pyclass(frozen, module = "fluoropose._native")]
pub(crate) struct Calibration {
    pub(crate) read: calibration::Calibration,
}

#[pymethods]
impl Calibration {
    /// Reads the text of a calibration file.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let read = calibration::Calibration::parse(text).map_err(python_error)?;
        Ok(Self { read })
    }

    /// The text of a file that reads back as the same calibration.
    fn text(&self) -> String {
        self.read.to_string()
    }

    /// What it says, in words, where that is no matrix.
    fn words(&self) -> Option<String> {
        match self.read {
            calibration::Calibration::PrincipalDistance {
                distance,
                offset: [right, up],
                pitch,
            } => Some(format!(
                "principal distance {distance} mm, principal point {right} mm to the right of the frame's middle and {up} mm above it, pixels of {pitch} mm"
            )),
            calibration::Calibration::CameraMatrix { .. } => None,
        }
    }

    /// Columns and rows of the frames that it is for, where it says so.
    fn size(&self) -> Option<(usize, usize)> {
        match self.read {
            calibration::Calibration::CameraMatrix { size, .. } => Some(size),
            _ => None,
        }
    }

    /// What is unusual of the camera for frames of a size, a sentence each: most often the calibration is wrong then.
    fn doubts(&self, width: usize, height: usize) -> PyResult<Vec<String>> {
        let camera = camera_of_frames(&self.read, (width, height));
        Ok(camera.map_err(python_error)?.1)
    }

    /// What a copy in another process is made from.
    fn __getnewargs__(&self) -> (String,) {
        (self.text(),)
    }

    /// Nothing changes it.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Focal lengths and principal point for frames of a size, pixels; a pixel's centre is its index + 0.5.
    fn camera(&self, width: usize, height: usize) -> PyResult<(f64, f64, f64, f64)> {
        let camera = self.read.camera(width, height).map_err(python_error)?;
        let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
        Ok((fx, fy, cx, cy))
    }
}
