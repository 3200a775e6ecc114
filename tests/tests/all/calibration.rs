//! A calibration that is of other frames is not believed because an outline fits.

use fluoropose::camera::Camera;
use fluoropose::finder::{Doubt, Limits, Verdict, judge_fit};
use fluoropose::image::mask::Mask;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, RefineBuffers, fit_at, refine};
use fluoropose_phantom::film::{Placed, silhouette};
use fluoropose_tests::{SEEN_FEMUR, femur, surface};

const DISTANCE: f64 = 1198.0;
const PITCH: f64 = 0.373;
fn camera(pitch: f64) -> Camera {
    Camera::from_principal_distance(1024, 1024, DISTANCE, pitch, [0.0; 2]).expect("possible")
}

/// Refined from `start` and judged, as the finder does.
fn judged(model: &Model<'_>, camera: &Camera, seen: Silhouette<'_>, start: &Pose) -> Verdict {
    let (view, mut buffers) = ([CameraView::only(camera, seen)], RefineBuffers::default());
    let mut memory = buffers.borrow(model, camera);
    let refined = refine(model, &view, start, Default::default(), &mut memory).expect("refined");
    let fit = fit_at(model, &view, &refined.pose, &mut memory).expect("seen");
    judge_fit(&fit, true, &Limits::USUAL)
}

#[test]
fn a_fit_behind_the_detector_is_doubtful() {
    let femur = femur();
    let words =
        silhouette(&camera(PITCH), &Placed::at_rest(&femur, SEEN_FEMUR.into())).expect("drawn");
    let mask = Mask::new(&words, 1024, 1024).expect("fits");
    let (seen, model) = (Silhouette::from(&mask), surface(femur));
    let model = model.as_model();

    let truth = Pose::from(SEEN_FEMUR);
    assert_eq!(judged(&model, &camera(PITCH), seen, &truth), Verdict::Good);

    // Frames of 2048 pixels a side have half the pitch: the outline fits as well at twice the depth.
    let mut twice = truth;
    twice.translation = truth.translation.map(|mm| 2.0 * mm);
    let of_others = camera(PITCH / 2.0);
    let Verdict::Doubtful(Doubt::Behind { mm }) = judged(&model, &of_others, seen, &twice) else {
        panic!("not told");
    };
    let middle = twice.transform(&model.bounds().centre);
    assert!((mm - (-middle[2] - DISTANCE)).abs() < 60.0, "{mm}");

    // A camera matrix knows of no detector.
    let matrix = Camera::new(1024, 1024, of_others.focal(), of_others.principal_point());
    let matrix = matrix.expect("possible");
    assert_eq!(judged(&model, &matrix, seen, &twice), Verdict::Good);
}
