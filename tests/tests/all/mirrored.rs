//! A tray and its mirror image on a film that is known.

use fluoropose::film::{FilmConstants, FilmModel};
use fluoropose::finder::{Candidate, correct_candidates};
use fluoropose::image::frame::Frame;
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{
    CameraView, Fit, ImageTarget, Polarity, RefineBuffers, RefineOptions, refine,
};
use fluoropose_phantom::film::motion::{DEEPEST_DEG, knee};
use fluoropose_phantom::film::{Physics, Placed, Scene, expose};
use fluoropose_phantom::implant::{Side, Size};
use fluoropose_tests::{camera, femur, surface, tibia};

/// The tray as the demonstration's first frame has it: 4 degrees from its mirror image.
const TRUE: EulerPose = EulerPose {
    x_mm: -6.0,
    y_mm: -24.0,
    z_mm: -1084.0,
    z_rot_deg: 4.0,
    x_rot_deg: 0.75,
    y_rot_deg: 3.1,
};

/// What the built-in film makes of titanium.
fn film() -> FilmModel {
    let constants = FilmConstants {
        curvature: 1.0 / 38.0,
        blur_px: 0.7,
    };
    FilmModel::certain(constants, 0.2)
}

fn grey() -> Vec<u8> {
    let (femur, tibia, camera) = (femur(), tibia(), camera());
    let width_mm = Size::default().width_mm();
    let position = knee(TRUE, DEEPEST_DEG / 2.0, Side::Left, &femur, width_mm);
    let scene = Scene {
        camera,
        side: Side::Left,
        width_mm,
        femur: Placed::at_rest(&femur, position.femur.into()),
        tibia: Placed::at_rest(&tibia, position.tibia.into()),
    };
    expose(&scene, &Physics::default(), 1, 0).expect("a film")
}

/// One click found the mirror image alone, before anything was known of the film, and it was called good.
#[test]
fn the_mirror_image_of_a_corrected_tray_is_looked_at() {
    let (pixels, camera, model) = (grey(), camera(), surface(tibia()));
    let model = model.as_model();
    let planes = symmetry_planes(model.mesh());
    let frame = Frame::new(&pixels, camera.width(), camera.height(), camera.width());
    let image = ImageTarget {
        frame: &frame.expect("fits"),
        unknown: None,
        polarity: Polarity::DarkImplant,
        film: Some(film()),
    };
    let (options, mut buffers) = (RefineOptions::default(), RefineBuffers::default());
    let mut memory = buffers.borrow(&model, &camera);
    let truth = Pose::from(TRUE);
    let start = mirror_pose(&truth, &planes[0]);
    let view = [CameraView::only(&camera, image)];
    let wrong = refine(&model, &view, &start, options, &mut memory).expect("refined");
    let wrong = Candidate {
        pose: wrong.pose,
        start,
        located: None,
        refined: Some(wrong),
        covariance: None,
        fit: Fit::default(),
    };
    let off = |pose: &Pose| geodesic_deg(&pose.rotation, &truth.rotation);
    let mut corrected = |planes: &[_]| {
        let seen = (&camera, image);
        correct_candidates(&model, seen, planes, &[wrong], options, &mut memory).expect("corrected")
    };
    let alone = corrected(&[]);
    assert!(alone.len() == 1 && off(&alone[0].pose) > 3.0);
    let both = corrected(&planes);
    assert_eq!(both.len(), 2);
    assert!(off(&both[0].pose) < 0.4, "{:.2} deg", off(&both[0].pose));
    // So much less remains there that nobody has to be asked.
    assert!(1.3 * both[0].misfit() < both[1].misfit());
}
