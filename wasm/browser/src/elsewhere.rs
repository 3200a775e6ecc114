//! The names, where there is no browser: whatever is called panics, as `js-sys` does there.

use wasm_bindgen::Clamped;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// An error as JavaScript throws it.
    pub type Error;
    /// With a message.
    #[wasm_bindgen(constructor)]
    pub fn new(message: &str) -> Error;

    /// Bytes.
    pub type Uint8Array;
    /// Of a buffer.
    #[wasm_bindgen(constructor)]
    pub fn new(buffer: &JsValue) -> Uint8Array;
    /// Whole numbers of 16 bits.
    pub type Uint16Array;
    /// Whole numbers of 32 bits.
    pub type Uint32Array;
    /// Where they lie.
    #[wasm_bindgen(method, getter)]
    pub fn buffer(this: &Uint32Array) -> JsValue;
    /// Numbers of 32 bits.
    pub type Float32Array;
    /// Numbers of 64 bits.
    pub type Float64Array;

    /// Pixels as a canvas takes them.
    pub type ImageData;
    /// So many in a row.
    #[wasm_bindgen(catch, constructor)]
    pub fn new_with_u8_clamped_array(
        data: Clamped<&[u8]>,
        width: u32,
    ) -> Result<ImageData, JsValue>;

    /// What is drawn on.
    pub type CanvasRenderingContext2d;
    /// Puts pixels there.
    #[wasm_bindgen(catch, method)]
    pub fn put_image_data(
        this: &CanvasRenderingContext2d,
        image: &ImageData,
        column: f64,
        row: f64,
    ) -> Result<(), JsValue>;
}

/// Typed arrays are made from numbers.
macro_rules! made_from {
    ($($array:ident $number:ty),*) => {$(
        impl From<&[$number]> for $array {
            fn from(_: &[$number]) -> Self {
                panic!("there is no browser here")
            }
        }
    )*};
}

made_from!(Uint8Array u8, Uint16Array u16, Uint32Array u32, Float32Array f32, Float64Array f64);
