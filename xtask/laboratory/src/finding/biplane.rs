//! Two cameras that see one implant at once.

use std::fmt;

use anyhow::Result;
use fluoropose::camera::calibration::Calibration;
use fluoropose::finder::choice::DECISIVE_RATIO;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::CameraView;

use super::finder::Finder;

/// A camera that fits by so little better alone, pixels, sees the same: no calibration is better.
const SAME_PX: f64 = 0.1;

/// Two cameras that see the implant at two poses. In words it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// What a camera's mask leaves of what it meets at the pose for both, pixels.
    pub together_px: f64,
    /// What it leaves at the nearest pose of its own, pixels.
    pub alone_px: f64,
}

impl Contradiction {
    /// Whether cameras contradict each other at a pose that was brought onto the masks of all: the worst of them, where one does.
    ///
    /// # Errors
    /// Where the model cannot be drawn.
    pub fn at(
        finder: &mut Finder<'_>,
        views: &[CameraView<'_>],
        pose: &Pose,
    ) -> Result<Option<Self>> {
        let mut worst: Option<Self> = None;
        for view in views {
            let view = std::slice::from_ref(view);
            let together_px = finder.fit_views(view, pose)?.residual_px;
            let Some((own, _)) = finder.refine_views(view, &[*pose])?.into_iter().next() else {
                continue;
            };
            let alone_px = finder.fit_views(view, &own.pose)?.residual_px;
            let one = Self {
                together_px,
                alone_px,
            };
            if together_px > (alone_px + SAME_PX).max(DECISIVE_RATIO * alone_px)
                && worst.is_none_or(|worst| together_px > worst.together_px)
            {
                worst = Some(one);
            }
        }
        Ok(worst)
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a camera's mask lies {:.2} px off where both are met, and {:.2} px at a pose of its own: do both show the same moment, and is each calibration its camera's?",
            self.together_px, self.alone_px
        )
    }
}

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
/// of the two is no camera matrix or does not say where it stands, or where both stand at one place.
pub fn between(first: &Calibration, other: &Calibration) -> Option<Pose> {
    let place = |calibration: &Calibration| match calibration {
        Calibration::CameraMatrix { laboratory, .. } => {
            (*laboratory).map(|place| place.flip_camera_axes())
        }
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
        // A camera of which nothing says where it stands does not stand where the laboratory begins.
        let placeless = first.split("\nrotation").next().expect("a part");
        let (first, other, placeless) = (parse(&first), parse(&other), parse(placeless));
        assert_eq!(between(&placeless, &other), None);
        assert_eq!(between(&first, &placeless), None);
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
