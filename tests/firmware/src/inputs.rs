//! What is in flash: a library or an implant, and an outline, made by `cargo xtask test --firmware`.

#[cfg(not(feature = "outlines"))]
use fluoropose::Point;

/// A library of the built-in femoral component, in the core's format.
#[cfg(not(any(feature = "finder", feature = "refine")))]
pub(crate) static LIBRARY: &[u8] = include_bytes!(env!("FLUOROPOSE_LIBRARY"));

/// The outline's file: pairs of little-endian `f64`, column and row of each vertex in pixels.
#[cfg(not(feature = "outlines"))]
const OUTLINE: &[u8] = include_bytes!(env!("FLUOROPOSE_OUTLINE"));

/// The outline, read when the program is built: its points stay in flash.
#[cfg(not(feature = "outlines"))]
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

#[cfg(not(feature = "outlines"))]
const fn number_at(first: usize) -> f64 {
    let mut bits = 0;
    let mut byte = 0;
    while byte < 8 {
        bits |= (OUTLINE[first + byte] as u64) << (8 * byte);
        byte += 1;
    }
    f64::from_bits(bits)
}
