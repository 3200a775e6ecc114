//! A knee whose lowest points are known exactly, and random numbers.

use std::vec::Vec;

use crate::math::{Vector3, add, apply, multiply, rotation_by, sin_cos, sqrt, subtract};
use crate::mesh::Mesh;
use crate::mesh::edges::fake;
use crate::pose::covariance::{Matrix6, PoseCovariance};
use crate::pose::{EulerPose, Pose};

/// Vertices and triangles.
#[derive(Clone, Default)]
pub(crate) struct Parts {
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Parts {
    pub(crate) fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).expect("valid")
    }

    /// The same in other axes: what a file with these would hold.
    pub(crate) fn in_axes(&self, model_from_field: &Pose) -> Self {
        let place = |vertex: &[f32; 3]| {
            let moved = model_from_field.transform(&vertex.map(f64::from));
            moved.map(|x| x as f32)
        };
        Self {
            vertices: self.vertices.iter().map(place).collect(),
            triangles: self.triangles.clone(),
        }
    }

    pub(crate) fn add_box(&mut self, low: [f32; 3], high: [f32; 3]) {
        fake::add_box(low, high, &mut self.vertices, &mut self.triangles);
    }

    fn add_sphere(&mut self, middle: [f64; 3], radius: f64, rings: u32) {
        let first = self.vertices.len() as u32;
        let around = 2 * rings;
        for ring in 0..=rings {
            let (ring_radius, along) =
                sin_cos(core::f64::consts::PI * f64::from(ring) / f64::from(rings));
            for step in 0..around {
                let (y, x) = sin_cos(core::f64::consts::TAU * f64::from(step) / f64::from(around));
                let unit = [ring_radius * x, ring_radius * y, along];
                let at: [f64; 3] = core::array::from_fn(|k| middle[k] + radius * unit[k]);
                self.vertices.push(at.map(|x| x as f32));
            }
        }
        for ring in 0..rings {
            for step in 0..around {
                let at = |ring: u32, step: u32| first + ring * around + step % around;
                let [a, b] = [at(ring, step), at(ring, step + 1)];
                let [c, d] = [at(ring + 1, step), at(ring + 1, step + 1)];
                self.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
    }
}

pub(crate) const RADIUS: f64 = 20.0;
pub(crate) const ACROSS: f64 = 24.0;

/// Two condyles: balls of 20 mm about (2, -1, 24) and (2, -1, -24), x anterior and y superior.
pub(crate) fn femur() -> Parts {
    let mut parts = Parts::default();
    for z in [-ACROSS, ACROSS] {
        parts.add_sphere([2.0, -1.0, z], RADIUS, 48);
    }
    parts
}

/// A plate from -25 to 25 (anterior), -38 to 38 (across), its upper side at 4 mm, with a small rim and a keel.
pub(crate) fn tray() -> Parts {
    let mut parts = Parts::default();
    parts.add_box([-25.0, 0.0, -38.0], [25.0, 4.0, 38.0]);
    parts.add_box([-25.0, 4.0, -38.0], [-24.0, 6.0, 38.0]);
    parts.add_box([-8.0, -40.0, -5.0], [6.0, 0.0, 5.0]);
    parts
}

pub(crate) fn pose(place: [f64; 3], [z_rot_deg, x_rot_deg, y_rot_deg]: [f64; 3]) -> Pose {
    let [x_mm, y_mm, z_mm] = place;
    Pose::from(EulerPose {
        x_mm,
        y_mm,
        z_mm,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    })
}

/// Numbers without a pattern (splitmix64), normally distributed.
pub(crate) struct Normal(pub(crate) u64);

impl Normal {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn next(&mut self) -> f64 {
        let (radius, turn) = (self.unit(), self.unit());
        let length = sqrt(-2.0 * crate::math::ln(1.0 - radius));
        length * sin_cos(core::f64::consts::TAU * turn).0
    }

    pub(crate) fn some<const N: usize>(&mut self) -> [f64; N] {
        core::array::from_fn(|_| self.next())
    }
}

/// A factor of a covariance as single-plane poses have it, turns in radians and shifts in mm: depth is the worst known.
pub(crate) fn factor(depth_mm: f64) -> Matrix6 {
    let mut factor = [[0.0; 6]; 6];
    let deviations = [0.006, 0.008, 0.003, 0.1, 0.1, depth_mm];
    for (k, deviation) in deviations.into_iter().enumerate() {
        factor[k][k] = deviation;
    }
    factor[5][0] = 0.4 * depth_mm;
    factor[3][1] = 0.05;
    factor[1][0] = -0.002;
    factor
}

pub(crate) fn times(factor: &Matrix6, unit: &[f64; 6]) -> [f64; 6] {
    factor.map(|row| row.iter().zip(unit).map(|(a, b)| a * b).sum())
}

pub(crate) fn covariance(factor: &Matrix6) -> PoseCovariance {
    PoseCovariance {
        matrix: core::array::from_fn(|a| {
            core::array::from_fn(|b| (0..6).map(|k| factor[a][k] * factor[b][k]).sum())
        }),
    }
}

/// A pose after a step of its rotation about a middle, radians, and of its place, mm.
pub(crate) fn moved(pose: &Pose, middle: &Vector3, step: &[f64; 6]) -> Pose {
    let [a, b, c, shift @ ..] = *step;
    let rotation = multiply(&rotation_by(&[a, b, c]), &pose.rotation);
    let place = add(&pose.transform(middle), &shift);
    Pose {
        rotation,
        translation: subtract(&place, &apply(&rotation, middle)),
    }
}
