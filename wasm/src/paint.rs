//! Pixels onto a canvas.

use wasm_bindgen::{Clamped, JsValue};
use web_sys::{CanvasRenderingContext2d, ImageData};

/// An opaque colour as one little-endian RGBA word; `rgb` is `0xRRGGBB`.
pub(crate) fn opaque(rgb: u32) -> u32 {
    let [blue, green, red, _] = rgb.to_le_bytes();
    u32::from_le_bytes([red, green, blue, 255])
}

/// Puts RGBA words onto the canvas with the upper left corner at `column`, `row`. JavaScript copies them.
pub(crate) fn put(
    context: &CanvasRenderingContext2d,
    rgba: &[u32],
    width: usize,
    column: usize,
    row: usize,
) -> Result<(), JsValue> {
    if rgba.is_empty() || width == 0 {
        return Ok(());
    }
    let bytes: Vec<u8> = rgba.iter().flat_map(|word| word.to_le_bytes()).collect();
    let image = ImageData::new_with_u8_clamped_array(Clamped(&bytes), width as u32)?;
    context.put_image_data(&image, column as f64, row as f64)
}
