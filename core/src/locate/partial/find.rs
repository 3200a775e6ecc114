//! From a silhouette of which a part is known to poses.

use heapless::Vec;

use super::error::PartialError;
use super::fit::Known;
use super::follow::follow;
use super::memory::{KNOWN_POINTS, PartialMemory, partial_needed};
use super::outline::{OutlinePoint, OutlinePoints, Sampling};
use super::scale_levels::{LEVEL_NUMBERS, ScaleLevels};
use super::search::PartialSearch;
use super::smooth::Plane;
use super::trace::{PixelSide, trace};
use super::units::{KNOWN_SPACING, LEAST_PIECE, REACH, Units};
use super::view::ViewMemory;
use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::library::Library;
use crate::locate::rerank::{Reranked, rerank};
use crate::locate::whole::Located;
use crate::mesh::Model;
use crate::render::RenderError;

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
    model: &Model<'_>,
    memory: PartialMemory<'_>,
) -> Result<Vec<Reranked, K>, PartialError> {
    let mask = silhouette.mask();
    let (width, height) = (camera.width(), camera.height());
    if (mask.width(), mask.height()) != (width, height) {
        return Err(RenderError::Size.into());
    }
    let needs = partial_needed(library, camera, model);
    memory.check(&needs)?;
    let words = memory.words.get_mut(..needs.words).unwrap_or_default();
    let frame = words_needed(width, height);
    let (frame, canonical) = words.split_at_mut_checked(frame).unwrap_or_default();
    let (bits, visited) = canonical
        .split_at_mut_checked(canonical.len() / 2)
        .unwrap_or_default();
    let (own, others) = memory
        .points
        .split_at_mut_checked(KNOWN_POINTS)
        .unwrap_or_default();
    let (levels, numbers) = memory
        .numbers
        .split_at_mut_checked(LEVEL_NUMBERS)
        .unwrap_or_default();
    let mut drawn = MaskMut::new(frame, width, height)?;
    let units = Units::new(library, camera);
    let plane = Plane::new(width, height, camera.aspect());
    let outline = known_outline(silhouette, &units, plane, &mut drawn, memory.sides, own)?;
    let search = PartialSearch {
        levels: ScaleLevels::new(&outline, units.spacing, units.scales(library), levels),
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
    Ok(rerank(
        &poses, model, camera, silhouette, projected, &mut drawn,
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
    sides: &mut [PixelSide],
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
