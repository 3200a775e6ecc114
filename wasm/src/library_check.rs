//! Whether a library is sound, told without keeping it.

use fluoropose::library::Library;
use wasm_bindgen::prelude::*;

use fluoropose_page::error::sentence;

/// Reads a library from its first byte to its last.
///
/// # Errors
/// The core's sentence about what is damaged.
#[wasm_bindgen(js_name = checkLibrary)]
pub fn check_library(bytes: &[u8]) -> Result<(), JsError> {
    Library::open(bytes).map(drop).map_err(sentence)
}
