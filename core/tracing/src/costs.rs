//! What it costs a path to pass a pixel: little along edges that have the implant on the right side.
//!
//! The gradient is computed at two scales. The strength of an edge is the square root of the scalar product of the two
//! gradients: those of an edge agree, those of noise do not, and the finer scale tells the place (Xu et al., *IEEE Trans.
//! Image Processing* 3, 1994). A strength that is not a maximum across the edge is reduced, so that paths keep to the
//! middle of the edge.

use crate::error::TracingError;
use crate::side::Inside;
use crate::smoothed::{Scale, greatest, smooth_row};
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::memory::{TooLittleMemory, check_length};

mod gradient;

use gradient::{angle_of, coarse_row, gradients_row, is_ridge, rows_around};

/// An edge at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// Strength, from 0 for no edge to 255.
    pub strength: u8,
    /// The direction out of the implant, in which it gets brighter (darker for a bright implant): in 256ths of a full
    /// turn, clockwise on the screen from the direction to the right.
    pub outwards: u8,
}

/// The edges of every pixel of a frame, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Costs<'a> {
    edges: &'a [Edge],
    width: usize,
    height: usize,
}

impl<'a> Costs<'a> {
    /// Edges of `width` x `height` pixels, row by row without gaps.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there are fewer edges than pixels.
    pub fn new(edges: &'a [Edge], width: usize, height: usize) -> Result<Self, TooLittleMemory> {
        let needed = width.saturating_mul(height);
        check_length("edges", needed, edges.len())?;
        Ok(Self {
            edges: edges.get(..needed).unwrap_or_default(),
            width,
            height,
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

    /// The edge at a pixel; none outside the frame.
    #[must_use]
    pub fn at(&self, column: usize, row: usize) -> Edge {
        if column >= self.width {
            return Edge::default();
        }
        self.number(row.saturating_mul(self.width).saturating_add(column))
    }

    /// The edge at the pixel of a number, row by row.
    pub(crate) fn number(&self, number: usize) -> Edge {
        self.edges.get(number).copied().unwrap_or_default()
    }
}

/// Working memory of a [`CostBuilder`], the same from the first step to the last: each slice has at least a place for every
/// pixel.
#[derive(Debug)]
pub struct CostMemory<'a> {
    /// The frame, smoothed.
    pub fine: &'a mut [u16],
    /// The frame, smoothed more.
    pub coarse: &'a mut [u16],
    /// Strengths before they are related to those of the whole frame.
    pub magnitude: &'a mut [u16],
    /// The result.
    pub edges: &'a mut [Edge],
}

/// The stages through which all rows go, one after another.
const STAGES: usize = 4;
/// A magnitude counts as half the greatest strength at this fraction of the magnitude that one pixel in 100 exceeds,
const STRONG_FRACTION: f64 = 0.15;
/// and at least at this multiple of the median magnitude, which is that of noise.
const NOISE_TIMES: f64 = 3.0;
/// Strength beside the middle of an edge, in 256ths of that in its middle.
const OFF_RIDGE: u32 = 144;
/// Bins of magnitudes.
const BINS: usize = 4096;

/// Computes the edges of a frame some rows at a time, so that a page can go on painting in between.
#[derive(Clone, Debug)]
pub struct CostBuilder {
    width: usize,
    height: usize,
    inside: Inside,
    scale: Option<Scale>,
    /// Rows that are done, over all stages.
    done: usize,
    /// The magnitude of half the greatest strength.
    reference: u32,
}

impl CostBuilder {
    /// For frames of `width` x `height` pixels.
    #[must_use]
    pub fn new(width: usize, height: usize, inside: Inside) -> Self {
        Self {
            width,
            height,
            inside,
            scale: None,
            done: 0,
            reference: 1,
        }
    }

    /// Whether nothing is left to do.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.done >= STAGES * self.height
    }

    /// Does `rows` more rows, of four times the number of rows of the frame, and returns whether all is done.
    ///
    /// # Errors
    /// [`TracingError::OtherFrame`] where the frame has another size, and [`TracingError::Memory`].
    pub fn step<P: Pixel>(
        &mut self,
        frame: &Frame<'_, P>,
        memory: &mut CostMemory<'_>,
        rows: usize,
    ) -> Result<bool, TracingError> {
        if (frame.width(), frame.height()) != (self.width, self.height) {
            return Err(TracingError::OtherFrame);
        }
        let needed = self.width * self.height;
        check_length("fine cells", needed, memory.fine.len())?;
        check_length("coarse cells", needed, memory.coarse.len())?;
        check_length("magnitudes", needed, memory.magnitude.len())?;
        check_length("edges", needed, memory.edges.len())?;
        let scale = *self.scale.get_or_insert_with(|| Scale::of(greatest(frame)));
        for _ in 0..rows {
            if self.is_done() {
                break;
            }
            self.next_row(frame, scale, memory);
            self.done += 1;
        }
        Ok(self.is_done())
    }

    fn next_row<P: Pixel>(
        &mut self,
        frame: &Frame<'_, P>,
        scale: Scale,
        memory: &mut CostMemory<'_>,
    ) {
        let (width, height) = (self.width, self.height);
        let row = self.done % height;
        match self.done / height {
            0 => smooth_row(frame, scale, row, memory.fine),
            1 => coarse_row(memory.fine, width, height, row, memory.coarse),
            2 => {
                let scales = [&*memory.fine, &*memory.coarse];
                let turn = if self.inside == Inside::Bright {
                    128
                } else {
                    0
                };
                let magnitudes = &mut memory.magnitude[row * width..(row + 1) * width];
                let edges = &mut memory.edges[row * width..(row + 1) * width];
                gradients_row(scales, width, height, row, |column, magnitude, [x, y]| {
                    magnitudes[column] = magnitude;
                    edges[column].outwards = angle_of(x, y).wrapping_add(turn);
                });
            }
            _ => {
                if row == 0 {
                    self.reference = reference(&memory.magnitude[..width * height]);
                }
                self.strengths_row(row, memory);
            }
        }
    }

    fn strengths_row(&self, row: usize, memory: &mut CostMemory<'_>) {
        let rows = rows_around(memory.magnitude, self.width, self.height, row);
        let edges = memory.edges.iter_mut().skip(row * self.width);
        for ((column, &magnitude), edge) in rows[1].iter().enumerate().zip(edges) {
            let magnitude = u32::from(magnitude);
            let strength = 255 * magnitude / (magnitude + self.reference);
            let ridge = is_ridge(rows, column, edge.outwards);
            let weight = if ridge { 256 } else { OFF_RIDGE };
            edge.strength = ((strength * weight) >> 8) as u8;
        }
    }
}

/// The magnitude of half the greatest strength: far above noise, and a fraction of that of a strong edge.
fn reference(magnitudes: &[u16]) -> u32 {
    let width = (usize::from(u16::MAX) + 1) / BINS;
    let mut counts = [0u32; BINS];
    for &magnitude in magnitudes {
        counts[usize::from(magnitude) / width] += 1;
    }
    let quantile = |fraction: f64| {
        let rank = fraction * magnitudes.len() as f64;
        let mut sum = 0;
        let bin = counts.iter().position(|&count| {
            sum += count;
            f64::from(sum) >= rank
        });
        (bin.unwrap_or_default() * width) as f64
    };
    let strong = STRONG_FRACTION * quantile(0.99);
    strong.max(NOISE_TIMES * quantile(0.5)).max(1.0) as u32
}

#[cfg(test)]
pub(crate) mod tests;
