//! The joint's other component, where that is known.

use fluoropose::camera::Camera;
use fluoropose::follow::Limb;
use fluoropose::image::mask::{MaskMut, Word, words_needed};
use fluoropose::math::Vector3;
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tracing::beside;
use wasm_bindgen::JsError;

use crate::shape::Shape;
use fluoropose_page::error::sentence;

/// The other component.
pub(super) struct Other {
    model: OwnedModel,
    shape: Option<Shape>,
    projected: Vec<Projected>,
}

/// Where it is in a frame.
pub(super) struct Beside {
    pub(super) pose: Pose,
    /// Its middle, mm in the camera's frame.
    pub(super) middle: Vector3,
    /// Pixels that are its own.
    pub(super) hidden: Vec<Word>,
    /// Whether its joint tells where the component is that is sought.
    pub(super) in_joint: bool,
}

impl Other {
    /// # Errors
    /// The core's sentence about the model.
    pub(super) fn new(
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        shape: Option<Shape>,
    ) -> Result<Self, JsError> {
        let model = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        let projected = vec![Projected::default(); scratch_needed(&model.as_model())];
        Ok(Self {
            model,
            shape,
            projected,
        })
    }

    /// As its joint knows it, where its shape tells its axes.
    pub(super) fn limb(&self) -> Option<Limb<'_>> {
        Some(self.shape?.limb(*self.model.as_model().mesh()))
    }

    /// Where it is in a frame of the camera; its edges reach some pixels beyond its silhouette.
    ///
    /// # Errors
    /// The core's sentence about a pose that cannot be drawn.
    pub(super) fn at(
        &mut self,
        pose: Pose,
        in_joint: bool,
        camera: &Camera,
    ) -> Result<Beside, JsError> {
        let (width, height) = (camera.width(), camera.height());
        let model = self.model.as_model();
        let [mut drawn, mut hidden] = [(); 2].map(|()| vec![0; words_needed(width, height)]);
        let mut mask = MaskMut::new(&mut drawn, width, height).map_err(sentence)?;
        render(&model, camera, &pose, &mut self.projected, &mut mask).map_err(sentence)?;
        let mut wide = MaskMut::new(&mut hidden, width, height).map_err(sentence)?;
        beside::hide(&mask.as_mask(), &mut wide);
        Ok(Beside {
            pose,
            middle: pose.transform(&model.bounds().centre),
            hidden,
            in_joint,
        })
    }
}
