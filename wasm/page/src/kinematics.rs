//! The joint between two components, for the page's curve.

use fluoropose::joint::kinematics::{Side, joint_angles, joint_axes, relative_pose};
use fluoropose::pose::Pose;
use wasm_bindgen::prelude::*;

use crate::pose_numbers::{axes_from, from_numbers};

/// The six numbers of a joint from the poses of its components (x, y, z in mm, then z, x and y rotation in degrees) and the
/// axes of their models (nine numbers each, as `axes_from` takes them): anterior-posterior, superior-inferior and
/// mediolateral translation (mm), flexion, abduction and internal rotation (degrees). `left` is the side of the body.
///
/// # Errors
/// When a pose is not six finite numbers, or axes are no right-handed frame.
#[wasm_bindgen(js_name = jointMotion)]
pub fn joint_motion(
    femur: &[f64],
    femur_axes: &[f64],
    tibia: &[f64],
    tibia_axes: &[f64],
    left: bool,
) -> Result<Vec<f64>, JsError> {
    let side = if left { Side::Left } else { Side::Right };
    let femur =
        Pose::from(from_numbers(femur)?).compose(&joint_axes(&axes_from(femur_axes)?, side));
    let tibia =
        Pose::from(from_numbers(tibia)?).compose(&joint_axes(&axes_from(tibia_axes)?, side));
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
    use crate::pose_numbers::to_numbers;
    use fluoropose::pose::EulerPose;

    const OWN: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    const FEMUR: [f64; 6] = [0.0, 0.0, -1000.0, 0.0, 0.0, 0.0];
    const TIBIA: [f64; 6] = [3.0, -20.0, -999.0, -60.0, 0.0, 0.0];

    #[test]
    fn the_order_is_the_cores() {
        let joint = joint_motion(&FEMUR, &OWN, &TIBIA, &OWN, true).ok().unwrap();
        assert_eq!(joint.len(), 6);
        assert!((joint[3] - 60.0).abs() < 1e-9, "flexion {}", joint[3]);
        assert!((joint[2] + 1.0).abs() < 1e-9, "mediolateral {}", joint[2]);
    }

    /// A file whose y points forwards, z up and x to the right shows the same joint.
    #[test]
    fn the_files_axes_drop_out() {
        let axes = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0];
        let field_from_model = axes_from(&axes).ok().unwrap().inverse();
        let pose = Pose::from(from_numbers(&TIBIA).ok().unwrap()).compose(&field_from_model);
        let other = to_numbers(&EulerPose::from(pose));
        let wanted = joint_motion(&FEMUR, &OWN, &TIBIA, &OWN, false)
            .ok()
            .unwrap();
        let joint = joint_motion(&FEMUR, &OWN, &other, &axes, false)
            .ok()
            .unwrap();
        for (number, wanted) in joint.iter().zip(&wanted) {
            assert!((number - wanted).abs() < 1e-9, "{joint:?} for {wanted:?}");
        }
    }
}
