//! Calibration texts read and written for the page.

use fluoropose::camera::Camera;
use fluoropose::camera::calibration::{Calibration, CalibrationError};
use wasm_bindgen::prelude::*;

use crate::error::sentence;

/// The camera of a calibration text for frames of `width` x `height` pixels.
pub fn camera(text: &str, width: u32, height: u32) -> Result<Camera, JsError> {
    calibration_of(text, width, height).map(|(_, camera)| camera)
}

/// A calibration text with its camera for frames of `width` x `height` pixels.
pub fn calibration_of(
    text: &str,
    width: u32,
    height: u32,
) -> Result<(Calibration, Camera), JsError> {
    let calibration = own(text)?;
    let camera = calibration
        .camera(width as usize, height as usize)
        .map_err(sentence)?;
    Ok((calibration, camera))
}

/// A calibration in a form of the core's own: what else is read of others' is brought into one when it is opened, by who has the whole reader.
fn own(text: &str) -> Result<Calibration, JsError> {
    let own = Calibration::parse_own(text).map_err(sentence)?;
    own.ok_or_else(|| sentence(CalibrationError::UnknownKind))
}

/// What a calibration text says, for a chip and a form.
#[wasm_bindgen]
pub struct CalibrationText(Calibration);

#[wasm_bindgen]
impl CalibrationText {
    /// Reads `JT_INTCALIB` or MayaCam 2.0.
    ///
    /// # Errors
    /// The core's sentence about the line or value at fault.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str) -> Result<CalibrationText, JsError> {
        own(text).map(Self)
    }

    /// Whether a text is in one of those forms, right or wrong, and not in one of others.
    #[wasm_bindgen(js_name = isOwn)]
    #[must_use]
    pub fn is_own(text: &str) -> bool {
        !matches!(Calibration::parse_own(text), Ok(None))
    }

    /// Principal distance, principal point x and y (mm from the frame's centre) and pixel pitch, all mm; nothing for a
    /// camera matrix.
    #[wasm_bindgen(getter)]
    pub fn principal(&self) -> Option<Vec<f64>> {
        match self.0 {
            Calibration::PrincipalDistance {
                distance,
                offset: [x, y],
                pitch,
            } => Some(vec![distance, x, y, pitch]),
            Calibration::CameraMatrix { .. } => None,
        }
    }

    /// `fx`, `fy`, `cx`, `cy` in pixels, for frames of this size.
    ///
    /// # Errors
    /// The core's sentence when a value is impossible or the calibration is for frames of another size.
    #[wasm_bindgen(js_name = cameraFor)]
    pub fn camera_for(&self, width: u32, height: u32) -> Result<Vec<f64>, JsError> {
        let camera = self
            .0
            .camera(width as usize, height as usize)
            .map_err(sentence)?;
        Ok([camera.focal(), camera.principal_point()].concat())
    }
}

/// Typed values as a `JT_INTCALIB` text: millimetres, the principal point from the frame's centre (x right, y up).
///
/// # Errors
/// The core's sentence about a value that is not possible, for frames of `width` x `height` pixels.
#[wasm_bindgen(js_name = jtIntcalibText)]
pub fn jt_intcalib_text(
    distance: f64,
    x: f64,
    y: f64,
    pitch: f64,
    width: u32,
    height: u32,
) -> Result<String, JsError> {
    let calibration = Calibration::PrincipalDistance {
        distance,
        offset: [x, y],
        pitch,
    };
    calibration
        .camera(width as usize, height as usize)
        .map_err(sentence)?;
    Ok(calibration.to_string())
}
