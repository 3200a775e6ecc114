//! An implant at its pose, and its silhouette.

use crate::implant::Triangles;
use anyhow::{Result, anyhow};
use fluoropose::camera::Camera;
use fluoropose::image::mask::{MaskMut, Word, words_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};

/// An implant where it is.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// Its mesh, mm.
    pub mesh: &'a Triangles,
    /// `camera_from_model`.
    pub pose: Pose,
}

/// The true silhouette of an implant at the camera's own sampling: the core rasteriser's,
/// as the words of a mask of the camera's size.
///
/// # Errors
/// When the implant lies behind the focus, or is not a usable mesh.
pub fn silhouette(camera: &Camera, placed: &Placed<'_>) -> Result<Vec<Word>> {
    let mesh = Model::from_triangles(&placed.mesh.vertices, &placed.mesh.triangles)?;
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    let (width, height) = (camera.width(), camera.height());
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height)?;
    render(&mesh, camera, &placed.pose, &mut scratch, &mut mask)
        .map_err(|error| anyhow!("an implant of the scene cannot be drawn: {error}"))?;
    Ok(words)
}
