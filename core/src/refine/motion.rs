//! How fast the outline of a model at a pose moves in a view with each parameter of a step.

use super::border::BorderPixel;
use super::view::CameraView;
use crate::camera::Camera;
use crate::math::{Vector3, floor};
use crate::pose::Pose;

/// How the outline moves, in 32 bits: a Jacobian only leads the way to where residuals vanish, so a part in a million of it
/// changes no pose. It is reckoned where it is needed, because to keep it takes more memory than all else of a sample.
pub(super) struct Motion {
    focal: [f32; 2],
    /// The principal point: the pixel, and from its middle on. A part of a frame, whose pixels are counted from another, tells the
    /// same.
    principal: [i32; 2],
    beside: [f32; 2],
    /// Middle of the model in camera coordinates, mm.
    centre: [f32; 3],
    /// `world_from_camera`, where the camera does not stand in the world's axes.
    back: Option<[[f32; 3]; 3]>,
}

impl Motion {
    /// Of a model whose middle is at `centre` in camera coordinates.
    pub(super) fn of(view: &CameraView<'_>, centre: &Vector3) -> Self {
        let rotation = &view.placement.rotation;
        // A column is a row of the inverse.
        let back = || core::array::from_fn(|k| core::array::from_fn(|row| rotation[row][k] as f32));
        Self {
            back: (*rotation != Pose::IDENTITY.rotation).then(back),
            ..Self::in_camera(view.camera, centre)
        }
    }

    /// The same, by turns about and shifts along the camera's axes.
    pub(super) fn in_camera(camera: &Camera, centre: &Vector3) -> Self {
        let principal = camera.principal_point();
        let pixel = principal.map(floor);
        Self {
            focal: camera.focal().map(|x| x as f32),
            principal: pixel.map(|x| x as i32),
            beside: [
                (principal[0] - pixel[0] - 0.5) as f32,
                (principal[1] - pixel[1] - 0.5) as f32,
            ],
            centre: centre.map(|x| x as f32),
            back: None,
        }
    }

    /// How fast the image of the outline at a sample moves along its normal (pixels) for each parameter: three turns about the
    /// middle of the model (per radian), three shifts (per mm).
    ///
    /// With `u = fx X / D`, `v = -fy Y / D`, `D = -Z`:
    /// `du = fx (dX / D + X dZ / D^2)`, `dv = -fy (dY / D + Y dZ / D^2)`, and a turn `w` moves the
    /// point by `w x (X - c)`.
    #[inline]
    pub(super) fn jacobian(&self, sample: &BorderPixel) -> [f32; 6] {
        let ([fx, fy], [cx, cy]) = (self.focal, self.principal);
        let off = [i32::from(sample.column) - cx, i32::from(sample.row) - cy];
        let [right, down] = sample.normal();
        let depth = sample.depth();
        let nearness = 1.0 / depth;
        let x = (off[0] as f32 - self.beside[0]) / fx;
        let y = (self.beside[1] - off[1] as f32) / fy;
        let [i, j, k] = self.centre;
        let arm = [x * depth - i, y * depth - j, -depth - k];
        let (a, b) = (right * fx * nearness, -down * fy * nearness);
        // Image motion along the normal per mm of motion of the point.
        let push = [a, b, a * x + b * y];
        // push . (w x arm) = w . (arm x push)
        let twist = [
            arm[1] * push[2] - arm[2] * push[1],
            arm[2] * push[0] - arm[0] * push[2],
            arm[0] * push[1] - arm[1] * push[0],
        ];
        let (twist, push) = match &self.back {
            None => (twist, push),
            Some(back) => (apply(back, twist), apply(back, push)),
        };
        [twist[0], twist[1], twist[2], push[0], push[1], push[2]]
    }
}

fn apply(matrix: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * x + row[1] * y + row[2] * z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{Mask, words_needed};
    use crate::math::{apply, cross, subtract};
    use crate::pose::EulerPose;
    use proptest::prelude::*;

    /// Oracle: the image of the point behind a sample, moved by a little step, in 64 bits.
    fn moved(view: &CameraView<'_>, centre: &Vector3, sample: &BorderPixel) -> [f64; 6] {
        let ([fx, fy], [cx, cy]) = (view.camera.focal(), view.camera.principal_point());
        let (depth, [column, row]) = (f64::from(sample.depth()), sample.place());
        let point = [(column - cx) / fx * depth, -(row - cy) / fy * depth, -depth];
        let [right, down] = sample.slope.map(f64::from);
        let length = libm::hypot(right, down);
        let along = |point: &Vector3| {
            let image = view.camera.project(point).expect("in front");
            (image.column * right + image.row * down) / length
        };
        core::array::from_fn(|k| {
            const LITTLE: f64 = 1e-4;
            let mut values = [0.0; 6];
            values[k] = LITTLE;
            let [a, b, c, x, y, z] = values;
            // The step's axes are the world's.
            let [turn, shift] = [[a, b, c], [x, y, z]].map(|v| apply(&view.placement.rotation, &v));
            let spin = cross(&turn, &subtract(&point, centre));
            let there = |sign: f64| {
                let moved = core::array::from_fn(|i| point[i] + sign * (spin[i] + shift[i]));
                along(&moved)
            };
            (there(1.0) - there(-1.0)) / (2.0 * LITTLE)
        })
    }

    properties! {
        #[test]
        fn jacobians_are_differences_of_images(
            column in 0u16..1024, row in 0u16..1024, slope in (-160i16..=160, -160i16..=160),
            depth in 500.0..1500.0f32, off in proptest::array::uniform3(-60.0..60.0f64),
            angles in proptest::array::uniform3(-180.0..180.0f64), turned in any::<bool>(),
        ) {
            prop_assume!(slope != (0, 0));
            let camera = Camera::new(1024, 1024, [4000.0, 3950.0], [511.3, 509.8]).expect("valid");
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles.map(|angle| if turned { angle } else { 0.0 });
            let placement = Pose::from(EulerPose { z_rot_deg, x_rot_deg, y_rot_deg, ..EulerPose::default() });
            let sample = BorderPixel {
                column, row, slope: [slope.0, slope.1], near: depth, far: depth, ..BorderPixel::EMPTY
            };
            let [x, y, z] = off;
            let centre = [x, y, z - f64::from(depth)];
            let words = std::vec![0; words_needed(1024, 1024)];
            let mask = Mask::new(&words, 1024, 1024).expect("fits");
            let view = CameraView { camera: &camera, placement, target: (&mask).into() };
            let wanted = moved(&view, &centre, &sample);
            let found = Motion::of(&view, &centre).jacobian(&sample);
            for (found, wanted) in found.iter().zip(&wanted) {
                prop_assert!((f64::from(*found) - wanted).abs() < 2e-3 + 1e-5 * wanted.abs(), "{found} for {wanted}");
            }
        }
    }
}
