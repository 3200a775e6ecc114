//! A tray and its mirror image on a film that is known.

use std::sync::OnceLock;

use fluoropose::film::{FilmConstants, FilmModel};
use fluoropose::finder::{Candidate, correct_candidates};
use fluoropose::follow::{Anchor, From, Starts, Subject, frame_pose_at, refined_on_frame};
use fluoropose::image::frame::Frame;
use fluoropose::math::{add, apply, multiply, radians, rotation_by, subtract};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{
    CameraView, Fit, ImageTarget, Polarity, RefineBuffers, RefineMemory, RefineOptions, refine,
};
use fluoropose_phantom::film::motion::{DEEPEST_DEG, knee};
use fluoropose_phantom::film::{Physics, Placed, Scene, expose};
use fluoropose_phantom::implant::{Side, Size};
use fluoropose_tests::{camera, femur, surface, tibia};

/// The tray as the demonstration's first frame has it: 4 degrees from its mirror image.
pub(crate) const TRUE: EulerPose = EulerPose {
    x_mm: -6.0,
    y_mm: -24.0,
    z_mm: -1084.0,
    z_rot_deg: 4.0,
    x_rot_deg: 0.75,
    y_rot_deg: 3.1,
};

/// What the built-in film makes of titanium.
fn film() -> FilmModel {
    FilmModel::certain(FilmConstants::plain(1.0 / 38.0, 0.7), 0.2)
}

/// The frame, which four tests want.
pub(crate) fn grey() -> &'static [u8] {
    static GREY: OnceLock<Vec<u8>> = OnceLock::new();
    GREY.get_or_init(drawn)
}

fn drawn() -> Vec<u8> {
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

pub(crate) fn shown<'f>(frame: &'f Frame<'f, u8>) -> ImageTarget<'f> {
    ImageTarget {
        frame,
        unknown: None,
        polarity: Polarity::DarkImplant,
        film: Some(film()),
    }
}

/// Turned about the middle of the model, degrees about the axes of the image, and shifted, mm.
fn moved(pose: &Pose, middle: &[f64; 3], [x, y]: [f64; 2], shift: [f64; 3]) -> Pose {
    let turn = rotation_by(&[radians(x), radians(y), 0.0]);
    let centre = pose.transform(middle);
    let arm = apply(&turn, &subtract(&pose.translation, &centre));
    Pose {
        rotation: multiply(&turn, &pose.rotation),
        translation: add(&add(&arm, &centre), &shift),
    }
}

/// One click found the mirror image alone, before anything was known of the film, and it was called good.
#[test]
fn the_mirror_image_of_a_corrected_tray_is_looked_at() {
    let (pixels, camera, model) = (grey(), camera(), surface(tibia()));
    let model = model.as_model();
    let planes = symmetry_planes(model.mesh());
    let frame = Frame::new(pixels, camera.width(), camera.height(), camera.width());
    let frame = frame.expect("fits");
    let image = shown(&frame);
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

/// Work on a tray in its frame, whose film is known.
fn on_the_tray(work: impl FnOnce(&Subject<'_>, &ImageTarget<'_>, &mut RefineMemory<'_>)) {
    let (pixels, camera, model) = (grey(), camera(), surface(tibia()));
    let model = model.as_model();
    let frame = Frame::new(pixels, camera.width(), camera.height(), camera.width());
    let frame = frame.expect("fits");
    let image = shown(&frame);
    let subject = Subject::new(&model, &[], &camera);
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &camera);
    work(&subject, &image, &mut memory);
}

/// Starts around a pose, with how far off they are, degrees.
fn around(truth: &Pose, middle: &[f64; 3]) -> impl Iterator<Item = (Pose, f64)> {
    let ways = (0..6).flat_map(|turn| [1.0, 3.0, 6.0].map(|deg| (turn, deg)));
    ways.map(|(turn, deg)| {
        let (sin, cos) = f64::from(turn).sin_cos();
        (moved(truth, middle, [deg * cos, deg * sin], [0.0; 3]), deg)
    })
}

#[test]
fn what_is_given_up_on_the_way_would_have_left_more() {
    on_the_tray(|subject, image, memory| {
        let (truth, middle) = (Pose::from(TRUE), subject.model.bounds().centre);

        // A hand leaves more than is usual.
        let by_hand = moved(&truth, &middle, [0.0; 2], [0.35, -0.3, 0.0]);
        let seen = frame_pose_at(subject, image, &by_hand, memory).expect("drawn");
        let anchor = Anchor::fixed(subject, image, (3, &by_hand), memory).expect("drawn");
        assert_eq!((anchor.found, anchor.fixed), (seen, true));
        let usual = anchor.usual.misfit_px;
        assert!(usual < 0.5 * seen.misfit_px, "{usual} {}", seen.misfit_px);

        let (mut kept, mut left) = (0, 0);
        for (start, deg) in around(&truth, &middle) {
            let start = (&start, From::Near);
            let whole = refined_on_frame(subject, image, start, memory).expect("refined");
            let any = Starts::new(subject, image).lead(start, memory);
            assert_eq!(any, Some(whole));
            let most_px = 1.5 * usual;
            let within = Starts::new(subject, image).lead_within(most_px, start, memory);
            match whole.misfit_px <= most_px {
                true => assert_eq!(within, Some(whole), "{deg} degrees"),
                false => assert_eq!(within, None, "{deg} degrees"),
            }
            *(if within.is_some() {
                &mut kept
            } else {
                &mut left
            }) += 1;
        }
        assert!(kept > 3 && left > 3, "{kept} {left}");
    });
}

/// The naive way is to go to the end from each start.
#[test]
fn what_is_given_up_at_a_known_pose_would_have_ended_there() {
    on_the_tray(|subject, image, memory| {
        let (truth, middle) = (Pose::from(TRUE), subject.model.bounds().centre);
        let own = refined_on_frame(subject, image, (&truth, From::Near), memory);
        let own = own.expect("refined");
        let covariance = own.covariance.expect("determined");
        let starts = Starts::new(subject, image).knowing(&[own.pose]);
        let (mut back, mut on) = (0, 0);
        for (start, deg) in around(&truth, &middle) {
            let start = (&start, From::Near);
            let whole = refined_on_frame(subject, image, start, memory).expect("refined");
            match starts.lead(start, memory) {
                // The same bits.
                Some(one) => {
                    assert_eq!(one, whole, "{deg} degrees");
                    on += 1;
                }
                None => {
                    let is_there = covariance.holds(&own.pose, &whole.pose, &middle, 0.6 * 0.6);
                    assert_eq!(is_there, Some(true), "{deg} degrees");
                    back += 1;
                }
            }
        }
        assert!(back > 5 && on > 1, "{back} {on}");
    });
}
