//! A component where its joint leaves it beside the other one.

use fluoropose::camera::Camera;
use fluoropose::follow::{InJoint, JointSearch, Limb, Subject};
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::math::{norm, subtract};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::{KneeComponent, anatomical_axes};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_phantom::film::motion::{Position, deep_knee_bend};
use fluoropose_phantom::implant::Side;
use fluoropose_tests::{femur, surface, tibia, turned};

use crate::track::{SIDE, frame};

const KINDS: [KneeComponent; 2] = [KneeComponent::Femur, KneeComponent::Tibia];

fn limb(model: &OwnedModel, component: KneeComponent) -> Limb<'_> {
    let mesh = *model.as_model().mesh();
    let axes = anatomical_axes(&mesh, &symmetry_planes(&mesh), component);
    Limb {
        mesh,
        component,
        axes: axes.expect("the shape tells"),
    }
}

/// Femur and tray, the same with their files' axes turned by `by`, and a knee that bends.
fn knee(by: &Pose) -> ([OwnedModel; 2], Vec<[Pose; 2]>) {
    let film: Vec<Position> = deep_knee_bend(24, Side::Left, &femur(), 70.0, 1);
    let back = by.inverse();
    let poses = film.iter().map(|position| {
        [position.femur, position.tibia].map(|pose| Pose::from(pose).compose(&back))
    });
    (
        [femur(), tibia()].map(|part| turned(&surface(part), by)),
        poses.collect(),
    )
}

/// Across and along the view, mm.
fn off(one: &Pose, other: &Pose, model: &OwnedModel) -> [f64; 2] {
    let middle = model.as_model().bounds().centre;
    let [x, y, z] = subtract(&one.transform(&middle), &other.transform(&middle));
    [norm(&[x, y, 0.0]), z.abs()]
}

#[test]
fn one_of_the_expected_poses_is_near_at_any_flexion_and_whatever_the_axes() {
    let turned = Pose {
        rotation: [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        translation: [11.0, -5.0, 40.0],
    };
    for by in [Pose::IDENTITY, turned] {
        let (models, film) = knee(&by);
        let limbs = [0, 1].map(|k| limb(&models[k], KINDS[k]));
        for (poses, known) in film.iter().flat_map(|poses| [(poses, 0), (poses, 1)]) {
            let sought = 1 - known;
            let joint = InJoint::beside(&limbs[known], &poses[known]);
            let near = joint.poses(&limbs[sought]).filter(|expected| {
                let [across, along] = off(expected, &poses[sought], &models[sought]);
                let turn = geodesic_deg(&expected.rotation, &poses[sought].rotation);
                turn < 16.0 && across < 16.0 && along < 5.0
            });
            assert!(near.count() >= 1, "{:?} sought", KINDS[sought]);
        }
    }
}

/// What the search finds of a tray beside its femur in a frame whose tray is so much darker than what surrounds it.
fn found(darker: f64, number: usize) -> (Option<Pose>, Pose) {
    let (models, _) = knee(&Pose::IDENTITY);
    let (thigh, tray) = (femur(), tibia());
    let film = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1);
    let Position { femur, tibia, .. } = film[number];
    let grey = frame([(&thigh, femur, 120.0), (&tray, tibia, darker)], number);
    let [known, sought] = &models;
    let camera = Camera::from_principal_distance(SIDE, SIDE, 1200.0, 0.746, [0.0, 0.0]);
    let camera = camera.expect("valid");
    let mut words = vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    let mut scratch = vec![Projected::default(); scratch_needed(&known.as_model())];
    let pose = Pose::from(femur);
    render(&known.as_model(), &camera, &pose, &mut scratch, &mut mask).expect("in front");
    let femurs = mask.into_mask();
    let frame = Frame::new(&grey, SIDE, SIDE, SIDE).expect("fits");
    let image = ImageTarget {
        frame: &frame,
        unknown: Some(&femurs),
        polarity: Polarity::DarkImplant,
        film: None,
    };
    let model = sought.as_model();
    let planes = symmetry_planes(model.mesh());
    let subject = Subject::new(&model, &planes, &camera);
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &camera);
    let joint = InJoint::beside(&limb(known, KneeComponent::Femur), &pose);
    let mut search = JointSearch::new(&image, &joint, &limb(sought, KneeComponent::Tibia));
    let mut steps = 1;
    while search.step(&subject, &image, &mut memory) {
        steps += 1;
    }
    assert!(steps > 8 && search.progress() >= 1.0);
    (search.found().map(|found| found.pose), tibia.into())
}

#[test]
fn a_faint_tray_is_found_beside_its_femur_and_none_where_there_is_none() {
    let (models, _) = knee(&Pose::IDENTITY);
    let planes = symmetry_planes(models[1].as_model().mesh());
    for number in [0, 40, 79] {
        let (pose, truth) = found(30.0, number);
        let pose = pose.expect("it is there");
        let sides = [pose, mirror_pose(&pose, &planes[0])];
        let turn = sides.map(|side| geodesic_deg(&side.rotation, &truth.rotation));
        let [across, _] = off(&pose, &truth, &models[1]);
        assert!(
            turn[0].min(turn[1]) < 3.0 && across < 2.0,
            "{number}: {turn:?}, {across} mm"
        );
        assert_eq!(found(0.0, number).0, None, "{number}");
    }
}
