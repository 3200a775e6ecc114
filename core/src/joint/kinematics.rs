//! Joint kinematics: the tibial component relative to the femoral one, in the field's six
//! numbers.

use core::fmt;

use crate::math::{apply, asin, degrees, dot, scale, transpose};
use crate::pose::{EulerPose, Pose};

/// Side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// Left knee.
    Left,
    /// Right knee.
    Right,
}

impl Side {
    /// The sign of anterior along x of [`joint_axes`]: 1 for a left knee, -1 for a right one. Their z is medial in both.
    #[must_use]
    pub fn forward(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// `left` or `right`.
impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

/// The six numbers of a tibiofemoral joint as the field publishes them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointAngles {
    /// Anterior-posterior translation, mm.
    pub anterior_mm: f64,
    /// Superior-inferior translation, mm.
    pub superior_mm: f64,
    /// Mediolateral translation, mm: of the femoral origin along z of [`joint_axes`], so positive to medial.
    pub lateral_mm: f64,
    /// Flexion, degrees.
    pub flexion_deg: f64,
    /// Abduction (positive) and adduction, degrees.
    pub abduction_deg: f64,
    /// Internal (positive) and external rotation, degrees.
    pub internal_deg: f64,
}

/// `femur_from_tibia`: the tibial component in the femoral component's coordinates,
/// `inverse(camera_from_femur) * camera_from_tibia`.
#[must_use]
pub fn relative_pose(femur: &Pose, tibia: &Pose) -> Pose {
    femur.inverse().compose(tibia)
}

/// The six numbers of a relative pose `P = (R, t)` ([`relative_pose`]).
///
/// Translation is `-R^T t`, the femoral origin seen from the tibial component, in the order
/// anterior-posterior, superior-inferior, mediolateral; rotations are the z, x and y angles of
/// `R = Rz Rx Ry`. Left knees change the sign of flexion and internal rotation, right knees that
/// of the anterior-posterior translation: the convention in which the field's program for
/// single-plane studies writes them, a form of Grood and Suntay's (J. Biomech. Eng. 105, 1983).
#[must_use]
pub fn joint_angles(relative: &Pose, side: Side) -> JointAngles {
    let [anterior, superior, lateral] = scale(
        &apply(&transpose(&relative.rotation), &relative.translation),
        -1.0,
    );
    let euler = EulerPose::from(*relative);
    let forward = side.forward();
    let turn = -forward;
    JointAngles {
        anterior_mm: forward * anterior,
        superior_mm: superior,
        lateral_mm: lateral,
        flexion_deg: turn * euler.z_rot_deg,
        abduction_deg: euler.x_rot_deg,
        internal_deg: turn * euler.y_rot_deg,
    }
}

/// The axes in which [`joint_angles`] takes a component of this side, in its model's coordinates, from the anatomical ones
/// (`model_from_field` of `mesh::anatomy`: x anterior, y superior, z to the patient's right).
///
/// The field's files of right implants are those of left ones mirrored in x: there x is posterior and z to the left, medial as in a
/// left knee. Without this half turn about y a right knee's flexion and anterior-posterior translation had the wrong sign.
#[must_use]
pub fn joint_axes(anatomical: &Pose, side: Side) -> Pose {
    match side {
        Side::Left => *anatomical,
        Side::Right => anatomical.compose(&HALF_TURN),
    }
}

/// About y.
const HALF_TURN: Pose = Pose {
    rotation: [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    translation: [0.0; 3],
};

/// Coronal tilt between the two components: the elevation of the femoral mediolateral axis above
/// the tibial plate, degrees, -90 to 90. Zero where both condyles are equally high above it.
///
/// Model axes as in the field's implant files: x anteroposterior, y superoinferior (for the tibial
/// component along its stem, upwards), z mediolateral, in both components alike. The tilt is
/// `asin(y_tib . R_tib^T R_fem z)`, a projection of one axis on another: an angle of Euler's would
/// mix it with axial rotation where the two components are 90 degrees apart.
#[must_use]
pub fn coronal_tilt_deg(femur: &Pose, tibia: &Pose) -> f64 {
    let mediolateral = apply(&femur.rotation, &[0.0, 0.0, 1.0]);
    let upwards = apply(&tibia.rotation, &[0.0, 1.0, 0.0]);
    degrees(asin(dot(&mediolateral, &upwards)))
}

/// The angle between the mediolateral axes of the two components as lines, degrees, 0 to 90: whose side of the body it is does
/// not matter, nor which end of an axis is which. Of a knee it is what abduction and axial rotation are together.
///
/// Model axes as of [`coronal_tilt_deg`].
#[must_use]
pub fn across_deg(femur: &Pose, tibia: &Pose) -> f64 {
    let [a, b] = [femur, tibia].map(|pose| apply(&pose.rotation, &[0.0, 0.0, 1.0]));
    90.0 - degrees(asin(dot(&a, &b).abs().min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, y: f64, z: f64, rotations: [f64; 3]) -> Pose {
        let [z_rot_deg, x_rot_deg, y_rot_deg] = rotations;
        Pose::from(EulerPose {
            x_mm: x,
            y_mm: y,
            z_mm: z,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
        })
    }

    #[test]
    fn how_far_a_knee_turns_and_tilts_is_told_whichever_way_axes_point() {
        let femur = pose(4.0, -17.0, -1083.0, [8.0, 5.0, -1.0]);
        for (turn, abduction) in [
            (0.0, 0.0),
            (30.0, 0.0),
            (-79.0, 0.0),
            (0.0, 40.0),
            (20.0, 10.0),
        ] {
            // Flexion is about the mediolateral axis, and says nothing.
            for flexion in [0.0, 110.0] {
                let flexed = femur.compose(&pose(0.0, 0.0, 0.0, [flexion, 0.0, 0.0]));
                let tibia = flexed.compose(&pose(0.0, 0.0, 0.0, [0.0, abduction, turn]));
                let cosine = f64::cos(f64::to_radians(turn)) * f64::cos(f64::to_radians(abduction));
                let known = cosine.acos().to_degrees();
                for other in [tibia, tibia.compose(&HALF_TURN)] {
                    let told = across_deg(&femur, &other);
                    assert!((told - known).abs() < 1e-6, "{told} for {known}");
                    assert!((across_deg(&other, &femur) - told).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn the_camera_drops_out() {
        let femur = pose(4.0, -17.0, -1083.0, [8.0, 5.0, -1.0]);
        let tibia = pose(-28.0, -18.0, -1085.0, [-84.0, 0.5, -9.0]);
        let moved = pose(50.0, 20.0, -100.0, [40.0, 10.0, 70.0]);
        let a = joint_angles(&relative_pose(&femur, &tibia), Side::Left);
        let b = joint_angles(
            &relative_pose(&moved.compose(&femur), &moved.compose(&tibia)),
            Side::Left,
        );
        assert!((a.flexion_deg - b.flexion_deg).abs() < 1e-9);
        assert!((a.anterior_mm - b.anterior_mm).abs() < 1e-9);
    }

    #[test]
    fn the_translation_is_the_femoral_origin_in_tibial_axes() {
        let femur = pose(4.0, -17.0, -1083.0, [8.0, 5.0, -1.0]);
        let tibia = pose(-28.0, -18.0, -1085.0, [-84.0, 0.5, -9.0]);
        let joint = joint_angles(&relative_pose(&femur, &tibia), Side::Left);
        let origin = tibia.inverse().transform(&femur.translation);
        assert!((joint.anterior_mm - origin[0]).abs() < 1e-9);
        assert!((joint.superior_mm - origin[1]).abs() < 1e-9);
        assert!((joint.lateral_mm - origin[2]).abs() < 1e-9);
    }

    #[test]
    fn a_pure_flexion_is_flexion_alone_and_sides_mirror_signs() {
        let femur = pose(0.0, 0.0, -1000.0, [0.0; 3]);
        let tibia = femur.compose(&pose(3.0, -20.0, 1.0, [-60.0, 0.0, 0.0]));
        let relative = relative_pose(&femur, &tibia);
        let left = joint_angles(&relative, Side::Left);
        let right = joint_angles(&relative, Side::Right);
        assert!((left.flexion_deg - 60.0).abs() < 1e-9);
        assert!(left.abduction_deg.abs() < 1e-9 && left.internal_deg.abs() < 1e-9);
        assert!((left.flexion_deg + right.flexion_deg).abs() < 1e-12);
        assert!((left.anterior_mm + right.anterior_mm).abs() < 1e-12);
        assert_eq!(left.superior_mm, right.superior_mm);
    }

    /// The knee of the other side, seen in a mirror, with each model mirrored in its z, which is to the right.
    fn mirrored(pose: &Pose) -> Pose {
        let [across, through] = [[-1.0, 1.0, 1.0], [1.0, 1.0, -1.0]];
        Pose {
            rotation: core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    across[row] * pose.rotation[row][column] * through[column]
                })
            }),
            translation: core::array::from_fn(|row| across[row] * pose.translation[row]),
        }
    }

    #[test]
    fn a_knee_and_its_mirror_image_have_the_same_six_numbers() {
        let femur = pose(4.0, -17.0, -1083.0, [8.0, 5.0, -1.0]);
        let tibia = pose(-28.0, -38.0, -1085.0, [-84.0, 1.5, -9.0]);
        let joint = |[femur, tibia]: [Pose; 2], side| {
            let axes = joint_axes(&Pose::IDENTITY, side);
            joint_angles(
                &relative_pose(&femur.compose(&axes), &tibia.compose(&axes)),
                side,
            )
        };
        let left = joint([femur, tibia], Side::Left);
        let right = joint([mirrored(&femur), mirrored(&tibia)], Side::Right);
        let numbers = |joint: JointAngles| {
            let moved = [joint.anterior_mm, joint.superior_mm, joint.lateral_mm];
            let turned = [joint.flexion_deg, joint.abduction_deg, joint.internal_deg];
            moved.into_iter().chain(turned)
        };
        for (left, right) in numbers(left).zip(numbers(right)) {
            assert!((left - right).abs() < 1e-9, "{left} and {right}");
        }
        assert!(left.flexion_deg > 80.0);
        // A right implant's file as the field has it keeps its numbers.
        assert_eq!(joint_axes(&HALF_TURN, Side::Right), Pose::IDENTITY);
    }

    #[test]
    fn the_tilt_is_that_of_the_femoral_axis_and_knows_no_flexion_or_turn() {
        let tibia = pose(-28.0, -18.0, -1085.0, [-84.0, 0.5, -9.0]);
        for tilt in [-30.0, -3.0, 0.0, 0.2, 12.0] {
            for flexion in [-10.0, 0.0, 60.0, 90.0, 130.0] {
                for turn in [-15.0, 0.0, 90.0] {
                    // In tibial axes: flexed about its own z, then tilted about x, then turned.
                    let turned = pose(0.0, 0.0, 0.0, [0.0, 0.0, turn]);
                    let tilted = pose(0.0, 0.0, 0.0, [0.0, -tilt, 0.0]);
                    let flexed = pose(5.0, 20.0, 1.0, [flexion, 0.0, 0.0]);
                    let femur = tibia.compose(&turned).compose(&tilted).compose(&flexed);
                    assert!((coronal_tilt_deg(&femur, &tibia) - tilt).abs() < 1e-9);
                }
            }
        }
    }
}
