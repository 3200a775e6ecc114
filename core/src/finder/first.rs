//! First poses of a silhouette: of the whole outline, and of pieces of it where something hides a part.

use core::task::Poll;

use heapless::Vec;

use super::component::Component;
use super::error::FindError;
use super::memory::FinderMemory;
use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::locate::partial::{PartialError, known_fraction, locate_partial};
use crate::locate::rerank::{Reranked, add_drawn};
use crate::locate::{Located, LocatedPoses, locate};
use crate::pace::to_the_end;
use crate::render::RenderError;

/// First poses that are kept of one silhouette.
pub const FIRST_POSES: usize = 12;

/// The same of a library that covers a window of views: fewer come near the best.
const IN_A_WINDOW: usize = 6;

/// Beyond this part of the silhouette unmatched, something may hide a part of it that nobody marked.
const DOUBTFUL_SHARE: f64 = 0.06;

/// First poses of a silhouette.
#[derive(Clone, Debug)]
pub struct FirstPoses {
    /// Fewest unmatched pixels first; at least one.
    pub poses: Vec<Reranked, FIRST_POSES>,
    /// Whether the canonical silhouette reaches its frame's border, where the score does not see all of it.
    pub clipped: bool,
    /// Whether a part of the outline is unknown or cut off, so that pieces of it led to all poses.
    pub partial: bool,
}

/// The poses that explain a silhouette, as the library has them: local minima of the score surface, put in order by
/// drawing the model at each. Where a part of the silhouette is unknown or cut off, pieces of its outline lead to them.
///
/// # Errors
/// [`FindError`] where the silhouette has no canonical form, nothing of its outline is known, the model cannot be drawn at
/// any pose, or memory is too short.
pub fn first_poses(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
) -> Result<FirstPoses, FindError> {
    let mut search = FirstSearch::new();
    to_the_end(|| search.go_on(component, camera, silhouette, memory))?;
    Ok(search.first)
}

/// The search of [`first_poses`] between two slices: the library, and then a drawing each.
pub(super) struct FirstSearch {
    pub(super) first: FirstPoses,
    /// Poses of the library.
    located: Vec<Located, FIRST_POSES>,
    /// How many of them were drawn; `None` before it was searched.
    drawn: Option<usize>,
    undrawable: Option<RenderError>,
}

impl FirstSearch {
    /// Nothing yet.
    pub(super) fn new() -> Self {
        Self {
            first: FirstPoses {
                poses: Vec::new(),
                clipped: false,
                partial: false,
            },
            located: Vec::new(),
            drawn: None,
            undrawable: None,
        }
    }

    /// As new.
    pub(super) fn restart(&mut self) {
        self.first.poses.clear();
        (self.first.clipped, self.first.partial) = (false, false);
        (self.drawn, self.undrawable) = (None, None);
    }

    /// Does a slice.
    pub(super) fn go_on(
        &mut self,
        component: &Component<'_>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
        memory: &mut FinderMemory<'_>,
    ) -> Poll<Result<(), FindError>> {
        let first = &mut self.first;
        let Some(drawn) = &mut self.drawn else {
            if known_fraction(silhouette).is_partial() {
                first.partial = true;
                return Poll::Ready(add_of_pieces(component, camera, silhouette, memory, first));
            }
            self.search_library(component, camera, silhouette, memory)?;
            self.drawn = Some(0);
            return Poll::Pending;
        };
        if let Some(located) = self.located.get(*drawn) {
            *drawn += 1;
            let size = [camera.width(), camera.height()];
            let words = words_needed(size[0], size[1]);
            let words = memory.refine.drawn.get_mut(..words).unwrap_or_default();
            let mut drawn = MaskMut::new(words, size[0], size[1])?;
            let memory = (&mut *memory.refine.projected, &mut drawn);
            let seen = (camera, silhouette);
            let error = add_drawn(located, component.model, seen, memory, &mut first.poses)?;
            self.undrawable = error.or(self.undrawable);
            return Poll::Pending;
        }
        Poll::Ready(match (first.poses.is_empty(), self.undrawable) {
            (false, _) => Ok(()),
            (true, Some(error)) => Err(error.into()),
            (true, None) => Err(FindError::NoView),
        })
    }
    /// By itself, because it leaves only its answer on the stack.
    #[inline(never)]
    fn search_library(
        &mut self,
        component: &Component<'_>,
        camera: &Camera,
        silhouette: &Silhouette<'_>,
        memory: &mut FinderMemory<'_>,
    ) -> Result<(), FindError> {
        let mut work = memory.workspace.reborrow();
        if work.bytes.is_empty() {
            // Nothing is drawn yet.
            work = work.with_words(memory.refine.drawn);
        }
        let found: LocatedPoses<FIRST_POSES> =
            locate(silhouette.mask(), camera, component.library, work)?;
        self.first.clipped = found.form.clipped;
        self.located = found.poses;
        self.located.truncate(kept(component));
        Ok(())
    }
}

impl FirstPoses {
    /// Whether the best of them leaves so little unmatched that nothing seems to be hidden.
    pub(super) fn explain(&self, silhouette: &Silhouette<'_>) -> bool {
        let limit = DOUBTFUL_SHARE * silhouette.mask().area() as f64;
        let best = self.poses.first();
        best.is_some_and(|best| best.unmatched as f64 <= limit)
    }
}

/// Adds poses that pieces of the outline lead to, for a silhouette of which something may hide a part that nobody marked, in the
/// place of those that there are.
#[inline(never)]
pub(super) fn add_of_pieces(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
    first: &mut FirstPoses,
) -> Result<(), FindError> {
    first.poses.clear();
    if cfg!(not(feature = "pieces")) {
        return Err(PartialError::LeftOut.into());
    }
    let Component { library, model, .. } = component;
    let partial = memory.partial.reborrow();
    first.poses = locate_partial(silhouette, camera, library, model, partial)?;
    first.poses.truncate(kept(component));
    Ok(())
}

fn kept(component: &Component<'_>) -> usize {
    match component.library.info().grid.is_around() {
        true => FIRST_POSES,
        false => IN_A_WINDOW,
    }
}
