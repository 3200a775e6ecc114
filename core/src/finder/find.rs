//! From what a camera saw to the poses that explain it.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::choice::{ChoiceContext, choose};
use super::component::Component;
use super::corrected::{add_assessed, onto_target};
use super::error::FindError;
use super::first::{FirstPoses, add_of_pieces, first_poses_paced};
use super::memory::FinderMemory;
use super::rivals::{RefinedRival, RivalRefinement, STARTS, worth_refining};
use super::verdict::{Decision, Limits, contenders, judge};
use crate::camera::Camera;
use crate::image::silhouette::Silhouette;
use crate::locate::rerank::Reranked;
use crate::pace::{Pace, at_once};
use crate::pose::Pose;
use crate::refine::{CameraView, ImageTarget, RefineError, RefineOptions, fit_at};
use crate::shortlist::{first_of, keep};

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
    let wanted = Wanted {
        component,
        camera,
        silhouette,
        goal,
        options,
    };
    let pace = Pace::new();
    at_once(&pace, find_paced(&wanted, memory, found, &pace))
}

/// What is to be found in a frame, and how far its poses are brought: what [`find`] is asked.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'w> {
    /// The implant.
    pub component: &'w Component<'w>,
    /// What saw it; of a silhouette in a part of a frame, that part's.
    pub camera: &'w Camera,
    /// What was seen.
    pub silhouette: &'w Silhouette<'w>,
    /// How far poses are brought.
    pub goal: Goal<'w>,
    /// How they are refined.
    pub options: RefineOptions,
}

/// The same as [`find_into`] in slices ([`crate::pace`]): the search of the library, then each drawing of the model. What is
/// one slice as a whole is rare: poses of pieces of an outline, a closer look around a pose of an outline that fits in part
/// only, and all that is done on a grey frame.
///
/// # Errors
/// As [`find`]; what `found` holds then, or while work is left, means nothing.
pub async fn find_paced(
    wanted: &Wanted<'_>,
    memory: &mut FinderMemory<'_>,
    found: &mut Found,
    pace: &Pace,
) -> Result<(), FindError> {
    let Wanted {
        component,
        camera,
        silhouette,
        ..
    } = *wanted;
    if component.library.info().model != component.model.digest() {
        return Err(FindError::OtherModel);
    }
    let candidates = &mut found.candidates;
    candidates.clear();
    let mut first = FirstPoses::NONE;
    first_poses_paced(component, camera, silhouette, memory, pace, &mut first).await?;
    (found.clipped, found.partial) = (first.clipped, first.partial);
    let mut way = Way {
        component,
        camera,
        silhouette,
        options: wanted.options,
        memory,
        pace,
    };
    match wanted.goal {
        Goal::Library => way.as_the_library_has_them(&mut first, candidates),
        goal => {
            way.on_outline(&mut first, candidates).await?;
            match goal {
                Goal::Image(image) => way.on_image(image, candidates),
                _ => Ok(()),
            }
        }
    }
}

/// From first poses to candidates.
struct Way<'w, 'm> {
    component: &'w Component<'w>,
    camera: &'w Camera,
    silhouette: &'w Silhouette<'w>,
    options: RefineOptions,
    memory: &'w mut FinderMemory<'m>,
    pace: &'w Pace,
}

type Candidates = Vec<Candidate, CANDIDATES>;

impl Way<'_, '_> {
    #[inline(never)]
    fn as_the_library_has_them(
        &mut self,
        first: &mut FirstPoses,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        self.add_unrefined(&first.poses, candidates)?;
        if !first.partial && !first.explain(self.silhouette) {
            // A second opinion: where there is none, the first stands.
            self.look_for_pieces(first);
            self.add_unrefined(&first.poses, candidates)?;
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
    /// that pieces of the outline lead to are refined too, in their place.
    async fn on_outline(
        &mut self,
        first: &mut FirstPoses,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        self.add_refined(worth_refining(&first.poses), candidates)
            .await?;
        let met = candidates.first().map_or(0.0, |best| best.fit.met);
        if !first.partial && met < Limits::USUAL.good_met {
            self.look_for_pieces(first);
            // A second opinion that leads nowhere is none.
            let worth = worth_refining(&first.poses);
            let _ = self.add_refined(worth, candidates).await;
        }
        Ok(())
    }

    #[inline(never)]
    fn on_image(
        &mut self,
        image: ImageTarget<'_>,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        let outline = candidates.clone();
        let (model, camera, options) = (self.component.model, self.camera, self.options);
        let memory = &mut self.memory.refine;
        *candidates = onto_target(model, camera, image, &outline, options, memory)?;
        Ok(())
    }

    /// Poses that pieces of the outline lead to in the place of the first ones; none where they lead to none.
    fn look_for_pieces(&mut self, first: &mut FirstPoses) {
        let (camera, silhouette) = (self.camera, self.silhouette);
        // What was there is cleared in any case.
        let _ = add_of_pieces(self.component, camera, silhouette, self.memory, first);
    }

    async fn add_refined(
        &mut self,
        worth: &[Reranked],
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        let starts = worth.iter().map(|rival| rival.located.pose);
        let starts: Vec<Pose, STARTS> = first_of(starts);
        let view = CameraView::only(self.camera, *self.silhouette);
        let Component { model, planes, .. } = *self.component;
        let memory = &mut self.memory.refine;
        let mut refined = Vec::new();
        let mut rivals = RivalRefinement {
            model,
            views: &[view],
            planes,
            options: self.options,
            memory,
            pace: self.pace,
            answers: &mut refined,
        };
        rivals.run(&starts).await?;
        let located = |found: &RefinedRival| worth.get(found.start).copied();
        let assessed = add_assessed(
            model, &view, &refined, located, memory, candidates, self.pace,
        );
        Ok(assessed.await?)
    }
}
