//! Vertices in perspective: where each lies in the image, in fixed point.

use thiserror::Error;

use crate::camera::Camera;
use crate::image::contour::Point;
use crate::image::scan::FixedPoint;
use crate::math::{Vector3, dot};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::{Bounds, Mesh};
use crate::pose::Pose;
use crate::render::reach::Reach;
use crate::render::whole::{WORTH_IT, WholeImages};

/// Why a model cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

/// The images of those vertices that are asked for. Each is made once where there is a slot for each vertex; where there are
/// fewer, several vertices have one slot in turn, and an image that has made way for another is made again.
pub(crate) struct Images<'i> {
    camera: &'i Camera,
    pose: &'i Pose,
    bounds: Bounds,
    /// Where it is known already.
    reach: Option<Reach>,
    /// Made where it is first wanted.
    whole: Option<Option<WholeImages>>,
    vertices: &'i [[f32; 3]],
    slots: &'i mut [Projected],
    /// Of slots that are for several vertices: whose image each holds, four in one place of memory.
    owners: &'i mut [Projected],
}

/// Slots whose owners are kept in one place of memory.
const OWNERS: usize = 4;

impl<'i> Images<'i> {
    /// Images in borrowed memory, none of which is made. All vertices must have images.
    pub(crate) fn new(
        mesh: &Mesh<'i>,
        camera: &'i Camera,
        pose: &'i Pose,
        memory: &'i mut [Projected],
    ) -> Self {
        memory.fill(FixedPoint::NONE);
        Self::left(mesh, camera, pose, memory)
    }

    /// The same of a surface of which it is known how far it reaches.
    pub(super) fn reaching(mut self, reach: Reach) -> Self {
        self.reach = Some(reach);
        self
    }

    /// Images as they were left in memory, at the same pose.
    pub(crate) fn left(
        mesh: &Mesh<'i>,
        camera: &'i Camera,
        pose: &'i Pose,
        memory: &'i mut [Projected],
    ) -> Self {
        let vertices = mesh.vertices();
        let slots = match memory.len() {
            few if few < vertices.len() => few * OWNERS / (OWNERS + 1),
            _ => vertices.len(),
        };
        let (slots, owners) = memory.split_at_mut_checked(slots).unwrap_or_default();
        Self {
            camera,
            pose,
            bounds: mesh.bounds(),
            reach: None,
            whole: None,
            vertices,
            slots,
            owners,
        }
    }

    /// Makes the images of all vertices, several side by side, where there is a slot for each.
    ///
    /// # Errors
    /// [`RenderError::BehindCamera`] where a vertex has none.
    pub(crate) fn make_all(&mut self) -> Result<(), RenderError> {
        let mut all = self.slots.len() == self.vertices.len();
        if all {
            for (slot, place) in self.slots.iter_mut().zip(self.vertices) {
                let (point, inside) = image_of(self.camera, self.pose, place);
                *slot = point;
                all &= inside;
            }
        }
        match all {
            true => Ok(()),
            false => check_images(self.vertices, self.camera, self.pose),
        }
    }

    /// The images of all vertices, where each has a slot and all were made.
    pub(crate) fn all(&self) -> Option<&[Projected]> {
        (self.slots.len() == self.vertices.len()).then_some(&*self.slots)
    }

    /// The vertices in model coordinates, mm.
    pub(crate) fn vertices(&self) -> &'i [[f32; 3]] {
        self.vertices
    }

    pub(crate) fn of(&mut self, vertex: u32) -> Projected {
        let vertex = vertex as usize;
        if self.slots.len() < self.vertices.len() {
            let at = Shared::of(vertex, self.slots.len());
            return at.image(self.slots, self.owners).unwrap_or_else(|| {
                let image = self.made(vertex);
                at.keep(image, self.slots, self.owners);
                image
            });
        }
        match self.slots.get(vertex) {
            Some(&image) if image != FixedPoint::NONE => image,
            _ => {
                let image = self.made(vertex);
                if let Some(slot) = self.slots.get_mut(vertex) {
                    *slot = image;
                }
                image
            }
        }
    }

    fn made(&mut self, vertex: usize) -> Projected {
        // Indices were checked when the mesh was made.
        let Some(place) = self.vertices.get(vertex) else {
            return FixedPoint::NONE;
        };
        let (camera, pose, bounds) = (self.camera, self.pose, &self.bounds);
        let make = || {
            let reach = self.reach.unwrap_or_else(|| Reach::of(bounds, pose));
            WholeImages::new(camera, pose, bounds, &reach)
        };
        let whole = match WORTH_IT {
            true => self.whole.get_or_insert_with(make).as_ref(),
            false => None,
        };
        whole
            .and_then(|whole| whole.of(place))
            .unwrap_or_else(|| image_of(camera, pose, place).0)
    }
}

/// The slot of a vertex that is not the only one to use it.
struct Shared {
    slot: usize,
    owner: usize,
}

impl Shared {
    fn of(vertex: usize, slots: usize) -> Self {
        Self {
            slot: vertex.checked_rem(slots).unwrap_or(0),
            owner: vertex.checked_div(slots).unwrap_or(0),
        }
    }

    /// The image of the vertex, where the slot holds it.
    fn image(&self, slots: &[Projected], owners: &[Projected]) -> Option<Projected> {
        let owner = owners.get(self.slot / OWNERS)?.quarter(self.slot);
        let image = *slots.get(self.slot)?;
        let is_own = usize::from(owner) == self.owner && image != FixedPoint::NONE;
        is_own.then_some(image)
    }

    /// Takes the slot; an owner whose number is too large for its bits does not.
    fn keep(&self, image: Projected, slots: &mut [Projected], owners: &mut [Projected]) {
        let (owner, slot) = (owners.get_mut(self.slot / OWNERS), slots.get_mut(self.slot));
        if let (Some(owner), Some(slot), Ok(own)) = (owner, slot, u16::try_from(self.owner)) {
            owner.set_quarter(self.slot, own);
            *slot = image;
        }
    }
}

/// Refuses a pose at which a vertex has no image.
///
/// # Errors
/// [`RenderError::BehindCamera`] with the first of them.
pub(crate) fn check_images(
    vertices: &[[f32; 3]],
    camera: &Camera,
    pose: &Pose,
) -> Result<(), RenderError> {
    let beyond = |vertex| !image_of(camera, pose, vertex).1;
    match vertices.iter().position(beyond) {
        Some(first) => Err(RenderError::BehindCamera(first)),
        None => Ok(()),
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
    let slots = first(VERTICES, mesh.vertices().len(), scratch)?;
    Images::left(mesh, camera, pose, slots).make_all()?;
    Ok(slots)
}

/// The image of a vertex, and whether it has one. Without a branch: several at once.
#[inline(always)]
pub(super) fn image_of(camera: &Camera, pose: &Pose, vertex: &[f32; 3]) -> (FixedPoint, bool) {
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
