//! The whole way at once: from a silhouette to the poses that explain it.

use heapless::Vec;
use thiserror::Error;

use crate::camera::Camera;
use crate::canonical::{CanonicalError, CanonicalForm, canonicalise};
use crate::estimate::pose_from_view;
use crate::interpolate::{FineView, interpolate};
use crate::library::Library;
use crate::mask::{Mask, Word};
use crate::matching::{MatchError, Scores, score, scores_needed};
use crate::pose::Pose;

/// Why no pose was found.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LocateError {
    /// The silhouette has no canonical form.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// Working memory has the wrong length.
    #[error(transparent)]
    Match(#[from] MatchError),
}

/// Working memory of [`locate`].
#[derive(Debug)]
pub struct Workspace<'a> {
    /// [`crate::canonical::CanonicalSpec::words_needed`] words; afterwards the canonical mask.
    pub canonical: &'a mut [Word],
    /// As many words again.
    pub turned: &'a mut [Word],
    /// [`scores_needed`] numbers; afterwards the score surfaces.
    pub scores: &'a mut [u32],
}

/// Lengths of a [`Workspace`] for a library: words of each mask, and scores.
#[must_use]
pub fn workspace_needed(library: &Library<'_>) -> (usize, usize) {
    let words = library.info().canonical.words_needed();
    (words, scores_needed(library.views()))
}

/// A pose that explains the silhouette, and the view that led to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// `camera_from_model`.
    pub pose: Pose,
    /// Number of the nearest view of the library.
    pub view: usize,
    /// The view between the views.
    pub fine: FineView,
}

/// What [`locate`] found.
#[derive(Clone, Debug)]
pub struct Found<'w, const K: usize> {
    /// What was taken away from the silhouette to reach canonical form.
    pub form: CanonicalForm,
    /// Unmatched pixels of every view.
    pub scores: Scores<'w>,
    /// At most `K` poses, one for each local minimum of the score surface, fewest unmatched
    /// pixels first. More than one with similar scores means that the silhouette is ambiguous.
    pub poses: Vec<Located, K>,
}

/// Finds the poses of the library's model that explain `mask`, as seen by `camera`.
///
/// # Errors
/// [`LocateError`] for a mask without a canonical form or working memory of the wrong length.
pub fn locate<'w, const K: usize>(
    mask: &Mask<'_>,
    camera: &Camera,
    library: &Library<'_>,
    work: Workspace<'w>,
) -> Result<Found<'w, K>, LocateError> {
    let info = library.info();
    let form = canonicalise(mask, &info.canonical, camera.aspect(), work.canonical)?;
    let scores = score(library, work.canonical, work.turned, work.scores)?;
    let minima: Vec<_, K> = scores.minima();
    let poses = minima
        .iter()
        .map(|candidate| {
            let canonical = if candidate.reversed {
                &*work.turned
            } else {
                &*work.canonical
            };
            let fine = interpolate(library, &scores, candidate, canonical);
            Located {
                pose: pose_from_view(camera, info, &form, &fine),
                view: candidate.view,
                fine,
            }
        })
        .collect();
    Ok(Found {
        form,
        scores,
        poses,
    })
}
