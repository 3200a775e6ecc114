//! From what a camera saw to the poses that explain it.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::choice::{ChoiceContext, choose};
use super::component::Component;
use super::corrected::{add_assessed, onto_target};
use super::error::FindError;
use super::first::{FIRST_POSES, FirstPoses, first_poses, of_pieces};
use super::memory::FinderMemory;
use super::rivals::{RefinedRival, STARTS, add_rivals, worth_refining};
use super::verdict::{Decision, Limits, contenders, judge};
use crate::camera::Camera;
use crate::image::silhouette::Silhouette;
use crate::locate::rerank::Reranked;
use crate::pose::Pose;
use crate::refine::{CameraView, ImageTarget, RefineError, RefineOptions, fit_at};
use crate::shortlist::keep;

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
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Best first: by the loss after refinement, or by the pixels that differ when the model is drawn. At least one.
    pub candidates: Vec<Candidate, CANDIDATES>,
    /// Whether the canonical silhouette reaches its frame's border, where the score does not see all of it.
    pub clipped: bool,
    /// Whether a part of the outline is unknown or cut off, so that pieces of it led to the poses.
    pub partial: bool,
}

impl Found {
    /// Nothing found: what static memory is filled with.
    pub const NOTHING: Self = Self {
        candidates: Vec::new(),
        clipped: false,
        partial: false,
    };

    /// Chooses among the candidates by what else is known of the frame, and judges the choice. `None` where there is no
    /// candidate.
    #[must_use]
    pub fn decide(&self, context: &ChoiceContext<'_>) -> Option<Decision> {
        let choice = choose(&contenders(&self.candidates), context)?;
        let verdict = judge(&self.candidates, &choice, &Limits::USUAL)?;
        Some(Decision { choice, verdict })
    }
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
    let mut found = Found::NOTHING;
    find_into(
        component, camera, silhouette, goal, options, memory, &mut found,
    )?;
    Ok(found)
}

/// The same into memory that the caller keeps, for stacks that have no room for two copies of all candidates, 8 KB each.
///
/// # Errors
/// As [`find`]; what `found` holds then means nothing.
pub fn find_into(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    goal: Goal<'_>,
    options: RefineOptions,
    memory: &mut FinderMemory<'_>,
    found: &mut Found,
) -> Result<(), FindError> {
    if component.library.info().model != component.model.digest() {
        return Err(FindError::OtherModel);
    }
    let first = first_poses(component, camera, silhouette, memory)?;
    let mut way = Way {
        component,
        camera,
        silhouette,
        options,
        memory,
    };
    let candidates = &mut found.candidates;
    candidates.clear();
    (found.clipped, found.partial) = (first.clipped, first.partial);
    match goal {
        Goal::Library => way.as_the_library_has_them(&first, candidates),
        Goal::Outline => way.on_outline(&first, candidates),
        Goal::Image(image) => way.on_image(&first, image, candidates),
    }
}

/// From first poses to candidates.
struct Way<'w, 'm> {
    component: &'w Component<'w>,
    camera: &'w Camera,
    silhouette: &'w Silhouette<'w>,
    options: RefineOptions,
    memory: &'w mut FinderMemory<'m>,
}

type Candidates = Vec<Candidate, CANDIDATES>;

impl Way<'_, '_> {
    #[inline(never)]
    fn as_the_library_has_them(
        &mut self,
        first: &FirstPoses,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        self.add_unrefined(&first.poses, candidates)?;
        if !first.partial && !first.explain(self.silhouette) {
            // A second opinion: where there is none, the first stands.
            let pieces = self.pieces();
            self.add_unrefined(&pieces, candidates)?;
        }
        Ok(())
    }

    fn add_unrefined(
        &mut self,
        poses: &[Reranked],
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        let view = CameraView::only(self.camera, *self.silhouette);
        let (model, memory) = (self.component.model, &mut self.memory.refine);
        let mut beyond = None;
        for located in poses.iter().take(CANDIDATES) {
            let pose = located.located.pose;
            let fit = match fit_at(model, &[view], &pose, memory) {
                Err(error @ RefineError::BeyondCrop) => {
                    beyond = Some(error);
                    continue;
                }
                fit => fit?,
            };
            let candidate = Candidate {
                pose,
                start: pose,
                located: Some(*located),
                refined: None,
                covariance: None,
                fit,
            };
            keep(candidates, candidate, Candidate::misfit);
        }
        match beyond.filter(|_| candidates.is_empty()) {
            Some(error) => Err(error.into()),
            None => Ok(()),
        }
    }

    /// Refined poses; where they leave a part of the outline unmet, as when something hides it and nobody said so, those
    /// that pieces of the outline lead to are refined too.
    fn on_outline(
        &mut self,
        first: &FirstPoses,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        self.add_refined(worth_refining(&first.poses), candidates)?;
        let met = candidates.first().map_or(0.0, |best| best.fit.met);
        if !first.partial && met < Limits::USUAL.good_met {
            self.add_of_pieces(candidates);
        }
        Ok(())
    }

    #[inline(never)]
    fn add_of_pieces(&mut self, candidates: &mut Candidates) {
        let pieces = self.pieces();
        // A second opinion that leads nowhere is none.
        let _ = self.add_refined(worth_refining(&pieces), candidates);
    }

    #[inline(never)]
    fn on_image(
        &mut self,
        first: &FirstPoses,
        image: ImageTarget<'_>,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        let mut outline = Vec::new();
        self.on_outline(first, &mut outline)?;
        let (model, camera, options) = (self.component.model, self.camera, self.options);
        let memory = &mut self.memory.refine;
        *candidates = onto_target(model, camera, image, &outline, options, memory)?;
        Ok(())
    }

    fn pieces(&mut self) -> Vec<Reranked, FIRST_POSES> {
        of_pieces(self.component, self.camera, self.silhouette, self.memory).unwrap_or_default()
    }

    fn add_refined(
        &mut self,
        worth: &[Reranked],
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        let starts = worth.iter().map(|rival| rival.located.pose);
        let starts: Vec<Pose, STARTS> = starts.collect();
        let view = CameraView::only(self.camera, *self.silhouette);
        let Component { model, planes, .. } = *self.component;
        let memory = &mut self.memory.refine;
        let mut refined = Vec::new();
        add_rivals(
            model,
            &[view],
            &starts,
            planes,
            self.options,
            memory,
            &mut refined,
        )?;
        let located = |found: &RefinedRival| worth.get(found.start).copied();
        Ok(add_assessed(
            model, &view, &refined, located, memory, candidates,
        )?)
    }
}
