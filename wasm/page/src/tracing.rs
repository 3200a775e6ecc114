//! Aids for tracing: a threshold, the live-wire, snapping, smoothing and a brush.
//!
//! Outlines and paths are columns and rows by turns, in frame pixels.

mod live_wire;
mod reshape;
mod threshold;

pub use live_wire::{Cooling, LiveWire};
pub use reshape::{brush_outline, simplify_outline, smooth_outline, snap_outline, snap_path};
pub use threshold::ThresholdAid;

use fluoropose::image::contour::Point;
use fluoropose_tracing::{Hand, Inside, ShapeError, Vertex};
use wasm_bindgen::prelude::*;

/// What an aid made of an outline.
#[wasm_bindgen]
pub struct Reshaped {
    vertices: Vec<Vertex>,
    error: ShapeError,
    left_out: f64,
}

impl Reshaped {
    fn new(vertices: &[Vertex], error: ShapeError) -> Self {
        Self {
            vertices: vertices.to_vec(),
            error,
            left_out: 0.0,
        }
    }
}

#[wasm_bindgen]
impl Reshaped {
    /// Columns and rows by turns; none where nothing is left or was found.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn points(&self) -> Vec<f64> {
        let points = self.vertices.iter();
        points.flat_map(|v| [v.at.column, v.at.row]).collect()
    }

    /// Where on the given line each point comes from: `k` for its point `k`, untouched; `k + t` for one that lies on side
    /// `k`, or was moved from there; -1 for a new one.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn from(&self) -> Vec<f64> {
        self.vertices.iter().map(|vertex| vertex.from).collect()
    }

    /// The greatest distance of the given line from this one, pixels.
    #[wasm_bindgen(getter, js_name = maxError)]
    #[must_use]
    pub fn max_error(&self) -> f64 {
        self.error.max
    }

    /// The root mean square distance, pixels.
    #[wasm_bindgen(getter, js_name = rmsError)]
    #[must_use]
    pub fn rms_error(&self) -> f64 {
        self.error.rms
    }

    /// Area of smaller pieces that were left out, square pixels.
    #[wasm_bindgen(getter, js_name = leftOut)]
    #[must_use]
    pub fn left_out(&self) -> f64 {
        self.left_out
    }
}

/// Points from columns and rows by turns.
fn points_of(numbers: &[f64]) -> Vec<Point> {
    let pairs = numbers.as_chunks().0.iter();
    pairs
        .map(|&[column, row]| Point::new(column, row))
        .collect()
}

fn inside_of(dark: bool) -> Inside {
    if dark { Inside::Dark } else { Inside::Bright }
}

/// The hand on which the implant is: 1 right, -1 left, 0 either.
fn hand_of_side(side: i32) -> Hand {
    match side.signum() {
        1 => Hand::Right,
        -1 => Hand::Left,
        _ => Hand::Either,
    }
}
