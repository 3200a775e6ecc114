//! Calibration from a bead grid or a ruler, and correction of distortion, for the page.

use fluoropose::frame::{Frame, Pixel};
use fluoropose::grid::automatic::{FoundGrid, MARKS, Memory, find_grid};
use fluoropose::grid::correction::{Corrected, fit};
use fluoropose::grid::discs::{Disc, sums_needed};
use fluoropose::grid::distortion::Distortion;
use fluoropose::grid::lattice::Bead;
use fluoropose::grid::plate::{Distances, camera};
use fluoropose::grid::resample::{map_row, resample_row};
use fluoropose::grid::ruler::scale;
use wasm_bindgen::prelude::*;

use crate::error::sentence;
use crate::film::Film;

/// The beads of a grid that was found in a picture.
#[wasm_bindgen]
pub struct BeadGrid {
    found: FoundGrid,
    beads: Vec<Bead>,
}

#[wasm_bindgen]
impl BeadGrid {
    /// Looks for a grid in 8-bit pixels. A radius (px) of 0 stands for any.
    ///
    /// # Errors
    /// The core's sentence when there is no grid or the shape does not fit the pixels.
    #[wasm_bindgen(js_name = inEightBit)]
    pub fn in_eight_bit(
        pixels: &[u8],
        width: u32,
        height: u32,
        radius: f64,
        bright: bool,
    ) -> Result<BeadGrid, JsError> {
        Self::search(pixels, width, height, radius, bright)
    }

    /// The same in 16-bit pixels.
    ///
    /// # Errors
    /// The core's sentence when there is no grid or the shape does not fit the pixels.
    #[wasm_bindgen(js_name = inSixteenBit)]
    pub fn in_sixteen_bit(
        pixels: &[u16],
        width: u32,
        height: u32,
        radius: f64,
        bright: bool,
    ) -> Result<BeadGrid, JsError> {
        Self::search(pixels, width, height, radius, bright)
    }

    /// Column, row, number to the right and number down of each bead of the lattice.
    #[wasm_bindgen(getter)]
    pub fn beads(&self) -> Vec<f64> {
        flat(&self.beads)
    }

    /// Round marks, those of no lattice too.
    #[wasm_bindgen(getter)]
    pub fn marks(&self) -> usize {
        self.found.marks
    }

    /// Radius of the beads, px.
    #[wasm_bindgen(getter, js_name = radiusPx)]
    pub fn radius_px(&self) -> f64 {
        self.found.radius_px
    }
}

impl BeadGrid {
    fn search<P: Pixel>(
        pixels: &[P],
        width: u32,
        height: u32,
        radius: f64,
        bright: bool,
    ) -> Result<BeadGrid, JsError> {
        let (width, height) = (width as usize, height as usize);
        let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
        let mut sums = vec![0; sums_needed(width, height)];
        let mut discs = vec![Disc::default(); MARKS];
        let mut beads = vec![Bead::default(); MARKS];
        let mut queue = vec![0; MARKS];
        let mut memory = Memory {
            sums: &mut sums,
            discs: &mut discs,
            beads: &mut beads,
            queue: &mut queue,
        };
        let radius = (radius != 0.0).then_some(radius);
        let found = find_grid(&frame, bright, radius, &mut memory).map_err(sentence)?;
        beads.truncate(found.marks);
        Ok(Self { found, beads })
    }
}

/// Four numbers a bead: column, row, number to the right, number down.
const PER_BEAD: usize = 4;

fn flat(beads: &[Bead]) -> Vec<f64> {
    let numbered = beads.iter().filter_map(|bead| Some((bead.at, bead.index?)));
    numbered
        .flat_map(|(at, index)| [at[0], at[1], index[0].into(), index[1].into()])
        .collect()
}

fn beads_of(flat: &[f64]) -> Vec<Bead> {
    flat.as_chunks::<PER_BEAD>()
        .0
        .iter()
        .map(|&[column, row, i, j]| Bead::new([column, row], Some([i as i32, j as i32])))
        .collect()
}

/// A correction of distortion with what tells how good it is.
#[wasm_bindgen]
pub struct DistortionFit {
    corrected: Corrected,
    beads: Vec<Bead>,
}

/// Fits a correction to beads (column, row, number to the right, number down each) of frames of this size.
///
/// # Errors
/// The core's sentence when the beads do not determine one.
#[wasm_bindgen(js_name = fitDistortion)]
pub fn fit_distortion(beads: &[f64], width: u32, height: u32) -> Result<DistortionFit, JsError> {
    let mut beads = beads_of(beads);
    let corrected = fit(&mut beads, (width as usize, height as usize)).map_err(sentence)?;
    Ok(DistortionFit { corrected, beads })
}

#[wasm_bindgen]
impl DistortionFit {
    /// The correction as the numbers that are stored.
    #[wasm_bindgen(getter)]
    pub fn numbers(&self) -> Vec<f64> {
        self.corrected.distortion.numbers().to_vec()
    }

    /// Beads used, beads dropped, residual before and after (px), cross-validated residuals of orders 3, 4 and 5 (px;
    /// NaN where there are too few beads), and the largest shift (px).
    #[wasm_bindgen(getter)]
    pub fn quality(&self) -> Vec<f64> {
        let Corrected {
            distortion,
            used,
            dropped,
            before_px,
            after_px,
            left_out_px,
            ..
        } = self.corrected;
        let [three, four, five] = left_out_px.map(|residual| residual.unwrap_or(f64::NAN));
        let largest = distortion.largest_shift_px();
        vec![
            used as f64,
            dropped as f64,
            before_px,
            after_px,
            three,
            four,
            five,
            largest,
        ]
    }

    /// Of each bead: its place, how far it lies from the straight lattice, and how far it still does once corrected;
    /// all as column and row, px.
    #[wasm_bindgen(getter)]
    pub fn residuals(&self) -> Vec<f64> {
        let Corrected {
            distortion,
            straight,
            ..
        } = &self.corrected;
        let beads = self.beads.iter();
        let all = beads.filter_map(|bead| {
            let before = straight.residual(bead)?;
            let after = straight.residual(&Bead::new(distortion.straight(bead.at), bead.index))?;
            Some([bead.at, before, after])
        });
        all.flatten().flatten().collect()
    }

    /// The beads (four numbers each) where the correction puts them.
    #[wasm_bindgen(getter, js_name = straightBeads)]
    pub fn straight_beads(&self) -> Vec<f64> {
        let distortion = &self.corrected.distortion;
        let moved = self.beads.iter();
        let moved: Vec<Bead> = moved
            .map(|bead| Bead::new(distortion.straight(bead.at), bead.index))
            .collect();
        flat(&moved)
    }
}

/// Applies a stored correction.
#[wasm_bindgen]
pub struct Straightener {
    distortion: Distortion,
    /// Where each pixel of the straight frame is in the frame as taken; made when the first frame is.
    map: Vec<[f32; 2]>,
}

#[wasm_bindgen]
impl Straightener {
    /// From the stored numbers.
    ///
    /// # Errors
    /// The core's sentence for numbers that are no correction.
    #[wasm_bindgen(constructor)]
    pub fn new(numbers: &[f64]) -> Result<Straightener, JsError> {
        let distortion = Distortion::from_numbers(numbers).map_err(sentence)?;
        Ok(Self {
            distortion,
            map: Vec::new(),
        })
    }

    /// Columns and rows of points, by turns, where they lie once straight.
    pub fn straight(&self, points: &[f64]) -> Vec<f64> {
        let points = points.as_chunks::<2>().0.iter();
        points
            .flat_map(|&point| self.distortion.straight(point))
            .collect()
    }

    /// The way back. A point that has no place near by in the picture as taken stays where it is.
    pub fn bent(&self, points: &[f64]) -> Vec<f64> {
        let points = points.as_chunks::<2>().0.iter();
        points
            .flat_map(|&point| self.distortion.bent(point).unwrap_or(point))
            .collect()
    }

    /// The straight frame of a frame as taken.
    ///
    /// # Errors
    /// A sentence when the frame has another size than the correction is for.
    pub fn film(&mut self, film: &Film) -> Result<Film, JsError> {
        let (width, height) = self.distortion.size();
        if film.size() != (width, height) {
            let (columns, rows) = film.size();
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
        match (film.eight_bit(), film.sixteen_bit()) {
            (Some(pixels), _) => {
                Film::from_eight_bit(resampled(&pixels, &self.map, width, height)?, columns, rows)
            }
            (_, pixels) => {
                let pixels = pixels.unwrap_or_default();
                Film::from_sixteen_bit(resampled(&pixels, &self.map, width, height)?, columns, rows)
            }
        }
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
                    .straight([column as f64 + 0.5, row as f64 + 0.5]);
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

/// The camera that took a bead plate: pixel pitch and its standard deviation (mm), principal point x and y from the
/// frame's middle (mm) and their standard deviations, 1 where the picture tells the principal point, tilt of the plate
/// (degrees), residual (px), beads used. Distances in mm: between beads, source to detector, source to plate.
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
