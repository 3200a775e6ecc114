//! Frames that are made up, for tests.

use super::contrast::Contrast;
use super::frame_pose::FramePose;
use super::look::{Looked, Missing};
use crate::math::{radians, rotation_by};
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance};
use crate::refine::Fit;

/// What an outline that tells all tells: variances of 1e-6.
const DETERMINED: Matrix6 = {
    let mut information = [[0.0; 6]; 6];
    let mut k = 0;
    while k < 6 {
        information[k][k] = 1e6;
        k += 1;
    }
    information
};

/// Turned by so many degrees about the camera's y, a metre away; its edges are all there.
pub(super) fn turned(deg: f64, misfit_px: f64) -> FramePose {
    FramePose {
        pose: Pose {
            rotation: rotation_by(&[0.0, radians(deg), 0.0]),
            translation: [0.0, 0.0, -1000.0],
        },
        covariance: PoseCovariance::from_information(&DETERMINED),
        film_steps: [[0.0; 6]; 2],
        fit: Fit {
            met: 1.0,
            known: 1.0,
            ..Fit::default()
        },
        misfit_px,
        contrast: Contrast {
            step: 1.0,
            strength: 1.0,
            known: 1.0,
        },
    }
}

/// Nothing out of the ordinary came of a frame.
pub(super) fn looked(found: Result<FramePose, Missing>) -> Looked {
    Looked {
        found,
        ordinary: true,
        searched: false,
        known: 1.0,
    }
}
