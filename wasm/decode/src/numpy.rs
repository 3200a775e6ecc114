//! NumPy arrays (`.npy`): a frame, or a film of them.
//!
//! The form is that of `numpy.lib.format`, versions 1.0 to 3.0: a mark, a header that is a Python dictionary of type, order and shape, then the
//! numbers. It is read here: the libraries for it bring a parser of all Python literals.

mod problem;

mod header;
mod shape;

use header::Header;
use problem::{damaged, not_read};
use shape::Shape;

use crate::error::Problem;
use crate::frame::{GreyFrame, Pixels, checked_area};
use crate::limits::MAX_FRAMES;
use crate::luminance::{luminance, weighted};
use crate::numbers::{Range, in_16_bits};

pub(crate) use header::MARK;

/// An array whose header has been checked, and that all its numbers are there.
pub(crate) struct Array {
    header: Header,
    shape: Shape,
    /// Of all its numbers, where these do not fit pixels as they are: all frames are mapped alike.
    range: Option<Range>,
}

impl Array {
    pub(crate) fn open(bytes: &[u8]) -> Result<Self, Problem> {
        let header = Header::of(bytes)?;
        let shape = Shape::of(&header.shape, header.is_by_columns)?;
        let [width, height] = [shape.columns.count, shape.rows.count];
        checked_area(width as u64, height as u64)?;
        if !(1..=MAX_FRAMES).contains(&shape.frames.count) {
            let detail = format!("{} frames", shape.frames.count);
            return Err(not_read(detail));
        }
        let numbers = header
            .shape
            .iter()
            .try_fold(header.number.bytes(), |all, &each| all.checked_mul(each));
        let there = bytes.len() - header.length;
        if numbers.is_none_or(|needed| needed > there) {
            return Err(damaged("it is too short for its stated shape"));
        }
        let array = Self {
            header,
            shape,
            range: None,
        };
        let range = (!array.header.number.fits()).then(|| array.range(bytes));
        Ok(Self { range, ..array })
    }

    pub(crate) fn count(&self) -> usize {
        self.shape.frames.count
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        // Within `MAX_SIDE`.
        (
            self.shape.columns.count as u32,
            self.shape.rows.count as u32,
        )
    }

    /// Decodes frame `index`, which there is.
    pub(crate) fn frame(&self, bytes: &[u8], index: usize) -> GreyFrame {
        let (width, height) = self.size();
        let values = self.shape.pixels(index).map(|at| self.grey(bytes, at));
        let mut notes = Vec::new();
        let pixels = match (self.range, self.header.number.bytes()) {
            (Some(range), _) => in_16_bits(values, range, &mut notes),
            (None, 1) => Pixels::U8(values.map(|value| value as u8).collect()),
            (None, _) => Pixels::U16(values.map(|value| value as u16).collect()),
        };
        GreyFrame {
            notes,
            ..GreyFrame::plain(width, height, pixels)
        }
    }

    /// The number of a pixel, or the luminance of its colours.
    fn grey(&self, bytes: &[u8], at: usize) -> f64 {
        let number = |channel: usize| self.number(bytes, at + channel * self.shape.channels.step);
        match self.shape.channels.count {
            3.. if self.header.number.fits() => {
                let [red, green, blue] = [0, 1, 2].map(|channel| number(channel) as u16);
                luminance(red, green, blue).into()
            }
            3.. => weighted([number(0), number(1), number(2)]),
            _ => number(0),
        }
    }

    fn number(&self, bytes: &[u8], at: usize) -> f64 {
        let Header { number, length, .. } = self.header;
        number.read(&bytes[length + at * number.bytes()..])
    }

    fn range(&self, bytes: &[u8]) -> Range {
        let frames = 0..self.count();
        let values = frames.flat_map(|index| self.shape.pixels(index));
        Range::of(
            values.map(|at| self.grey(bytes, at)),
            self.header.number.is_whole(),
        )
    }
}
