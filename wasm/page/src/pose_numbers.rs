//! Poses as six numbers, the form in which they cross into JavaScript.

use fluoropose::pose::{EulerPose, Pose};
use wasm_bindgen::JsError;

/// x, y, z (mm), then z, x and y rotation (degrees).
pub type PoseNumbers = [f64; 6];

/// The six numbers of a pose.
pub fn to_numbers(pose: &EulerPose) -> PoseNumbers {
    PoseNumbers::from(*pose)
}

/// The pose of six numbers.
///
/// # Errors
/// A sentence where there are not six.
pub fn from_numbers(numbers: &[f64]) -> Result<EulerPose, JsError> {
    match PoseNumbers::try_from(numbers) {
        Ok(numbers) if numbers.iter().all(|n| n.is_finite()) => Ok(EulerPose::from(numbers)),
        _ => Err(JsError::new("A pose is six finite numbers")),
    }
}

/// The poses of a film, six numbers a frame, all NaN where there is none.
///
/// # Errors
/// A sentence where there are not six for each.
pub fn all_poses(numbers: &[f64]) -> Result<Vec<Option<Pose>>, JsError> {
    let (poses, rest) = numbers.as_chunks::<6>();
    if !rest.is_empty() {
        return Err(JsError::new("A pose is six numbers"));
    }
    let pose = |numbers: &[f64; 6]| match numbers.iter().all(|number| number.is_nan()) {
        true => Ok(None),
        false => Ok(Some(Pose::from(from_numbers(numbers)?))),
    };
    poses.iter().map(pose).collect()
}

/// The rotation `model_from_field` of nine numbers: the directions anterior, superior and to the patient's right, one after
/// another, in the model's coordinates.
///
/// # Errors
/// A sentence where they are no right-handed frame.
pub fn axes_from(directions: &[f64]) -> Result<Pose, JsError> {
    let wrong = || {
        JsError::new("Axes are three directions of length one, at right angles and right-handed")
    };
    let &[ax, ay, az, sx, sy, sz, rx, ry, rz] = directions else {
        return Err(wrong());
    };
    let axes = Pose {
        rotation: [[ax, sx, rx], [ay, sy, ry], [az, sz, rz]],
        translation: [0.0; 3],
    };
    // Sessions keep them to some decimals.
    if axes.is_rigid(1e-6) {
        Ok(axes)
    } else {
        Err(wrong())
    }
}
