//! First poses of a silhouette: of the whole outline, and of pieces of it where something hides a part.

use heapless::Vec;

use super::component::Component;
use super::error::FindError;
use super::memory::FinderMemory;
use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::locate::locate;
use crate::locate::partial::{known_fraction, locate_partial};
use crate::locate::rerank::{Reranked, rerank_paced};
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
    let pace = Pace::new();
    at_once(
        &pace,
        first_poses_paced(component, camera, silhouette, memory, &pace),
    )
}

/// The same in slices: the search of the library, then one for each drawing.
pub(super) async fn first_poses_paced(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
    pace: &Pace,
) -> Result<FirstPoses, FindError> {
    pace.pause().await;
    if known_fraction(silhouette).is_partial() {
        return Ok(FirstPoses {
            poses: of_pieces(component, camera, silhouette, memory)?,
            clipped: false,
            partial: true,
        });
    }
    let whole = of_whole(component, camera, silhouette, memory, pace).await?;
    match whole.poses.is_empty() {
        true => Err(FindError::NoView),
        false => Ok(whole),
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

async fn of_whole(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
    pace: &Pace,
) -> Result<FirstPoses, FindError> {
    let Component { library, model, .. } = component;
    let work = memory.workspace.reborrow();
    let mut found = locate::<FIRST_POSES>(silhouette.mask(), camera, library, work)?;
    found.poses.truncate(kept(component));
    let (width, height) = (camera.width(), camera.height());
    let words = memory.refine.drawn.get_mut(..words_needed(width, height));
    let mut drawn = MaskMut::new(words.unwrap_or_default(), width, height)?;
    let scratch = &mut *memory.refine.projected;
    let poses = rerank_paced(
        &found.poses,
        model,
        camera,
        silhouette,
        scratch,
        &mut drawn,
        pace,
    );
    Ok(FirstPoses {
        poses: poses.await?,
        clipped: found.form.clipped,
        partial: false,
    })
}

/// Poses that pieces of the outline lead to, for a silhouette of which something may hide a part that nobody marked.
pub(super) fn of_pieces(
    component: &Component<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    memory: &mut FinderMemory<'_>,
) -> Result<Vec<Reranked, FIRST_POSES>, FindError> {
    let Component { library, model, .. } = component;
    let partial = memory.partial.reborrow();
    let mut found = locate_partial(silhouette, camera, library, model, partial)?;
    found.truncate(kept(component));
    Ok(found)
}

fn kept(component: &Component<'_>) -> usize {
    match component.library.info().grid.is_around() {
        true => FIRST_POSES,
        false => IN_A_WINDOW,
    }
}
