//! Image formation: what an X-ray film of a replaced knee looks like, from known poses.
//!
//! Along each ray from the focus the attenuation of skin, muscle, bone and metal is added up (Beer and Lambert);
//! scatter, focal-spot blur, quantum noise, detector blur and a logarithmic display follow. Implant edges come from the core's
//! rasteriser, sampled 4 x 4 times in a pixel, so they agree with the silhouettes of the same poses. Anatomy is
//! drawn in the sagittal plane of the bone that carries it: outlines are tables, thickness across is that of a rounded tube.
//!
//! Nothing here is measured from a patient, and no distance in the picture means anything but the implants' poses.

mod anatomy;
mod detector;
mod metal;
pub mod motion;
mod plane;
mod sagittal;
mod texture;
mod tissue;
mod tube;

use crate::implant::{Side, Triangles};
use crate::pipeline::files::MaskBuffer;
use anyhow::{Result, anyhow};
use fluoropose::camera::Camera;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use plane::Plane;
use rayon::prelude::*;
use sagittal::{Sagittal, ray};

/// An implant where it is.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// Its mesh, mm.
    pub mesh: &'a Triangles,
    /// `camera_from_model`.
    pub pose: Pose,
}

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

/// The true silhouette of an implant at the camera's own sampling: the core rasteriser's.
///
/// # Errors
/// When the implant lies behind the focus, or is not a usable mesh.
pub fn silhouette(camera: &Camera, placed: &Placed<'_>) -> Result<MaskBuffer> {
    let mesh = Model::from_triangles(&placed.mesh.vertices, &placed.mesh.triangles)?;
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    let mut buffer = MaskBuffer::new(camera.width(), camera.height())?;
    buffer
        .draw(|mask| render(&mesh, camera, &placed.pose, &mut scratch, mask))
        .map_err(|error| anyhow!("an implant of the scene cannot be drawn: {error}"))?;
    Ok(buffer)
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
