//! The plane that brings a surface's reflection nearest to the surface.

use super::nearest::{Foot, feet, feet_on_tangents};
use super::sample::{SAMPLES, Samples};
use crate::math::{Matrix3, Vector3, add, cross, dot, norm, scale, solve_spd};
use crate::mesh::surface::Mesh;

/// A plane relative to the samples' origin: `normal . x = offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Unit normal.
    pub(super) normal: Vector3,
    /// Distance from the origin along it, mm.
    pub(super) offset: f64,
}

/// A plane and how well it does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    pub(super) plane: Plane,
    /// Mean square distance of the reflected surface from the surface, square mm.
    pub(super) squared: f64,
}

/// Damping of the first step, and the factor by which it grows and falls.
const DAMPING: f64 = 1e-3;
const DAMPING_FACTOR: f64 = 10.0;
/// Steps end where the mean square falls by less than this part of it, or, while it is above what
/// is wanted, by less than that part.
const FLAT: f64 = 1e-3;
const SLOW: f64 = 0.05;
/// Steps end below this turn, radians, and shift, parts of the size.
const STILL: f64 = 1e-4;
/// Below this part of the size a deviation is the rounding of the vertices.
const EXACT: f64 = 1e-7;

/// What a plane is fitted to.
pub(super) struct Target<'a> {
    pub(super) samples: &'a Samples,
    /// The whole surface; without it the tangent planes of the samples stand for it, which is
    /// coarse but costs next to nothing.
    pub(super) surface: Option<&'a Mesh<'a>>,
}

impl Target<'_> {
    /// Where the mirror images of the samples come to lie; their mean square distance.
    fn measure(&self, plane: &Plane, found: &mut [Foot; SAMPLES]) -> f64 {
        let height = |point: &Vector3| dot(&plane.normal, point) - plane.offset;
        let image = |point: Vector3| add(&point, &scale(&plane.normal, -2.0 * height(&point)));
        let images = self.samples.points.map(image);
        match self.surface {
            Some(mesh) => feet(mesh, self.samples, &images, found),
            None => feet_on_tangents(self.samples, &images, found),
        }
        found.iter().map(|foot| foot.squared).sum::<f64>() / SAMPLES as f64
    }

    /// Fits a plane from `start` in at most `passes` damped Gauss-Newton steps. They end early
    /// where they do not lead quickly below the root mean square distance `wanted`, mm.
    ///
    /// Distances are those along the way to the nearest point, so points may slide along the
    /// surface and few steps suffice (Chen and Medioni, Image Vision Comput. 10, 1992).
    pub(super) fn fit(&self, start: Plane, passes: usize, wanted: f64) -> Fitted {
        let mut found = [Foot::NONE; SAMPLES];
        let mut trial = [Foot::NONE; SAMPLES];
        let squared = self.measure(&start, &mut found);
        let mut best = Fitted {
            plane: start,
            squared,
        };
        let exact = EXACT * self.samples.size;
        let mut damping = DAMPING;
        for _ in 0..passes {
            if best.squared < exact * exact {
                break;
            }
            let Some((plane, length)) = self.step(&best.plane, &found, damping) else {
                break;
            };
            let squared = self.measure(&plane, &mut trial);
            let gain = best.squared - squared;
            if gain > 0.0 {
                best = Fitted { plane, squared };
                found = trial;
                damping /= DAMPING_FACTOR;
            } else {
                damping *= DAMPING_FACTOR;
            }
            let least = if squared > wanted * wanted {
                SLOW
            } else {
                FLAT
            };
            if length < STILL || (0.0..least * squared).contains(&gain) {
                break;
            }
        }
        best
    }

    /// The next plane and the length of the step that leads to it: turn and relative shift.
    fn step(&self, plane: &Plane, found: &[Foot; SAMPLES], damping: f64) -> Option<(Plane, f64)> {
        let (first, second) = tangents(&plane.normal);
        let size = self.samples.size;
        let mut normal_matrix: Matrix3 = [[0.0; 3]; 3];
        let mut gradient = [0.0; 3];
        for (point, foot) in self.samples.points.iter().zip(found) {
            let height = dot(&plane.normal, point) - plane.offset;
            let facing = dot(&foot.direction, &plane.normal);
            let turn =
                |to: &Vector3| -2.0 * (height * dot(&foot.direction, to) + dot(point, to) * facing);
            let row = [turn(&first), turn(&second), 2.0 * facing * size];
            for (sums, value) in normal_matrix.iter_mut().zip(row) {
                *sums = add(sums, &scale(&row, value));
            }
            gradient = add(&gradient, &scale(&row, -foot.along));
        }
        // A body of revolution leaves a turn open; the floor keeps such a turn at zero.
        let trace = (0..3).map(|k| normal_matrix[k][k]).sum::<f64>();
        for (k, row) in normal_matrix.iter_mut().enumerate() {
            row[k] += damping * row[k] + 1e-9 * trace;
        }
        let [a, b, shift] = solve_spd(normal_matrix, gradient)?;
        let moved = add(&plane.normal, &add(&scale(&first, a), &scale(&second, b)));
        let next = Plane {
            normal: scale(&moved, 1.0 / norm(&moved)),
            offset: plane.offset + shift * size,
        };
        Some((next, norm(&[a, b, shift])))
    }
}

/// Two unit vectors perpendicular to a unit normal and to each other.
pub(super) fn tangents(normal: &Vector3) -> (Vector3, Vector3) {
    let flattest = (1..3).fold(0, |best, k| {
        if normal[k].abs() < normal[best].abs() {
            k
        } else {
            best
        }
    });
    let mut axis = [0.0; 3];
    axis[flattest] = 1.0;
    let first = cross(normal, &axis);
    let first = scale(&first, 1.0 / norm(&first));
    (first, cross(normal, &first))
}
