//! Starts around a pose that is only roughly known: the best of those tried, and the pose itself.

use fluoropose::Silhouette;
use fluoropose::finder::nearby::{NEARBY, nearby};
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::RefineBuffers;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tests::{TRUTH, camera, femur, mesh};

#[test]
fn the_pose_itself_is_tried_after_the_best_around_it() {
    let (camera, triangles) = (camera(), femur());
    let model = mesh(&triangles);
    let (width, height) = (camera.width(), camera.height());
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).expect("valid");
    let mut projected = vec![Projected::default(); scratch_needed(&model)];
    let truth = Pose::from(TRUTH);
    render(&model, &camera, &truth, &mut projected, &mut mask).expect("drawn");
    let mask = mask.into_mask();
    let silhouette = Silhouette::from(&mask);

    let start = Pose::from(EulerPose {
        x_rot_deg: TRUTH.x_rot_deg + 2.0,
        z_mm: TRUTH.z_mm - 9.0,
        ..TRUTH
    });
    let mut buffers = RefineBuffers::default();
    let memory = &mut buffers.borrow(&model, &camera);
    let starts = nearby(&model, &camera, &silhouette, &start, 1.0, memory);
    assert_eq!(starts.len(), NEARBY);
    assert_eq!(starts.last(), Some(&start));
    let apart = |pose: &Pose| geodesic_deg(&pose.rotation, &truth.rotation);
    assert!(apart(&starts[0]) < 0.5 * apart(&start));
}
