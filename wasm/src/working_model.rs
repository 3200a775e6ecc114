//! The model that a library was made from: rivals are drawn with it, ranked and refined.

use fluoropose::camera::Camera;
use fluoropose::film::FilmProfile;
use fluoropose::finder::{
    Candidate, Component, FinderBuffers, FinderMemory, FirstPoses, Found, Goal, correct_candidates,
    find, first_poses, is_determined, look_around,
};
use fluoropose::follow::{Subject, refined_around};
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::{MaskMut, Word, words_needed};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::rerank::unmatched_at_pose;
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::{SymmetryPlane, is_nearly_symmetric, symmetry_planes};
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{
    CameraView, Fit as OutlineFit, Iterate, OutlineReading, Polarity, RefineOptions, Refined,
    Target, assess, film_profiles, fit_at, outline_readings, polarity_at, refine, refine_traced,
};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::search::kernels::Kernels;
use wasm_bindgen::JsError;

mod answers;

pub(crate) use answers::{Assessed, Fit, Judged, Ranked};

use crate::anatomy::ShapeAxes;
use crate::squares::{side_of, square_px};
use crate::uncertainty::{Uncertainty, uncertainty};
use fluoropose_page::error::sentence;

/// Mirror images nearer to another pose than this are that one, degrees.
const SAME_DEG: f64 = 1.0;

/// A model with the working memory to draw and refine it. The memory grows with the first frame and stays.
pub(crate) struct WorkingModel {
    owned: OwnedModel,
    pub(crate) buffers: FinderBuffers,
    /// The model as drawn, where nothing is refined.
    drawn: Vec<Word>,
    projected: Vec<Projected>,
    /// Found with the first refinement: it takes some tens of milliseconds.
    planes: Option<Vec<SymmetryPlane>>,
}

impl WorkingModel {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    ///
    /// # Errors
    /// The core's sentence about the vertex or triangle at fault.
    pub(crate) fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Self, JsError> {
        let owned = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        let projected = scratch_needed(&owned.as_model());
        Ok(Self {
            owned,
            buffers: FinderBuffers::default(),
            drawn: Vec::new(),
            projected: vec![Projected::default(); projected],
            planes: None,
        })
    }

    /// The core's view of the model.
    pub(crate) fn model(&self) -> Model<'_> {
        self.owned.as_model()
    }

    /// What a person should know of it.
    pub(crate) fn remarks(&self) -> Vec<String> {
        self.owned.remarks()
    }

    /// What its shape tells of its axes, as a femoral component's or a tray's.
    pub(crate) fn axes(&mut self, femoral: bool) -> ShapeAxes {
        let model = self.owned.as_model();
        ShapeAxes::of(model.mesh(), planes_of(&mut self.planes, &model), femoral)
    }

    /// Calls `with` with the component that a library and this model make, and memory to find it.
    pub(crate) fn with_component<T>(
        &mut self,
        library: &Library<'_>,
        camera: &Camera,
        with: impl FnOnce(&Component<'_>, FinderMemory<'_>) -> T,
    ) -> T {
        let model = self.owned.as_model();
        let planes = planes_of(&mut self.planes, &model);
        let component = Component {
            library,
            model: &model,
            planes,
        };
        let memory = self.buffers.borrow(&component, camera, Kernels::PORTABLE);
        with(&component, memory)
    }

    /// First poses of a silhouette, best first, and what else is known of them.
    ///
    /// # Errors
    /// The core's sentence about the silhouette.
    pub(crate) fn first_poses(
        &mut self,
        library: &Library<'_>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<FirstPoses, JsError> {
        self.with_component(library, camera, |component, mut memory| {
            first_poses(component, camera, silhouette, &mut memory).map_err(sentence)
        })
    }

    /// Poses of a silhouette, refined.
    ///
    /// # Errors
    /// The core's sentence about the silhouette, or why none can be refined.
    pub(crate) fn find(
        &mut self,
        library: &Library<'_>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
        goal: Goal<'_>,
    ) -> Result<Found, JsError> {
        let options = RefineOptions::default();
        self.with_component(library, camera, |component, mut memory| {
            find(component, camera, silhouette, goal, options, &mut memory).map_err(sentence)
        })
    }

    /// One of the candidates as the page reads it; nothing where there are not so many.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn ranked(
        &mut self,
        candidates: &[Candidate],
        index: usize,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Option<Ranked>, JsError> {
        let Some(candidate) = candidates.get(index) else {
            return Ok(None);
        };
        let located = candidate
            .located
            .ok_or_else(|| JsError::new("the library did not lead to this pose"))?;
        Ok(Some(Ranked {
            located: located.located,
            pose: candidate.pose,
            drawn: self.draw(&candidate.pose, camera, silhouette)?,
            fit: candidate.refined.map(|refined| Fit {
                refined,
                start: candidate.start,
            }),
            covariance: candidate.covariance,
            judged: Judged::of(candidates, index),
        }))
    }

    /// How uncertain a pose is; nothing where that is not known.
    pub(crate) fn uncertainty_of(&self, ranked: &Ranked) -> Option<Uncertainty> {
        let middle = self.owned.as_model().bounds().centre;
        Some(uncertainty(
            &ranked.covariance?,
            &[[0.0; 6]; 2],
            &ranked.pose,
            &middle,
        ))
    }

    /// How sure a refined pose is and how well it fits, by what a camera saw; in pixels of the frame, as all that is handed out.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn assess(
        &mut self,
        refined: &Refined,
        view: CameraView<'_>,
    ) -> Result<Assessed, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let found = assess(&model, &[view], refined, &mut memory).map_err(sentence)?;
        let middle = model.bounds().centre;
        let known =
            |covariance| uncertainty(&covariance, &found.film_steps, &refined.pose, &middle);
        Ok(Assessed {
            uncertainty: found.covariance.map(known),
            determined: is_determined(found.covariance.as_ref()),
            fit: found.fit.in_pixels(side_of(&view)),
        })
    }

    /// How well a pose fits that somebody set.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn fit_at(
        &mut self,
        pose: &Pose,
        view: CameraView<'_>,
    ) -> Result<OutlineFit, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let fit = fit_at(&model, &[view], pose, &mut memory).map_err(sentence)?;
        Ok(fit.in_pixels(side_of(&view)))
    }

    /// The same, with what was seen beside each piece of the outline.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn outline_readings(
        &mut self,
        pose: &Pose,
        view: CameraView<'_>,
        visit: impl FnMut(&OutlineReading),
    ) -> Result<OutlineFit, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let fit = outline_readings(&model, view, pose, &mut memory, visit).map_err(sentence)?;
        Ok(fit.in_pixels(side_of(&view)))
    }

    /// Brings one pose onto what was seen, without rivals or mirror images: somebody chose where to start.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn refine_from(
        &mut self,
        start: &Pose,
        view: CameraView<'_>,
        options: RefineOptions,
    ) -> Result<Refined, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        refine(&model, &[view], start, options, &mut memory).map_err(sentence)
    }

    /// The same from a pose that somebody set: on a frame from around it too.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn refine_set(
        &mut self,
        start: &Pose,
        view: CameraView<'_>,
        options: RefineOptions,
    ) -> Result<Refined, JsError> {
        let Target::Image(image) = view.target else {
            return self.refine_from(start, view, options);
        };
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let subject = Subject {
            options,
            ..Subject::new(&model, &[], view.camera)
        };
        refined_around(&subject, &image, start, &mut memory).map_err(sentence)
    }

    /// Brings poses that were refined on a frame to where its film puts the edges, and adds mirror images of the best; best first.
    /// One that cannot be corrected is left out.
    ///
    /// # Errors
    /// The core's sentence about why none can be corrected.
    pub(crate) fn correct(
        &mut self,
        refined: &[Refined],
        view: CameraView<'_>,
    ) -> Result<Vec<Candidate>, JsError> {
        let Target::Image(image) = view.target else {
            return Ok(Vec::new());
        };
        let model = self.owned.as_model();
        let planes = planes_of(&mut self.planes, &model);
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let known: Vec<Candidate> = refined.iter().map(candidate_of).collect();
        let (seen, options) = ((view.camera, image), RefineOptions::default());
        let found = correct_candidates(&model, seen, planes, &known, options, &mut memory);
        Ok(found.map_err(sentence)?.into_iter().collect())
    }

    /// Brings what was found to where its film puts the edges of a frame.
    ///
    /// # Errors
    /// The core's sentence about why none can be corrected.
    pub(crate) fn correct_found(
        &mut self,
        found: &mut Found,
        view: CameraView<'_>,
    ) -> Result<(), JsError> {
        let Target::Image(image) = view.target else {
            return Ok(());
        };
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let (seen, options) = ((view.camera, image), RefineOptions::default());
        // Mirror images are among them.
        let (known, memory) = (&found.candidates, &mut memory);
        let corrected = correct_candidates(&model, seen, &[], known, options, memory);
        found.candidates = corrected.map_err(sentence)?;
        let side = square_px(image.film.as_ref());
        let all = found.candidates.iter_mut();
        all.for_each(|one| *one = one.in_pixels(side));
        Ok(())
    }

    /// A pose that was found on a frame, refined there or put where its film puts the edges, and its mirror images.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn with_mirror_images(
        &mut self,
        pose: &Pose,
        view: CameraView<'_>,
    ) -> Result<Vec<Candidate>, JsError> {
        if matches!(view.target, Target::Image(image) if image.film.is_some()) {
            return self.correct(&[Refined::at(*pose)], view);
        }
        let model = self.owned.as_model();
        let planes = planes_of(&mut self.planes, &model).to_vec();
        let options = RefineOptions::default();
        let own = self.refine_from(pose, view, options)?;
        let mut all = vec![own];
        for plane in planes {
            let start = mirror_pose(&own.pose, &plane);
            let is_new = |one: &Refined| {
                let apart =
                    |known: &Refined| geodesic_deg(&known.pose.rotation, &one.pose.rotation);
                all.iter().all(|known| apart(known) >= SAME_DEG)
            };
            // One that leads nowhere is no rival.
            let mirrored = self.refine_from(&start, view, options).ok();
            all.extend(mirrored.filter(is_new));
        }
        let assessed = all.iter().map(|refined| {
            let assessed = self.assess(refined, view)?;
            Ok(Candidate {
                fit: assessed.fit,
                ..candidate_of(refined)
            })
        });
        assessed.collect()
    }

    /// Whether its outlines hardly tell it from its mirror image.
    pub(crate) fn is_nearly_symmetric(&mut self) -> bool {
        let model = self.owned.as_model();
        is_nearly_symmetric(&model, planes_of(&mut self.planes, &model))
    }

    /// Other poses around one that leaves more than is usual on its film, best first: where another leaves less it is among them.
    /// At `enough_px` no farther one is looked for.
    ///
    /// # Errors
    /// The core's sentence about the model.
    pub(crate) fn look_around(
        &mut self,
        refined: &Refined,
        view: CameraView<'_>,
        enough_px: f64,
    ) -> Result<Vec<Candidate>, JsError> {
        let Target::Image(image) = view.target else {
            return Ok(Vec::new());
        };
        let model = self.owned.as_model();
        let planes = planes_of(&mut self.planes, &model);
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        let known = candidate_of(refined);
        let seen = (view.camera, image);
        let how = (RefineOptions::default(), enough_px);
        let found = look_around(&model, seen, planes, &[known], how, &mut memory);
        let found = found.map_err(sentence)?.into_iter();
        Ok(found.filter(|found| found.pose != refined.pose).collect())
    }

    /// Reads profiles of a frame across the model's outline at a pose; gives how many.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn film_profiles(
        &mut self,
        pose: &Pose,
        view: &CameraView<'_>,
        profiles: &mut [FilmProfile],
    ) -> Result<usize, JsError> {
        let Target::Image(image) = &view.target else {
            return Ok(0);
        };
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, view.camera);
        // Whoever keeps them says of which component and frame they are.
        let names = (0, 0);
        film_profiles(
            &model,
            view.camera,
            pose,
            image,
            names,
            &mut memory,
            profiles,
        )
        .map_err(sentence)
    }

    /// Whether the implant is darker or brighter than what surrounds it, by the pixels on both sides of its outline.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn polarity(
        &mut self,
        pose: &Pose,
        camera: &Camera,
        frame: &dyn Grey,
    ) -> Result<Polarity, JsError> {
        let model = self.owned.as_model();
        let mut memory = self.buffers.refine().borrow(&model, camera);
        polarity_at(&model, camera, pose, frame, &mut memory).map_err(sentence)
    }

    /// The model's silhouette at a pose.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    pub(crate) fn drawn_at(&mut self, pose: &Pose, camera: &Camera) -> Result<&[Word], JsError> {
        let (width, height) = (camera.width(), camera.height());
        self.drawn.resize(words_needed(width, height), 0);
        let model = self.owned.as_model();
        let mut mask = MaskMut::new(&mut self.drawn, width, height).map_err(sentence)?;
        render(&model, camera, pose, &mut self.projected, &mut mask).map_err(sentence)?;
        Ok(&self.drawn)
    }

    /// The poses by which refinement goes from `start`.
    ///
    /// # Errors
    /// The core's sentence about why it cannot be refined.
    pub(crate) fn convergence(
        &mut self,
        start: &Pose,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Vec<Iterate>, JsError> {
        let model = self.owned.as_model();
        let view = CameraView::only(camera, *silhouette);
        let mut memory = self.buffers.refine().borrow(&model, camera);
        let mut steps = Vec::new();
        let mut note = |step: &Iterate| steps.push(*step);
        let options = RefineOptions::default();
        refine_traced(&model, &[view], start, options, &mut memory, &mut note).map_err(sentence)?;
        Ok(steps)
    }

    /// Known frame pixels that differ from the silhouette when the model is drawn at a pose; nothing where it cannot be
    /// drawn.
    pub(crate) fn draw(
        &mut self,
        pose: &Pose,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
    ) -> Result<Option<u64>, JsError> {
        let (width, height) = (camera.width(), camera.height());
        self.drawn.resize(words_needed(width, height), 0);
        let model = self.owned.as_model();
        let mut drawn = MaskMut::new(&mut self.drawn, width, height).map_err(sentence)?;
        Ok(unmatched_at_pose(
            &model,
            camera,
            pose,
            silhouette,
            &mut self.projected,
            &mut drawn,
        )
        .ok())
    }
}

/// The model's planes of symmetry, which are found once.
fn planes_of<'p>(
    known: &'p mut Option<Vec<SymmetryPlane>>,
    model: &Model<'_>,
) -> &'p [SymmetryPlane] {
    known.get_or_insert_with(|| symmetry_planes(model.mesh()).to_vec())
}

/// A refined pose as a candidate of which nothing else is known.
fn candidate_of(refined: &Refined) -> Candidate {
    Candidate {
        pose: refined.pose,
        start: refined.pose,
        located: None,
        refined: Some(*refined),
        covariance: None,
        fit: OutlineFit::default(),
    }
}
