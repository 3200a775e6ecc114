//! Outlines that the frame's border cuts off.

use std::f64::consts::TAU;

use fluoropose::camera::Camera;
use fluoropose::math::{Matrix3, Vector3, apply, multiply};
use fluoropose::pose::{Pose, Quaternion};
use rand::{Rng, RngExt};

use super::curve::Curve;

/// Nothing is turned farther than this, radians: beyond it no detector reaches.
const FARTHEST: f64 = 1.0;

/// Moves a pose so that the frame's border cuts off the part `fraction` of the outline's length, in a
/// random direction. `curves` are the whole outline at `pose`, in the camera's frame.
///
/// The pose is turned about the X-ray focus: the rays that touch the model stay the same, so its
/// outline does too, but for the detector's tilt; a shift would show another side of it.
pub(super) fn cut_off(
    pose: &Pose,
    curves: &[Curve],
    camera: &Camera,
    fraction: f64,
    random: &mut impl Rng,
) -> Pose {
    let rays: Vec<(Vector3, f64)> = curves
        .iter()
        .flat_map(|curve| curve.points.iter().zip(curve.lengths()))
        .map(|(point, length)| {
            let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
            (
                [(point.column - cx) / fx, (cy - point.row) / fy, -1.0],
                length,
            )
        })
        .collect();
    let whole: f64 = rays.iter().map(|(_, length)| length).sum();
    let direction = random.random_range(0.0..TAU);
    let cut = |angle: f64| {
        let turn = turn(direction, angle);
        let outside = rays
            .iter()
            .filter(|(ray, _)| !in_frame(camera, &apply(&turn, ray)));
        outside.map(|(_, length)| length).sum::<f64>() / whole
    };
    let (mut low, mut high) = (0.0, FARTHEST);
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        if cut(middle) < fraction {
            low = middle;
        } else {
            high = middle;
        }
    }
    let turn = turn(direction, high);
    Pose {
        rotation: multiply(&turn, &pose.rotation),
        translation: apply(&turn, &pose.translation),
    }
}

/// The turn by `angle` that moves the optical axis to the right and up by `direction`.
fn turn(direction: f64, angle: f64) -> Matrix3 {
    let (sine, cosine) = libm::sincos(direction);
    let (s, c) = libm::sincos(angle / 2.0);
    // (0, 0, -1) x (cosine, sine, 0)
    Matrix3::from(Quaternion {
        w: c,
        x: s * sine,
        y: -s * cosine,
        z: 0.0,
    })
}

fn in_frame(camera: &Camera, ray: &Vector3) -> bool {
    camera.project(ray).is_some_and(|image| {
        (0.0..=camera.width() as f64).contains(&image.column)
            && (0.0..=camera.height() as f64).contains(&image.row)
    })
}
