//! Pixels of a frame that are not of the picture: those that a shutter covers.

use std::rc::Rc;

use fluoropose::image::mask::{MaskMut, Word, words_needed};
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Runs of pixels, numbered row by row: of each the first, and the one after its last. None where all of the frame is the picture.
#[derive(Clone, Default)]
pub(crate) struct Covered(Rc<[u32]>);

impl Covered {
    /// Of a frame of so many pixels; `None` where these are no runs in it.
    pub(crate) fn new(ends: Vec<u32>, pixels: usize) -> Option<Self> {
        let is_within = ends.last().is_none_or(|&last| last as usize <= pixels);
        let are_runs = ends.len().is_multiple_of(2) && ends.is_sorted_by(|a, b| a < b);
        (is_within && are_runs).then(|| Self(ends.into()))
    }

    /// Whether all of the frame is the picture.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Both ends of each run, by turns.
    pub(crate) fn ends(&self) -> &[u32] {
        &self.0
    }

    /// The runs, from the first one on.
    pub(crate) fn runs(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let runs = self.0.as_chunks::<2>().0.iter();
        runs.map(|&[first, after]| first as usize..after as usize)
    }

    /// Whether a pixel is one of them.
    pub(crate) fn has(&self, number: usize) -> bool {
        self.0.partition_point(|&end| end as usize <= number) % 2 == 1
    }

    /// Of a frame in squares of `side` x `side` pixels, `size` of them: those of which a pixel is covered.
    pub(crate) fn reduced(
        &self,
        (width, _): (usize, usize),
        (columns, rows): (usize, usize),
        side: usize,
    ) -> Self {
        let mut squares = vec![false; columns * rows];
        for number in self.runs().flatten() {
            let (column, row) = (number % width / side, number / width / side);
            if column < columns && row < rows {
                squares[row * columns + column] = true;
            }
        }
        let is_covered = |number: usize| squares.get(number).copied().unwrap_or(false);
        let begins = |&number: &usize| is_covered(number) != (number > 0 && is_covered(number - 1));
        let ends = (0..=squares.len()).filter(begins);
        Self(ends.map(|number| number as u32).collect())
    }

    /// They are set in a mask of the frame's size.
    ///
    /// # Errors
    /// The core's sentence about that size.
    pub(crate) fn words(&self, width: usize, height: usize) -> Result<Vec<Word>, JsError> {
        let mut words = vec![0; words_needed(width, height)];
        let mut mask = MaskMut::new(&mut words, width, height).map_err(sentence)?;
        for run in self.runs() {
            for row in run.start / width..run.end.div_ceil(width) {
                let column = |number: usize| number.saturating_sub(row * width).min(width) as i64;
                mask.fill_span(row, column(run.start), column(run.end));
            }
        }
        Ok(words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::Mask;

    #[test]
    fn runs_are_set_in_a_mask_across_rows() {
        let ends = vec![0, 1, 5, 17, 20, 21, 33, 35];
        let covered = Covered::new(ends.clone(), 35).unwrap();
        let Ok(words) = covered.words(7, 5) else {
            panic!("the size is possible")
        };
        let mask = Mask::new(&words, 7, 5).unwrap();
        let in_runs: Vec<usize> = covered.runs().flatten().collect();
        for number in 0..35 {
            let due = ends
                .chunks(2)
                .any(|run| run[0] <= number && number < run[1]);
            let number = number as usize;
            assert_eq!(covered.has(number), due, "{number}");
            assert_eq!(mask.get(number % 7, number / 7), due, "{number}");
            assert_eq!(in_runs.contains(&number), due, "{number}");
        }
    }

    #[test]
    fn what_are_no_runs_of_the_frame_is_refused() {
        for ends in [vec![1], vec![0, 36], vec![3, 2], vec![4, 6, 6, 8]] {
            assert!(Covered::new(ends.clone(), 35).is_none(), "{ends:?}");
        }
        assert!(Covered::new(Vec::new(), 35).unwrap().is_empty());
    }
}
