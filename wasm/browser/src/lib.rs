//! What modules of a page use of a browser.
//!
//! Elsewhere, where nothing calls it, these are names alone, with which the modules are compiled, linted and tested: all of `js-sys` takes
//! 8 s of a processor to compile. What is named otherwise here than there does not compile for the page.

#[cfg(target_family = "wasm")]
pub use js_sys::{Error, Float32Array, Float64Array, Uint8Array, Uint16Array, Uint32Array};
#[cfg(target_family = "wasm")]
pub use web_sys::{CanvasRenderingContext2d, ImageData};

#[cfg(not(target_family = "wasm"))]
mod elsewhere;
#[cfg(not(target_family = "wasm"))]
pub use elsewhere::{
    CanvasRenderingContext2d, Error, Float32Array, Float64Array, ImageData, Uint8Array,
    Uint16Array, Uint32Array,
};
