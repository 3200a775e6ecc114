//! From what a camera saw to the poses that explain it.

use core::future::Future;
use core::iter::once;
use core::task::{Poll, ready};

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::choice::{ChoiceContext, choose};
use super::component::Component;
use super::corrected::{add_assessed, onto_target};
use super::error::FindError;
use super::first::{FirstPoses, FirstSearch, add_of_pieces};
use super::memory::FinderMemory;
use super::rivals::{Rivals, worth_refining};
use super::rounds::Subject;
use super::usual::usual_px;
use super::verdict::{Decision, Limits, Verdict, contenders, judge, judge_fit};
use crate::camera::Camera;
use crate::image::silhouette::Silhouette;
use crate::locate::partial::known_fraction;
use crate::locate::rerank::Reranked;
use crate::pace::{Pace, in_slices, to_the_end};
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
    let wanted = Wanted {
        component,
        camera,
        silhouette,
        goal,
        options,
    };
    let mut search = FrameSearch::new();
    to_the_end(|| search.go_on(&wanted, memory, found))
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

/// The same as [`find_into`] as a future that keeps to a pace ([`crate::pace`]), in the slices of [`FrameSearch`].
///
/// # Errors
/// As [`find`]; what `found` holds then, or while work is left, means nothing.
pub fn find_paced(
    wanted: &Wanted<'_>,
    memory: &mut FinderMemory<'_>,
    found: &mut Found,
    pace: &Pace,
) -> impl Future<Output = Result<(), FindError>> {
    let mut search = FrameSearch::new();
    in_slices(pace, move || search.go_on(wanted, memory, found))
}

/// All that is done for [`find`] between two slices: the search of the library, then each drawing of the model. What is
/// one slice as a whole is rare: poses of pieces of an outline, a closer look around a pose of an outline that fits in part
/// only, and all that is done on a grey frame.
pub struct FrameSearch {
    first: FirstSearch,
    rivals: Rivals,
    at: At,
    near: Option<Near>,
    /// How many of the refined poses were assessed.
    assessed: usize,
}

/// Where a search looks first.
#[derive(Clone, Copy)]
struct Near {
    pose: Pose,
    /// What may be left there, pixels.
    limit_px: f64,
}

/// How far a search is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    Start,
    /// The pose to look at first is refined.
    Near,
    /// First poses are looked for.
    First,
    /// First poses are refined.
    Refining,
    /// Those of pieces are, which the first left open.
    Again,
}

type Candidates = Vec<Candidate, CANDIDATES>;

impl Default for FrameSearch {
    fn default() -> Self {
        Self::new()
    }
}

impl FrameSearch {
    /// Nothing is done yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            first: FirstSearch::new(),
            rivals: Rivals::new(),
            at: At::Start,
            near: None,
            assessed: 0,
        }
    }

    /// As new: what was done is forgotten.
    pub fn restart(&mut self) {
        self.first.restart();
        (self.at, self.near) = (At::Start, None);
    }

    /// The same, to look first where the component is likely to be, as it was on the frame before: at `pose`, which left `misfit_px`
    /// pixels there ([`Candidate::misfit`]). Where that pose and its mirror images lead to one that fits well and leaves what is
    /// usual of the component ([`super::FilmMisfits`]), the library is not searched: what is far from them is not among the
    /// candidates. Otherwise, and where a part of the outline is unknown or [`Goal::Library`] is wanted, all is as if no pose had been
    /// given.
    pub fn restart_near(&mut self, pose: &Pose, misfit_px: f64) {
        self.restart();
        self.near = Some(Near {
            pose: *pose,
            limit_px: usual_px(misfit_px),
        });
    }

    /// Does a slice; [`Poll::Ready`] is the last, and the one after it begins anew. What is wanted, and the memory with all that is
    /// in it, must be those of the slice before.
    ///
    /// # Errors
    /// As [`find`]; what `found` holds then, or while slices are left, means nothing.
    pub fn go_on(
        &mut self,
        wanted: &Wanted<'_>,
        memory: &mut FinderMemory<'_>,
        found: &mut Found,
    ) -> Poll<Result<(), FindError>> {
        let done = self.slice(wanted, memory, found);
        if done.is_ready() {
            self.restart();
        }
        done
    }

    fn slice(
        &mut self,
        wanted: &Wanted<'_>,
        memory: &mut FinderMemory<'_>,
        found: &mut Found,
    ) -> Poll<Result<(), FindError>> {
        let component = wanted.component;
        if self.at == At::Start {
            if component.library.info().model != component.model.digest() {
                return Poll::Ready(Err(FindError::OtherModel));
            }
            self.begin(wanted, found);
        }
        if self.at == At::Near {
            let refined = ready!(self.go_on_refining(wanted, memory, &mut found.candidates));
            if refined.is_ok() && self.is_usual(found.candidates.first()) {
                return Poll::Ready(wanted.brought_to_goal(memory, &mut found.candidates));
            }
            self.at = At::First;
            return Poll::Pending;
        }
        let candidates = &mut found.candidates;
        if self.at == At::First {
            let (camera, silhouette) = (wanted.camera, wanted.silhouette);
            ready!(self.first.go_on(component, camera, silhouette, memory))?;
            candidates.clear();
            let first = &self.first.first;
            (found.clipped, found.partial) = (first.clipped, first.partial);
            if let Goal::Library = wanted.goal {
                let first = &mut self.first.first;
                return Poll::Ready(as_the_library_has_them(wanted, first, memory, candidates));
            }
            self.refine(At::Refining, wanted);
        }
        let refined = ready!(self.go_on_refining(wanted, memory, candidates));
        let first = &mut self.first.first;
        if self.at == At::Refining {
            refined?;
            let met = candidates.first().map_or(0.0, |best| best.fit.met);
            if !first.partial && met < Limits::USUAL.good_met {
                // Something may hide a part of the outline, and nobody said so.
                look_for_pieces(wanted, memory, first);
                self.refine(At::Again, wanted);
                return Poll::Pending;
            }
        }
        // A second opinion that leads nowhere is none.
        Poll::Ready(wanted.brought_to_goal(memory, candidates))
    }

    /// Begins near a known pose, where there is one that may lead to all that is wanted. By itself, so that it leaves nothing on the stack.
    #[inline(never)]
    fn begin(&mut self, wanted: &Wanted<'_>, found: &mut Found) {
        self.at = At::First;
        let is_outline = !matches!(wanted.goal, Goal::Library);
        let near = self.near.filter(|_| is_outline);
        if let Some(near) = near.filter(|_| !known_fraction(wanted.silhouette).is_partial()) {
            found.candidates.clear();
            (found.clipped, found.partial) = (false, false);
            (self.at, self.assessed) = (At::Near, 0);
            let view = [wanted.view()];
            self.rivals.begin(once(near.pose), &wanted.subject(&view));
        }
    }

    /// Whether the best pose near the one that was given is as good as that one was.
    #[inline(never)]
    fn is_usual(&self, best: Option<&Candidate>) -> bool {
        let limit_px = self.near.map_or(0.0, |near| near.limit_px);
        best.is_some_and(|best| {
            let alone = judge_fit(&best.fit, best.covariance.is_some(), &Limits::USUAL);
            alone == Verdict::Good && best.misfit() <= limit_px
        })
    }

    /// Refines what is worth it of the first poses.
    fn refine(&mut self, at: At, wanted: &Wanted<'_>) {
        let worth = worth_refining(&self.first.first.poses);
        let starts = worth.iter().map(|rival| rival.located.pose);
        (self.at, self.assessed) = (at, 0);
        let view = [wanted.view()];
        self.rivals.begin(starts, &wanted.subject(&view));
    }

    /// Draws once, to refine a pose, or to say of a refined one how certain it is.
    fn go_on_refining(
        &mut self,
        wanted: &Wanted<'_>,
        memory: &mut FinderMemory<'_>,
        candidates: &mut Candidates,
    ) -> Poll<Result<(), RefineError>> {
        let (view, memory) = ([wanted.view()], &mut memory.refine);
        ready!(self.rivals.go_on(&wanted.subject(&view), memory))?;
        let answers = self.rivals.answers().iter().take(CANDIDATES);
        let mut left = answers.skip(self.assessed);
        let Some(refined) = left.next() else {
            return Poll::Ready(Ok(()));
        };
        self.assessed += 1;
        let located = self.first.first.poses.get(refined.start).copied();
        let model = wanted.component.model;
        add_assessed(model, &view[0], (refined, located), memory, candidates)?;
        Poll::Pending
    }
}

impl<'w> Wanted<'w> {
    /// Brings poses of the outline onto the frame, where that is wanted.
    fn brought_to_goal(
        &self,
        memory: &mut FinderMemory<'_>,
        candidates: &mut Candidates,
    ) -> Result<(), FindError> {
        match self.goal {
            Goal::Image(image) => on_image(self, image, memory, candidates),
            _ => Ok(()),
        }
    }

    fn view(&self) -> CameraView<'w> {
        CameraView::only(self.camera, *self.silhouette)
    }

    fn subject<'s>(&'s self, view: &'s [CameraView<'s>]) -> Subject<'s> {
        Subject {
            model: self.component.model,
            views: view,
            planes: self.component.planes,
            options: self.options,
        }
    }
}

#[inline(never)]
fn as_the_library_has_them(
    wanted: &Wanted<'_>,
    first: &mut FirstPoses,
    memory: &mut FinderMemory<'_>,
    candidates: &mut Candidates,
) -> Result<(), FindError> {
    add_unrefined(wanted, &first.poses, memory, candidates)?;
    if !first.partial && !first.explain(wanted.silhouette) {
        // A second opinion: where there is none, the first stands.
        look_for_pieces(wanted, memory, first);
        add_unrefined(wanted, &first.poses, memory, candidates)?;
    }
    Ok(())
}

fn add_unrefined(
    wanted: &Wanted<'_>,
    poses: &[Reranked],
    memory: &mut FinderMemory<'_>,
    candidates: &mut Candidates,
) -> Result<(), FindError> {
    let (model, view) = (wanted.component.model, wanted.view());
    let mut beyond = None;
    for located in poses.iter().take(CANDIDATES) {
        let pose = located.located.pose;
        let fit = match fit_at(model, &[view], &pose, &mut memory.refine) {
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

#[inline(never)]
fn on_image(
    wanted: &Wanted<'_>,
    image: ImageTarget<'_>,
    memory: &mut FinderMemory<'_>,
    candidates: &mut Candidates,
) -> Result<(), FindError> {
    let outline = candidates.clone();
    let (model, camera, options) = (wanted.component.model, wanted.camera, wanted.options);
    let memory = &mut memory.refine;
    *candidates = onto_target(model, camera, image, &outline, options, memory)?;
    Ok(())
}

/// Poses that pieces of the outline lead to in the place of the first ones; none where they lead to none.
fn look_for_pieces(wanted: &Wanted<'_>, memory: &mut FinderMemory<'_>, first: &mut FirstPoses) {
    let (camera, silhouette) = (wanted.camera, wanted.silhouette);
    // What was there is cleared in any case.
    let _ = add_of_pieces(wanted.component, camera, silhouette, memory, first);
}
