//! Vertices in perspective: where each lies in the image, in fixed point.

use thiserror::Error;

use crate::camera::Camera;
use crate::image::contour::Point;
use crate::image::scan::FixedPoint;
use crate::math::{Vector3, dot};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::Mesh;
use crate::pose::Pose;

/// Why a model cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RenderError {
    /// A vertex is on or behind the focus, or so near it that its image has no bounds.
    #[error(
        "vertex {0} of the model lies at or behind the X-ray focus, or its image is more than 131 072 pixels away; check the pose's z (negative, mm)"
    )]
    BehindCamera(usize),
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// The mask has another size than the camera's frame.
    #[error("the mask and the camera's frame differ in size")]
    Size,
}

/// What working memory of drawing holds.
pub(crate) const VERTICES: &str = "projected vertices";

/// Working memory of [`super::render()`], which needs [`super::scratch_needed`] of them: one projected vertex.
pub type Projected = FixedPoint;

/// The images of those vertices that are asked for, each made once.
pub(crate) struct Images<'i> {
    camera: &'i Camera,
    pose: &'i Pose,
    vertices: &'i [[f32; 3]],
    slots: &'i mut [Projected],
}

impl<'i> Images<'i> {
    /// Images in borrowed memory, a slot for each vertex. All vertices must have images.
    pub(crate) fn new(
        mesh: &Mesh<'i>,
        camera: &'i Camera,
        pose: &'i Pose,
        slots: &'i mut [Projected],
    ) -> Self {
        slots.fill(FixedPoint::NONE);
        Self {
            camera,
            pose,
            vertices: mesh.vertices(),
            slots,
        }
    }

    /// A vertex in model coordinates, mm; `None` where there is no such vertex.
    pub(crate) fn vertex(&self, vertex: u32) -> Option<&'i [f32; 3]> {
        self.vertices.get(vertex as usize)
    }

    pub(crate) fn of(&mut self, vertex: u32) -> Projected {
        // Indices were checked when the mesh was made.
        let vertex = vertex as usize;
        let (Some(slot), Some(place)) = (self.slots.get_mut(vertex), self.vertices.get(vertex))
        else {
            return FixedPoint::NONE;
        };
        if *slot == FixedPoint::NONE {
            *slot = image_of(self.camera, self.pose, place).0;
        }
        *slot
    }
}

/// Projects all vertices into borrowed memory and returns their images.
///
/// # Errors
/// [`RenderError::Scratch`] and [`RenderError::BehindCamera`].
pub(crate) fn project<'s>(
    mesh: &Mesh<'_>,
    camera: &Camera,
    pose: &Pose,
    scratch: &'s mut [Projected],
) -> Result<&'s [Projected], RenderError> {
    let images = first(VERTICES, mesh.vertices().len(), scratch)?;
    let mut all = true;
    for (vertex, image) in mesh.vertices().iter().zip(&mut *images) {
        let (point, inside) = image_of(camera, pose, vertex);
        *image = point;
        all &= inside;
    }
    if all {
        return Ok(images);
    }
    let beyond = |vertex| !image_of(camera, pose, vertex).1;
    let first = mesh.vertices().iter().position(beyond);
    Err(RenderError::BehindCamera(first.unwrap_or_default()))
}

/// The image of a vertex, and whether it has one. Without a branch: several at once.
#[inline(always)]
fn image_of(camera: &Camera, pose: &Pose, vertex: &[f32; 3]) -> (FixedPoint, bool) {
    let model: Vector3 = vertex.map(f64::from);
    let [x, y, z]: Vector3 =
        core::array::from_fn(|k| dot(&pose.rotation[k], &model) + pose.translation[k]);
    let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
    let nearness = -1.0 / z;
    let (point, inside) = FixedPoint::rounded(Point {
        column: cx + fx * x * nearness,
        row: cy - fy * y * nearness,
    });
    (point, inside & (z < 0.0))
}
