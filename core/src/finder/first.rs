//! First poses of a silhouette: of the whole outline, and of pieces of it where something hides a part.

use heapless::Vec;

use super::component::Component;
use super::error::FindError;
use super::memory::FinderMemory;
use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::locate::partial::{PartialError, known_fraction, locate_partial};
use crate::locate::rerank::{Reranked, rerank_paced};
use crate::locate::{LocatedPoses, locate};
use crate::pace::{Pace, at_once};

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
    let (mut first, pace) = (FirstPoses::NONE, Pace::new());
    let work = first_poses_paced(component, camera, silhouette, memory, &pace, &mut first);
    at_once(&pace, work)?;
    Ok(first)
}

/// The same in slices, the search of the library and then one for each drawing, into what was [`FirstPoses::NONE`]: to move so
/// many poses takes kilobytes of stack.
pub(super) async fn first_poses_paced(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
    pace: &Pace,
    first: &mut FirstPoses,
) -> Result<(), FindError> {
    pace.pause().await;
    if known_fraction(silhouette).is_partial() {
        first.partial = true;
        return add_of_pieces(component, camera, silhouette, memory, first);
    }
    of_whole(component, camera, silhouette, memory, pace, first).await?;
    match first.poses.is_empty() {
        true => Err(FindError::NoView),
        false => Ok(()),
    }
}

impl FirstPoses {
    /// None yet.
    pub(super) const NONE: Self = Self {
        poses: Vec::new(),
        clipped: false,
        partial: false,
    };

    /// Whether the best of them leaves so little unmatched that nothing seems to be hidden.
    pub(super) fn explain(&self, silhouette: &Silhouette<'_>) -> bool {
        let limit = DOUBTFUL_SHARE * silhouette.mask().area() as f64;
        let best = self.poses.first();
        best.is_some_and(|best| best.unmatched as f64 <= limit)
    }
}

async fn of_whole(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
    pace: &Pace,
    first: &mut FirstPoses,
) -> Result<(), FindError> {
    let found = in_library(component, camera, silhouette, memory)?;
    first.clipped = found.form.clipped;
    let (width, height) = (camera.width(), camera.height());
    let words = memory.refine.drawn.get_mut(..words_needed(width, height));
    let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
    let scratch = &mut *memory.refine.projected;
    let poses = found.poses.get(..kept(component)).unwrap_or(&found.poses);
    let (seen, memory) = ((camera, silhouette), (scratch, &mut drawn));
    rerank_paced(poses, component.model, seen, memory, pace, &mut first.poses).await?;
    Ok(())
}

/// The search of the library. By itself, because it leaves only its answer on the stack.
#[inline(never)]
fn in_library(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
) -> Result<LocatedPoses<FIRST_POSES>, FindError> {
    let mut work = memory.workspace.reborrow();
    if work.bytes.is_empty() {
        // Nothing is drawn yet.
        work = work.with_words(memory.refine.drawn);
    }
    Ok(locate(silhouette.mask(), camera, component.library, work)?)
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
