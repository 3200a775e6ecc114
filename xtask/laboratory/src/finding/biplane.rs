//! Two cameras that see one implant at once.

use fluoropose::camera::calibration::Calibration;
use fluoropose::pose::{EulerPose, Pose};

/// Where a second camera stands whose axis meets that of the first at `distance` mm from both,
/// turned by `angle` degrees about the vertical there: `second_from_first`.
pub fn turned_about(distance: f64, angle: f64) -> Pose {
    let meeting = Pose {
        translation: [0.0, 0.0, -distance],
        ..Pose::IDENTITY
    };
    let turn = Pose::from(EulerPose {
        y_rot_deg: angle,
        ..EulerPose::default()
    });
    meeting.compose(&turn).compose(&meeting.inverse())
}

/// Where the camera of `other` stands as seen from that of `first`, `other_from_first`, both
/// looking along -z: from the laboratory that their files share (MayaCam 2.0). `None` where one
/// of the two is no camera matrix, or neither has a place in the laboratory.
pub fn between(first: &Calibration, other: &Calibration) -> Option<Pose> {
    let place = |calibration: &Calibration| match calibration {
        Calibration::CameraMatrix { laboratory, .. } => Some(laboratory.flip_camera_axes()),
        _ => None,
    };
    let (first, other) = (place(first)?, place(other)?);
    let apart = first != other;
    apart.then(|| other.compose(&first.inverse()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::math::{add, norm, scale};

    #[test]
    fn the_axes_meet_at_the_distance() {
        let second = turned_about(900.0, 60.0);
        let seen = second.transform(&[0.0, 0.0, -900.0]);
        assert!(norm(&add(&seen, &[0.0, 0.0, 900.0])) < 1e-9);
        // The first focus is 900 mm from that point too, at 60 degrees.
        let focus = second.transform(&[0.0; 3]);
        let triangle = norm(&focus);
        assert!((triangle - 900.0).abs() < 1e-9, "{triangle}");
    }

    #[test]
    fn a_point_of_the_laboratory_is_one_point_in_both_frames() {
        let text = |translation: &str, rotation: &str| {
            format!(
                "image size\n100,100\n\ncamera matrix\n500,0,50\n0,500,50\n0,0,1\n\nrotation\n{rotation}\n\ntranslation\n{translation}\n"
            )
        };
        let first = text("1\n2\n900", "1,0,0\n0,1,0\n0,0,1");
        let other = text("-4\n0\n800", "0,0,-1\n0,1,0\n1,0,0");
        let parse = |text: &str| Calibration::parse(text).expect("valid");
        let (first, other) = (parse(&first), parse(&other));
        let between = between(&first, &other).expect("two places");
        let point = [10.0, -20.0, 30.0];
        // In the files' convention the first camera sees R X + t = (11, -18, 930), in ours y and
        // z change their sign; the other sees (-30 - 4, -20, 10 + 800).
        let ours = between.transform(&[11.0, 18.0, -930.0]);
        assert!(
            norm(&add(&ours, &scale(&[-34.0, 20.0, -810.0], -1.0))) < 1e-9,
            "{ours:?} {point:?}"
        );
    }
}
