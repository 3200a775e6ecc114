//! What is in flash: a library and an outline, made by `cargo xtask test --firmware`.

#[cfg(feature = "finder")]
use fluoropose::Point;

/// A library of the built-in femoral component, in the core's format.
pub static LIBRARY: &[u8] = include_bytes!(concat!(
    env!("FLUOROPOSE_FIRMWARE_INPUTS"),
    "/femur.library"
));

/// The outline: pairs of little-endian `f64`, column and row of each vertex in pixels.
pub const OUTLINE: &[u8] = include_bytes!(concat!(
    env!("FLUOROPOSE_FIRMWARE_INPUTS"),
    "/femur.outline"
));

/// The same as points, read when the program is built: they stay in flash.
#[cfg(feature = "finder")]
pub(crate) static POINTS: [Point; OUTLINE.len() / 16] = {
    let mut points = [Point {
        column: 0.0,
        row: 0.0,
    }; OUTLINE.len() / 16];
    let mut number = 0;
    while number < points.len() {
        points[number] = Point {
            column: number_at(16 * number),
            row: number_at(16 * number + 8),
        };
        number += 1;
    }
    points
};

#[cfg(feature = "finder")]
const fn number_at(first: usize) -> f64 {
    let mut bits = 0;
    let mut byte = 0;
    while byte < 8 {
        bits |= (OUTLINE[first + byte] as u64) << (8 * byte);
        byte += 1;
    }
    f64::from_bits(bits)
}
