//! How much of a model lies beyond the frame's border.

use crate::camera::Camera;
use crate::math::Vector3;
use crate::mesh::{Bounds, Model};
use crate::pose::Pose;

/// Cells along each side of the box about a model that are asked whether they are in the frame.
const ALONG: usize = 12;

/// Part of a model that lies beyond the frame, by the cells of the box about it in which it has vertices, of however many a piece of its surface is made;
/// `pose` is `camera_from_model`.
pub(crate) fn part_beyond(model: &Model<'_>, camera: &Camera, pose: &Pose) -> f64 {
    Frame {
        camera,
        beyond: [0; 4],
    }
    .part_beyond(model, pose)
}

/// A frame, of which a camera may see a part.
pub(super) struct Frame<'c> {
    pub(super) camera: &'c Camera,
    /// Pixels of the frame to the left of what the camera sees, above it, to the right and below.
    pub(super) beyond: [usize; 4],
}

impl Frame<'_> {
    /// The same of a frame of which a part is seen: [`part_beyond`].
    pub(super) fn part_beyond(&self, model: &Model<'_>, pose: &Pose) -> f64 {
        let bounds = model.bounds();
        if self.is_ball_within(&bounds, pose) {
            return 0.0;
        }
        let cells = Cells::new(model.vertices());
        let mut taken = [false; ALONG * ALONG * ALONG];
        for vertex in model.vertices() {
            if let Some(taken) = taken.get_mut(cells.of(vertex)) {
                *taken = true;
            }
        }
        let (mut beyond, mut all) = (0_u32, 0_u32);
        for (cell, _) in taken.iter().enumerate().filter(|&(_, &taken)| taken) {
            all += 1;
            beyond += u32::from(!self.is_within(&pose.transform(&cells.middle(cell))));
        }
        f64::from(beyond) / f64::from(all.max(1))
    }

    /// Whether the cube about the ball about a model lies in the frame, so that the model does.
    fn is_ball_within(&self, bounds: &Bounds, pose: &Pose) -> bool {
        let [x, y, z] = pose.transform(&bounds.centre);
        (0..8_u32).all(|corner| {
            let aside = |axis: u32| match corner & axis {
                0 => bounds.radius,
                _ => -bounds.radius,
            };
            let place = [x + aside(1), y + aside(2), z + aside(4)];
            self.is_within(&place)
        })
    }

    /// Whether a place in front of the camera, mm, is in the frame.
    fn is_within(&self, place: &Vector3) -> bool {
        let [left, above, right, below] = self.beyond;
        let within =
            |at: f64, before: usize, side: usize| (-(before as f64)..side as f64).contains(&at);
        self.camera.project(place).is_some_and(|place| {
            within(place.column, left, self.camera.width() + right)
                && within(place.row, above, self.camera.height() + below)
        })
    }
}

/// The cells of the box about a model, in 32 bits, which a microcontroller has: those of a cube about a long rod would be wider than it, and
/// reach beyond a frame that holds it.
struct Cells {
    low: [f32; 3],
    per_mm: [f32; 3],
}

impl Cells {
    fn new(vertices: &[[f32; 3]]) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for vertex in vertices {
            for ((low, high), &at) in low.iter_mut().zip(&mut high).zip(vertex) {
                (*low, *high) = (at.min(*low), at.max(*high));
            }
        }
        let per_mm = core::array::from_fn(|axis| {
            let side = high[axis] - low[axis];
            // Of a flat part all are in the first.
            if side > 0.0 { ALONG as f32 / side } else { 0.0 }
        });
        Self { low, per_mm }
    }

    /// Number of the cell that a vertex lies in.
    fn of(&self, vertex: &[f32; 3]) -> usize {
        let along = |axis: usize| {
            let cell = (vertex[axis] - self.low[axis]) * self.per_mm[axis];
            (cell as usize).min(ALONG - 1)
        };
        (along(0) * ALONG + along(1)) * ALONG + along(2)
    }

    /// The middle of a cell, mm.
    fn middle(&self, cell: usize) -> Vector3 {
        let numbers = [cell / (ALONG * ALONG), cell / ALONG % ALONG, cell % ALONG];
        core::array::from_fn(|axis| {
            let per_mm = f64::from(self.per_mm[axis]);
            let along = match per_mm > 0.0 {
                true => (numbers[axis] as f64 + 0.5) / per_mm,
                false => 0.0,
            };
            f64::from(self.low[axis]) + along
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::EulerPose;
    use std::vec::Vec;

    /// A square of 20 mm in cells of `sides` mm, one after another from the left, of two triangles a millimetre of height each.
    fn square(sides: impl IntoIterator<Item = f32>) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles, mut left) = (Vec::new(), Vec::new(), -10.0);
        for side in sides {
            for down in (0..20u8).map(|mm| f32::from(mm) - 10.0) {
                let first = vertices.len() as u32;
                let corners = [[0.0, 0.0], [side, 0.0], [side, 1.0], [0.0, 1.0]];
                vertices.extend(corners.map(|[x, y]| [left + x, down + y, 0.0]));
                triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
            left += side;
        }
        (vertices, triangles)
    }

    /// Beyond of a square a metre away, 20 pixels wide, so many to the right of the middle of a frame of 100 pixels.
    fn beyond(square: &(Vec<[f32; 3]>, Vec<[u32; 3]>), right_mm: f64) -> f64 {
        let model = Model::from_triangles(&square.0, &square.1).expect("a square");
        let camera = Camera::new(100, 100, [1000.0; 2], [50.0; 2]).expect("valid");
        let pose = Pose {
            translation: [right_mm, 0.0, -1000.0],
            ..Pose::IDENTITY
        };
        part_beyond(&model, &camera, &pose)
    }

    #[test]
    fn what_stands_across_the_border_is_beyond_by_its_part() {
        let even = square([0.5; 40]);
        for (right_mm, wanted) in [
            (0.0, 0.0),
            (35.0, 0.0),
            (50.0, 0.5),
            (55.0, 0.75),
            (80.0, 1.0),
        ] {
            let part = beyond(&even, right_mm);
            assert!((part - wanted).abs() < 0.07, "{right_mm}: {part}");
        }
    }

    /// As of a stem with a thread, or of a file whose faces are of many sizes.
    #[test]
    fn where_vertices_lie_close_does_not_count() {
        let even = square([0.5; 40]);
        let fine_left = square([0.1; 100].into_iter().chain([1.0; 10]));
        let fine_right = square([1.0; 10].into_iter().chain([0.1; 100]));
        for right_mm in [40.0, 43.0, 46.0, 50.0, 54.0, 57.0, 60.0] {
            let wanted = beyond(&even, right_mm);
            assert_eq!(beyond(&fine_left, right_mm), wanted, "{right_mm}");
            assert_eq!(beyond(&fine_right, right_mm), wanted, "{right_mm}");
        }
    }

    /// Cells lie along the model's axes: in others they are others, and tell the same but for what one of them holds.
    #[test]
    fn the_models_axes_matter_by_a_cell_at_most() {
        let even = square([0.5; 40]);
        for turned_deg in [10.0, 33.0, 45.0, 71.0] {
            let turn = Pose::from(EulerPose {
                z_rot_deg: turned_deg,
                x_rot_deg: turned_deg / 2.0,
                ..EulerPose::default()
            });
            let other_axes = |vertex: &[f32; 3]| {
                turn.inverse()
                    .transform(&vertex.map(f64::from))
                    .map(|x| x as f32)
            };
            let turned: Vec<[f32; 3]> = even.0.iter().map(other_axes).collect();
            let model = Model::from_triangles(&turned, &even.1).expect("a square");
            let camera = Camera::new(100, 100, [1000.0; 2], [50.0; 2]).expect("valid");
            for right_mm in [43.0, 46.0, 50.0, 54.0, 57.0] {
                let there = Pose {
                    translation: [right_mm, 0.0, -1000.0],
                    ..turn
                };
                let part = part_beyond(&model, &camera, &there);
                let wanted = beyond(&even, right_mm);
                assert!(
                    (part - wanted).abs() < 0.1,
                    "{turned_deg} {right_mm}: {part} {wanted}"
                );
            }
        }
    }

    /// At any of its ends, along the frame's border and across it.
    #[test]
    fn of_a_long_rod_near_the_border_nothing_is_beyond_until_it_is() {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in -50..50i8 {
            let first = vertices.len() as u32;
            let along = 2.0 * f32::from(k);
            vertices.extend([
                [along, -2.0, 0.0],
                [along + 2.0, -2.0, 0.0],
                [along, 2.0, 3.0],
            ]);
            triangles.push([first, first + 1, first + 2]);
        }
        let model = Model::from_triangles(&vertices, &triangles).expect("a rod");
        let camera = Camera::new(400, 400, [1000.0; 2], [200.0; 2]).expect("valid");
        let part = |turned_deg: f64, off_mm: f64| {
            let turn = Pose::from(EulerPose {
                z_rot_deg: turned_deg,
                ..EulerPose::default()
            });
            let pose = Pose {
                translation: [off_mm, 0.0, -1000.0],
                ..turn
            };
            part_beyond(&model, &camera, &pose)
        };
        for side in [-1.0, 1.0] {
            // Along the border, 3 mm within it and as much beyond, and across it.
            assert_eq!(part(90.0, 195.0 * side), 0.0, "{side}");
            assert_eq!(part(90.0, 205.0 * side), 1.0, "{side}");
            assert!((part(0.0, 200.0 * side) - 0.5).abs() < 0.05, "{side}");
            assert_eq!(part(0.0, 97.0 * side), 0.0, "{side}");
        }
    }

    #[test]
    fn behind_the_source_nothing_is_seen() {
        let even = square([1.0; 20]);
        let model = Model::from_triangles(&even.0, &even.1).expect("a square");
        let camera = Camera::new(100, 100, [1000.0; 2], [50.0; 2]).expect("valid");
        let behind = Pose {
            translation: [0.0, 0.0, 50.0],
            ..Pose::IDENTITY
        };
        assert_eq!(part_beyond(&model, &camera, &behind), 1.0);
    }
}
