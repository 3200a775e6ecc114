//! A frame cut at a grey level, and the place between two pixels where the level is passed.

use crate::error::TracingError;
use crate::list::List;
use crate::side::Inside;
use crate::smoothed::Smoothed;
use crate::vertex::Vertex;
use fluoropose::image::border::Crack;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Mask, MaskMut, Word};
use fluoropose::math::floor;

/// A frame cut at a level.
pub(super) struct Cut<'a> {
    pub(super) frame: &'a Smoothed<'a>,
    inside: Inside,
    /// In smoothed values.
    level: f64,
}

impl<'a> Cut<'a> {
    pub(super) fn new(frame: &'a Smoothed<'a>, inside: Inside, level: f64) -> Self {
        Self {
            frame,
            inside,
            level: level * frame.scale().per_grey(),
        }
    }

    pub(super) fn holds(&self, value: u16) -> bool {
        match self.inside {
            Inside::Dark => f64::from(value) <= self.level,
            Inside::Bright => f64::from(value) >= self.level,
        }
    }

    /// Sets the pixels on the implant's side of the level.
    pub(super) fn fill(&self, mask: &mut MaskMut<'_>) {
        mask.clear();
        // Integers on both sides: the loop below runs for every move of the slider.
        let (low, high) = match self.inside {
            Inside::Dark if self.level < 0.0 => return,
            Inside::Dark => (0, whole(floor(self.level))),
            Inside::Bright if self.level > f64::from(u16::MAX) => return,
            Inside::Bright => (whole(libm::ceil(self.level)), u16::MAX),
        };
        for row in 0..mask.height() {
            let mut cells = self.frame.row(row).chunks(Word::BITS as usize);
            mask.replace_row(row, |_, _| {
                let bits = cells.next().unwrap_or_default().iter().enumerate();
                bits.fold(0, |word, (bit, &cell)| {
                    word | Word::from(low <= cell && cell <= high) << bit
                })
            });
        }
    }

    /// Writes one point for each side of a pixel along the border that begins at `start`, and returns the enclosed area,
    /// square pixels.
    pub(super) fn follow(
        &self,
        mask: &Mask<'_>,
        start: Crack,
        line: &mut List<'_, Vertex>,
    ) -> Result<f64, TracingError> {
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
    /// where one of them lies beyond the frame.
    fn crossing(&self, at: Crack) -> Point {
        let next = at.step();
        let middle = [at.column + next.column, at.row + next.row].map(|sum| sum as f64 / 2.0);
        let fraction = self.fraction(at).unwrap_or(0.5) - 0.5;
        // From the right hand to the left.
        let (right, down) = (next.column - at.column, next.row - at.row);
        let (right, down) = (down as f64, -right as f64);
        Point::new(middle[0] + fraction * right, middle[1] + fraction * down)
    }

    /// The fraction of the way from the pixel on the right hand to that on the left at which the level is passed.
    fn fraction(&self, at: Crack) -> Option<f64> {
        let value = |left_hand| {
            let (column, row) = at.pixel_ahead(left_hand)?;
            let cell = self.frame.row(row).get(column)?;
            Some(f64::from(*cell))
        };
        let (inner, outer) = (value(false)?, value(true)?);
        let fraction = (self.level - inner) / (outer - inner);
        // Strictly between the two, so that no points of the border coincide. A NaN is refused too.
        let passed = (0.0..=1.0).contains(&fraction);
        passed.then(|| fraction.clamp(1e-3, 1.0 - 1e-3))
    }
}

fn whole(value: f64) -> u16 {
    value.clamp(0.0, f64::from(u16::MAX)) as u16
}
