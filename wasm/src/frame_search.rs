//! A component looked for in whole frames, where nobody points at it.

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::finder::{Component, FinderBuffers};
use fluoropose::follow::{self, Subject};
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::math::Vector3;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::EulerPose;
use fluoropose::refine::{ImageTarget, Polarity};
use fluoropose::search::kernels::Kernels;
use fluoropose_tracing::one_click::OneClickBuffers;
use fluoropose_tracing::seeds::seeds_needed;
use fluoropose_tracing::whole_frame::WholeFrame;
use wasm_bindgen::prelude::*;

use crate::film::film_model;
use crate::hidden::{hide, with_mask};
use crate::matcher::OpenLibrary;
use fluoropose_page::calibration::camera;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::to_numbers;

/// Frames of a film of `frames` in which a component is looked for that nobody pointed at, in this order.
#[wasm_bindgen(js_name = framesToSearch)]
pub fn frames_to_search(frames: usize) -> Vec<usize> {
    follow::frames_to_search(&(0..frames)).to_vec()
}

/// Looks for a component in one frame after the other, in steps between which a worker can be called off.
#[wasm_bindgen]
pub struct FrameSearch {
    library: OpenLibrary,
    model: OwnedModel,
    planes: Vec<SymmetryPlane>,
    camera: Camera,
    polarity: Polarity,
    film: Option<FilmModel>,
    /// The joint's other component: its middle (mm, in the camera's frame), and the pixels that are its own.
    beside: Option<(Vector3, Vec<Word>)>,
    finder: FinderBuffers,
    own: OneClickBuffers,
    search: Option<WholeFrame>,
}

#[wasm_bindgen]
impl FrameSearch {
    /// With a library's bytes and the model that it was made from, for frames of the size that the calibration text is for.
    ///
    /// # Errors
    /// The core's sentences about library, model and calibration.
    #[wasm_bindgen(constructor)]
    pub fn new(
        library: Vec<u8>,
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        calibration: &str,
        width: u32,
        height: u32,
        bright_implant: bool,
    ) -> Result<FrameSearch, JsError> {
        let model = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        Ok(Self {
            library: OpenLibrary::of(library)?,
            planes: symmetry_planes(model.as_model().mesh()).to_vec(),
            model,
            camera: camera(calibration, width, height)?,
            polarity: match bright_implant {
                true => Polarity::BrightImplant,
                false => Polarity::DarkImplant,
            },
            film: None,
            beside: None,
            finder: FinderBuffers::default(),
            own: OneClickBuffers::default(),
            search: None,
        })
    }

    /// What the film makes of the component, as `FilmFacts.model` gives it, or nothing of it.
    ///
    /// # Errors
    /// A sentence about the numbers.
    #[wasm_bindgen(js_name = knowFilm)]
    pub fn know_film(&mut self, film: &[f64]) -> Result<(), JsError> {
        self.film = film_model(film)?;
        Ok(())
    }

    /// Says where the joint's other component is in the next frame: its middle (x, y, z in mm, in the camera's frame) and its outline
    /// (columns and rows by turns). Without a middle it is not known.
    ///
    /// # Errors
    /// The core's sentence about the outline.
    pub fn beside(&mut self, middle: &[f64], outline: &[f64]) -> Result<(), JsError> {
        self.beside = match *middle {
            [x, y, z] => {
                let mut words = vec![0; words_needed(self.camera.width(), self.camera.height())];
                hide(outline, &self.camera, &mut words)?;
                Some(([x, y, z], words))
            }
            _ => None,
        };
        Ok(())
    }

    /// The next part of the search of a frame, the same until it is done; `fresh` begins with it. Gives whether there is more to do.
    ///
    /// # Errors
    /// A sentence about a frame of another size.
    pub fn step(&mut self, frame: &FrameImage, fresh: bool) -> Result<bool, JsError> {
        let model = self.model.as_model();
        let component = Component {
            library: self.library.borrow_dependent(),
            model: &model,
            planes: &self.planes,
        };
        let subject = Subject::new(&model, &self.planes, &self.camera);
        let (camera, polarity, kept) = (&self.camera, self.polarity, &mut self.search);
        let (finder, own) = (&mut self.finder, &mut self.own);
        let (middle, hidden) = match &self.beside {
            Some((middle, words)) => (Some(*middle), Some(words.as_slice())),
            None => (None, None),
        };
        let mut look = |image: &ImageTarget<'_>| {
            if fresh || kept.is_none() {
                let mut sums = vec![0.0; seeds_needed(camera)];
                let begun = WholeFrame::new(image, &component, camera, middle, &mut sums);
                *kept = Some(begun.map_err(sentence)?);
            }
            let Some(search) = kept else {
                return Ok(false);
            };
            let Some(needs) = search.needs(camera) else {
                return Ok(false);
            };
            let finder = finder.borrow(&component, camera, Kernels::PORTABLE);
            let mut memory = own.borrow(&needs, finder.workspace, finder.refine);
            search
                .step(&subject, image, &component, &mut memory)
                .map_err(sentence)
        };
        frame.look(|frame| {
            with_mask(hidden, camera, |unknown| {
                look(&ImageTarget {
                    frame,
                    unknown,
                    polarity,
                    film: self.film,
                })
            })
        })
    }

    /// The part of a frame's search that is done, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn progress(&self) -> f64 {
        self.search.as_ref().map_or(0.0, WholeFrame::progress)
    }

    /// Column and row of a click that leads to what was found.
    #[wasm_bindgen(getter)]
    pub fn place(&self) -> Option<Vec<f64>> {
        let place = self.search.as_ref()?.found()?.place;
        Some(vec![place.column, place.row])
    }

    /// Six numbers of the pose that was found.
    #[wasm_bindgen(getter)]
    pub fn pose(&self) -> Option<Vec<f64>> {
        let pose = self.search.as_ref()?.found()?.pose.pose;
        Some(to_numbers(&EulerPose::from(pose)).to_vec())
    }
}
