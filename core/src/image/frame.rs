//! Grey frames: borrowed 8- and 16-bit pixels with a stride, regions of interest, and the
//! stretch that makes pixels square.

use thiserror::Error;

use super::display::QuickCurve;
use super::grey::{Grey, StraightLine};

/// A grey value: `u8` or `u16`.
pub trait Pixel: Copy + Ord + Default + Into<u32> {
    /// The value nearest to `value`, clamped to what the type holds.
    fn from_u32(value: u32) -> Self;

    /// [`Grey::at`] of a frame of such pixels. A method of each type, so that it is compiled here, with the core's
    /// optimisation, and not where a frame is made.
    fn grey_at(frame: &Frame<'_, Self>, column: f64, row: f64) -> Option<f64>;

    /// [`Grey::at_through`] of a frame of such pixels.
    fn intensity_at(
        frame: &Frame<'_, Self>,
        column: f64,
        row: f64,
        curve: &QuickCurve,
    ) -> Option<f64>;

    /// [`Grey::add_along`] of a frame of such pixels.
    fn add_intensities(
        frame: &Frame<'_, Self>,
        line: &StraightLine,
        curve: &QuickCurve,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()>;
}

macro_rules! pixel {
    ($type:ty) => {
        impl Pixel for $type {
            fn from_u32(value: u32) -> Self {
                Self::try_from(value).unwrap_or(Self::MAX)
            }

            fn grey_at(frame: &Frame<'_, Self>, column: f64, row: f64) -> Option<f64> {
                frame.between(column, row, f64::from)
            }

            fn intensity_at(
                frame: &Frame<'_, Self>,
                column: f64,
                row: f64,
                curve: &QuickCurve,
            ) -> Option<f64> {
                frame.between(column, row, |grey| curve.linear(grey))
            }

            fn add_intensities(
                frame: &Frame<'_, Self>,
                line: &StraightLine,
                curve: &QuickCurve,
                weight: f64,
                sums: &mut [f64],
            ) -> Option<()> {
                frame.add_along_line(line, |grey| curve.linear(grey), weight, sums)
            }
        }
    };
}

pixel!(u8);
pixel!(u16);

/// Why a frame or a region is not one.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameError {
    /// Width or height is zero.
    #[error("the frame is {width} x {height} pixels; both must be at least 1")]
    Empty {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Rows would overlap.
    #[error("the stride of {stride} pixels is shorter than a row of {width}")]
    StrideTooShort {
        /// Pixels from one row's start to the next.
        stride: usize,
        /// Columns.
        width: usize,
    },
    /// The buffer ends before the last row does.
    #[error("the frame needs {needed} pixels but the buffer holds {given}")]
    BufferTooShort {
        /// Pixels that the shape takes.
        needed: usize,
        /// Pixels that were given.
        given: usize,
    },
    /// A region of interest leaves the frame.
    #[error(
        "the region from column {column}, row {row}, {width} x {height} pixels, leaves the frame of {frame_width} x {frame_height}"
    )]
    RegionOutside {
        /// First column.
        column: usize,
        /// First row.
        row: usize,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Columns of the frame.
        frame_width: usize,
        /// Rows of the frame.
        frame_height: usize,
    },
}

/// A rectangle of whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column.
    pub column: usize,
    /// First row.
    pub row: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A borrowed grey frame. Rows may be longer in memory than in the picture (`stride`).
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a, P> {
    pixels: &'a [P],
    width: usize,
    height: usize,
    stride: usize,
}

impl<'a, P: Pixel> Frame<'a, P> {
    /// A frame of `width` x `height` pixels whose rows begin `stride` pixels apart.
    ///
    /// # Errors
    /// [`FrameError`] when the shape is empty, overlaps itself or does not fit the buffer.
    pub fn new(
        pixels: &'a [P],
        width: usize,
        height: usize,
        stride: usize,
    ) -> Result<Self, FrameError> {
        if width == 0 || height == 0 {
            return Err(FrameError::Empty { width, height });
        }
        if stride < width {
            return Err(FrameError::StrideTooShort { stride, width });
        }
        let needed = (height - 1).saturating_mul(stride).saturating_add(width);
        if pixels.len() < needed {
            return Err(FrameError::BufferTooShort {
                needed,
                given: pixels.len(),
            });
        }
        Ok(Self {
            pixels,
            width,
            height,
            stride,
        })
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

    /// The pixels of one row; empty below the frame.
    #[must_use]
    pub fn row(&self, row: usize) -> &'a [P] {
        if row >= self.height {
            return &[];
        }
        let start = row * self.stride;
        self.pixels
            .get(start..start + self.width)
            .unwrap_or_default()
    }

    /// The pixel at a column and row; beyond the border, the nearest pixel of it.
    #[must_use]
    pub fn nearest(&self, column: isize, row: isize) -> P {
        let row = row.clamp(0, self.height as isize - 1) as usize;
        let column = column.clamp(0, self.width as isize - 1) as usize;
        self.row(row).get(column).copied().unwrap_or_default()
    }

    /// The part of the frame inside `region`, without copying.
    ///
    /// # Errors
    /// [`FrameError::RegionOutside`] when it leaves the frame, [`FrameError::Empty`] when it
    /// has no pixel.
    pub fn region(&self, region: PixelRect) -> Result<Self, FrameError> {
        let fits = |from: usize, length: usize, whole: usize| {
            from.checked_add(length).is_some_and(|end| end <= whole)
        };
        if !fits(region.column, region.width, self.width)
            || !fits(region.row, region.height, self.height)
        {
            return Err(FrameError::RegionOutside {
                column: region.column,
                row: region.row,
                width: region.width,
                height: region.height,
                frame_width: self.width,
                frame_height: self.height,
            });
        }
        let start = region.row * self.stride + region.column;
        let pixels = self.pixels.get(start..).unwrap_or_default();
        Self::new(pixels, region.width, region.height, self.stride)
    }
}

impl<P: Pixel> Grey for Frame<'_, P> {
    fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn at(&self, column: f64, row: f64) -> Option<f64> {
        P::grey_at(self, column, row)
    }

    fn at_through(&self, column: f64, row: f64, curve: &QuickCurve) -> Option<f64> {
        if curve.curve().is_straight() {
            return Some(curve.curve().upright(self.at(column, row)?));
        }
        P::intensity_at(self, column, row, curve)
    }

    fn add_along(
        &self,
        line: &StraightLine,
        curve: &QuickCurve,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()> {
        P::add_intensities(self, line, curve, weight, sums)
    }
}

impl<P: Pixel> Frame<'_, P> {
    /// What is made of each pixel, linear between the four nearest centres.
    #[inline]
    fn between(&self, column: f64, row: f64, of: impl Fn(u32) -> f64) -> Option<f64> {
        let (column, row) = (column - 0.5, row - 0.5);
        let last = |side: usize| side as f64 - 1.0;
        // A NaN is in no range.
        let inside =
            column >= 0.0 && row >= 0.0 && column <= last(self.width) && row <= last(self.height);
        if !inside {
            return None;
        }
        let (left, above) = (column as usize, row as usize);
        let (right, down) = (column - left as f64, row - above as f64);
        // Beyond the last pixel stands that pixel again; it counts for nothing there.
        let next = usize::from(left + 1 < self.width);
        let below = if above + 1 < self.height {
            self.stride
        } else {
            0
        };
        let first = above * self.stride + left;
        let value = |place: usize| {
            let value: u32 = (*self.pixels.get(place)?).into();
            Some(of(value))
        };
        let upper = value(first)? * (1.0 - right) + value(first + next)? * right;
        let first = first + below;
        let lower = value(first)? * (1.0 - right) + value(first + next)? * right;
        Some(upper * (1.0 - down) + lower * down)
    }

    /// What is made of each pixel, at the places of a line.
    #[inline]
    fn add_along_line(
        &self,
        line: &StraightLine,
        of: impl Fn(u32) -> f64,
        weight: f64,
        sums: &mut [f64],
    ) -> Option<()> {
        let ends = [0, sums.len().saturating_sub(1)].map(|end| line.place(end));
        let within = |x: f64, side: usize| x >= 0.5 && x < side as f64 - 0.5;
        let has_pixel_beyond =
            |[column, row]: [f64; 2]| within(column, self.width) && within(row, self.height);
        if !ends.into_iter().all(has_pixel_beyond) {
            for (number, sum) in sums.iter_mut().enumerate() {
                let [column, row] = line.place(number);
                *sum += weight * self.between(column, row, &of)?;
            }
            return Some(());
        }
        // All places lie between the ends, and four pixels round each.
        for (number, sum) in sums.iter_mut().enumerate() {
            let place = line.place(number).map(|x| x - 0.5);
            let below = place.map(whole_below);
            let [right, down] = [place[0] - below[0], place[1] - below[1]];
            let [left, above] = below.map(|x| (x + WHOLE).to_bits() as u32 as usize);
            let first = above.wrapping_mul(self.stride).wrapping_add(left);
            let value = |place: usize| self.pixels.get(place).map(|&pixel| of(pixel.into()));
            let two = |first: usize| {
                Some(value(first)? * (1.0 - right) + value(first.wrapping_add(1))? * right)
            };
            let (upper, lower) = (two(first)?, two(first.wrapping_add(self.stride))?);
            *sum += weight * (upper * (1.0 - down) + lower * down);
        }
        Some(())
    }
}

/// Beside this number there are whole ones alone, and their low bits count them.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The whole number below one from 0 on, of 31 bits at most. Without a branch, so that several are found at once.
#[inline(always)]
fn whole_below(x: f64) -> f64 {
    let near = (x + WHOLE) - WHOLE;
    near - if near > x { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::display::DisplayCurve;
    use proptest::prelude::*;
    use std::vec::Vec;

    #[test]
    fn a_region_shows_the_same_pixels() {
        let pixels: [u8; 24] = core::array::from_fn(|k| k as u8);
        let frame = Frame::new(&pixels, 5, 4, 6).expect("fits");
        let region = PixelRect {
            column: 2,
            row: 1,
            width: 3,
            height: 2,
        };
        let part = frame.region(region).expect("inside");
        assert_eq!(part.row(0), [8, 9, 10]);
        assert_eq!(part.row(1), [14, 15, 16]);
        assert_eq!(part.row(2), []);
        assert!(frame.region(PixelRect { width: 4, ..region }).is_err());
        assert!(
            frame
                .region(PixelRect {
                    column: usize::MAX,
                    ..region
                })
                .is_err()
        );
    }

    properties! {
        #[test]
        fn what_is_added_along_a_line_is_what_each_place_gives(
            grey in proptest::collection::vec(0..4000u16, 9 * 12),
            origin in proptest::array::uniform2(0.0..9.0f64),
            turn in -3.2..3.2f64, expected in -2.0..2.0f64, aside in -1.0..1.0f64,
            count in 0..12usize, curvature in prop_oneof![Just(0.0), Just(0.002)], inverted in any::<bool>(),
        ) {
            let bytes: Vec<u8> = grey.iter().map(|grey| (grey / 16) as u8).collect();
            let curve = QuickCurve::from(DisplayCurve::new(curvature, inverted));
            let (down, right) = libm::sincos(turn);
            let line = StraightLine {
                origin,
                direction: [right, down],
                aside: [-aside * down, aside * right],
                expected,
                middle: count / 2,
                step: 0.5,
            };
            let frames: [&dyn Grey; 2] = [
                &Frame::new(&grey, 11, 9, 12).expect("fits"),
                &Frame::new(&bytes, 11, 9, 12).expect("fits"),
            ];
            for frame in frames {
                let mut sums = std::vec![0.25; count];
                let added = frame.add_along(&line, &curve, 0.375, &mut sums);
                let each: Option<Vec<f64>> = (0..count)
                    .map(|number| {
                        let [column, row] = line.place(number);
                        Some(0.25 + 0.375 * frame.at_through(column, row, &curve)?)
                    })
                    .collect();
                prop_assert_eq!(added.map(|()| sums), each);
            }
        }
    }

    properties! {
        #[test]
        fn the_whole_number_below_is_that_of_the_library(x in 0.0..2e5f64, whole in 0..i32::MAX, near in -1e-9..1e-9f64) {
            for x in [x, f64::from(whole), (f64::from(whole % 5000) + near).max(0.0), libm::floor(x) + 0.5] {
                prop_assert_eq!(whole_below(x), libm::floor(x));
                prop_assert_eq!((whole_below(x) + WHOLE).to_bits() as u32, x as u32);
            }
        }
    }

    #[test]
    fn shapes_that_do_not_fit_are_named() {
        assert_eq!(
            Frame::<u8>::new(&[], 0, 1, 1).err(),
            Some(FrameError::Empty {
                width: 0,
                height: 1
            })
        );
        assert!(Frame::<u16>::new(&[0; 10], 4, 3, 3).is_err());
        assert!(Frame::<u16>::new(&[0; 11], 4, 3, 4).is_err());
        assert!(Frame::<u16>::new(&[0; 11], 4, 3, usize::MAX).is_err());
    }
}
