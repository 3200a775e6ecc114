//! A part before a camera, for tests.

use std::vec;
use std::vec::Vec;

use crate::camera::Camera;
use crate::image::mask::{Mask, MaskMut, Word, words_needed};
use crate::library::ViewRecord;
use crate::locate::Located;
use crate::locate::interpolate::FineView;
use crate::locate::rerank::Reranked;
use crate::math::{radians, rotation_by};
use crate::mesh::OwnedModel;
use crate::mesh::edges::fake::add_box;
use crate::pose::Pose;
use crate::render::{Projected, render, scratch_needed};

/// Columns and rows of the frame.
pub(crate) const SIDE: usize = 160;
/// Grey values of metal and of what is beside it.
pub(crate) const METAL: u8 = 40;
pub(crate) const BESIDE: u8 = 200;

/// A crank of three boxes, which has no symmetry.
pub(crate) fn crank() -> OwnedModel {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for (low, high) in [
        ([-40.0, -12.0, -15.0], [40.0, 12.0, 15.0]),
        ([18.0, 0.0, -10.0], [40.0, 45.0, 8.0]),
        ([-40.0, -38.0, -6.0], [-25.0, 0.0, 14.0]),
    ] {
        add_box(low, high, &mut vertices, &mut triangles);
    }
    let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
    OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("valid")
}

/// That sees it in half of its width from a metre away.
pub(crate) fn camera() -> Camera {
    Camera::new(SIDE, SIDE, [1000.0, 980.0], [81.0, 78.5]).expect("valid")
}

/// A metre away in the middle of the frame, turned about the camera's axes by so many degrees, as a rotation vector, and shifted, mm.
pub(crate) fn placed(turn_deg: [f64; 3], [right, up, nearer]: [f64; 3]) -> Pose {
    Pose {
        rotation: rotation_by(&turn_deg.map(radians)),
        translation: [right, up, nearer - 1000.0],
    }
}

/// The words of the mask that the part has at a pose.
pub(crate) fn drawn(model: &OwnedModel, camera: &Camera, pose: &Pose) -> Vec<Word> {
    let mut words = vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    let model = model.as_model();
    let mut scratch = vec![Projected::default(); scratch_needed(&model)];
    render(&model, camera, pose, &mut scratch, &mut mask).expect("in front");
    words
}

/// The grey frame that it has there.
pub(crate) fn grey(model: &OwnedModel, camera: &Camera, pose: &Pose) -> Vec<u8> {
    let words = drawn(model, camera, pose);
    let mask = Mask::new(&words, SIDE, SIDE).expect("fits");
    let value = |at: usize| match mask.get(at % SIDE, at / SIDE) {
        true => METAL,
        false => BESIDE,
    };
    (0..SIDE * SIDE).map(value).collect()
}

/// What the library said of a pose that leaves so many pixels unmatched.
pub(crate) fn located(unmatched: u64) -> Reranked {
    Reranked {
        located: Located {
            pose: Pose::IDENTITY,
            view: 0,
            fine: FineView {
                record: ViewRecord::default(),
                reversed: false,
                unmatched: 0,
                at_border: false,
            },
            by_pieces: false,
        },
        unmatched,
    }
}
