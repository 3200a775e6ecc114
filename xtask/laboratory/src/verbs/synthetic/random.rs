//! Random rotations and poses.

use fluoropose::math::{Matrix3, apply};
use fluoropose::mesh::Model;
use fluoropose::pose::{Pose, Quaternion};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::ranges::{DEPTH_MM, LATERAL_MM};

/// A rotation that is equally likely everywhere: a unit quaternion from inside the unit ball of four dimensions.
pub(super) fn rotation(random: &mut ChaCha8Rng) -> Matrix3 {
    let (quaternion, length) = loop {
        let draw: [f64; 4] = std::array::from_fn(|_| random.random_range(-1.0..=1.0f64));
        let square: f64 = draw.iter().map(|q| q * q).sum();
        if (0.01..=1.0).contains(&square) {
            break (draw, square.sqrt());
        }
    };
    let [w, x, y, z] = quaternion.map(|q| q / length);
    Quaternion { w, x, y, z }.into()
}

/// A pose of any rotation, the middle of the model's box within the protocol's range about `distance`.
pub(super) fn pose(random: &mut ChaCha8Rng, model: &Model<'_>, distance: f64) -> Pose {
    let rotation = rotation(random);
    let mut draw = |reach: f64| reach * random.random_range(-1.0..=1.0f64);
    let centre = [
        draw(LATERAL_MM),
        draw(LATERAL_MM),
        -distance + draw(DEPTH_MM),
    ];
    let middle = apply(&rotation, &model.bounds().centre);
    Pose {
        rotation,
        translation: std::array::from_fn(|k| centre[k] - middle[k]),
    }
}
