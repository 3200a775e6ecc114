//! The region under the cursor at a grey level, as an outline.
//!
//! No pixel is flooded: only the outer border is followed, from the cursor on, so that holes count as filled and specks
//! elsewhere cost nothing. The points lie where the grey value, linear between the pixels' centres, passes the level
//! (marching squares; Lorensen and Cline, *Computer Graphics* 21, 1987).

mod cut;
mod region;
mod suggest;

pub use suggest::suggested_level;

use cut::Cut;
use region::Region;

use crate::error::{TracingError, check_setting};
use crate::list::List;
use crate::side::Inside;
use crate::simplify::{Simplify, simplify};
use crate::smoothed::Smoothed;
use crate::vertex::{ShapeError, Vertex};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Word, words_needed};
use fluoropose::memory::check_length;

/// Which region is searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Which side of the level belongs to the region. The level itself belongs to it.
    pub inside: Inside,
    /// Grey value of the frame.
    pub level: f64,
    /// What is connected only by bridges thinner than `2 * bridge + 1` pixels is cut off: 0, which cuts nothing, to
    /// [`MOST_BRIDGE`].
    pub bridge: usize,
    /// The outline is simplified by at most this distance, pixels.
    pub tolerance: f64,
}

/// The greatest [`Threshold::bridge`].
pub const MOST_BRIDGE: usize = 16;
/// Regions of a smaller area are specks, square pixels.
const LEAST_AREA: f64 = 16.0;

/// Working memory of [`region_at`]: each slice at least as long as [`threshold_needed`] says.
#[derive(Debug)]
pub struct ThresholdMemory<'a> {
    /// Three masks of the frame's size.
    pub words: &'a mut [Word],
    /// Points along the border before it is simplified.
    pub line: &'a mut [Vertex],
    /// One mark for each of those points.
    pub marks: &'a mut [bool],
}

/// Lengths of the slices of a [`ThresholdMemory`] for a frame of `width` x `height` pixels: the number of words, then the
/// number of points and of marks. The number of points is that of a region worth tracing, with reserve; the border of
/// noise may be longer, which is the error [`TracingError::TooLong`].
#[must_use]
pub fn threshold_needed(width: usize, height: usize) -> (usize, usize) {
    (3 * words_needed(width, height), 16 * (width + height))
}

/// Writes the outline of the region under `cursor`, or within 3 pixels of it, to `out`, clockwise on the screen. Returns
/// how far simplifying moved it; `None`, with `out` empty, where there is no region or only a speck.
///
/// # Errors
/// [`TracingError::Setting`] about the bridge or the tolerance, [`TracingError::Memory`], and [`TracingError::TooLong`]
/// where the border has more points than there is memory for.
pub fn region_at(
    frame: &Smoothed<'_>,
    cursor: Point,
    threshold: &Threshold,
    memory: ThresholdMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<Option<ShapeError>, TracingError> {
    out.clear();
    check_setting(
        "the bridge",
        threshold.bridge as f64,
        0.0,
        MOST_BRIDGE as f64,
    )?;
    let size = words_needed(frame.width(), frame.height());
    check_length("words", 3 * size, memory.words.len())?;
    let cut = Cut::new(frame, threshold.inside, threshold.level);
    let (bits, rest) = memory.words.split_at_mut(size);
    let (a, b) = rest.split_at_mut(size);
    let masks = [bits, a, b.get_mut(..size).unwrap_or_default()];
    let Some(region) = Region::at(&cut, cursor, threshold.bridge, masks)? else {
        return Ok(None);
    };
    let mut line = List::new(memory.line);
    let area = cut.follow(&region.mask, region.start, &mut line)?;
    if area < LEAST_AREA {
        return Ok(None);
    }
    let settings = Simplify {
        closed: true,
        tolerance: threshold.tolerance,
        balanced: true,
    };
    simplify(line.as_slice(), &settings, |_| false, memory.marks, out).map(Some)
}

#[cfg(test)]
mod tests;
