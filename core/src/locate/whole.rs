//! From a whole silhouette to the first poses that explain it.

use heapless::Vec;
use thiserror::Error;

use crate::camera::Camera;
use crate::canonical::{CanonicalError, CanonicalForm, CanonicalSpec, canonicalise, reverse};
use crate::image::mask::{Mask, Word};
use crate::library::Library;
use crate::locate::estimate::pose_from_view;
use crate::locate::interpolate::{FineView, interpolate};
use crate::memory::first;
use crate::pose::Pose;
use crate::search::kernels::Kernels;
use crate::search::{MatchError, Scores, scores_needed};
use crate::search::{Query, ViewSearch, ViewSearchMemory, query_bytes_needed, search_bytes_needed};

/// Why no pose was found.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
    /// The same number of words; afterwards the canonical mask rotated by 180 degrees.
    pub rotated: &'a mut [Word],
    /// [`scores_needed`] numbers.
    pub scores: &'a mut [u32],
    /// [`workspace_bytes_needed`] bytes.
    pub bytes: &'a mut [u8],
    /// The inner loops: [`Kernels::PORTABLE`], or those of a crate that knows the machine.
    pub kernels: Kernels,
}

impl Workspace<'_> {
    /// The same memory, borrowed for a shorter time.
    pub fn reborrow(&mut self) -> Workspace<'_> {
        Workspace {
            canonical: self.canonical,
            rotated: self.rotated,
            scores: self.scores,
            bytes: self.bytes,
            kernels: self.kernels,
        }
    }

    /// The same with words in place of its bytes: those of the silhouette, of which nothing is needed once its form is known.
    #[must_use]
    pub fn with_words<'w>(self, words: &'w mut [Word]) -> Workspace<'w>
    where
        Self: 'w,
    {
        Workspace {
            bytes: bytemuck::cast_slice_mut(words),
            ..self
        }
    }
}

/// Lengths of a [`Workspace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkspaceNeeds {
    /// Words of each of the two masks.
    pub words: usize,
    /// Scores.
    pub scores: usize,
    /// Bytes.
    pub bytes: usize,
}

/// Lengths of a [`Workspace`] for a library.
#[must_use]
pub fn workspace_needed(library: &Library<'_>) -> WorkspaceNeeds {
    let spec = &library.info().canonical;
    WorkspaceNeeds {
        words: spec.words_needed(),
        scores: scores_needed(library.views()),
        bytes: workspace_bytes_needed(spec),
    }
}

/// Bytes of a [`Workspace`] for libraries of a canonical frame.
#[must_use]
pub const fn workspace_bytes_needed(spec: &CanonicalSpec) -> usize {
    query_bytes_needed(spec) + search_bytes_needed(spec)
}

/// A pose that explains the silhouette, and the view that led to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// `camera_from_model`.
    pub pose: Pose,
    /// Number of the nearest view of the library.
    pub view: usize,
    /// The interpolated view.
    pub fine: FineView,
    /// Whether pieces of the outline led to it ([`crate::locate::partial`]): then `fine` has no score of whole silhouettes.
    pub by_pieces: bool,
}

/// What [`locate`] found.
#[derive(Clone, Debug)]
pub struct LocatedPoses<const K: usize> {
    /// What was taken away from the silhouette to reach canonical form.
    pub form: CanonicalForm,
    /// At most `K` poses, fewest unmatched pixels first: one for each local minimum of the score surface that is near
    /// enough to the best ([`ViewSearch::rivals`]). Several with similar scores mean that the silhouette is ambiguous.
    pub poses: Vec<Located, K>,
}

/// Finds the poses of the library's model that explain `mask`, as seen by `camera`: canonical form, the views that differ
/// in the fewest pixels, interpolation between them, and the equations of Walker et al. 1996, section 2.3. The mask must
/// hold the whole silhouette; for a part of one see [`crate::locate::partial`].
///
/// # Errors
/// [`LocateError`] for a mask without a canonical form or working memory of the wrong length.
pub fn locate<const K: usize>(
    mask: &Mask<'_>,
    camera: &Camera,
    library: &Library<'_>,
    mut work: Workspace<'_>,
) -> Result<LocatedPoses<K>, LocateError> {
    let form = canonical_form(mask, camera, library, &mut work)?;
    locate_form(&form, camera, library, work)
}

/// The first half of [`locate`]: the canonical form of a silhouette, whose pixels are needed no more then.
///
/// # Errors
/// As [`locate`].
#[cfg_attr(target_os = "none", inline(never))]
pub fn canonical_form(
    mask: &Mask<'_>,
    camera: &Camera,
    library: &Library<'_>,
    work: &mut Workspace<'_>,
) -> Result<CanonicalForm, LocateError> {
    let spec = &library.info().canonical;
    let straight = words_of(spec, work.canonical)?;
    Ok(canonicalise(mask, spec, camera.aspect(), straight)?)
}

/// The second half of [`locate`]: the poses of the silhouette of which [`canonical_form`] told the form, in the same `work`. Where
/// this has no bytes, the words of the silhouette serve ([`Workspace::with_words`]).
///
/// # Errors
/// As [`locate`].
#[cfg_attr(target_os = "none", inline(never))]
pub fn locate_form<const K: usize>(
    form: &CanonicalForm,
    camera: &Camera,
    library: &Library<'_>,
    work: Workspace<'_>,
) -> Result<LocatedPoses<K>, LocateError> {
    let info = library.info();
    let [straight, rotated] = both_directions(&info.canonical, work.canonical, work.rotated)?;
    let (prepared, sketches) = split_bytes(work.bytes, &info.canonical)?;
    let query = Query::new(&info.canonical, straight, rotated, prepared)?;
    let memory = ViewSearchMemory {
        bounds: work.scores,
        sketches,
    };
    let mut search = ViewSearch::new(library, &query, &work.kernels, memory)?;
    let rivals: Vec<_, K> = search.rivals();
    // Made where it is handed back: a copy of it takes kilobytes of stack.
    let mut found = Ok(LocatedPoses {
        form: *form,
        poses: Vec::new(),
    });
    for candidate in &rivals {
        let fine = interpolate(&mut search, candidate);
        let located = Located {
            pose: pose_from_view(camera, info, form, &fine),
            view: candidate.view,
            fine,
            by_pieces: false,
        };
        if let Ok(LocatedPoses { poses, .. }) = &mut found {
            // There is room for as many.
            let _ = poses.push(located);
        }
    }
    found
}

/// The scores of all views for `mask`, as seen by `camera`, and its canonical form. [`locate`] looks at no more of them
/// than it has to.
///
/// # Errors
/// As [`locate`].
pub fn score_views<'w>(
    mask: &Mask<'_>,
    camera: &Camera,
    library: &Library<'_>,
    mut work: Workspace<'w>,
) -> Result<(CanonicalForm, Scores<'w>), LocateError> {
    let form = canonical_form(mask, camera, library, &mut work)?;
    let spec = &library.info().canonical;
    let [straight, rotated] = both_directions(spec, work.canonical, work.rotated)?;
    let (prepared, _) = split_bytes(work.bytes, spec)?;
    let query = Query::new(spec, straight, rotated, prepared)?;
    let scores = Scores::fill(library, work.scores, |view, reversed| {
        query.unmatched(library, view, reversed, &work.kernels)
    })?;
    Ok((form, scores))
}

/// A canonical mask as it is and rotated by 180 degrees.
fn both_directions<'w>(
    spec: &CanonicalSpec,
    straight: &'w mut [Word],
    rotated: &'w mut [Word],
) -> Result<[&'w [Word]; 2], LocateError> {
    let (straight, rotated) = (words_of(spec, straight)?, words_of(spec, rotated)?);
    reverse(straight, rotated);
    Ok([straight, rotated])
}

fn words_of<'w>(spec: &CanonicalSpec, words: &'w mut [Word]) -> Result<&'w mut [Word], MatchError> {
    Ok(first(
        "words of canonical mask",
        spec.words_needed(),
        words,
    )?)
}

/// The query's bytes and the sketches'.
fn split_bytes<'a>(
    bytes: &'a mut [u8],
    spec: &CanonicalSpec,
) -> Result<(&'a mut [u8], &'a mut [u8]), MatchError> {
    let bytes = first("bytes", workspace_bytes_needed(spec), bytes)?;
    Ok(bytes
        .split_at_mut_checked(query_bytes_needed(spec))
        .unwrap_or_default())
}
