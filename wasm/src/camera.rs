//! What is unusual of a calibration, in the core's words.

use fluoropose::camera::calibration::Calibration;
use fluoropose_page::calibration;
use fluoropose_page::error::sentence;
use wasm_bindgen::prelude::*;

/// What is unusual of the camera of a calibration text for frames of `width` x `height` pixels: sentences without their full stops. Where their
/// file states it: `distance` mm from source to detector, and `spacing`, mm between pixels there along a row and from row to row.
///
/// # Errors
/// The core's sentence about the calibration.
#[wasm_bindgen(js_name = cameraDoubts)]
pub fn camera_doubts(
    text: &str,
    width: u32,
    height: u32,
    distance: Option<f64>,
    spacing: Option<Vec<f64>>,
) -> Result<Vec<String>, JsError> {
    let (calibration, camera) = calibration::calibration_of(text, width, height)?;
    let spacing = spacing.and_then(|pair| <[f64; 2]>::try_from(pair).ok());
    let stated = distance.zip(spacing);
    let beside = stated.and_then(|(distance, spacing)| camera.doubt_beside(distance, spacing));
    let doubts = calibration.doubts(&camera).chain(beside);
    Ok(doubts.map(|doubt| doubt.to_string()).collect())
}

/// A calibration text of any kind as `JT_INTCALIB` or MayaCam 2.0, which all else here reads.
///
/// # Errors
/// The core's sentence about the line or value at fault.
#[wasm_bindgen(js_name = calibrationText)]
pub fn calibration_text(text: &str) -> Result<String, JsError> {
    let calibration = Calibration::parse(text).map_err(sentence)?;
    Ok(calibration.to_string())
}

/// Distances in mm of the libraries that a part is looked for with in frames of `width` x `height` pixels, as the core's
/// `search_distances` has them.
///
/// # Errors
/// The core's sentence about the calibration.
#[wasm_bindgen(js_name = searchDistances)]
pub fn search_distances(
    text: &str,
    width: u32,
    height: u32,
    told: Option<f64>,
    depth: Option<f64>,
) -> Result<Vec<f64>, JsError> {
    let (calibration, _) = calibration::calibration_of(text, width, height)?;
    Ok(calibration.search_distances(told, depth).to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_a_mm_for_mm_a_pixel_are_told() {
        let told = |pitch: f64| {
            let text = format!("JT_INTCALIB\n1198\n0\n0\n{pitch}\n");
            camera_doubts(&text, 800, 800, Some(1198.0), Some(vec![pitch; 2])).ok()
        };
        assert_eq!(told(0.4774).unwrap(), Vec::<String>::new());
        let [doubt] = told(2.0945).unwrap().try_into().unwrap();
        assert!(
            doubt.starts_with("the focal length, 572.0 pixels, is 0.71 times"),
            "{doubt}"
        );
        let text = "JT_INTCALIB\n1198\n0\n0\n0.4774\n";
        let other = camera_doubts(text, 800, 800, Some(1198.0), Some(vec![0.2; 2])).ok();
        let [doubt] = other.unwrap().try_into().unwrap();
        assert!(
            doubt.contains("times that which the frames' file states"),
            "{doubt}"
        );
    }
}
