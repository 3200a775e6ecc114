//! The outline of a library's view as samples at equal distances.

use super::outline::{OutlinePoint, OutlinePoints, Sampling};
use super::smooth::Plane;
use super::trace::{PixelSide, trace};
use super::units::Units;
use crate::image::mask::{Mask, MaskMut, Word};
use crate::image::silhouette::Silhouette;
use crate::library::Library;

/// Borders of views shorter than this, in samples, are left out.
const LEAST: f64 = 8.0;

/// Working memory for views.
pub(super) struct ViewMemory<'a> {
    /// Words of a canonical mask.
    pub(super) bits: &'a mut [Word],
    /// The same number of words.
    pub(super) visited: &'a mut [Word],
    pub(super) sides: &'a mut [PixelSide],
    pub(super) points: &'a mut [OutlinePoint],
}

/// The outline of view number `view`: points in canonical pixels, to the right and upwards from
/// the canonical frame's middle, `units.spacing` apart. What that frame cuts is unknown.
/// `None` where memory is too short.
pub(super) fn view_outline<'m>(
    library: &Library<'_>,
    view: usize,
    units: &Units,
    memory: &'m mut ViewMemory<'_>,
) -> Option<OutlinePoints<'m>> {
    let size = library.info().canonical.size();
    library.draw(view, memory.bits);
    let mask = Mask::new(memory.bits, size, size).ok()?;
    let mut visited = MaskMut::new(memory.visited, size, size).ok()?;
    let least = (LEAST * units.spacing) as usize;
    let silhouette = Silhouette::from(&mask);
    let stretches = trace(&silhouette, &mut visited, memory.sides, least)?;
    let sampling = Sampling {
        plane: Plane::new(size, size, 1.0),
        reach: units.view_reach,
        spacing: units.spacing,
    };
    OutlinePoints::new(memory.sides, &stretches, &sampling, memory.points)
}
