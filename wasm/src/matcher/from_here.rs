//! Poses that a person set, refined from where they stand: against an outline, or the grey frame itself.

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{CameraView, ImageTarget, Locks, Polarity, RefineOptions, Refined};
use fluoropose_tracing::beside;
use wasm_bindgen::prelude::*;

use super::Matcher;
use super::hand_verdict::{HandVerdict, Held};
use crate::choice::Surroundings;
use crate::film::film_model;
use crate::squares::{look_in_squares, side_of, square_px};
use crate::uncertainty::Uncertainty;
use crate::working_model::WorkingModel;
use fluoropose_page::calibration::camera;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{PoseNumbers, from_numbers, to_numbers};
use fluoropose_page::traced::Traced;

/// What refinement made of a pose.
#[wasm_bindgen]
pub struct HandFit {
    pose: PoseNumbers,
    residual_px: f64,
    drawn: Option<u64>,
    uncertainty: Option<Uncertainty>,
    bright: bool,
    verdict: HandVerdict,
}

#[wasm_bindgen]
impl HandFit {
    /// x, y, z (mm), z, x and y rotation (degrees).
    #[wasm_bindgen(getter)]
    pub fn pose(&self) -> Vec<f64> {
        self.pose.to_vec()
    }

    /// Root mean square of what remains between the outlines, or between outline and edges, pixels.
    #[wasm_bindgen(getter)]
    pub fn residual(&self) -> f64 {
        self.residual_px
    }

    /// Known frame pixels that differ from the outline when the model is drawn at the pose; nothing without an outline.
    #[wasm_bindgen(getter)]
    pub fn drawn(&self) -> Option<f64> {
        self.drawn.map(|drawn| drawn as f64)
    }

    /// As `Match.uncertainty`; nothing where numbers were locked or the pose is not determined.
    #[wasm_bindgen(getter)]
    pub fn uncertainty(&self) -> Option<Vec<f64>> {
        self.uncertainty.map(|numbers| numbers.to_vec())
    }

    /// Whether the implant was taken to be brighter than what surrounds it.
    #[wasm_bindgen(getter)]
    pub fn bright(&self) -> bool {
        self.bright
    }

    /// How far the pose is to be trusted.
    #[wasm_bindgen(getter)]
    pub fn verdict(&self) -> HandVerdict {
        self.verdict.clone()
    }
}

/// Hides what a model covers at a pose, and some pixels round it.
///
/// # Errors
/// The core's sentence about the pose.
pub(super) fn hide_model(
    model: &mut WorkingModel,
    pose: &Pose,
    camera: &Camera,
    words: &mut [Word],
) -> Result<(), JsError> {
    let (width, height) = (camera.width(), camera.height());
    let drawn = model.drawn_at(pose, camera)?;
    let drawn = Mask::new(drawn, width, height).map_err(sentence)?;
    let mut hidden = MaskMut::onto(words, width, height).map_err(sentence)?;
    beside::hide(&drawn, &mut hidden);
    Ok(())
}

/// Pixels of a frame whose edges are not the implant's: the other component's.
#[wasm_bindgen]
pub struct HiddenPixels {
    pub(super) camera: Camera,
    pub(super) words: Vec<Word>,
}

#[wasm_bindgen]
impl HiddenPixels {
    /// None yet, for the camera of a calibration text and frames of `width` x `height` pixels.
    ///
    /// # Errors
    /// The core's sentence about the calibration.
    #[wasm_bindgen(constructor)]
    pub fn new(calibration: &str, width: u32, height: u32) -> Result<HiddenPixels, JsError> {
        let camera = camera(calibration, width, height)?;
        Ok(Self {
            words: vec![0; words_needed(camera.width(), camera.height())],
            camera,
        })
    }

    /// Hides what another component's model covers at a pose (six numbers), and some pixels round it.
    ///
    /// # Errors
    /// The core's sentence about the pose or the model.
    pub fn add(&mut self, other: &mut Matcher, pose: &[f64]) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let model = model_of(&mut other.model)?;
        hide_model(model, &pose, &self.camera, &mut self.words)
    }

    /// Hides what lies along those sides of an outline that are marked unknown: what hides the implant there has edges of its own.
    ///
    /// # Errors
    /// A sentence about an outline on a frame of another size.
    #[wasm_bindgen(js_name = addUnknown)]
    pub fn add_unknown(&mut self, traced: &Traced) -> Result<(), JsError> {
        let unknown = traced.unknown().unwrap_or_default();
        if !unknown.is_empty() && unknown.len() != self.words.len() {
            return Err(JsError::new("The outline lies on a frame of another size"));
        }
        let words = self.words.iter_mut().zip(unknown);
        words.for_each(|(hidden, unknown)| *hidden |= unknown);
        Ok(())
    }
}

#[wasm_bindgen]
impl Matcher {
    /// Brings the model from a pose (six numbers) onto an outline. Of `locked`, six flags in the order of the numbers, those
    /// that are not zero stay. `around`: what the answer's verdict is held against.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined from there.
    #[wasm_bindgen(js_name = refineFrom)]
    pub fn refine_from(
        &mut self,
        traced: &Traced,
        start: &[f64],
        locked: &[u8],
        around: &Surroundings,
    ) -> Result<HandFit, JsError> {
        let (start, options) = begin(start, locked)?;
        let model = model_of(&mut self.model)?;
        let camera = traced.camera();
        traced.look(|silhouette| {
            let view = CameraView::only(&camera, *silhouette);
            let mut fit = fitted(model, &start, view, options, around)?;
            let pose = Pose::from(from_numbers(&fit.pose)?);
            fit.drawn = model.draw(&pose, &camera, silhouette)?;
            Ok(fit)
        })
    }

    /// The same onto the edges of a grey frame, seen by the camera of a calibration text; from around the pose too where that leads to none that is
    /// good and nothing is locked. `known` is what the film makes of the component, as `FilmFacts.model` gives it, or empty. `bright`: whether the
    /// implant is brighter than what surrounds it. Where that is not known it is seen at the start, which beside the implant is a guess.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined from there.
    #[wasm_bindgen(js_name = refineOnFrame)]
    #[allow(
        clippy::too_many_arguments,
        reason = "JavaScript passes arrays and handles, one by one"
    )]
    pub fn refine_on_frame(
        &mut self,
        film: &FrameImage,
        hidden: &HiddenPixels,
        start: &[f64],
        locked: &[u8],
        known: &[f64],
        bright: Option<bool>,
        around: &Surroundings,
    ) -> Result<HandFit, JsError> {
        let (start, options) = begin(start, locked)?;
        let model = model_of(&mut self.model)?;
        let on = (film, film_model(known)?, bright);
        on_frame(model, on, hidden, &start, |model, view, bright| {
            let fit = fitted(model, &start, view, options, around)?;
            Ok(HandFit { bright, ..fit })
        })
    }

    /// How far a pose that somebody set (six numbers) is to be trusted, by an outline.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    #[wasm_bindgen(js_name = judgeOutline)]
    pub fn judge_outline(
        &mut self,
        traced: &Traced,
        pose: &[f64],
        around: &Surroundings,
    ) -> Result<HandVerdict, JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let model = model_of(&mut self.model)?;
        let camera = traced.camera();
        traced.look(|silhouette| {
            let view = CameraView::only(&camera, *silhouette);
            HandVerdict::at(model, &pose, view, around)
        })
    }

    /// The same by the edges of a grey frame.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    #[wasm_bindgen(js_name = judgeOnFrame)]
    pub fn judge_on_frame(
        &mut self,
        film: &FrameImage,
        hidden: &HiddenPixels,
        pose: &[f64],
        known: &[f64],
        bright: Option<bool>,
        around: &Surroundings,
    ) -> Result<HandVerdict, JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let model = model_of(&mut self.model)?;
        let on = (film, film_model(known)?, bright);
        on_frame(model, on, hidden, &pose, |model, view, _| {
            HandVerdict::at(model, &pose, view, around)
        })
    }
}

/// Calls `with` with what the camera saw on a grey frame; whether the implant is bright is seen at `pose` where it is not known, and told too.
pub(super) fn on_frame<T>(
    model: &mut WorkingModel,
    (frame, film, bright): (&FrameImage, Option<FilmModel>, Option<bool>),
    hidden: &HiddenPixels,
    pose: &Pose,
    with: impl FnOnce(&mut WorkingModel, CameraView<'_>, bool) -> Result<T, JsError>,
) -> Result<T, JsError> {
    let (camera, unknown) = (&hidden.camera, Some(&*hidden.words));
    let side = square_px(film.as_ref());
    look_in_squares(side, frame, camera, unknown, |frame, camera, unknown| {
        let polarity = match bright {
            Some(is_bright) => Polarity::of(is_bright),
            None => model.polarity(pose, camera, frame)?,
        };
        let target = ImageTarget {
            frame,
            unknown,
            polarity,
            film,
        };
        let bright = polarity == Polarity::BrightImplant;
        with(model, CameraView::only(camera, target), bright)
    })
}

fn fitted(
    model: &mut WorkingModel,
    start: &Pose,
    view: CameraView<'_>,
    options: RefineOptions,
    around: &Surroundings,
) -> Result<HandFit, JsError> {
    let refined: Refined = model.refine_set(start, view, options)?;
    let assessed = model.assess(&refined, view)?;
    // How sure a pose is of which a part was given is not known.
    let free = options.locks.is_empty();
    let determined = !free || assessed.determined;
    let held = Held {
        pose: &refined.pose,
        fit: &assessed.fit,
        determined,
        refined: free,
    };
    let verdict = HandVerdict::beside(model, &held, view, around);
    Ok(HandFit {
        pose: to_numbers(&EulerPose::from(refined.pose)),
        residual_px: refined.in_pixels(side_of(&view)).residual_px,
        drawn: None,
        uncertainty: assessed.uncertainty.filter(|_| free),
        bright: false,
        verdict,
    })
}

fn begin(start: &[f64], locked: &[u8]) -> Result<(Pose, RefineOptions), JsError> {
    let &[x, y, z, z_rot, x_rot, y_rot] = locked else {
        return Err(JsError::new("Locks are six flags"));
    };
    let locks = Locks {
        translation: [x, y, z].map(|flag| flag != 0),
        z_rot: z_rot != 0,
        x_rot: x_rot != 0,
        y_rot: y_rot != 0,
    };
    let options = RefineOptions {
        locks,
        ..RefineOptions::default()
    };
    Ok((from_numbers(start)?.into(), options))
}

pub(super) fn model_of(model: &mut Option<WorkingModel>) -> Result<&mut WorkingModel, JsError> {
    model.as_mut().ok_or_else(|| {
        JsError::new("Refining a pose needs the model, not only its library: open it too")
    })
}
