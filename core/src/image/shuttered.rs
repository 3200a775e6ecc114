//! Frames of which a shutter covers a part: what is behind it is no more of the picture than what is beyond the frame's border.

use super::display::QuickCurve;
use super::grey::{Grey, StraightLine};
use super::mask::{Mask, MaskError, WORD_BITS, Word};

/// A grey frame, and the pixels of it that are not the picture. Between these nothing is read, as beyond the outermost centres.
#[derive(Clone, Copy, Debug)]
pub struct Shuttered<F, W> {
    frame: F,
    words: W,
}

impl<F: Grey, W: AsRef<[Word]>> Shuttered<F, W> {
    /// A frame of which the pixels set in a mask of these words, row by row, are not the picture.
    ///
    /// # Errors
    /// [`MaskError`] where they are no mask of the frame's size.
    pub fn new(frame: F, words: W) -> Result<Self, MaskError> {
        let (width, height) = frame.size();
        Mask::new(words.as_ref(), width, height)?;
        Ok(Self { frame, words })
    }

    /// What is behind the shutter.
    fn behind(&self) -> Mask<'_> {
        let (width, height) = self.frame.size();
        Mask::of_checked(self.words.as_ref(), width, height)
    }
}

/// Whether none of the pixels around a place that the frame has is behind the shutter. Neither generic nor a method, so that it is compiled here and not by whoever has a frame.
fn is_open(behind: &Mask<'_>, [column, row]: [f64; 2]) -> bool {
    let (column, row) = (column - 0.5, row - 0.5);
    // Beyond the frame it is the frame that gives nothing.
    if !(column >= 0.0 && row >= 0.0) {
        return true;
    }
    let (left, above) = (column as usize, row as usize);
    // The next pixel counts for nothing at a centre.
    let right = u32::from(column > left as f64);
    let down = u32::from(row > above as f64);
    let counted = 1 | right << 1 | down << 2 | (right & down) << 3;
    behind.square(left, above) & counted == 0
}

/// The same of so many places of a line. Near most lines is no shutter, which the rows that they cross tell sooner.
fn are_open(behind: &Mask<'_>, line: &StraightLine, count: usize) -> bool {
    let ends = [0, count.saturating_sub(1)].map(|end| line.place(end));
    is_box_open(behind, ends) || (0..count).all(|number| is_open(behind, line.place(number)))
}

/// Whether no pixel of the box between two places is behind the shutter, nor one around it.
fn is_box_open(behind: &Mask<'_>, [one, other]: [[f64; 2]; 2]) -> bool {
    // What lies before the frame is cut off.
    let range = |axis: usize| {
        let (low, high) = (one[axis].min(other[axis]), one[axis].max(other[axis]));
        (low as usize).saturating_sub(2)..(high as usize).saturating_add(2)
    };
    let (columns, rows) = (range(0), range(1));
    let rows = rows.start..rows.end.min(behind.height());
    let words = columns.start / WORD_BITS..columns.end.min(behind.width()).div_ceil(WORD_BITS);
    let is_clear = |row: usize| {
        let words = behind.row(row).get(words.clone()).unwrap_or_default();
        words.iter().all(|&word| word == 0)
    };
    rows.is_empty() || words.is_empty() || rows.clone().all(is_clear)
}

impl<F: Grey, W: AsRef<[Word]>> Grey for Shuttered<F, W> {
    fn size(&self) -> (usize, usize) {
        self.frame.size()
    }

    fn at(&self, column: f64, row: f64) -> Option<f64> {
        is_open(&self.behind(), [column, row]).then(|| self.frame.at(column, row))?
    }

    fn at_through(&self, column: f64, row: f64, curve: &QuickCurve) -> Option<f64> {
        is_open(&self.behind(), [column, row]).then(|| self.frame.at_through(column, row, curve))?
    }

    fn add_along(
        &self,
        line: &StraightLine,
        curve: &QuickCurve,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()> {
        if are_open(&self.behind(), line, sums.len()) {
            return self.frame.add_along(line, curve, weight, sums);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::display::DisplayCurve;
    use crate::image::frame::Frame;
    use crate::image::mask::{MaskMut, words_needed};
    use proptest::prelude::*;

    const W: usize = 37;
    const H: usize = 9;

    /// The picture alone, pixel by pixel.
    fn naive(pixels: &[u16], behind: &Mask<'_>, column: f64, row: f64) -> Option<f64> {
        let (column, row) = (column - 0.5, row - 0.5);
        let mut sum = 0.0;
        for y in [libm::floor(row), libm::floor(row) + 1.0] {
            for x in [libm::floor(column), libm::floor(column) + 1.0] {
                let weight = (1.0 - (column - x).abs()) * (1.0 - (row - y).abs());
                if weight > 0.0 {
                    let inside = (0.0..W as f64).contains(&x) && (0.0..H as f64).contains(&y);
                    if !inside || behind.get(x as usize, y as usize) {
                        return None;
                    }
                    sum += weight * f64::from(pixels[y as usize * W + x as usize]);
                }
            }
        }
        Some(sum)
    }

    properties! {
        #[test]
        fn nothing_is_read_behind_a_shutter_and_all_else_as_ever(
            pixels in proptest::collection::vec(0..4000u16, W * H),
            closed in proptest::collection::vec((0..W, 0..H), 0..12),
            column in -1.0..W as f64 + 1.0, row in -1.0..H as f64 + 1.0, centred in any::<bool>(),
            turn in -3.2..3.2f64, count in 0..9usize,
        ) {
            let mut words = [0; words_needed(W, H)];
            let mut behind = MaskMut::new(&mut words, W, H).expect("fits");
            closed.iter().for_each(|&(column, row)| behind.set(column, row, true));
            let behind = behind.into_mask();
            let frame = Frame::new(&pixels, W, H, W).expect("fits");
            let shuttered = Shuttered::new(frame, behind.words()).expect("same size");
            let place = |x: f64| if centred { libm::floor(x) + 0.5 } else { x };
            let (column, row) = (place(column), place(row));
            let told = naive(&pixels, &behind, column, row);
            prop_assert_eq!(shuttered.at(column, row).is_some(), told.is_some());
            if let (Some(read), Some(told)) = (shuttered.at(column, row), told) {
                prop_assert!((read - told).abs() < 1e-9, "{} {}", read, told);
            }
            let curve = QuickCurve::from(DisplayCurve::new(0.002, false));
            let whole = frame.at_through(column, row, &curve).filter(|_| told.is_some());
            prop_assert_eq!(shuttered.at_through(column, row, &curve), whole);

            let (down, right) = libm::sincos(turn);
            let line = StraightLine {
                origin: [column, row],
                direction: [right, down],
                aside: [0.0; 2],
                expected: 0.0,
                middle: 0,
                step: 0.5,
            };
            let (mut sums, mut alone) = ([0.25; 9], [0.25; 9]);
            let added = shuttered.add_along(&line, &curve, 0.5, &mut sums[..count]);
            let open = (0..count).all(|number| {
                let [column, row] = line.place(number);
                shuttered.at(column, row).is_some()
            });
            prop_assert_eq!(added.is_some(), open);
            if open {
                frame.add_along(&line, &curve, 0.5, &mut alone[..count]);
                prop_assert_eq!(sums, alone);
            }
        }
    }

    #[test]
    fn a_shutter_of_another_size_is_refused() {
        let pixels = [0u8; W * H];
        let frame = Frame::new(&pixels, W, H, W).expect("fits");
        assert!(Shuttered::new(frame, [0; words_needed(W, H - 1)]).is_err());
        assert!(Shuttered::new(frame, [Word::MAX; words_needed(W, H)]).is_err());
    }
}
