//! What is in flash: a library and an outline, made by `cargo xtask test --firmware`.

/// A library of the built-in femoral component, in the core's format.
pub static LIBRARY: &[u8] = include_bytes!(concat!(
    env!("FLUOROPOSE_FIRMWARE_INPUTS"),
    "/femur.library"
));

/// The outline: pairs of little-endian `f64`, column and row of each vertex in pixels.
pub static OUTLINE: &[u8] = include_bytes!(concat!(
    env!("FLUOROPOSE_FIRMWARE_INPUTS"),
    "/femur.outline"
));
