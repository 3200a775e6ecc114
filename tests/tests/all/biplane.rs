//! Two cameras see one implant: depth is known as well as what lies in the plane.

use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::CameraView;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::finding::biplane::{Contradiction, turned_about};
use fluoropose_laboratory::finding::{Finder, Method, ViewOptions, build_library};
use fluoropose_laboratory::noise::DisturbanceOptions;
use fluoropose_laboratory::verbs::synthetic::{Protocol, Variant, measure_as};
use fluoropose_tests::{TRUTH, camera, surface, tibia};

/// A tibia is the hard case: one camera leaves its depth the weakest number.
#[test]
fn depth_is_as_good_as_the_plane() {
    let protocol = Protocol {
        method: Method::Refined,
        distance: 1084.0,
        poses: 8,
        seed: 11,
        disturbance: DisturbanceOptions::default(),
    };
    let model = surface(tibia());
    let mesh = model.as_model();
    let measure = |biplane| {
        let variant = Variant {
            biplane,
            ..Variant::default()
        };
        let views = ViewOptions::window([0.0, 0.0]);
        measure_as(mesh, camera(), &views, &protocol, variant).expect("poses are found")
    };
    let (one, two) = (measure(None).median, measure(Some(70.0)).median);
    assert!(two.z_mm < 2.0 * two.x_mm.max(two.y_mm), "{two:?}");
    assert!(two.z_mm < one.z_mm / 5.0, "{two:?} against {one:?}");
}

/// The second camera's mask is of the same moment, or of one in which the implant lay a little elsewhere.
#[test]
fn cameras_that_saw_other_moments_contradict_each_other() {
    let (model, camera) = (surface(tibia()), camera());
    let mesh = model.as_model();
    let second = turned_about(1070.0, 70.0);
    let drawn = |pose: &Pose| {
        let mut words: Vec<Word> = vec![0; words_needed(camera.width(), camera.height())];
        let mut mask = MaskMut::new(&mut words, camera.width(), camera.height()).expect("fits");
        let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
        render(&mesh, &camera, pose, &mut scratch, &mut mask).expect("in front");
        words
    };
    // Nothing is looked for in it.
    let few = "0:1:1".parse().ok();
    let views = ViewOptions {
        x: few,
        y: few,
        ..ViewOptions::window([0.0, 0.0])
    };
    let built = build_library(mesh, camera, &views, 1084.0).expect("drawn");
    let mut finder = Finder::open(&built.bytes, mesh, camera, Method::Refined).expect("its own");
    let truth = Pose::from(TRUTH);
    for (x_mm, turn_deg, contradicts) in [(0.0, 0.0, false), (2.0, 0.0, true), (0.0, 2.0, true)] {
        let then = Pose::from(EulerPose {
            x_mm: TRUTH.x_mm + x_mm,
            z_rot_deg: TRUTH.z_rot_deg + turn_deg,
            ..TRUTH
        });
        let words = [drawn(&truth), drawn(&second.compose(&then))];
        let [one, two] = words
            .each_ref()
            .map(|words| Mask::new(words, camera.width(), camera.height()).expect("fits"));
        let views = [
            CameraView::only(&camera, &one),
            CameraView {
                placement: second,
                ..CameraView::only(&camera, &two)
            },
        ];
        let found = finder.refine_views(&views, &[truth]).expect("a pose");
        let told = Contradiction::at(&mut finder, &views, &found[0].0.pose).expect("drawn");
        assert_eq!(
            told.is_some(),
            contradicts,
            "{x_mm} mm, {turn_deg} deg: {told:?}"
        );
    }
}
