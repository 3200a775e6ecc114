//! First poses from a part of an outline, without a start.
//!
//! Area, centroid and principal axis are what an occluder or the frame's border breaks, so none of
//! them is used. What is left are stretches of outline:
//!
//! 1. The borders of the mask are followed; sides next to an unknown pixel or at the frame's
//!    border are left out. What remains is smoothed and resampled at equal distances, whole
//!    stretches and parts of them (windows), at the scales that the object's distance allows.
//! 2. The outline of every fourth degree's view is followed likewise. Each window is slid along it
//!    by arc length; at each place the best similarity has a closed form (least squares with
//!    complex numbers). As in Wolfson, *On curve matching* (IEEE Trans. PAMI 12, 1990), a window
//!    only proposes.
//! 3. A proposal is judged by all that is known: the view's outline, laid on the frame, should
//!    meet the known outline wherever pixels are known, and cover all of it. The best of each view are
//!    brought nearer by a robust fit to the nearest points (four parameters), judged again, and
//!    the best of all views that differ in rotation are followed on the full grid.
//! 4. The similarity stands for the canonical form that the whole silhouette would have had, so the pose
//!    comes from it by the same equations as any other ([`crate::locate::estimate`]), and the poses are
//!    put in order by drawing the model and counting known pixels ([`crate::locate::rerank`]).

mod field;
mod fit;
mod follow;
mod hypothesis;
mod ladder;
mod memory;
mod outline;
mod search;
mod share;
mod similarity;
mod slide;
mod smooth;
mod trace;
mod units;
mod view;

pub use hypothesis::Hypothesis;
pub use memory::{PartialMemory, PartialNeeds, partial_needed};
pub use outline::OutlinePoint;
pub use share::{KnownShare, known_share};
pub use trace::Side;

use heapless::Vec;
use thiserror::Error;

use crate::camera::Camera;
use crate::image::mask::{MaskError, MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::library::Library;
use crate::locate::rerank::{Verified, verify};
use crate::locate::whole::Located;
use crate::mesh::Mesh;
use crate::render::RenderError;
use fit::Known;
use follow::follow;
use ladder::{LADDER_NUMBERS, Ladder};
use memory::KNOWN_POINTS;
use outline::{OutlinePoints, Sampling};
use search::Search;
use smooth::Plane;
use trace::trace;
use units::{KNOWN_SPACING, LEAST_PIECE, REACH, Units};
use view::ViewMemory;

/// Why no pose was found from a part of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PartialError {
    /// No side of the mask has two known pixels, in pieces long enough to use.
    #[error(
        "nothing of the outline is known: all of it lies in unknown pixels, beyond the frame's border, or in pieces shorter than {least} pixel sides"
    )]
    NothingKnown {
        /// Sides of the shortest piece that is used.
        least: usize,
    },
    /// Too little is known.
    #[error(
        "{known:.0} pixels of the outline are known, but a first pose needs {needed:.0}; trace more of it"
    )]
    TooShort {
        /// Length known, pixel widths.
        known: f64,
        /// Length needed, pixel widths.
        needed: f64,
    },
    /// The outline is no implant's.
    #[error(
        "the mask's outline has more than {0} pixel sides; drop the specks and fill the holes of the mask"
    )]
    TooRough(usize),
    /// No view of the library is like the known part.
    #[error(
        "no view of the library fits the known part of the outline; is it the right model, side and nominal view?"
    )]
    NoFit,
    /// Lent memory is too short.
    #[error("a first pose from a part of an outline needs {needed} {what} but {given} were lent")]
    Memory {
        /// Which memory.
        what: &'static str,
        /// Length needed.
        needed: usize,
        /// Length lent.
        given: usize,
    },
    /// A mask is not possible.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The model cannot be drawn, or mask and camera differ in size.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// Finds poses of the library's model that explain what is known of `silhouette`: at most `K`,
/// fewest differing known pixels first. The object's distance is taken to be 0.75 to 1.35 times
/// the library's, its rotation within the library's views.
///
/// Poses are as good as the nearest view, a degree or so: starts for
/// [`crate::finder::rivals::refine_rivals`].
///
/// # Errors
/// [`PartialError`].
pub fn locate_partial<const K: usize>(
    silhouette: &Silhouette<'_>,
    camera: &Camera,
    library: &Library<'_>,
    mesh: &Mesh<'_>,
    memory: PartialMemory<'_>,
) -> Result<Vec<Verified, K>, PartialError> {
    let mask = silhouette.mask();
    let (width, height) = (camera.width(), camera.height());
    if (mask.width(), mask.height()) != (width, height) {
        return Err(RenderError::Size.into());
    }
    let needs = partial_needed(library, camera, mesh);
    memory.check(&needs)?;
    let words = &mut memory.words[..needs.words];
    let (frame, canonical) = words.split_at_mut(words_needed(width, height));
    let (bits, visited) = canonical.split_at_mut(canonical.len() / 2);
    let (own, others) = memory.points.split_at_mut(KNOWN_POINTS);
    let (ladder, numbers) = memory.numbers.split_at_mut(LADDER_NUMBERS);
    let mut drawn = MaskMut::new(frame, width, height)?;
    let units = Units::new(library, camera);
    let plane = Plane::new(width, height, camera.aspect());
    let outline = known_outline(silhouette, &units, plane, &mut drawn, memory.sides, own)?;
    let search = Search {
        ladder: Ladder::new(&outline, units.spacing, units.scales(library), ladder),
        known: Known::new(silhouette, plane, outline, &units, memory.cells),
        library,
        units,
    };
    let mut views = ViewMemory {
        bits,
        visited,
        sides: memory.sides,
        points: others,
    };
    let found = search.coarse(&mut views, numbers, memory.hypotheses);
    let poses: Vec<Located, K> = follow(&search, camera, found, &mut views);
    if poses.is_empty() {
        return Err(PartialError::NoFit);
    }
    let projected = memory.projected;
    Ok(verify(
        &poses, mesh, camera, silhouette, projected, &mut drawn,
    )?)
}

/// Least length of outline that a pose is found from, in canonical pixels: a third of the shortest
/// outline of any implant, which is that of a disc.
const LEAST_KNOWN: f64 = 145.0;

/// The known part of the outline.
fn known_outline<'p>(
    silhouette: &Silhouette<'_>,
    units: &Units,
    plane: Plane,
    visited: &mut MaskMut<'_>,
    sides: &mut [Side],
    points: &'p mut [OutlinePoint],
) -> Result<OutlinePoints<'p>, PartialError> {
    let least = ((LEAST_PIECE * units.pixel) as usize).max(4);
    let rough = PartialError::TooRough(sides.len());
    let stretches = trace(silhouette, visited, sides, least).ok_or(rough)?;
    let sampling = Sampling {
        plane,
        reach: ((REACH * units.pixel + 0.5) as usize).max(1),
        spacing: KNOWN_SPACING * units.pixel,
    };
    let outline = OutlinePoints::new(sides, &stretches, &sampling, points).ok_or(rough)?;
    let needed = LEAST_KNOWN * units.pixel;
    match outline.length {
        0.0 => Err(PartialError::NothingKnown { least }),
        known if known < needed => Err(PartialError::TooShort { known, needed }),
        _ => Ok(outline),
    }
}

#[cfg(test)]
mod tests;
