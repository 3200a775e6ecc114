//! The region under the cursor at a grey level, as an outline.
//!
//! No pixel is flooded: the outer border is followed from the cursor, so holes are filled by not looking at them, and
//! specks elsewhere are never seen. Points lie where the grey value, linear between the pixels' centres, passes the
//! level (marching squares; Lorensen and Cline, *Computer Graphics* 21, 1987).

mod region;
mod suggest;

pub use suggest::suggested_level;

use super::list::List;
use super::simplify::{Simplify, simplify};
use super::smoothed::Smoothed;
use super::{AidError, ShapeError, Vertex, check_length, check_setting};
use fluoropose::image::border::Crack;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};

/// Which side of the level the implant is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inside {
    /// The implant is darker than what surrounds it.
    Dark,
    /// The implant is brighter: an inverted film.
    Bright,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Which side of the level belongs to the region. The level itself does.
    pub inside: Inside,
    /// Grey value of the film.
    pub level: f64,
    /// What hangs on by bridges thinner than `2 * bridge + 1` pixels is cut off; 0 cuts nothing.
    pub bridge: usize,
    /// The outline is simplified by at most so many pixels.
    pub tolerance: f64,
}

/// The greatest [`Threshold::bridge`].
pub const MOST_BRIDGE: usize = 16;
/// How far from the cursor the region may begin, pixels.
const NEAR: usize = 3;
/// Regions of fewer pixels are specks.
const LEAST_AREA: f64 = 16.0;
/// After bridges were cut, corners that were lost with them are given back so far.
const CORNERS: usize = 2;

/// Working memory of [`region_at`]: each slice at least as long as [`threshold_needed`] says.
#[derive(Debug)]
pub struct ThresholdMemory<'a> {
    /// Three masks of the frame's size.
    pub words: &'a mut [Word],
    /// Points along the border before it is simplified.
    pub line: &'a mut [Vertex],
    /// One for each of those.
    pub marks: &'a mut [bool],
}

/// Lengths of a [`ThresholdMemory`]'s slices: words, and points along the border as many as regions worth tracing
/// have. More fills the list and is an error.
#[must_use]
pub fn threshold_needed(width: usize, height: usize) -> (usize, usize) {
    (3 * words_needed(width, height), 16 * (width + height))
}

/// Writes the outline of the region at or near `cursor` to `out`, clockwise on the screen, and gives the distance that
/// simplifying moved it. `None`, and an empty list, where there is no region or only a speck.
///
/// # Errors
/// [`AidError`] about the settings or the memory.
pub fn region_at(
    film: &Smoothed<'_>,
    cursor: Point,
    threshold: &Threshold,
    memory: ThresholdMemory<'_>,
    out: &mut List<'_, Vertex>,
) -> Result<Option<ShapeError>, AidError> {
    out.clear();
    check_setting(
        "the bridge",
        threshold.bridge as f64,
        0.0,
        MOST_BRIDGE as f64,
    )?;
    let size = words_needed(film.width(), film.height());
    check_length("words", 3 * size, memory.words.len())?;
    let cut = Cut::new(film, threshold.inside, threshold.level);
    let (bits, rest) = memory.words.split_at_mut(size);
    let (a, b) = rest.split_at_mut(size);
    let masks = [bits, a, b.get_mut(..size).unwrap_or_default()];
    let Some(region) = region::Region::at(&cut, cursor, threshold.bridge, masks)? else {
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

/// A film cut at a level.
struct Cut<'a> {
    film: &'a Smoothed<'a>,
    inside: Inside,
    /// In the film's smoothed values.
    level: f64,
}

impl<'a> Cut<'a> {
    fn new(film: &'a Smoothed<'a>, inside: Inside, level: f64) -> Self {
        Self {
            film,
            inside,
            level: level * film.scale().per_grey(),
        }
    }

    fn holds(&self, value: u16) -> bool {
        match self.inside {
            Inside::Dark => f64::from(value) <= self.level,
            Inside::Bright => f64::from(value) >= self.level,
        }
    }

    /// Sets the pixels that belong to the region's side.
    fn fill(&self, mask: &mut MaskMut<'_>) {
        mask.clear();
        // Whole numbers on both sides: the loop below is that of the slider.
        let (low, high) = match self.inside {
            Inside::Dark if self.level < 0.0 => return,
            Inside::Dark => (0, whole(fluoropose::math::floor(self.level))),
            Inside::Bright if self.level > f64::from(u16::MAX) => return,
            Inside::Bright => (whole(libm::ceil(self.level)), u16::MAX),
        };
        for row in 0..mask.height() {
            let mut cells = self.film.row(row).chunks(Word::BITS as usize);
            mask.replace_row(row, |_, _| {
                let bits = cells.next().unwrap_or_default().iter().enumerate();
                bits.fold(0, |word, (bit, &cell)| {
                    word | Word::from(low <= cell && cell <= high) << bit
                })
            });
        }
    }

    /// Writes one point for each side of a pixel along the border that begins at `start`; gives the enclosed area in
    /// square pixels.
    fn follow(
        &self,
        mask: &Mask<'_>,
        start: Crack,
        line: &mut List<'_, Vertex>,
    ) -> Result<f64, AidError> {
        let mut at = start;
        let mut twice_area = 0;
        loop {
            line.push(Vertex::new(self.crossing(at)))?;
            let next = at.step();
            twice_area += at.column * next.row - at.row * next.column;
            at = next.turn(mask);
            if at == start {
                return Ok(twice_area as f64 / 2.0);
            }
        }
    }

    /// Where the level is passed between the pixels on both hands; the middle between them where it is not passed, or
    /// one of them lies beyond the frame.
    fn crossing(&self, at: Crack) -> Point {
        let next = at.step();
        let middle = [at.column + next.column, at.row + next.row].map(|sum| sum as f64 / 2.0);
        let share = self.share(at).unwrap_or(0.5) - 0.5;
        // From the right hand to the left.
        let (right, down) = (next.column - at.column, next.row - at.row);
        let (right, down) = (down as f64, -right as f64);
        Point::new(middle[0] + share * right, middle[1] + share * down)
    }

    /// The share of the way from the pixel on the right hand to that on the left at which the level is passed.
    fn share(&self, at: Crack) -> Option<f64> {
        let value = |left_hand| {
            let (column, row) = at.pixel_ahead(left_hand)?;
            let cell = self.film.row(row).get(column)?;
            Some(f64::from(*cell))
        };
        let (inner, outer) = (value(false)?, value(true)?);
        let share = (self.level - inner) / (outer - inner);
        // Strictly between, so that no two points of the border fall together. Also refuses NaN.
        let passed = (0.0..=1.0).contains(&share);
        passed.then(|| share.clamp(1e-3, 1.0 - 1e-3))
    }
}

fn whole(value: f64) -> u16 {
    value.clamp(0.0, f64::from(u16::MAX)) as u16
}

#[cfg(test)]
mod tests;
