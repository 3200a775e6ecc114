//! Calibration from the beads of a grid or from a ruler, and distortion corrected, for the page.

use fluoropose::image::frame::{Frame, Pixel};
use fluoropose_distortion::Distortion;
use fluoropose_distortion::lattice::Bead;
use fluoropose_distortion::plate::{Distances, camera};
use fluoropose_distortion::resample::{map_row, resample_row};
use fluoropose_distortion::ruler::scale;
use wasm_bindgen::prelude::*;

use crate::covered::Covered;
use crate::error::sentence;
use crate::frame_image::{FrameImage, Pixels};

/// Four numbers a bead: column, row, number to the right, number down.
const PER_BEAD: usize = 4;

/// Beads from four numbers each: column and row (px), number to the right, number down.
pub fn beads_of(flat: &[f64]) -> Vec<Bead> {
    flat.as_chunks::<PER_BEAD>()
        .0
        .iter()
        .map(|&[column, row, i, j]| Bead::new([column, row], Some([i as i32, j as i32])))
        .collect()
}

/// Applies a stored correction.
#[wasm_bindgen]
pub struct Undistorter {
    distortion: Distortion,
    /// Where each pixel of the straight frame is in the frame as taken; made when the first frame is.
    map: Vec<[f32; 2]>,
}

#[wasm_bindgen]
impl Undistorter {
    /// From the stored numbers.
    ///
    /// # Errors
    /// The core's sentence for numbers that are no correction.
    #[wasm_bindgen(constructor)]
    pub fn new(numbers: &[f64]) -> Result<Undistorter, JsError> {
        let distortion = Distortion::from_numbers(numbers).map_err(sentence)?;
        Ok(Self {
            distortion,
            map: Vec::new(),
        })
    }

    /// Columns and rows of points, by turns, where they lie once straight.
    pub fn undistorted(&self, points: &[f64]) -> Vec<f64> {
        let points = points.as_chunks::<2>().0.iter();
        points
            .flat_map(|&point| self.distortion.undistorted(point))
            .collect()
    }

    /// The way back. A point that has no place near by in the picture as taken stays where it is.
    pub fn distorted(&self, mut points: Vec<f64>) -> Vec<f64> {
        self.distort(&mut points);
        points
    }

    /// The undistorted frame of a frame as taken.
    ///
    /// # Errors
    /// A sentence when the frame has another size than the correction is for.
    pub fn frame(&mut self, frame: &FrameImage) -> Result<FrameImage, JsError> {
        let (width, height) = self.distortion.size();
        if frame.size() != (width, height) {
            let (columns, rows) = frame.size();
            return Err(JsError::new(&format!(
                "the correction of distortion is for frames of {width} x {height} pixels and this one has {columns} x {rows}"
            )));
        }
        if self.map.is_empty() {
            self.map = vec![[0.0; 2]; width * height];
            for (row, out) in self.map.chunks_exact_mut(width).enumerate() {
                map_row(&self.distortion, row, out);
            }
        }
        let (columns, rows) = (width as u32, height as u32);
        let mut straight = match frame.pixels() {
            Pixels::Eight(pixels) => FrameImage::from_eight_bit(
                resampled(pixels, &self.map, width, height)?,
                columns,
                rows,
            ),
            Pixels::Sixteen(pixels) => FrameImage::from_sixteen_bit(
                resampled(pixels, &self.map, width, height)?,
                columns,
                rows,
            ),
        }?;
        straight.cover(covered(frame.behind(), &self.map, width, height))?;
        Ok(straight)
    }

    /// For each pixel of the frame as taken, the number of the pixel of the straight frame that it shows, or one past
    /// the last: what overlays are drawn with on frames that stay as they are.
    pub fn sources(&self) -> Vec<u32> {
        let (width, height) = self.distortion.size();
        let mut out = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let [c, r] = self
                    .distortion
                    .undistorted([column as f64 + 0.5, row as f64 + 0.5]);
                let inside = (0.0..width as f64).contains(&c) && (0.0..height as f64).contains(&r);
                let index = if inside {
                    r as usize * width + c as usize
                } else {
                    width * height
                };
                out.push(index as u32);
            }
        }
        out
    }
}

impl Undistorter {
    /// Moves points, columns and rows by turns, as `bent` does.
    pub fn distort(&self, points: &mut [f64]) {
        for point in points.as_chunks_mut::<2>().0 {
            *point = self.distortion.distorted(*point).unwrap_or(*point);
        }
    }
}

fn resampled<P: Pixel>(
    pixels: &[P],
    map: &[[f32; 2]],
    width: usize,
    height: usize,
) -> Result<Vec<P>, JsError> {
    let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
    let mut out = vec![P::default(); width * height];
    for (places, row) in map.chunks_exact(width).zip(out.chunks_exact_mut(width)) {
        resample_row(&frame, places, row);
    }
    Ok(out)
}

/// The pixels of the straight frame that lie nearest to a covered one of the frame as taken.
fn covered(behind: &Covered, map: &[[f32; 2]], width: usize, height: usize) -> Vec<u32> {
    let mut ends = Vec::new();
    if behind.is_empty() {
        return ends;
    }
    for (number, &[column, row]) in map.iter().enumerate() {
        let inside = (0.0..width as f32).contains(&column) && (0.0..height as f32).contains(&row);
        let is_covered = inside && behind.has(row as usize * width + column as usize);
        if is_covered != (ends.len() % 2 == 1) {
            ends.push(number as u32);
        }
    }
    if ends.len() % 2 == 1 {
        ends.push(map.len() as u32);
    }
    ends
}

/// The camera that took a bead plate: pixel pitch and its standard deviation (mm), principal point x and y from the
/// frame's middle (mm) and their standard deviations, 1 where the picture tells the principal point, tilt of the plate
/// (degrees), residual (px), beads used, 1 where the picture is distorted, and
/// 1 where the plate is tilted too far for a correction of distortion. Distances in mm: between beads, source to detector, source to plate.
///
/// # Errors
/// The core's sentence for impossible lengths or too few beads.
#[wasm_bindgen(js_name = plateCamera)]
pub fn plate_camera(
    beads: &[f64],
    spacing: f64,
    source_to_detector: f64,
    source_to_plate: f64,
    width: u32,
    height: u32,
) -> Result<Vec<f64>, JsError> {
    let measured = Distances {
        spacing_mm: spacing,
        source_to_detector_mm: source_to_detector,
        source_to_plate_mm: source_to_plate,
    };
    let size = (width as usize, height as usize);
    let found = camera(&beads_of(beads), measured, size).map_err(sentence)?;
    Ok(vec![
        found.pitch_mm,
        found.pitch_deviation_mm,
        found.offset_mm[0],
        found.offset_mm[1],
        found.offset_deviation_mm[0],
        found.offset_deviation_mm[1],
        f64::from(u8::from(found.offset_is_measured)),
        found.tilt_deg,
        found.residual_px,
        found.used as f64,
        f64::from(u8::from(found.is_distorted())),
        f64::from(u8::from(found.is_tilted())),
    ])
}

/// Length in px, pixel pitch in mm and focal length in px from two marks (column, row, column, row) that are `length` mm
/// apart.
///
/// # Errors
/// The core's sentence for impossible lengths or marks on one spot.
#[wasm_bindgen(js_name = rulerScale)]
pub fn ruler_scale(
    marks: &[f64],
    length: f64,
    source_to_detector: f64,
    source_to_ruler: f64,
) -> Result<Vec<f64>, JsError> {
    let &[a, b, c, d] = marks else {
        return Err(JsError::new("a ruler has two marks"));
    };
    let found = scale(
        [[a, b], [c, d]],
        length,
        source_to_detector,
        source_to_ruler,
    )
    .map_err(sentence)?;
    Ok(vec![found.length_px, found.pitch_mm, found.focal_px])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_covered_moves_with_the_frame() {
        let (width, height) = (5, 3);
        let ends = vec![1, 3, 9, 11];
        let behind = Covered::new(ends, 15).unwrap();
        // Each pixel shows the one to its right; those of the last column, and one more, show none.
        let place = |number: usize| match number {
            7 => [f32::NAN; 2],
            _ => [(number % width) as f32 + 1.5, (number / width) as f32 + 0.5],
        };
        let map: Vec<[f32; 2]> = (0..15).map(place).collect();
        let moved = Covered::new(covered(&behind, &map, width, height), 15).unwrap();
        for number in 0..15 {
            let is_shown = number % width + 1 < width && number != 7;
            let due = is_shown && behind.has(number + 1);
            assert_eq!(moved.has(number), due, "{number}");
        }
    }
}
