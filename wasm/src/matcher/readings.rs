//! Where the edges of a grey frame lie beside a model's outline at a pose: what a person looks at to see where it fits.

use fluoropose::image::profile::NormalReading;
use fluoropose::pose::Pose;
use fluoropose::refine::{Fit, OutlineReading};
use wasm_bindgen::prelude::*;

use super::Matcher;
use super::from_here::{HiddenPixels, model_of, on_frame};
use crate::film::film_model;
use crate::squares::square_px;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::from_numbers;

/// The edges along an outline.
#[wasm_bindgen]
pub struct EdgeReadings {
    fit: Fit,
    numbers: Vec<f32>,
}

#[wasm_bindgen]
impl EdgeReadings {
    /// Seven numbers for each piece of the outline: column and row, pixels; its outward normal, to the right and downwards; its
    /// length, pixels; how far beyond it the frame's edge lies, pixels, NaN where there is none; and 1 where the outline is met,
    /// 0 where it is not, NaN where nothing can be told.
    #[wasm_bindgen(getter)]
    pub fn numbers(&self) -> Vec<f32> {
        self.numbers.clone()
    }

    /// Part of the outline that is met, of what can be told, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn met(&self) -> f64 {
        self.fit.met
    }

    /// Part of the outline within the frame of which anything can be told, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn known(&self) -> f64 {
        self.fit.known
    }

    /// Root mean square distance of what is met, pixels.
    #[wasm_bindgen(getter)]
    pub fn residual(&self) -> f64 {
        self.fit.residual_px
    }
}

#[wasm_bindgen]
impl Matcher {
    /// Reads the edges of a frame along the outline of the model at a pose (six numbers); `known` and `bright` as for
    /// `judgeOnFrame`, which judges the same.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    #[wasm_bindgen(js_name = readOnFrame)]
    pub fn read_on_frame(
        &mut self,
        film: &FrameImage,
        hidden: &HiddenPixels,
        pose: &[f64],
        known: &[f64],
        bright: Option<bool>,
    ) -> Result<EdgeReadings, JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let known = film_model(known)?;
        // Places are told in pixels of the frame.
        let side = square_px(known.as_ref()) as f64;
        let on = (film, known, bright);
        let mut numbers = Vec::new();
        let fit = on_frame(
            model_of(&mut self.model)?,
            on,
            hidden,
            &pose,
            |model, view, _| {
                model.outline_readings(&pose, view, |one| numbers.extend(numbers_of(one, side)))
            },
        )?;
        Ok(EdgeReadings { fit, numbers })
    }
}

fn numbers_of(one: &OutlineReading, side: f64) -> [f32; 7] {
    let beyond_px = match one.seen {
        NormalReading::At(px) => px,
        NormalReading::Nothing | NormalReading::Unknown => f64::NAN,
    };
    let met = one
        .is_met()
        .map_or(f64::NAN, |met| f64::from(u8::from(met)));
    let [right, down] = one.normal;
    let [column, row, length, beyond_px] =
        [one.column, one.row, one.length, beyond_px].map(|px| px * side);
    [column, row, right, down, length, beyond_px, met].map(|number| number as f32)
}
