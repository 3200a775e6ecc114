//! From what a camera saw to the poses that explain it.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::component::Component;
use super::error::FindError;
use super::first::{FirstPoses, first_poses};
use super::memory::FinderMemory;
use super::rivals::{RefinedRival, refine_rivals, worth_refining};
use crate::camera::Camera;
use crate::image::silhouette::Silhouette;
use crate::locate::rerank::Reranked;
use crate::pose::Pose;
use crate::refine::{CameraView, ImageTarget, RefineOptions, assess, fit_at};

/// Refined poses of an outline that are brought onto the grey frame: the best of them.
const ON_IMAGE: usize = 3;

/// How far poses are brought.
#[derive(Clone, Copy, Debug)]
pub enum Goal<'g> {
    /// The best views of the library, interpolated.
    Library,
    /// Then the model's outline brought onto the silhouette's.
    Outline,
    /// Then onto the edges of the grey frame.
    Image(ImageTarget<'g>),
}

/// The poses that explain what a camera saw.
#[derive(Clone, Debug)]
pub struct Found {
    /// Best first: by the loss after refinement, or by the pixels that differ when the model is drawn. At least one.
    pub candidates: Vec<Candidate, CANDIDATES>,
    /// Whether the canonical silhouette reaches its frame's border, where the score does not see all of it.
    pub clipped: bool,
    /// Whether a part of the outline is unknown or cut off, so that pieces of it led to the poses.
    pub partial: bool,
}

/// Finds the poses of a component that explain a silhouette; their mirror images are among them where the component is
/// nearly symmetric. What is made of them, a choice and a verdict, is [`Found::decide`]'s.
///
/// # Errors
/// [`FindError`]; too few working memory names what is missing.
pub fn find(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    goal: Goal<'_>,
    options: RefineOptions,
    memory: &mut FinderMemory<'_>,
) -> Result<Found, FindError> {
    if component.library.info().model != component.model.digest() {
        return Err(FindError::OtherModel);
    }
    let first = first_poses(component, camera, silhouette, memory)?;
    let mut way = Way {
        component,
        camera,
        options,
        memory,
    };
    let candidates = match goal {
        Goal::Library => way.as_the_library_has_them(&first, silhouette)?,
        Goal::Outline => way.on_outline(&first, silhouette)?,
        Goal::Image(image) => way.on_image(&first, silhouette, image)?,
    };
    Ok(Found {
        candidates,
        clipped: first.clipped,
        partial: first.partial,
    })
}

/// From first poses to candidates.
struct Way<'w, 'm> {
    component: &'w Component<'w>,
    camera: &'w Camera,
    options: RefineOptions,
    memory: &'w mut FinderMemory<'m>,
}

type Candidates = Vec<Candidate, CANDIDATES>;

impl Way<'_, '_> {
    fn as_the_library_has_them(
        &mut self,
        first: &FirstPoses,
        silhouette: &Silhouette<'_>,
    ) -> Result<Candidates, FindError> {
        let view = CameraView::only(self.camera, *silhouette);
        let model = self.component.model;
        let mut candidates = Vec::new();
        for located in first.poses.iter().take(CANDIDATES) {
            let pose = located.located.pose;
            let fit = fit_at(model, &[view], &pose, &mut self.memory.refine)?;
            let candidate = Candidate {
                pose,
                start: pose,
                located: *located,
                refined: None,
                covariance: None,
                fit,
            };
            // There is room for as many as are taken.
            let _ = candidates.push(candidate);
        }
        Ok(candidates)
    }

    fn on_outline(
        &mut self,
        first: &FirstPoses,
        silhouette: &Silhouette<'_>,
    ) -> Result<Candidates, FindError> {
        let worth = worth_refining(&first.poses);
        let view = CameraView::only(self.camera, *silhouette);
        let refined = self.refine_worth(worth, &view)?;
        self.candidates(&view, &refined, |found| worth.get(found.start).copied())
    }

    fn on_image(
        &mut self,
        first: &FirstPoses,
        silhouette: &Silhouette<'_>,
        image: ImageTarget<'_>,
    ) -> Result<Candidates, FindError> {
        let worth = worth_refining(&first.poses);
        let outline = CameraView::only(self.camera, *silhouette);
        let refined = self.refine_worth(worth, &outline)?;
        let starts: Vec<Pose, ON_IMAGE> = refined
            .iter()
            .take(ON_IMAGE)
            .map(|found| found.refined.pose)
            .collect();
        let view = CameraView::only(self.camera, image);
        let (model, options) = (self.component.model, self.options);
        // Their mirror images are among them.
        let on_image = refine_rivals(
            model,
            &[view],
            &starts,
            &[],
            options,
            &mut self.memory.refine,
        )?;
        self.candidates(&view, &on_image, |found| {
            worth.get(refined.get(found.start)?.start).copied()
        })
    }

    fn refine_worth(
        &mut self,
        worth: &[Reranked],
        view: &CameraView<'_>,
    ) -> Result<Vec<RefinedRival, { super::rivals::ANSWERS }>, FindError> {
        let starts: Vec<Pose, { super::rivals::STARTS }> =
            worth.iter().map(|rival| rival.located.pose).collect();
        let (model, planes) = (self.component.model, self.component.planes);
        let memory = &mut self.memory.refine;
        Ok(refine_rivals(
            model,
            &[*view],
            &starts,
            planes,
            self.options,
            memory,
        )?)
    }

    /// Refined poses with what led to them, how sure they are and how well they fit.
    fn candidates(
        &mut self,
        view: &CameraView<'_>,
        refined: &[RefinedRival],
        located: impl Fn(&RefinedRival) -> Option<Reranked>,
    ) -> Result<Candidates, FindError> {
        let mut candidates = Vec::new();
        for found in refined.iter().take(CANDIDATES) {
            // Each was refined from one of them.
            let Some(located) = located(found) else {
                continue;
            };
            let (model, memory) = (self.component.model, &mut self.memory.refine);
            let assessment = assess(model, &[*view], &found.refined, memory)?;
            let candidate = Candidate {
                pose: found.refined.pose,
                start: found.from,
                located,
                refined: Some(found.refined),
                covariance: assessment.covariance,
                fit: assessment.fit,
            };
            // There is room for as many as are taken.
            let _ = candidates.push(candidate);
        }
        Ok(candidates)
    }
}
