//! One frame: everything along each ray added up, then developed.

use super::beam::{Line, lines};
use super::cement::mantle;
use super::metal::Shadow;
use super::physics::{Physics, Sampling};
use super::placed::Placed;
use super::plane::Plane;
use super::sagittal::{Sagittal, ray};
use super::{detector, ruler, screws, tissue};
use crate::implant::Side;
use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::pose::Pose;
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

/// How much farther from the focus than this leg the other one is, mm.
const BEHIND: f64 = 140.0;

/// Exposes one 8-bit frame, row by row. The same seed and frame number give the same noise.
///
/// # Errors
/// When an implant cannot be projected (behind the focus), or is not a usable mesh.
pub fn expose(scene: &Scene<'_>, physics: &Physics, seed: u64, frame: u64) -> Result<Vec<u8>> {
    let mut tissue = soft_and_bone(scene, [0.0; 3], seed);
    if let Some(aside) = physics.surroundings.second_leg_mm {
        let other = soft_and_bone(scene, [aside, 8.0, -BEHIND], seed.wrapping_add(1));
        tissue.multiply(&other);
    }
    if physics.surroundings.ruler {
        ruler::lay(&mut tissue);
    }
    let shadows = shadows(scene, physics)?;
    let mut passed: Option<Plane> = None;
    for line in lines(physics.alloys.hardening) {
        let plane = through(&tissue, &shadows, &line)?;
        match &mut passed {
            None => passed = Some(plane.times(line.weight)),
            Some(sum) => sum.add(&plane.times(line.weight)),
        }
    }
    let passed = passed.unwrap_or(tissue);
    Ok(detector::develop(passed, physics, seed, frame))
}

/// The shadows of all metal and cement, each with its attenuation per mm.
fn shadows(scene: &Scene<'_>, physics: &Physics) -> Result<Vec<(Shadow, f64)>> {
    let (camera, sampling) = (&scene.camera, physics.sampling);
    let alloys = &physics.alloys;
    let mut all = Vec::new();
    for (placed, density) in [(&scene.femur, alloys.femur), (&scene.tibia, alloys.tibia)] {
        let mut density = density;
        if let Some(cement) = physics.surroundings.cement {
            let mantle = mantle(placed.mesh, scene.side, cement.thickness_mm);
            let around = Placed {
                mesh: &mantle,
                ..*placed
            };
            let shadow = Shadow::cast(
                camera,
                &around,
                Sampling {
                    least_path_mm: 0.0,
                    ..sampling
                },
            )?;
            all.push((shadow, cement.density));
            // The mantle's mesh holds the implant.
            density -= cement.density;
        }
        all.push((Shadow::cast(camera, placed, sampling)?, density));
    }
    if physics.surroundings.screws {
        for mesh in screws::pair(scene.side, scene.width_mm) {
            let placed = Placed {
                mesh: &mesh,
                ..scene.tibia
            };
            all.push((Shadow::cast(camera, &placed, sampling)?, alloys.tibia));
        }
    }
    Ok(all)
}

/// What passes of one line of the spectrum.
fn through(tissue: &Plane, shadows: &[(Shadow, f64)], line: &Line) -> Result<Plane> {
    let mut plane = match line.tissue == 1.0 {
        true => tissue.clone(),
        false => tissue.power(line.tissue),
    };
    for (shadow, density) in shadows {
        shadow.shade(&mut plane, density * line.metal)?;
    }
    Ok(plane)
}

/// Transmission through everything but metal, of a leg moved by so much (mm, camera's frame).
fn soft_and_bone(scene: &Scene<'_>, moved: [f64; 3], seed: u64) -> Plane {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let scale = scene.width_mm / 70.0;
    let plane = |placed: &Placed<'_>| {
        let pose = Pose {
            translation: std::array::from_fn(|k| placed.pose.translation[k] + moved[k]),
            ..placed.pose
        };
        Sagittal::new(&pose, scene.side, scale)
    };
    let (femur, tibia) = (plane(&scene.femur), plane(&scene.tibia));
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
