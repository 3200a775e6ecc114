//! The lowest point of either condyle above a tray's plate.
//!
//! Not where the components touch: an insert lies between them, which X-rays do not show. With its shape one could tell; the
//! lowest points are what is published without.

use crate::joint::plate::Plate;
use crate::math::{Vector3, add, cross, dot, norm, scale, subtract};
use crate::memory::{TooLittleMemory, check_length};
use crate::mesh::Mesh;
use crate::pose::Pose;

/// The place of a lowest point is the middle of the surface that lies within this of its height, mm: of a mesh's facets the
/// lowest vertex jumps by their size, and along a condyle that is straight across it would jump from side to side.
pub const CAP_MM: f64 = 0.1;

/// Triangles that lie this much higher, mm, are not looked at again when the pose is moved for its derivatives: a step of
/// [`super::relative`] moves a condyle by a tenth of that.
const NEAR_MM: f64 = 2.0;

/// The lowest point of a condyle, in the plate's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LowestPoint {
    /// In front of the middle of the plate, mm.
    pub anterior_mm: f64,
    /// To medial of the middle of the plate, mm.
    pub medial_mm: f64,
    /// Above the plate, mm.
    pub height_mm: f64,
}

/// Both condyles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Condyles {
    /// Of the half of the femoral component to medial of its middle.
    pub medial: LowestPoint,
    /// Of the other half.
    pub lateral: LowestPoint,
}

impl Condyles {
    /// How much higher the lateral condyle is, mm; negative where the medial one is. That is lift-off for an insert that is
    /// equally thick on both sides.
    #[must_use]
    pub fn lift_off_mm(&self) -> f64 {
        self.lateral.height_mm - self.medial.height_mm
    }
}

/// Probability that the magnitude of a normally distributed number is beyond a threshold; NaN where number or deviation is.
#[must_use]
pub fn probability_beyond(value: f64, deviation: f64, threshold: f64) -> f64 {
    let tail = |distance: f64| 0.5 * libm::erfc(distance / (deviation * core::f64::consts::SQRT_2));
    if deviation == 0.0 && !value.is_nan() {
        f64::from(u8::from(value.abs() > threshold))
    } else {
        tail(threshold - value) + tail(threshold + value)
    }
}

/// A femoral component above a plate.
#[derive(Clone, Copy, Debug)]
pub struct Above<'m> {
    mesh: Mesh<'m>,
    /// `joint_from_model` of the femoral component.
    joint_from_model: Pose,
    /// Between the halves, along z of the joint axes, mm.
    middle: f64,
    plate: Plate,
}

impl<'m> Above<'m> {
    /// A femoral component in its joint axes (`model_from_joint`) above a plate.
    #[must_use]
    pub fn new(mesh: Mesh<'m>, axes: &Pose, plate: Plate) -> Self {
        let joint_from_model = axes.inverse();
        let across = mesh.vertices().iter().map(|vertex| {
            let [.., z] = joint_from_model.transform(&vertex.map(f64::from));
            z
        });
        let (low, high) = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(z), high.max(z))
        });
        Self {
            mesh,
            joint_from_model,
            middle: (low + high) / 2.0,
            plate,
        }
    }

    /// How many numbers of triangles [`Self::near`] may need.
    #[must_use]
    pub fn memory_needed(&self) -> usize {
        self.mesh.triangles().len()
    }

    /// The triangles that may hold the lowest points at a pose (`tibia_from_femur`, in joint axes) and where it is moved by
    /// less than a degree or a millimetre.
    ///
    /// # Errors
    /// [`TooLittleMemory`] for fewer than [`Self::memory_needed`].
    pub fn near<'n>(
        &self,
        pose: &Pose,
        memory: &'n mut [u32],
    ) -> Result<&'n [u32], TooLittleMemory> {
        check_length("numbers of triangles", self.memory_needed(), memory.len())?;
        let from_model = self.plate_from_model(pose);
        let all = 0..self.mesh.triangles().len() as u32;
        let lowest = self.heights(&from_model, all.clone());
        let mut count = 0;
        for triangle in all {
            let height = self.height(&from_model, triangle);
            let most = lowest[0].max(lowest[1]) + NEAR_MM;
            if height < most && height < lowest[self.half(triangle)] + NEAR_MM {
                memory[count] = triangle;
                count += 1;
            }
        }
        Ok(&memory[..count])
    }

    /// The lowest points at a pose, of these triangles: all of the mesh, or those that are [`Self::near`]. A half without
    /// triangles has NaN.
    pub fn lowest_points(
        &self,
        pose: &Pose,
        triangles: impl Iterator<Item = u32> + Clone,
    ) -> Condyles {
        let from_model = self.plate_from_model(pose);
        let heights = self.heights(&from_model, triangles.clone());
        let mut caps = [Cap::default(); 2];
        for triangle in triangles {
            let half = self.half(triangle);
            let below = heights[half] + CAP_MM;
            if self.height(&from_model, triangle) < below {
                let corners = self.corners(triangle);
                caps[half].add(&corners.map(|corner| from_model.transform(&corner)), below);
            }
        }
        let point = |half: usize| {
            let [x, _, z] = caps[half].middle();
            LowestPoint {
                anterior_mm: self.plate.side.forward() * x,
                medial_mm: z,
                height_mm: Some(heights[half])
                    .filter(|height| height.is_finite())
                    .unwrap_or(f64::NAN),
            }
        };
        Condyles {
            medial: point(0),
            lateral: point(1),
        }
    }

    fn plate_from_model(&self, pose: &Pose) -> Pose {
        let from_femur = self.plate.from_tibia.compose(pose);
        from_femur.compose(&self.joint_from_model)
    }

    fn corners(&self, triangle: u32) -> [Vector3; 3] {
        let vertices = self.mesh.vertices();
        self.mesh.triangles()[triangle as usize]
            .map(|vertex| vertices[vertex as usize].map(f64::from))
    }

    /// The half that a triangle belongs to: 0 for the medial one.
    fn half(&self, triangle: u32) -> usize {
        let [a, b, c] = self.corners(triangle);
        let middle = scale(&add(&add(&a, &b), &c), 1.0 / 3.0);
        let [.., across] = &self.joint_from_model.rotation;
        let z = dot(across, &middle) + self.joint_from_model.translation[2];
        usize::from(z < self.middle)
    }

    /// How low a triangle reaches above the plate: the one of a corner's three coordinates that is asked for of all of them.
    fn height(&self, from_model: &Pose, triangle: u32) -> f64 {
        let [_, up, _] = &from_model.rotation;
        let [a, b, c] = self.corners(triangle).map(|corner| dot(up, &corner));
        a.min(b).min(c) + from_model.translation[1]
    }

    /// The lowest height of either half.
    fn heights(&self, from_model: &Pose, triangles: impl Iterator<Item = u32>) -> [f64; 2] {
        let mut heights = [f64::INFINITY; 2];
        for triangle in triangles {
            // Most triangles are too high for either half, and which one they belong to is not asked.
            let height = self.height(from_model, triangle);
            if height < heights[0].max(heights[1]) {
                let half = self.half(triangle);
                heights[half] = heights[half].min(height);
            }
        }
        heights
    }
}

/// The part of a surface below a height: its area, and its first moment.
#[derive(Clone, Copy, Default)]
struct Cap {
    area: f64,
    moment: Vector3,
}

impl Cap {
    /// Adds the part of a triangle that lies below a height.
    fn add(&mut self, corners: &[Vector3; 3], below: f64) {
        let mut cut = heapless::Vec::<Vector3, 4>::new();
        for (k, corner) in corners.iter().enumerate() {
            let next = &corners[(k + 1) % 3];
            if corner[1] < below {
                let _ = cut.push(*corner);
            }
            if (corner[1] < below) != (next[1] < below) {
                let part = (below - corner[1]) / (next[1] - corner[1]);
                let _ = cut.push(add(corner, &scale(&subtract(next, corner), part)));
            }
        }
        for pair in cut.windows(2).skip(1) {
            self.add_triangle(&[cut[0], pair[0], pair[1]]);
        }
    }

    fn add_triangle(&mut self, [a, b, c]: &[Vector3; 3]) {
        let area = norm(&cross(&subtract(b, a), &subtract(c, a)));
        self.area += area;
        let sum = add(&add(a, b), c);
        self.moment = add(&self.moment, &scale(&sum, area / 3.0));
    }

    fn middle(&self) -> Vector3 {
        scale(&self.moment, 1.0 / self.area)
    }
}

#[cfg(test)]
mod tests;
