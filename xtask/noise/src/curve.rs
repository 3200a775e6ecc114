//! The outlines of a mask as smooth closed curves.
//!
//! The border between pixels is a staircase. The middles of its unit steps lie on both sides of
//! the outline that was sampled, on average on it: a side of any slope is met without bias. What
//! is left is to smooth the steps without drawing curves inwards, as plain smoothing does.

use anyhow::Result;
use fluoropose::image::border::{first_pixel, follow_border};
use fluoropose::image::contour::{Contour, Point};
use fluoropose::image::mask::Mask;

use super::fill::filled;
use crate::mask_buffer::MaskBuffer;

/// Corners of one border that are kept: four times as many as an outline in a large frame has.
const CORNERS: usize = 1 << 16;

/// A closed curve round a region of a mask, or round a hole in one. Clockwise on the screen about
/// what it encloses.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Vertices, pixels of the frame.
    pub points: Vec<Point>,
    /// Unit normals there, to the right and downwards, away from the silhouette.
    pub normals: Vec<[f64; 2]>,
    /// Way along the curve from the first vertex to each, pixels.
    pub along: Vec<f64>,
    /// Way once round, pixels.
    pub length: f64,
    /// Whether it goes round a hole.
    pub hole: bool,
}

/// How a mask lies in the frame of the curves: sampled `factor` times as finely, and larger by
/// `margin` of its own pixels on each side.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Pixels of the mask along one of the frame's.
    pub factor: usize,
    /// Pixels of the mask left of and above the frame's first.
    pub margin: usize,
}

/// All outlines of a mask: of its regions and of their holes, of regions in holes, and so on,
/// what encloses before what is enclosed. `smoothing` is the standard deviation of the filter,
/// in pixels of the mask.
///
/// # Errors
/// For an outline with more than 65 536 corners.
pub fn curves(mask: &Mask<'_>, sampling: Sampling, smoothing: f64) -> Result<Vec<Curve>> {
    let mut corners: Box<Contour<CORNERS>> = Box::default();
    let mut rest = MaskBuffer::copy_of(mask);
    let mut found = Vec::new();
    while let Some((column, row)) = first_pixel(&rest.mask()) {
        follow_border(&rest.mask(), corners.as_mut())?;
        // Outlines of regions and of holes alternate from outside inwards: what is inside the
        // border changes, so the holes of this region are regions afterwards.
        let inside = filled(&[(&corners, false)], mask.width(), mask.height())?;
        rest = rest.combined(&inside, |rest, inside| rest ^ inside)?;
        let hole = !mask.get(column, row);
        found.push(Curve::smooth(&corners, hole, sampling, smoothing));
    }
    Ok(found)
}

impl Curve {
    fn smooth(corners: &[Point], hole: bool, sampling: Sampling, smoothing: f64) -> Self {
        let steps = middles(corners);
        // A filter as long as the whole border would leave nothing of a speck.
        let width = smoothing.min(steps.len() as f64 / 12.0);
        let points = kept_in_shape(&steps, width);
        let normals = normals(&kept_in_shape(&steps, 2.0 * width), hole);
        let place = |value: f64| (value - sampling.margin as f64) / sampling.factor as f64;
        let points: Vec<Point> = points
            .iter()
            .map(|&[column, row]| Point::new(place(column), place(row)))
            .collect();
        let (along, length) = ways(&points);
        Self {
            points,
            normals,
            along,
            length,
            hole,
        }
    }

    /// Length of the curve about each vertex, pixels: half of both sides that meet there.
    pub fn lengths(&self) -> impl Iterator<Item = f64> + '_ {
        let count = self.points.len();
        (0..count).map(move |k| {
            let before = self.along[(k + count - 1) % count];
            let after = self.along[(k + 1) % count];
            (after - before).rem_euclid(self.length) / 2.0
        })
    }
}

/// Middles of the unit steps of a border given by its corners.
fn middles(corners: &[Point]) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for (k, from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % corners.len()];
        let (right, down) = (to.column - from.column, to.row - from.row);
        let count = right.abs().max(down.abs());
        all.extend((0..count as usize).map(|step| {
            let part = (step as f64 + 0.5) / count;
            [from.column + part * right, from.row + part * down]
        }));
    }
    all
}

/// Smoothed by a Gaussian of `width` steps, and what that takes off a curve put back by smoothing
/// what it took ("twicing": Tukey, *Exploratory Data Analysis*, 1977). A circle's radius then
/// errs by the fourth power of the width over it, not by the second.
fn kept_in_shape(steps: &[[f64; 2]], width: f64) -> Vec<[f64; 2]> {
    let once = gaussian(steps, width);
    let twice = gaussian(&once, width);
    let both = once.iter().zip(&twice);
    both.map(|(once, twice)| [2.0 * once[0] - twice[0], 2.0 * once[1] - twice[1]])
        .collect()
}

/// Cyclic Gaussian filter; cut off at four standard deviations.
fn gaussian(values: &[[f64; 2]], width: f64) -> Vec<[f64; 2]> {
    let reach = (4.0 * width).ceil() as usize;
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|k| (k as f64 - reach as f64) / width)
        .map(|t| libm::exp(-t * t / 2.0))
        .collect();
    let sum: f64 = weights.iter().sum();
    let count = values.len();
    let first = count - reach % count;
    let smooth = |at: usize| {
        let mut total = [0.0; 2];
        for (k, weight) in weights.iter().enumerate() {
            let [column, row] = values[(at + first + k) % count];
            total[0] += weight * column;
            total[1] += weight * row;
        }
        total.map(|value| value / sum)
    };
    (0..count).map(smooth).collect()
}

/// Unit normals of a closed polygon, from the vertices before and after each.
fn normals(points: &[[f64; 2]], hole: bool) -> Vec<[f64; 2]> {
    let count = points.len();
    // On a clockwise way what is enclosed is on the right hand.
    let sign = if hole { -1.0 } else { 1.0 };
    let at = |k: usize| {
        let (before, after) = (points[(k + count - 1) % count], points[(k + 1) % count]);
        let (right, down) = (after[0] - before[0], after[1] - before[1]);
        let length = libm::hypot(right, down);
        if length > 0.0 {
            [sign * down / length, -sign * right / length]
        } else {
            [0.0; 2]
        }
    };
    (0..count).map(at).collect()
}

/// Ways from the first vertex to each, and once round.
fn ways(points: &[Point]) -> (Vec<f64>, f64) {
    let mut along = Vec::with_capacity(points.len());
    let mut way = 0.0;
    for (k, point) in points.iter().enumerate() {
        along.push(way);
        let next = points[(k + 1) % points.len()];
        way += libm::hypot(next.column - point.column, next.row - point.row);
    }
    (along, way)
}

/// The mask with `margin` pixels more on each side, where it goes on as at the frame's border:
/// an outline that the frame cuts off then runs on, and the cut is no outline.
///
/// # Errors
/// Where it would be larger than a mask can be.
pub fn widened(mask: &Mask<'_>, margin: usize) -> Result<MaskBuffer> {
    let (width, height) = (mask.width(), mask.height());
    let mut wide = MaskBuffer::new(width + 2 * margin, height + 2 * margin)?;
    wide.draw(|wide| {
        for row in 0..height + 2 * margin {
            let from = row.saturating_sub(margin).min(height - 1);
            for run in mask.runs(from) {
                let start = if run.start == 0 {
                    0
                } else {
                    run.start + margin
                };
                let beyond = if run.end == width { margin } else { 0 };
                for column in start..run.end + margin + beyond {
                    wide.set(column, row, true);
                }
            }
        }
    });
    Ok(wide)
}
