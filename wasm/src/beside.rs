//! Components that lie beside each other as in no knee, over the page's film.

use fluoropose::joint::beside::{Lying, Middles};
use fluoropose::mesh::Mesh;
use wasm_bindgen::prelude::*;

use fluoropose_page::error::sentence;
use fluoropose_page::pose_numbers::{axes_from, from_numbers};

/// Numbers of a pose and the standard deviation of its depth.
const NUMBERS: usize = 7;

/// The middles of both components of a knee.
#[wasm_bindgen]
pub struct KneeMiddles {
    middles: Option<Middles>,
}

#[wasm_bindgen]
impl KneeMiddles {
    /// From the models and their axes (nine numbers each, as `axes_from` takes them).
    ///
    /// # Errors
    /// The core's sentence about a mesh, or about axes that are no right-handed frame.
    #[wasm_bindgen(constructor)]
    pub fn new(
        femur_vertices: &[f32],
        femur_triangles: &[u32],
        femur_axes: &[f64],
        tibia_vertices: &[f32],
        tibia_triangles: &[u32],
        tibia_axes: &[f64],
    ) -> Result<Self, JsError> {
        let femur = mesh(femur_vertices, femur_triangles)?;
        let tibia = mesh(tibia_vertices, tibia_triangles)?;
        let axes = [axes_from(femur_axes)?, axes_from(tibia_axes)?];
        Ok(Self {
            middles: Middles::new((femur, &axes[0]), (tibia, &axes[1])),
        })
    }

    /// What is told of each frame of a film, a sentence without its full stop; nothing where nothing is. Of each frame the femoral pose
    /// (six numbers, not finite where there is none) with the standard deviation of its depth (mm, not finite where it is not known), then the
    /// tibial one.
    pub fn told(&self, frames: &[f64]) -> Vec<JsValue> {
        let told = self.sentences(frames).into_iter();
        told.map(|told| told.map_or(JsValue::NULL, |told| JsValue::from_str(&told)))
            .collect()
    }
}

impl KneeMiddles {
    fn sentences(&self, frames: &[f64]) -> Vec<Option<String>> {
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
        let (femur, tibia): (Vec<_>, Vec<_>) = poses
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&[f, t]| (f, t))
            .unzip();
        let Some(middles) = &self.middles else {
            return vec![None; femur.len()];
        };
        let told = middles.judge_poses(&femur, &tibia).into_iter();
        told.map(|told| told.map(|told| told.to_string())).collect()
    }
}

fn mesh<'m>(vertices: &'m [f32], triangles: &'m [u32]) -> Result<Mesh<'m>, JsError> {
    Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0).map_err(sentence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fake::add_box;

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
        let middles = KneeMiddles::new(&femur.0, &femur.1, &OWN, &tibia.0, &tibia.1, &OWN);
        middles.ok().unwrap()
    }

    #[test]
    fn a_film_whose_tray_lies_beside_its_femur_is_told_in_each_known_frame() {
        let middles = knee();
        let frame = |z: f64| {
            let mut frame = [0.0; 2 * NUMBERS];
            (frame[2], frame[9]) = (-900.0, -900.0 + z);
            frame[6] = f64::NAN;
            frame
        };
        let mut beside = [frame(30.0), frame(30.0), frame(2.0), frame(30.0)].concat();
        beside[0] = f64::NAN;
        let told = middles.sentences(&beside);
        let words =
            |told: &Option<String>| told.as_ref().is_some_and(|told| told.contains("mirrored"));
        assert_eq!(
            told.iter().map(words).collect::<Vec<_>>(),
            [false, true, true, true]
        );
        assert_eq!(middles.sentences(&[frame(2.0); 2].concat()), [None, None]);
        // Nobody knows how far away it is.
        let mut frame = frame(30.0);
        frame[13] = 40.0;
        assert_eq!(middles.sentences(&[frame; 2].concat()), [None, None]);
    }
}
