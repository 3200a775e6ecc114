//! The core's errors as JavaScript errors.

use std::fmt::Display;

use wasm_bindgen::JsError;

/// An `Error` with the sentence of `error`, its first letter large.
pub fn sentence(error: impl Display) -> JsError {
    let text = error.to_string();
    let mut letters = text.chars();
    let text = match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => text,
    };
    JsError::new(&text)
}
