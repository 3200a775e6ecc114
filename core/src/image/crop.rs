//! The part of a frame that holds all of a silhouette: what needs memory for each pixel then needs it for these alone.

use core::ops::Range;

use super::contour::{Outline, Point};
use super::mask::{MAX_SIDE, Mask, MaskError, MaskMut, Word, words_needed};

/// A rectangle of a frame, wherever it lies.
///
/// A camera cropped to it ([`crate::Camera::cropped`]) sees what the whole frame's sees there, so poses are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    frame: [usize; 2],
}

impl Crop {
    /// Pixels around a silhouette that refinement needs: what it draws on its way is off the silhouette by less, or leads
    /// nowhere.
    pub const MARGIN: usize = 24;

    /// All of a frame of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`MaskError::Shape`] where no mask can be so large.
    pub fn whole(width: usize, height: usize) -> Result<Self, MaskError> {
        Self::around(0..width, 0..height, 0, [width, height])
    }

    /// Some columns and rows of a frame and `margin` pixels around them, as far as the frame goes; `frame` is its width and
    /// height, pixels.
    ///
    /// # Errors
    /// [`MaskError::Shape`] for an impossible frame, [`MaskError::Empty`] where no column or no row of it is left.
    pub fn around(
        columns: Range<usize>,
        rows: Range<usize>,
        margin: usize,
        frame: [usize; 2],
    ) -> Result<Self, MaskError> {
        let [width, height] = frame;
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            return Err(MaskError::Shape { width, height });
        }
        let cut = |range: Range<usize>, side: usize| {
            let end = range.end.saturating_add(margin).min(side);
            range.start.saturating_sub(margin)..end
        };
        let (inside, across) = (cut(columns.clone(), width), cut(rows.clone(), height));
        if columns.is_empty() || rows.is_empty() || inside.is_empty() || across.is_empty() {
            return Err(MaskError::Empty);
        }
        Ok(Self {
            left: inside.start,
            top: across.start,
            width: inside.len(),
            height: across.len(),
            frame,
        })
    }

    /// Around an outline, of a frame of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`MaskError::Shape`] for an impossible frame.
    pub fn around_outline(
        outline: &Outline<'_>,
        margin: usize,
        frame: [usize; 2],
    ) -> Result<Self, MaskError> {
        // Points lie inside of a frame, and cutting off rounds down.
        let pixels = |of: fn(&Point) -> f64| {
            let (mut low, mut high) = (u32::MAX, 0);
            for point in outline.points() {
                let pixel = of(point) as u32;
                (low, high) = (low.min(pixel), high.max(pixel));
            }
            low as usize..high as usize + 1
        };
        let columns = pixels(|point| point.column);
        Self::around(columns, pixels(|point| point.row), margin, frame)
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Columns of the frame that it has.
    #[must_use]
    pub fn columns(&self) -> Range<usize> {
        self.left..self.left + self.width
    }

    /// Rows of the frame that it has.
    #[must_use]
    pub fn rows(&self) -> Range<usize> {
        self.top..self.top + self.height
    }

    /// Width and height of the frame, pixels.
    #[must_use]
    pub fn frame(&self) -> [usize; 2] {
        self.frame
    }

    /// Words of a mask of its size.
    #[must_use]
    pub fn words_needed(&self) -> usize {
        words_needed(self.width, self.height)
    }

    /// How many pixels of the frame lie beyond its left, upper, right and lower side.
    #[must_use]
    pub(crate) fn beyond(&self) -> [usize; 4] {
        let [width, height] = self.frame;
        let right = width - self.columns().end;
        [self.left, self.top, right, height - self.rows().end]
    }

    /// An empty mask of its size over borrowed words.
    ///
    /// # Errors
    /// [`MaskError::Memory`] for fewer than [`Self::words_needed`].
    pub fn mask<'w>(&self, words: &'w mut [Word]) -> Result<MaskMut<'w>, MaskError> {
        MaskMut::new(words, self.width, self.height)
    }

    /// The pixels inside `outline`: those that [`MaskMut::fill_outline`] sets in the whole frame.
    ///
    /// # Errors
    /// [`MaskError::Memory`] for fewer than [`Self::words_needed`].
    pub fn fill_outline<'w>(
        &self,
        outline: &Outline<'_>,
        words: &'w mut [Word],
    ) -> Result<Mask<'w>, MaskError> {
        let mut mask = self.mask(words)?;
        mask.fill_outline_from(outline, [self.left, self.top]);
        Ok(mask.into_mask())
    }

    /// Whether pixels of a mask of its size come nearer than `least` pixels to a side beyond which the frame goes on.
    pub(crate) fn is_near_side(&self, mask: &Mask<'_>, least: usize) -> bool {
        let (columns, rows) = mask.bounds();
        if rows.is_empty() {
            return false;
        }
        let room = [
            columns.start,
            rows.start,
            self.width.saturating_sub(columns.end),
            self.height.saturating_sub(rows.end),
        ];
        let sides = room.into_iter().zip(self.beyond());
        sides
            .into_iter()
            .any(|(room, beyond)| beyond > 0 && room < least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec;

    const FRAME: [usize; 2] = [150, 110];

    properties! {
        #[test]
        fn an_outline_fills_what_it_fills_in_the_whole_frame(
            corners in proptest::collection::vec((0.0..150.0f64, 0.0..110.0f64), 3..9),
            whole in proptest::bool::weighted(0.2),
            margin in 0..40usize,
        ) {
            let snapped = |x: f64| if whole { libm::floor(x) } else { x };
            let points: vec::Vec<Point> = corners
                .iter()
                .map(|&(column, row)| Point::new(snapped(column), snapped(row)))
                .collect();
            let Ok(outline) = Outline::new(&points, FRAME[0], FRAME[1]) else { return Ok(()) };
            let mut words = vec![0; words_needed(FRAME[0], FRAME[1])];
            let mut full = MaskMut::new(&mut words, FRAME[0], FRAME[1]).expect("fits");
            full.fill_outline(&outline);
            let full = full.into_mask();
            let Ok(crop) = Crop::around_outline(&outline, margin, FRAME) else { return Ok(()) };
            // What the memory held before does not matter.
            let mut words = vec![Word::MAX; crop.words_needed()];
            let mask = crop.fill_outline(&outline, &mut words).expect("fits");
            prop_assert_eq!(mask.area(), full.area());
            for (row, column) in crop.rows().flat_map(|row| crop.columns().map(move |c| (row, c))) {
                let own = mask.get(column - crop.columns().start, row - crop.rows().start);
                prop_assert_eq!(own, full.get(column, row));
            }
            let moments = mask.moments().moved(crop.columns().start, crop.rows().start);
            prop_assert_eq!(moments, full.moments());
        }
    }

    #[test]
    fn it_ends_where_the_frame_ends() {
        let crop = Crop::around(3..20, 90..110, 8, FRAME).expect("inside");
        assert_eq!((crop.columns(), crop.rows()), (0..28, 82..110));
        assert_eq!(crop.beyond(), [0, 82, 122, 0]);
        assert_eq!(Crop::around(3..3, 0..9, 8, FRAME), Err(MaskError::Empty));
        assert_eq!(
            Crop::around(400..410, 0..9, 8, FRAME),
            Err(MaskError::Empty)
        );
        let whole = Crop::whole(FRAME[0], FRAME[1]).expect("a frame");
        assert_eq!((whole.beyond(), whole.frame()), ([0; 4], FRAME));
        assert!(Crop::whole(0, 3).is_err() && Crop::whole(3, usize::MAX).is_err());
    }

    #[test]
    fn only_sides_inside_the_frame_count() {
        let crop = Crop::around(3..20, 60..90, 8, FRAME).expect("inside");
        let mut words = vec![0; crop.words_needed()];
        let mut near = |column: usize, row: usize| {
            let mut mask = crop.mask(&mut words).expect("fits");
            mask.set(column, row, true);
            crop.is_near_side(&mask.as_mask(), 3)
        };
        // The left side is the frame's.
        assert!(!near(0, 20) && !near(24, 20) && near(25, 20));
        assert!(near(9, 2) && !near(9, 3));
    }
}
