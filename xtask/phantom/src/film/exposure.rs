//! One frame: everything along each ray added up, then developed.

use super::placed::Placed;
use super::plane::Plane;
use super::sagittal::{Sagittal, ray};
use super::{detector, metal, tissue};
use crate::implant::Side;
use anyhow::Result;
use fluoropose::camera::Camera;
use rayon::prelude::*;

/// What stands between focus and detector.
pub struct Scene<'a> {
    /// The X-ray camera.
    pub camera: Camera,
    /// Which knee.
    pub side: Side,
    /// Mediolateral width of the implants in mm; the anatomy scales with it.
    pub width_mm: f64,
    /// The femoral component, of cobalt-chromium.
    pub femur: Placed<'a>,
    /// The tibial tray, of titanium.
    pub tibia: Placed<'a>,
}

/// Linear attenuation of the implants' alloys at the beam's mean energy, per mm.
const COBALT_CHROMIUM: f64 = 0.72;
const TITANIUM: f64 = 0.2;

/// Exposes one 8-bit frame, row by row. The same seed and frame number give the same noise.
///
/// # Errors
/// When an implant cannot be projected (behind the focus), or is not a usable mesh.
pub fn expose(scene: &Scene<'_>, seed: u64, frame: u64) -> Result<Vec<u8>> {
    let mut primary = soft_and_bone(scene, seed);
    for (placed, density) in [(&scene.femur, COBALT_CHROMIUM), (&scene.tibia, TITANIUM)] {
        metal::shade(&mut primary, &scene.camera, placed, density)?;
    }
    Ok(detector::develop(primary, seed, frame))
}

/// Transmission through everything but metal.
fn soft_and_bone(scene: &Scene<'_>, seed: u64) -> Plane {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let scale = scene.width_mm / 70.0;
    let femur = Sagittal::new(&scene.femur.pose, scene.side, scale);
    let tibia = Sagittal::new(&scene.tibia.pose, scene.side, scale);
    let knee = tissue::Knee::new(&femur, &tibia, seed);
    let mut values = vec![0.0; width * height];
    values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(row, pixels)| {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let ray = ray(&scene.camera, column as f64 + 0.5, row as f64 + 0.5);
                let attenuation = knee.attenuation(femur.locate(&ray), tibia.locate(&ray));
                *pixel = libm::exp(-scale * attenuation);
            }
        });
    Plane {
        width,
        height,
        values,
    }
}
