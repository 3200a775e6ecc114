//! Silhouettes as runs of pixels, row after row, as a detector reads them out: no memory for the pixels of a frame.

use core::ops::Range;

use thiserror::Error;

use super::crop::Crop;
use super::mask::{MAX_SIDE, Mask, MaskError, Word, runs_of};
use super::moments::Moments;
use crate::memory::TooLittleMemory;

/// Why a row does not belong to a silhouette.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunsError {
    /// No mask can be so large.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// Rows and runs come from the top to the bottom and from the left to the right.
    #[error("row {0} of the silhouette comes too late: rows rise, and so do the runs of each")]
    Order(usize),
    /// A run ends beyond the frame.
    #[error("row {0} of the silhouette reaches beyond the frame")]
    Beyond(usize),
    /// There are more runs than room.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
}

/// Neighbouring pixels of one row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelRun {
    row: u16,
    start: u16,
    end: u16,
}

impl PixelRun {
    /// What static memory is filled with.
    pub const EMPTY: Self = Self {
        row: 0,
        start: 0,
        end: 0,
    };

    /// The row.
    #[must_use]
    pub fn row(&self) -> usize {
        usize::from(self.row)
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> Range<usize> {
        usize::from(self.start)..usize::from(self.end)
    }
}

/// Takes the rows of a silhouette as they come, and sums its moments.
#[derive(Debug)]
pub struct RunBuilder<'m> {
    memory: &'m mut [PixelRun],
    count: usize,
    moments: Moments,
    /// The first column, and the one after the last.
    columns: [usize; 2],
    frame: [usize; 2],
}

impl<'m> RunBuilder<'m> {
    /// No row yet of a frame of `width` x `height` pixels. `memory` has room for one run for each row of the silhouette, and
    /// one for each gap in a row.
    ///
    /// # Errors
    /// [`RunsError::Mask`] for an impossible frame.
    pub fn new(memory: &'m mut [PixelRun], width: usize, height: usize) -> Result<Self, RunsError> {
        Crop::whole(width, height)?;
        Ok(Self {
            memory,
            count: 0,
            moments: Moments::default(),
            columns: [MAX_SIDE, 0],
            frame: [width, height],
        })
    }

    /// Adds a run below, or to the right of, all that were added before it and not touching them. An empty one is nothing.
    ///
    /// # Errors
    /// [`RunsError`]; nothing was added then.
    pub fn add_run(&mut self, row: usize, columns: Range<usize>) -> Result<(), RunsError> {
        let [width, height] = self.frame;
        if columns.is_empty() {
            return Ok(());
        }
        if row >= height || columns.end > width {
            return Err(RunsError::Beyond(row));
        }
        let last = self.count.checked_sub(1);
        let is_later = |last: &PixelRun| (last.row(), last.columns().end) < (row, columns.start);
        if !last
            .and_then(|last| self.memory.get(last))
            .is_none_or(is_later)
        {
            return Err(RunsError::Order(row));
        }
        let given = self.memory.len();
        *self.memory.get_mut(self.count).ok_or(TooLittleMemory {
            what: "runs of pixels",
            needed: self.count + 1,
            given,
        })? = PixelRun {
            row: row as u16,
            start: columns.start as u16,
            end: columns.end as u16,
        };
        self.count += 1;
        self.moments.add_run(row, &columns);
        let [first, end] = self.columns;
        self.columns = [first.min(columns.start), end.max(columns.end)];
        Ok(())
    }

    /// Adds a row, pixel by pixel from the left; `true` is the silhouette: a detector's values against a threshold.
    ///
    /// # Errors
    /// [`RunsError`]; the runs before the one at fault were added.
    pub fn add_row(
        &mut self,
        row: usize,
        pixels: impl IntoIterator<Item = bool>,
    ) -> Result<(), RunsError> {
        let (mut start, mut end) = (None, 0);
        for inside in pixels {
            match (start, inside) {
                (None, true) => start = Some(end),
                (Some(from), false) => {
                    self.add_run(row, from..end)?;
                    start = None;
                }
                _ => {}
            }
            end += 1;
        }
        start.map_or(Ok(()), |from| self.add_run(row, from..end))
    }

    /// Adds a row of bits, the lowest leftmost.
    ///
    /// # Errors
    /// [`RunsError`]; the runs before the one at fault were added.
    pub fn add_words(&mut self, row: usize, words: &[Word]) -> Result<(), RunsError> {
        runs_of(words, 0).try_for_each(|columns| self.add_run(row, columns))
    }

    /// All rows that were added.
    #[must_use]
    pub fn finish(self) -> Runs<'m> {
        let runs = self.memory.get(..self.count).unwrap_or_default();
        Runs {
            runs,
            moments: self.moments,
            columns: self.columns,
            frame: self.frame,
        }
    }

    /// The rows that were added so far.
    #[must_use]
    pub fn runs(&self) -> Runs<'_> {
        Runs {
            runs: self.memory.get(..self.count).unwrap_or_default(),
            moments: self.moments,
            columns: self.columns,
            frame: self.frame,
        }
    }

    /// Begins with another silhouette of a frame of `width` x `height` pixels in the same memory.
    ///
    /// # Errors
    /// [`RunsError::Mask`] for an impossible frame; what was added stays then.
    pub fn restart(&mut self, width: usize, height: usize) -> Result<(), RunsError> {
        Crop::whole(width, height)?;
        self.count = 0;
        self.moments = Moments::default();
        self.columns = [MAX_SIDE, 0];
        self.frame = [width, height];
        Ok(())
    }
}

/// A silhouette as runs of pixels.
#[derive(Clone, Copy, Debug)]
pub struct Runs<'m> {
    runs: &'m [PixelRun],
    moments: Moments,
    columns: [usize; 2],
    frame: [usize; 2],
}

impl<'m> Runs<'m> {
    /// The runs, from the top to the bottom and from the left to the right.
    #[must_use]
    pub fn runs(&self) -> &'m [PixelRun] {
        self.runs
    }

    /// Area and first and second moments, exact: those of a mask of the whole frame.
    #[must_use]
    pub fn moments(&self) -> Moments {
        self.moments
    }

    /// The part of the frame with the silhouette and `margin` pixels around it.
    ///
    /// # Errors
    /// [`MaskError::Empty`] where no pixel is set.
    pub fn crop(&self, margin: usize) -> Result<Crop, MaskError> {
        let rows = self.runs.first().zip(self.runs.last());
        let rows = rows.map_or(0..0, |(first, last)| first.row()..last.row() + 1);
        let [left, right] = self.columns;
        Crop::around(left..right, rows, margin, self.frame)
    }

    /// The silhouette as a mask of a part of the frame, over borrowed words; what lies beyond is cut off.
    ///
    /// # Errors
    /// [`MaskError::Memory`] for fewer than [`Crop::words_needed`].
    pub fn draw<'w>(&self, crop: &Crop, words: &'w mut [Word]) -> Result<Mask<'w>, MaskError> {
        let mut mask = crop.mask(words)?;
        let left = crop.columns().start as i64;
        for run in self.runs {
            if let Some(row) = run.row().checked_sub(crop.rows().start) {
                let [from, to] = [run.start, run.end].map(|column| i64::from(column) - left);
                mask.fill_span(row, from, to);
            }
        }
        Ok(mask.into_mask())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::words_needed;
    use proptest::prelude::*;
    use std::vec;

    const FRAME: [usize; 2] = [100, 30];

    properties! {
        #[test]
        fn runs_are_the_mask_that_a_whole_frame_holds(
            mut words in proptest::collection::vec(any::<Word>(), words_needed(FRAME[0], FRAME[1])),
            clear in proptest::collection::vec(any::<bool>(), FRAME[1]),
            way in 0..3, margin in 0..50usize,
        ) {
            let [width, height] = FRAME;
            for (row, words) in words.chunks_mut(4).enumerate() {
                words[3] &= 0xf;
                words[1] |= words[2] << 3;
                if clear[row] {
                    words.fill(0);
                }
            }
            let full = Mask::new(&words, width, height).expect("valid");
            let mut memory = vec![PixelRun::EMPTY; width * height];
            let mut builder = RunBuilder::new(&mut memory, width, height).expect("a frame");
            for row in 0..height {
                match way {
                    0 => builder.add_row(row, (0..width).map(|column| full.get(column, row))),
                    1 => builder.add_words(row, full.row(row)),
                    _ => full.runs(row).try_for_each(|run| builder.add_run(row, run)),
                }.expect("room");
            }
            let runs = builder.finish();
            prop_assert_eq!(runs.moments(), full.moments());
            let Ok(crop) = runs.crop(margin) else {
                prop_assert_eq!(full.area(), 0);
                return Ok(());
            };
            let (columns, rows) = full.bounds();
            prop_assert_eq!(crop, Crop::around(columns, rows, margin, FRAME).expect("some"));
            let mut words = vec![7; crop.words_needed()];
            let own = runs.draw(&crop, &mut words).expect("fits");
            prop_assert_eq!(own.area(), full.area());
            for (row, column) in crop.rows().flat_map(|row| crop.columns().map(move |c| (row, c))) {
                let own = own.get(column - crop.columns().start, row - crop.rows().start);
                prop_assert_eq!(own, full.get(column, row));
            }
        }
    }

    #[test]
    fn what_is_out_of_order_or_of_room_is_refused() {
        let mut memory = [PixelRun::EMPTY; 3];
        let mut builder = RunBuilder::new(&mut memory, 100, 30).expect("a frame");
        assert_eq!(builder.add_run(4, 8..12), Ok(()));
        assert_eq!(builder.add_run(4, 12..14), Err(RunsError::Order(4)));
        assert_eq!(builder.add_run(3, 50..60), Err(RunsError::Order(3)));
        assert_eq!(builder.add_run(4, 90..101), Err(RunsError::Beyond(4)));
        assert_eq!(builder.add_run(30, 0..1), Err(RunsError::Beyond(30)));
        assert_eq!(builder.add_run(2, 5..5), Ok(()));
        let row = (0..100).map(|column| column % 9 == 0);
        assert!(matches!(
            builder.add_row(6, row),
            Err(RunsError::Memory(TooLittleMemory {
                needed: 4,
                given: 3,
                ..
            }))
        ));
        assert_eq!(
            builder.restart(0, 30),
            Err(MaskError::Shape {
                width: 0,
                height: 30
            }
            .into())
        );
        let runs = builder.runs();
        assert_eq!((runs.runs().len(), runs.moments().area), (3, 6));
        // What lies beyond a part is cut off.
        let crop = Crop::around(5..10, 4..6, 0, [100, 30]).expect("inside");
        let mut words = [0; 2];
        assert_eq!(runs.draw(&crop, &mut words).expect("fits").area(), 2);
        assert_eq!(builder.restart(101, 30), Ok(()));
        assert_eq!(builder.runs().moments(), Moments::default());
        assert_eq!(builder.add_run(2, 90..101), Ok(()));
        assert_eq!(builder.finish().crop(0).expect("some").columns(), 90..101);
        assert!(RunBuilder::new(&mut [], 0, 3).is_err());
        let nothing = RunBuilder::new(&mut [], 5, 3).expect("a frame").finish();
        assert_eq!(nothing.crop(3), Err(MaskError::Empty));
    }
}
