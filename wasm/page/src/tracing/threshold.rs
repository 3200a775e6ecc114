//! The interactive threshold on a film.

use fluoropose::image::contour::Point;
use fluoropose::image::mask::Word;
use fluoropose_tracing::smoothed::{Scale, Smoothed};
use fluoropose_tracing::threshold::{
    Threshold, ThresholdMemory, region_at, suggested_level, threshold_needed,
};
use fluoropose_tracing::{Inside, List, ShapeError, Vertex};
use wasm_bindgen::prelude::*;

use super::{Reshaped, inside_of};
use crate::error::sentence;
use crate::frame_image::FrameImage;

/// A film smoothed once, of which regions are taken at any level.
#[wasm_bindgen]
pub struct ThresholdAid {
    cells: Vec<u16>,
    width: usize,
    height: usize,
    scale: Scale,
    inside: Inside,
    range: [f64; 2],
    words: Vec<Word>,
    line: Vec<Vertex>,
    made: Vec<Vertex>,
    marks: Vec<bool>,
}

#[wasm_bindgen]
impl ThresholdAid {
    /// Smooths a film, on which the implant is dark or else bright.
    ///
    /// # Errors
    /// The core's sentence about the film.
    #[wasm_bindgen(constructor)]
    pub fn new(film: &FrameImage, dark_inside: bool) -> Result<ThresholdAid, JsError> {
        let (width, height) = film.size();
        let mut cells = vec![0; width * height];
        let scale = film.smooth(&mut cells)?;
        let (words, points) = threshold_needed(width, height);
        let per_grey = scale.per_grey();
        let least = cells.iter().copied().min().unwrap_or_default();
        let greatest = cells.iter().copied().max().unwrap_or_default();
        Ok(Self {
            width,
            height,
            scale,
            inside: inside_of(dark_inside),
            range: [least, greatest].map(|value| f64::from(value) / per_grey),
            cells,
            words: vec![0; words],
            line: vec![Vertex::default(); points],
            made: vec![Vertex::default(); points],
            marks: vec![false; points],
        })
    }

    /// The least grey value of the smoothed film.
    #[wasm_bindgen(getter, js_name = leastLevel)]
    #[must_use]
    pub fn least_level(&self) -> f64 {
        self.range[0]
    }

    /// The greatest grey value of the smoothed film.
    #[wasm_bindgen(getter, js_name = greatestLevel)]
    #[must_use]
    pub fn greatest_level(&self) -> f64 {
        self.range[1]
    }

    /// The level at which the region round a point has the sharpest border; nothing where no level gives a region.
    #[must_use]
    pub fn suggest(&self, column: f64, row: f64) -> Option<f64> {
        let film = Smoothed::from_cells(&self.cells, self.width, self.height, self.scale).ok()?;
        suggested_level(&film, Point::new(column, row), self.inside)
    }

    /// The outline of the region at a point and a level, without what hangs on by bridges thinner than
    /// `2 * bridge + 1` pixels, simplified by at most `tolerance` pixels. No points where there is no region.
    ///
    /// # Errors
    /// The core's sentence about the settings, or where the region's border is endless, as that of noise is.
    pub fn outline(
        &mut self,
        column: f64,
        row: f64,
        level: f64,
        bridge: u32,
        tolerance: f64,
    ) -> Result<Reshaped, JsError> {
        let film = Smoothed::from_cells(&self.cells, self.width, self.height, self.scale)
            .map_err(sentence)?;
        let threshold = Threshold {
            inside: self.inside,
            level,
            bridge: bridge as usize,
            tolerance,
        };
        let memory = ThresholdMemory {
            words: &mut self.words,
            line: &mut self.line,
            marks: &mut self.marks,
        };
        let mut out = List::new(&mut self.made);
        let cursor = Point::new(column, row);
        let error = region_at(&film, cursor, &threshold, memory, &mut out).map_err(sentence)?;
        let none = ShapeError::default();
        Ok(Reshaped::new(out.as_slice(), error.unwrap_or(none)))
    }
}
