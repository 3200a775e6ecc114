//! What it costs a path to pass a pixel: little along edges that have the implant on the right side.
//!
//! The gradient is taken at two scales. The strength of an edge is the square root of the scalar product of both:
//! noise does not agree with itself at two scales, edges do, and the finer scale says where (Xu et al., *IEEE
//! Trans. Image Processing* 3, 1994). Where the strength is no maximum across the edge it counts less, so that paths
//! keep to the middle of it.

use super::smoothed::{Scale, greatest, smooth_row};
use super::threshold::Inside;
use super::{AidError, check_length};
use fluoropose::image::frame::{Frame, Pixel};

mod gradient;

use gradient::{angle_of, coarse_row, gradients_row, is_ridge, rows_around};

/// An edge at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// 0 for none to 255.
    pub strength: u8,
    /// Where it gets brighter (darker for a bright implant), that is out of the implant: in 256ths of a turn from the
    /// direction to the right, clockwise on the screen.
    pub outwards: u8,
}

/// Edges of every pixel of a frame, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Costs<'a> {
    edges: &'a [Edge],
    width: usize,
    height: usize,
}

impl<'a> Costs<'a> {
    /// Edges, row by row without gaps.
    ///
    /// # Errors
    /// [`AidError::Memory`] where there are too few.
    pub fn new(edges: &'a [Edge], width: usize, height: usize) -> Result<Self, AidError> {
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
    pub(super) fn number(&self, number: usize) -> Edge {
        self.edges.get(number).copied().unwrap_or_default()
    }
}

/// Working memory of a [`CostBuilder`]: each slice has a place for every pixel. Must be the same from step to step.
#[derive(Debug)]
pub struct CostMemory<'a> {
    /// The smoothed frame.
    pub fine: &'a mut [u16],
    /// The frame smoothed more.
    pub coarse: &'a mut [u16],
    /// Strengths before they are compared with the frame's.
    pub magnitude: &'a mut [u16],
    /// What is made.
    pub edges: &'a mut [Edge],
}

/// The stages through which all rows go, one after another.
const STAGES: usize = 4;
/// A strength is compared with this share of what only one pixel in a hundred exceeds...
const STRONG_SHARE: f64 = 0.15;
/// ... and with so many times the middle strength, which is that of noise.
const NOISE_TIMES: f64 = 3.0;
/// Beside an edge's middle its strength counts as so many 256ths.
const OFF_RIDGE: u32 = 144;
/// Bins of magnitudes.
const BINS: usize = 4096;

/// Works out the edges of a frame some rows at a time, so that a page can go on painting.
#[derive(Clone, Debug)]
pub struct CostBuilder {
    width: usize,
    height: usize,
    inside: Inside,
    scale: Option<Scale>,
    /// Rows of all stages.
    done: usize,
    /// Half strength.
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

    /// Works on `rows` more rows (of four times as many as the frame has) and says whether all is done.
    ///
    /// # Errors
    /// [`AidError`] where the frame has another size or memory is short.
    pub fn step<P: Pixel>(
        &mut self,
        frame: &Frame<'_, P>,
        memory: &mut CostMemory<'_>,
        rows: usize,
    ) -> Result<bool, AidError> {
        if (frame.width(), frame.height()) != (self.width, self.height) {
            return Err(AidError::OtherFrame);
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
                let grids = [&*memory.fine, &*memory.coarse];
                let turn = if self.inside == Inside::Bright {
                    128
                } else {
                    0
                };
                let magnitudes = &mut memory.magnitude[row * width..(row + 1) * width];
                let edges = &mut memory.edges[row * width..(row + 1) * width];
                gradients_row(grids, width, height, row, |column, magnitude, [x, y]| {
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
            let share = if ridge { 256 } else { OFF_RIDGE };
            edge.strength = ((strength * share) >> 8) as u8;
        }
    }
}

/// The magnitude that counts as half: far above noise, and what a strong edge has some times over.
fn reference(magnitudes: &[u16]) -> u32 {
    let width = (usize::from(u16::MAX) + 1) / BINS;
    let mut counts = [0u32; BINS];
    for &magnitude in magnitudes {
        counts[usize::from(magnitude) / width] += 1;
    }
    let below = |share: f64| {
        let rank = share * magnitudes.len() as f64;
        let mut sum = 0;
        let bin = counts.iter().position(|&count| {
            sum += count;
            f64::from(sum) >= rank
        });
        (bin.unwrap_or_default() * width) as f64
    };
    let strong = STRONG_SHARE * below(0.99);
    strong.max(NOISE_TIMES * below(0.5)).max(1.0) as u32
}

#[cfg(test)]
pub(crate) mod tests;
