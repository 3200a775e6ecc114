//! `.jts` texts read and written for the page.

use fluoropose::pose::jts;
use wasm_bindgen::prelude::*;

use crate::error::sentence;
use crate::pose_numbers::{from_numbers, to_numbers};

/// The poses of a `.jts`, `.jtak` or `.jtap` text, six numbers a row: x, y, z (mm), z, x and y rotation (degrees); six
/// times NaN for a frame without a pose.
///
/// # Errors
/// The core's sentence about the heading or the row at fault.
#[wasm_bindgen(js_name = readJts)]
pub fn read_jts(text: &str) -> Result<Vec<f64>, JsError> {
    let mut numbers = Vec::new();
    for row in jts::read(text).map_err(sentence)? {
        let pose = row.map_err(sentence)?;
        numbers.extend(pose.as_ref().map_or([f64::NAN; 6], to_numbers));
    }
    Ok(numbers)
}

/// A `.jts` text of rows of six numbers; six times NaN for a frame without a pose.
///
/// # Errors
/// When a row is short or a number is not finite.
#[wasm_bindgen(js_name = writeJts)]
pub fn write_jts(numbers: &[f64]) -> Result<String, JsError> {
    let mut text = String::new();
    jts::write_heading(&mut text).map_err(sentence)?;
    for row in numbers.chunks(6) {
        let empty = row.len() == 6 && row.iter().all(|number| number.is_nan());
        let pose = (!empty).then(|| from_numbers(row)).transpose()?;
        jts::write_row(&mut text, pose.as_ref()).map_err(sentence)?;
    }
    Ok(text)
}
