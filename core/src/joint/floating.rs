//! Joint translations of Grood and Suntay (J. Biomech. Eng. 105, 1983).
//!
//! Their three axes are the femur's mediolateral axis, the tibia's long axis, and the floating axis, perpendicular to both.
//! Rotations about these are the three angles of [`super::kinematics::joint_angles`]; the translations are others, because
//! the field takes all three in the tibia's own axes.

use crate::joint::kinematics::Side;
use crate::math::{cross, dot, norm, scale};
use crate::pose::Pose;

/// How far the tibial origin has moved from the femoral one along the axes of Grood and Suntay, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FloatingTranslations {
    /// Lateral shift of the tibia along the femur's mediolateral axis: their `q1`.
    pub lateral_mm: f64,
    /// Anterior drawer of the tibia along the floating axis: their `q2`.
    pub anterior_mm: f64,
    /// Distraction of the joint along the tibia's long axis: their `q3`.
    pub distraction_mm: f64,
}

/// The translations of a relative pose ([`super::kinematics::relative_pose`]) in the axes of
/// [`super::kinematics::joint_axes`].
///
/// Of one line that is both mediolateral and along the tibia (90 degrees of abduction) there is no floating axis: NaN.
#[must_use]
pub fn floating_translations(relative: &Pose, side: Side) -> FloatingTranslations {
    // Of the femur, whose z is medial in the axes of either side.
    let medial = [0.0, 0.0, 1.0];
    let along = relative.rotation.map(|row| row[1]);
    let across = cross(&along, &medial);
    let floating = scale(&across, side.forward() / norm(&across));
    let between = relative.translation;
    FloatingTranslations {
        lateral_mm: -dot(&between, &medial),
        anterior_mm: dot(&between, &floating),
        distraction_mm: -dot(&between, &along),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::kinematics::joint_angles;
    use crate::math::degrees;
    use crate::pose::EulerPose;
    use proptest::prelude::*;

    /// Grood and Suntay's own words for a right knee, with their axes: x to the right, y anterior, z proximal in both bones.
    /// Rows of `femur_from_tibia` by their equations; `[flexion, abduction, external rotation, q1, q2, q3]`. At
    /// more than 90 degrees between `I` and `k` the tibia's upper end leans to medial and its foot stands to lateral: abduction.
    fn by_the_paper(rotation: [[f64; 3]; 3], origin: [f64; 3]) -> [f64; 6] {
        let column = |k: usize| rotation.map(|row| row[k]);
        let (big_i, big_k) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let (small_i, small_k) = (column(0), column(2));
        let e2 = cross(&small_k, &big_i);
        let e2 = scale(&e2, 1.0 / norm(&e2));
        let beta = libm::acos(dot(&big_i, &small_k));
        [
            degrees(libm::asin(-dot(&e2, &big_k))),
            degrees(beta) - 90.0,
            degrees(libm::asin(-dot(&e2, &small_i))),
            dot(&origin, &big_i),
            dot(&origin, &e2),
            -dot(&origin, &small_k),
        ]
    }

    properties! {
        #[test]
        fn they_are_those_of_the_paper(
            z in -80.0..80.0f64, x in -60.0..60.0f64, y in -80.0..80.0f64,
            at in proptest::array::uniform3(-50.0..50.0f64),
        ) {
            // A right knee in the axes of its file: x posterior, y up, z to the left.
            let relative = Pose::from(EulerPose {
                x_mm: at[0], y_mm: at[1], z_mm: at[2], z_rot_deg: z, x_rot_deg: x, y_rot_deg: y,
            });
            // The paper's x, y, z are our -z, -x, y.
            let order = |v: [f64; 3]| [-v[2], -v[0], v[1]];
            let columns = [2, 0, 1].map(|k| order(relative.rotation.map(|row| row[k])));
            let sign = [-1.0, -1.0, 1.0];
            let rotation = core::array::from_fn(|row| {
                core::array::from_fn(|column| sign[column] * columns[column][row])
            });
            let paper = by_the_paper(rotation, order(relative.translation));
            let ours = joint_angles(&relative, Side::Right);
            let floating = floating_translations(&relative, Side::Right);
            let ours = [
                ours.flexion_deg, ours.abduction_deg, -ours.internal_deg,
                floating.lateral_mm, floating.anterior_mm, floating.distraction_mm,
            ];
            for (ours, paper) in ours.iter().zip(paper) {
                prop_assert!((ours - paper).abs() < 1e-9, "{ours} {paper}");
            }
        }
    }

    #[test]
    fn worked_by_hand() {
        // A left knee bent by 90 degrees, the tibial origin 3 mm in front of the femoral one, 20 mm below and 1 mm lateral:
        // the tibia points backwards, so what is below lies along the floating axis and what is in front along the tibia.
        let relative = Pose::from(EulerPose {
            x_mm: 3.0,
            y_mm: -20.0,
            z_mm: -1.0,
            z_rot_deg: -90.0,
            x_rot_deg: 0.0,
            y_rot_deg: 0.0,
        });
        let floating = floating_translations(&relative, Side::Left);
        let wanted = [1.0, 20.0, -3.0];
        let found = [
            floating.lateral_mm,
            floating.anterior_mm,
            floating.distraction_mm,
        ];
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
    }
}
