//! Components that lie beside each other as in no knee, over the page's film.

use fluoropose::camera::Camera;
use fluoropose::finder::{FlippedKnee, FlippedLooks};
use fluoropose::image::grey::Grey;
use fluoropose::joint::beside::{Beside, Lying, Middles};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, ImageTarget, RefineBuffers, RefineOptions, polarity_at};
use wasm_bindgen::prelude::*;

use crate::film::film_model;
use crate::squares::{look_in_squares, square_px};
use fluoropose_page::calibration::camera;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{axes_from, from_numbers};

/// Numbers of a pose and the standard deviation of its depth.
const NUMBERS: usize = 7;

/// Both components of a knee as they lie beside each other, and as they would with the pictures flipped.
#[wasm_bindgen]
pub struct KneeMiddles {
    models: [OwnedModel; 2],
    axes: [Pose; 2],
    middles: Option<Middles>,
    flipped: Option<Looked>,
}

/// Frames that are looked at as if they were flipped.
struct Looked {
    /// Drawn with mirrored models.
    knee: FlippedKnee,
    looks: FlippedLooks,
    /// Of femur and tibia, frame by frame.
    poses: [Vec<Option<Pose>>; 2],
}

#[wasm_bindgen]
impl KneeMiddles {
    /// From the models and their axes (nine numbers each, as `axes_from` takes them).
    ///
    /// # Errors
    /// The core's sentence about a mesh, or about axes that are no right-handed frame.
    #[wasm_bindgen(constructor)]
    pub fn new(
        femur_vertices: Vec<f32>,
        femur_triangles: Vec<u32>,
        femur_axes: &[f64],
        tibia_vertices: Vec<f32>,
        tibia_triangles: Vec<u32>,
        tibia_axes: &[f64],
    ) -> Result<Self, JsError> {
        let femur = OwnedModel::new(femur_vertices, femur_triangles).map_err(sentence)?;
        let tibia = OwnedModel::new(tibia_vertices, tibia_triangles).map_err(sentence)?;
        let axes = [axes_from(femur_axes)?, axes_from(tibia_axes)?];
        let [a, b] = [&femur, &tibia].map(|model| *model.as_model().mesh());
        Ok(Self {
            middles: Middles::new((a, &axes[0]), (b, &axes[1])),
            models: [femur, tibia],
            axes,
            flipped: None,
        })
    }

    /// What is told of each frame of a film, a sentence without its full stop; nothing where nothing is. Of each frame the femoral pose
    /// (six numbers, not finite where there is none) with the standard deviation of its depth (mm, not finite where it is not known), then the
    /// tibial one. With what was seen in frames as if they were flipped, once that is complete.
    pub fn told(&self, frames: &[f64]) -> Vec<JsValue> {
        let told = self.judged(frames).into_iter();
        told.map(|told| told.map_or(JsValue::NULL, |told| JsValue::from_str(&told.to_string())))
            .collect()
    }

    /// In which frames the tray lies farther off than mirrored pictures leave it: there a pose that is good by itself is not doubtful for one that is
    /// not.
    #[wasm_bindgen(js_name = beyondFlipping)]
    pub fn beyond_flipping(&self, frames: &[f64]) -> Vec<u8> {
        let told = self.judged(frames).into_iter();
        let is_beyond = |told: Option<Beside>| told.is_some_and(|told| told.is_beyond_flipping());
        told.map(|told| u8::from(is_beyond(told))).collect()
    }

    /// Begins to look at frames, given as `told` takes them, as if they were flipped; what was seen before is forgotten.
    #[wasm_bindgen(js_name = beginFlipped)]
    pub fn begin_flipped(&mut self, frames: &[f64]) {
        self.flipped = self.looked(frames);
    }

    /// The look that is wanted next: 0 the femur, 1 the tibia, and the frame; nothing where all is seen.
    #[wasm_bindgen(getter, js_name = wantedFlipped)]
    pub fn wanted_flipped(&self) -> Option<Vec<u32>> {
        let looked = self.flipped.as_ref()?;
        let &(component, frame) = looked.looks.wanted().first()?;
        Some(vec![
            u32::from(component == KneeComponent::Tibia),
            frame as u32,
        ])
    }

    /// Looks at the frame that is wanted. `film`: what it makes of the component, as `FilmFacts.model` gives it, or empty.
    ///
    /// # Errors
    /// A sentence about the calibration or the film.
    #[wasm_bindgen(js_name = lookFlipped)]
    pub fn look_flipped(
        &mut self,
        frame: &FrameImage,
        calibration: &str,
        width: u32,
        height: u32,
        film: &[f64],
    ) -> Result<(), JsError> {
        let camera = camera(calibration, width, height)?;
        let film = film_model(film)?;
        let Some(looked) = &mut self.flipped else {
            return Ok(());
        };
        let Some(&(component, at)) = looked.looks.wanted().first() else {
            return Ok(());
        };
        let number = usize::from(component == KneeComponent::Tibia);
        let model = self.models[number].as_model();
        let fit = |pose: Pose, frame: &dyn Grey, camera: &Camera| {
            let mut buffers = RefineBuffers::default();
            let mut memory = buffers.borrow(&model, camera);
            let image = ImageTarget {
                frame,
                unknown: None,
                polarity: polarity_at(&model, camera, &pose, frame, &mut memory).ok()?,
                film,
            };
            let (own, view) = ((&model, &pose), CameraView::only(camera, image));
            let options = RefineOptions::default();
            looked.knee.fit(component, own, view, options, &mut buffers)
        };
        let pose = looked.poses[number].get(at).copied().flatten();
        let side = square_px(film.as_ref());
        let fit = look_in_squares(side, frame, &camera, None, |frame, camera, _| {
            Ok(pose.and_then(|pose| fit(pose, frame, camera)))
        })?;
        looked.looks.take(fit);
        Ok(())
    }
}

impl KneeMiddles {
    fn judged(&self, frames: &[f64]) -> Vec<Option<Beside>> {
        let [femur, tibia] = lying(frames);
        let Some(middles) = &self.middles else {
            return vec![None; femur.len()];
        };
        let mut told = middles.judge_poses(&femur, &tibia);
        if let Some(Looked { knee, looks, .. }) = &self.flipped {
            let apart = middles.apart_of(&poses_of(&femur), &poses_of(&tibia));
            knee.judge(&mut told, &apart, &looks.fits());
        }
        told
    }

    fn looked(&self, frames: &[f64]) -> Option<Looked> {
        let poses = lying(frames).map(|film| poses_of(&film));
        let apart = self.middles.as_ref()?.apart_of(&poses[0], &poses[1]);
        let [femur, tibia] = [&self.models[0], &self.models[1]].map(OwnedModel::as_model);
        Some(Looked {
            knee: FlippedKnee::new((&femur, &self.axes[0]), (&tibia, &self.axes[1]))?,
            looks: FlippedLooks::new(&apart),
            poses,
        })
    }
}

/// Femur and tibia of each frame, from the numbers that `told` takes.
fn lying(frames: &[f64]) -> [Vec<Option<Lying>>; 2] {
    let pose = |numbers: &[f64; NUMBERS]| {
        let [pose @ .., sd] = numbers;
        let known = pose.iter().all(|number| number.is_finite());
        let pose = known.then(|| from_numbers(pose).ok()).flatten();
        let depth_sd_mm = if sd.is_finite() { *sd } else { 0.0 };
        pose.map(|pose| Lying {
            pose: pose.into(),
            depth_sd_mm,
        })
    };
    let poses: Vec<Option<Lying>> = frames.as_chunks().0.iter().map(pose).collect();
    let both = poses.as_chunks::<2>().0.iter();
    let (femur, tibia) = both.map(|&[femur, tibia]| (femur, tibia)).unzip();
    [femur, tibia]
}

fn poses_of(film: &[Option<Lying>]) -> Vec<Option<Pose>> {
    film.iter().map(|lying| Some((*lying)?.pose)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fake::add_box;
    use fluoropose::finder::FlippedFit;

    const OWN: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

    /// A femoral component of 68 mm over a tray of 76 mm: 15 mm are possible.
    fn knee() -> KneeMiddles {
        let (mut femur, mut tibia) = <((Vec<f32>, Vec<u32>), (Vec<f32>, Vec<u32>))>::default();
        add_box(
            [-5.0, 20.0, -34.0],
            [5.0, 40.0, 34.0],
            &mut femur.0,
            &mut femur.1,
        );
        add_box(
            [-25.0, -4.0, -38.0],
            [25.0, 0.0, 38.0],
            &mut tibia.0,
            &mut tibia.1,
        );
        let middles = KneeMiddles::new(femur.0, femur.1, &OWN, tibia.0, tibia.1, &OWN);
        middles.ok().unwrap()
    }

    #[test]
    fn a_film_whose_tray_lies_beside_its_femur_is_told_in_each_frame() {
        let middles = knee();
        let frame = |z: f64| {
            let mut frame = [0.0; 2 * NUMBERS];
            (frame[2], frame[9]) = (-900.0, -900.0 + z);
            frame[6] = f64::NAN;
            frame
        };
        let mut beside = [frame(30.0), frame(30.0), frame(2.0), frame(30.0)].concat();
        beside[0] = f64::NAN;
        let told = middles.judged(&beside);
        let words =
            |told: &Option<Beside>| told.is_some_and(|told| told.to_string().contains("mirrored"));
        assert_eq!(told.iter().map(words).collect::<Vec<_>>(), [true; 4]);
        assert_eq!(middles.judged(&[frame(2.0); 2].concat()), [None, None]);
        // Nobody knows how far away it is.
        let mut frame = frame(30.0);
        frame[13] = 40.0;
        assert_eq!(middles.judged(&[frame; 2].concat()), [None, None]);
    }

    /// What is told of a film whose tray lies well, once all looks have such a gain.
    fn told_of_gain(gain: f64) -> Vec<Option<Beside>> {
        let mut middles = knee();
        let mut frame = [0.0; 2 * NUMBERS];
        (frame[2], frame[9]) = (-900.0, -898.0);
        let frames = [frame; 4].concat();
        middles.begin_flipped(&frames);
        assert_eq!(middles.judged(&frames), [None; 4], "nothing was seen yet");
        let mut seen = 0;
        while let Some(wanted) = middles.wanted_flipped() {
            let looked = middles.flipped.as_mut().unwrap();
            let pose = looked.poses[wanted[0] as usize][wanted[1] as usize].unwrap();
            looked.looks.take(Some(FlippedFit { pose, gain }));
            seen += 1;
        }
        assert!(seen >= 2);
        middles.judged(&frames)
    }

    #[test]
    fn a_knee_that_fits_better_flipped_is_told_wherever_its_tray_lies() {
        let told = told_of_gain(1.5);
        assert!(told.iter().all(|told| {
            told.is_some_and(|told| {
                told.to_string()
                    .contains("fit better with the picture flipped")
            })
        }));
        assert_eq!(told_of_gain(1.1), [None; 4]);
        assert_eq!(told_of_gain(0.2), [None; 4]);
    }
}
