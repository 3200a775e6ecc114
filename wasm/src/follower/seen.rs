//! A component that is looked at in frames of a film.

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::follow::Subject;
use fluoropose::math::Vector3;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers, RefineMemory, polarity_at};
use fluoropose_page::calibration::camera;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use wasm_bindgen::prelude::*;

use crate::squares::look_in_squares;

/// The component, the camera, and the memory to look at frames.
pub(super) struct Seen {
    model: OwnedModel,
    planes: Vec<SymmetryPlane>,
    camera: Camera,
    /// Side of the squares that frames are looked at in, pixels.
    square_px: usize,
    /// Whether the implant is dark, once a frame has told it.
    polarity: Option<Polarity>,
    buffers: RefineBuffers,
}

impl Seen {
    /// # Errors
    /// The core's sentence about the model or the calibration.
    pub(super) fn new(
        (vertices, triangles): (Vec<f32>, Vec<u32>),
        calibration: &str,
        (width, height): (u32, u32),
        square_px: usize,
    ) -> Result<Self, JsError> {
        let model = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        Ok(Self {
            planes: symmetry_planes(model.as_model().mesh()).to_vec(),
            model,
            camera: camera(calibration, width, height)?,
            square_px,
            polarity: None,
            buffers: RefineBuffers::default(),
        })
    }

    /// Middle of the model's box, mm.
    pub(super) fn middle(&self) -> Vector3 {
        self.model.as_model().bounds().centre
    }

    /// Whether the implant is bright, once a frame has told it.
    pub(super) fn is_bright(&self) -> bool {
        self.polarity == Some(Polarity::BrightImplant)
    }

    /// Looks at a frame. The first one whose pose is `given` tells whether the implant is dark.
    ///
    /// # Errors
    /// The core's sentence about a given pose that cannot be drawn.
    pub(super) fn look<T>(
        &mut self,
        frame: &FrameImage,
        (given, film): (Option<&Pose>, Option<FilmModel>),
        work: impl FnOnce(&Subject<'_>, &ImageTarget<'_>, &mut RefineMemory<'_>) -> T,
    ) -> Result<T, JsError> {
        let model = self.model.as_model();
        let side = self.square_px;
        look_in_squares(side, frame, &self.camera, None, |frame, camera, _| {
            let subject = Subject::new(&model, &self.planes, camera);
            let mut memory = self.buffers.borrow(&model, camera);
            let polarity = &mut self.polarity;
            if let (None, Some(pose)) = (&polarity, given) {
                let told = polarity_at(&model, camera, pose, frame, &mut memory);
                *polarity = Some(told.map_err(sentence)?);
            }
            let image = ImageTarget {
                frame,
                unknown: None,
                polarity: polarity.unwrap_or(Polarity::DarkImplant),
                film,
            };
            Ok(work(&subject, &image, &mut memory))
        })
    }
}
