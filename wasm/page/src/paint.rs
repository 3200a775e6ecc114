//! Pixels onto a canvas.

use wasm_bindgen::{Clamped, JsValue};
use web_sys::{CanvasRenderingContext2d, ImageData};

/// A pixel as a canvas takes it: red, green, blue and opacity.
pub(crate) type Rgba = [u8; 4];

/// An opaque colour; `rgb` is `0xRRGGBB`.
pub(crate) fn opaque(rgb: u32) -> Rgba {
    let [blue, green, red, _] = rgb.to_le_bytes();
    [red, green, blue, 255]
}

/// Puts pixels onto the canvas with the upper left corner at `column`, `row`. The canvas reads them where they are.
pub(crate) fn put(
    context: &CanvasRenderingContext2d,
    pixels: &[Rgba],
    width: usize,
    column: usize,
    row: usize,
) -> Result<(), JsValue> {
    if pixels.is_empty() || width == 0 {
        return Ok(());
    }
    let bytes = Clamped(pixels.as_flattened());
    let image = ImageData::new_with_u8_clamped_array(bytes, width as u32)?;
    context.put_image_data(&image, column as f64, row as f64)
}
