//! An implant at its pose, and its silhouette.

use crate::implant::Triangles;
use anyhow::{Result, anyhow};
use fluoropose::camera::Camera;
use fluoropose::image::mask::{MaskMut, Word, words_needed};
use fluoropose::math::{add, multiply, rotation_by, scale};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use glam::{DMat3, DQuat, DVec3};

/// Moments of an exposure during which an implant moves.
const MOMENTS: usize = 5;

/// An implant where it is.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// Its mesh, mm.
    pub mesh: &'a Triangles,
    /// `camera_from_model` in the middle of the exposure.
    pub pose: Pose,
    /// How it moves meanwhile.
    pub motion: Motion,
}

/// A motion during an exposure, from its beginning to its end, in the camera's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Rotation vector about the model's origin, radians.
    pub turn: [f64; 3],
    /// Of the model's origin, mm.
    pub shift: [f64; 3],
}

impl Motion {
    /// A part of the motion from one pose to another.
    pub fn between(from: &Pose, to: &Pose, part: f64) -> Self {
        let matrix = |pose: &Pose| DMat3::from_cols_array_2d(&pose.rotation).transpose();
        let turn = DQuat::from_mat3(&(matrix(to) * matrix(from).transpose())).to_scaled_axis();
        let shift = DVec3::from(to.translation) - DVec3::from(from.translation);
        Self {
            turn: (turn * part).to_array(),
            shift: (shift * part).to_array(),
        }
    }
}

impl<'a> Placed<'a> {
    /// An implant that does not move.
    pub fn at_rest(mesh: &'a Triangles, pose: Pose) -> Self {
        Self {
            mesh,
            pose,
            motion: Motion::default(),
        }
    }

    /// Where the implant is at moments evenly spread over the exposure; one moment where it does not move.
    pub(super) fn moments(&self) -> Vec<Self> {
        if self.motion == Motion::default() {
            return vec![*self];
        }
        let at = |moment: usize| {
            let part = (moment as f64 + 0.5) / MOMENTS as f64 - 0.5;
            let turn = rotation_by(&scale(&self.motion.turn, part));
            let pose = Pose {
                rotation: multiply(&turn, &self.pose.rotation),
                translation: add(&self.pose.translation, &scale(&self.motion.shift, part)),
            };
            Self::at_rest(self.mesh, pose)
        };
        (0..MOMENTS).map(at).collect()
    }
}

/// The true silhouette of an implant in the middle of the exposure, at the camera's own sampling: the core rasteriser's,
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
