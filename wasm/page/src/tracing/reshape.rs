//! Outlines snapped, simplified, smoothed and painted.

use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose_tracing::brush::{Brush, BrushMemory, Cut, brush, brush_needed};
use fluoropose_tracing::simplify::{Simplify, as_vertices, simplify};
use fluoropose_tracing::snap::{Snap, snapped};
use fluoropose_tracing::soften::{SoftenMemory, soften, soften_needed};
use fluoropose_tracing::{Hand, List, ShapeError, Vertex};
use wasm_bindgen::prelude::*;

use super::{Reshaped, hand_of_side, inside_of, points_of};
use crate::error::sentence;
use crate::frame_image::{FrameImage, Pixels};

/// Pulls a closed outline to edges of a film within `reach` pixels of it, and simplifies it by at most `tolerance` pixels.
/// Where there is no edge it stays.
///
/// # Errors
/// The core's sentence about the outline or the settings.
#[wasm_bindgen(js_name = snapOutline)]
pub fn snap_outline(
    film: &FrameImage,
    points: &[f64],
    dark_inside: bool,
    reach: f64,
    tolerance: f64,
) -> Result<Reshaped, JsError> {
    let settings = Snap {
        closed: true,
        hand: Hand::Either,
        inside: inside_of(dark_inside),
        reach,
        tolerance,
    };
    reshaped(film, &points_of(points), &settings)
}

/// Pulls an open path to edges of a film, as [`snap_outline`] does. Its ends stay. The implant is on its right hand
/// (`side` 1), its left (-1) or either (0).
///
/// # Errors
/// The core's sentence about the path or the settings.
#[wasm_bindgen(js_name = snapPath)]
pub fn snap_path(
    film: &FrameImage,
    path: &[f64],
    side: i32,
    dark_inside: bool,
    reach: f64,
    tolerance: f64,
) -> Result<Reshaped, JsError> {
    let settings = Snap {
        closed: false,
        hand: hand_of_side(side),
        inside: inside_of(dark_inside),
        reach,
        tolerance,
    };
    reshaped(film, &points_of(path), &settings)
}

fn reshaped(film: &FrameImage, points: &[Point], settings: &Snap) -> Result<Reshaped, JsError> {
    let (width, height) = film.size();
    let found = match film.pixels() {
        Pixels::Eight(pixels) => {
            let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
            snapped(&frame, points, settings)
        }
        Pixels::Sixteen(pixels) => {
            let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
            snapped(&frame, points, settings)
        }
    };
    let (line, moved) = found.map_err(sentence)?;
    Ok(Reshaped::new(&line, moved))
}

/// Leaves out points of a closed outline as long as its shape moves by no more than `tolerance` pixels. No point moves.
///
/// # Errors
/// The core's sentence about the outline or the tolerance.
#[wasm_bindgen(js_name = simplifyOutline)]
pub fn simplify_outline(points: &[f64], tolerance: f64) -> Result<Reshaped, JsError> {
    let points = points_of(points);
    let mut given = vec![Vertex::default(); points.len()];
    let mut line = List::new(&mut given);
    as_vertices(&points, true, &mut line).map_err(sentence)?;
    let mut places = vec![Vertex::default(); points.len()];
    let mut out = List::new(&mut places);
    let settings = Simplify {
        closed: true,
        tolerance,
        balanced: false,
    };
    let mut marks = vec![false; points.len()];
    let error = simplify(line.as_slice(), &settings, |_| false, &mut marks, &mut out);
    Ok(Reshaped::new(out.as_slice(), error.map_err(sentence)?))
}

/// Smooths a closed outline along its length by a Gaussian of `sigma` pixels, without shrinking it, and simplifies it by
/// at most `tolerance` pixels.
///
/// # Errors
/// The core's sentence about the outline or the settings.
#[wasm_bindgen(js_name = smoothOutline)]
pub fn smooth_outline(points: &[f64], sigma: f64, tolerance: f64) -> Result<Reshaped, JsError> {
    let points = points_of(points);
    let count = soften_needed(&points, sigma);
    let mut places = vec![Vertex::default(); count];
    let mut out = List::new(&mut places);
    let memory = SoftenMemory {
        samples: &mut vec![Vertex::default(); count],
        rest: &mut vec![Point::default(); count],
        smooth: &mut vec![Vertex::default(); count],
        marks: &mut vec![false; count],
    };
    let error = soften(&points, sigma, tolerance, memory, &mut out);
    Ok(Reshaped::new(out.as_slice(), error.map_err(sentence)?))
}

/// Adds a disc of `radius` pixels, drawn along a stroke, to a closed outline, or takes it away. An outline without points
/// becomes that of the stroke. Points outside the stroke are untouched. Of several pieces the largest stays; no points
/// where all is gone.
///
/// # Errors
/// The core's sentence about the outline or the stroke.
#[wasm_bindgen(js_name = brushOutline)]
pub fn brush_outline(
    points: &[f64],
    stroke: &[f64],
    radius: f64,
    add: bool,
) -> Result<Reshaped, JsError> {
    let (points, stroke) = (points_of(points), points_of(stroke));
    let count = brush_needed(points.len(), stroke.len());
    let mut places = vec![Vertex::default(); count];
    let mut out = List::new(&mut places);
    let memory = BrushMemory {
        before: &mut vec![Vertex::default(); count],
        after: &mut vec![Vertex::default(); count],
        cuts: &mut vec![Cut::default(); count],
        marks: &mut vec![false; count],
    };
    let what = if add { Brush::Add } else { Brush::Erase };
    let left_out = brush(&points, &stroke, radius, what, memory, &mut out).map_err(sentence)?;
    Ok(Reshaped {
        left_out,
        ..Reshaped::new(out.as_slice(), ShapeError::default())
    })
}
