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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::add_box;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// The plane that is turned and moved by a step; the shift is a part of the size.
    fn stepped(plane: &Plane, [a, b, shift]: [f64; 3], size: f64) -> Plane {
        let (first, second) = tangents(&plane.normal);
        let moved = add(&plane.normal, &add(&scale(&first, a), &scale(&second, b)));
        Plane {
            normal: scale(&moved, 1.0 / norm(&moved)),
            offset: plane.offset + shift * size,
        }
    }

    /// A box of 60 x 20 x 40 mm in the middle of which the planes between its halves lie.
    fn with_box(
        look: impl Fn(&Mesh<'_>, &Samples) -> Result<(), TestCaseError>,
    ) -> Result<(), TestCaseError> {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        add_box(
            [-30.0, -10.0, -20.0],
            [30.0, 10.0, 20.0],
            &mut vertices,
            &mut triangles,
        );
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        look(&mesh, &Samples::new(&mesh).expect("it has an area"))
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Oracle: slopes of what a small step does to each mirrored point along the direction of its foot. Where the step ends the damped
        /// normal equations hold.
        #[test]
        fn a_step_is_that_of_gauss_and_newton(
            normal in prop::array::uniform3(-1.0..1.0f64), offset in -8.0..8.0f64, damping in prop_oneof![Just(0.0), 1e-3..10.0f64],
            is_exact in any::<bool>(),
        ) {
            prop_assume!(norm(&normal) > 0.1);
            let plane = Plane { normal: scale(&normal, 1.0 / norm(&normal)), offset };
            with_box(|mesh, samples| {
                let target = Target { samples, surface: is_exact.then_some(mesh) };
                let mut found = [Foot::NONE; SAMPLES];
                let squared = target.measure(&plane, &mut found);
                prop_assert!((found.iter().map(|foot| foot.along * foot.along).sum::<f64>() / SAMPLES as f64 - squared).abs() < 1e-6);
                let Some((next, length)) = target.step(&plane, &found, damping) else { return Ok(()) };
                let (first, second) = tangents(&plane.normal);
                let ahead = dot(&next.normal, &plane.normal);
                let shift = (next.offset - plane.offset) / samples.size;
                let step = [dot(&next.normal, &first) / ahead, dot(&next.normal, &second) / ahead, shift];
                prop_assert!((norm(&step) - length).abs() < 1e-6 * (1.0 + length));
                let image = |plane: &Plane, point: &Vector3| {
                    let height = dot(&plane.normal, point) - plane.offset;
                    add(point, &scale(&plane.normal, -2.0 * height))
                };
                let slopes = |point: &Vector3, foot: &Foot| -> Vector3 {
                    core::array::from_fn(|k| {
                        let along = |by: f64| {
                            let mut step = [0.0; 3];
                            step[k] = by;
                            dot(&foot.direction, &image(&stepped(&plane, step, samples.size), point))
                        };
                        (along(1e-5) - along(-1e-5)) / 2e-5
                    })
                };
                let (mut left, mut diagonal, mut size) = ([0.0; 3], [0.0; 3], 0.0);
                for (point, foot) in samples.points.iter().zip(&found) {
                    let row = slopes(point, foot);
                    left = add(&left, &scale(&row, dot(&row, &step) + foot.along));
                    diagonal = core::array::from_fn(|k| diagonal[k] + row[k] * row[k]);
                    size += norm(&row) * foot.along.abs();
                }
                for k in 0..3 {
                    // The floor under the diagonal is a part in 10^9 of all of it.
                    let rest = left[k] + damping * diagonal[k] * step[k];
                    let floor = 1e-9 * diagonal.iter().sum::<f64>() * step[k];
                    prop_assert!((rest + floor).abs() < 1e-4 * size.max(1e-3), "{} of {}: {}", rest, size, k);
                }
                Ok(())
            })?;
        }

        /// A plane is never left for one that is worse, and what is told of it is so.
        #[test]
        fn no_pass_makes_a_plane_worse(
            normal in prop::array::uniform3(-1.0..1.0f64), offset in -25.0..25.0f64, is_exact in any::<bool>(), wanted in prop_oneof![Just(0.0), 0.1..9.0f64],
        ) {
            prop_assume!(norm(&normal) > 0.1);
            let start = Plane { normal: scale(&normal, 1.0 / norm(&normal)), offset };
            with_box(|mesh, samples| {
                let target = Target { samples, surface: is_exact.then_some(mesh) };
                let measured = |plane: &Plane| target.measure(plane, &mut [Foot::NONE; SAMPLES]);
                let mut before = measured(&start);
                for passes in [0, 1, 2, 3, 5, 9] {
                    let fitted = target.fit(start, passes, wanted);
                    prop_assert_eq!(fitted.squared, measured(&fitted.plane));
                    prop_assert!(fitted.squared <= before);
                    before = fitted.squared;
                }
                Ok(())
            })?;
        }

        /// From a start so near that the surfaces differ by a thousandth of a millimetre, too.
        #[test]
        fn the_plane_of_an_exact_symmetry_is_found_to_rounding(
            tilt in prop::array::uniform2(-1.0..1.0f64), shift in -1.0..1.0f64, size in prop_oneof![Just(1e-5), Just(1e-2), Just(0.1)],
        ) {
            with_box(|mesh, samples| {
                let target = Target { samples, surface: Some(mesh) };
                let start = Plane { normal: [1.0, 0.0, 0.0], offset: 0.0 };
                let start = stepped(&start, [size * tilt[0], size * tilt[1], size * shift], samples.size);
                let fitted = target.fit(start, 30, 0.0);
                prop_assert!(fitted.squared <= (EXACT * samples.size) * (EXACT * samples.size), "{:?}", fitted);
                Ok(())
            })?;
        }
    }
}
