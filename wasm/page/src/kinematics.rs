//! The joint between two components, for the page's curve.

use fluoropose::pose::Pose;
use fluoropose::pose::kinematics::{Side, joint_angles, relative_pose};
use wasm_bindgen::prelude::*;

use crate::pose_numbers::from_numbers;

/// The six numbers of a joint from the poses of its components (x, y, z in mm, then z, x and y rotation in degrees):
/// anterior-posterior, superior-inferior and mediolateral translation (mm), flexion, abduction and internal rotation
/// (degrees). `left` is the side of the body.
///
/// # Errors
/// When a pose is not six finite numbers.
#[wasm_bindgen(js_name = jointMotion)]
pub fn joint_motion(femur: &[f64], tibia: &[f64], left: bool) -> Result<Vec<f64>, JsError> {
    let femur = Pose::from(from_numbers(femur)?);
    let tibia = Pose::from(from_numbers(tibia)?);
    let side = if left { Side::Left } else { Side::Right };
    let joint = joint_angles(&relative_pose(&femur, &tibia), side);
    Ok(vec![
        joint.anterior_mm,
        joint.superior_mm,
        joint.lateral_mm,
        joint.flexion_deg,
        joint.abduction_deg,
        joint.internal_deg,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_the_cores() {
        let femur = [0.0, 0.0, -1000.0, 0.0, 0.0, 0.0];
        let tibia = [3.0, -20.0, -999.0, -60.0, 0.0, 0.0];
        let joint = joint_motion(&femur, &tibia, true).ok().unwrap();
        assert_eq!(joint.len(), 6);
        assert!((joint[3] - 60.0).abs() < 1e-9, "flexion {}", joint[3]);
        assert!((joint[2] + 1.0).abs() < 1e-9, "mediolateral {}", joint[2]);
    }
}
