//! Bead grids found in pictures, and the correction of distortion that they give. For workers: it takes a second.

use fluoropose::image::frame::{Frame, Pixel};
use fluoropose_distortion::automatic::{DistortionGrid, distortion_grid};
use fluoropose_distortion::correction::{Corrected, fit};
use fluoropose_distortion::lattice::Bead;
use wasm_bindgen::prelude::*;

use fluoropose_page::distortion::beads_of;
use fluoropose_page::error::sentence;

/// The beads of a grid that was found in a picture.
#[wasm_bindgen]
pub struct BeadGrid {
    found: DistortionGrid,
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
        let radius = (radius != 0.0).then_some(radius);
        let (found, beads) = distortion_grid(&frame, bright, radius).map_err(sentence)?;
        Ok(Self { found, beads })
    }
}

fn flat(beads: &[Bead]) -> Vec<f64> {
    let numbered = beads.iter().filter_map(|bead| Some((bead.at, bead.index?)));
    numbered
        .flat_map(|(at, index)| [at[0], at[1], index[0].into(), index[1].into()])
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
            lattice,
            ..
        } = &self.corrected;
        let beads = self.beads.iter();
        let all = beads.filter_map(|bead| {
            let before = lattice.residual(bead)?;
            let after =
                lattice.residual(&Bead::new(distortion.undistorted(bead.at), bead.index))?;
            Some([bead.at, before, after])
        });
        all.flatten().flatten().collect()
    }

    /// The beads (four numbers each) where the correction puts them.
    #[wasm_bindgen(getter, js_name = undistortedBeads)]
    pub fn undistorted_beads(&self) -> Vec<f64> {
        let distortion = &self.corrected.distortion;
        let moved = self.beads.iter();
        let moved: Vec<Bead> = moved
            .map(|bead| Bead::new(distortion.undistorted(bead.at), bead.index))
            .collect();
        flat(&moved)
    }
}
