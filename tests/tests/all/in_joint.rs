//! A component where its joint leaves it beside the other one.

use fluoropose::camera::Camera;
use fluoropose::follow::{InJoint, JointSearch, Limb, Subject};
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::math::{norm, subtract};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::{KneeComponent, anatomical_axes};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::finding::{Clicker, Neighbour, ViewOptions, build_library};
use fluoropose_phantom::film::motion::{Position, deep_knee_bend};
use fluoropose_phantom::implant::Side;
use fluoropose_tests::{coarse_parts, surface, turned};
use fluoropose_tracing::one_click::Prompt;

use crate::track::{camera, frame};

const SIDE: usize = 384;
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
    let parts = coarse_parts();
    let film: Vec<Position> = deep_knee_bend(24, Side::Left, &parts[0], 70.0, 1);
    let back = by.inverse();
    let poses = film.iter().map(|position| {
        [position.femur, position.tibia].map(|pose| Pose::from(pose).compose(&back))
    });
    (
        parts.map(|part| turned(&surface(part), by)),
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

/// A frame of a knee that bends, and what is known of it.
struct Scene {
    grey: Vec<u8>,
    models: [OwnedModel; 2],
    camera: Camera,
    /// Of the femur, and of the tray.
    poses: [Pose; 2],
    /// The femur's silhouette.
    femurs: Vec<Word>,
}

impl Scene {
    /// With a tray that is so much darker than what surrounds it.
    fn of(darker: f64, number: usize) -> Self {
        let (models, _) = knee(&Pose::IDENTITY);
        let [thigh, tray] = coarse_parts();
        let film = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1);
        let Position { femur, tibia, .. } = film[number];
        let camera = camera(SIDE);
        let mut femurs = vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut femurs, SIDE, SIDE).expect("fits");
        let known = models[0].as_model();
        let mut scratch = vec![Projected::default(); scratch_needed(&known)];
        let poses = [femur, tibia].map(Pose::from);
        render(&known, &camera, &poses[0], &mut scratch, &mut mask).expect("in front");
        Self {
            grey: frame(
                SIDE,
                [(&thigh, femur, 120.0), (&tray, tibia, darker)],
                number,
            ),
            models,
            camera,
            poses,
            femurs,
        }
    }

    fn frame(&self) -> Frame<'_, u8> {
        Frame::new(&self.grey, SIDE, SIDE, SIDE).expect("fits")
    }

    fn covered(&self) -> Mask<'_> {
        Mask::new(&self.femurs, SIDE, SIDE).expect("fits")
    }

    fn joint(&self) -> InJoint {
        InJoint::beside(&self.limb(0), &self.poses[0])
    }

    fn limb(&self, part: usize) -> Limb<'_> {
        limb(&self.models[part], KINDS[part])
    }
}

/// What the search finds of a tray beside its femur.
fn found(scene: &Scene) -> Option<Pose> {
    let (frame, femurs) = (scene.frame(), scene.covered());
    let image = ImageTarget {
        frame: &frame,
        unknown: Some(&femurs),
        polarity: Polarity::DarkImplant,
        film: None,
    };
    let model = scene.models[1].as_model();
    let planes = symmetry_planes(model.mesh());
    let subject = Subject::new(&model, &planes, &scene.camera);
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &scene.camera);
    let mut search = JointSearch::new(&image, &scene.joint(), &scene.limb(1));
    let mut steps = 1;
    while search.step(&subject, &image, &mut memory) {
        steps += 1;
    }
    assert!(steps > 8 && search.progress() >= 1.0);
    search.found().map(|found| found.pose)
}

/// How far a tray is turned from where it is in a scene, or its mirror image, degrees, and how far it lies across the view, mm.
fn off_truth(scene: &Scene, pose: &Pose) -> [f64; 2] {
    let (truth, model) = (scene.poses[1], &scene.models[1]);
    let plane = symmetry_planes(model.as_model().mesh())[0];
    let turn = [*pose, mirror_pose(pose, &plane)]
        .map(|side| geodesic_deg(&side.rotation, &truth.rotation));
    [turn[0].min(turn[1]), off(pose, &truth, model)[0]]
}

#[test]
fn a_faint_tray_is_found_beside_its_femur_and_none_where_there_is_none() {
    for number in [0, 40, 79] {
        let scene = Scene::of(30.0, number);
        let [turn, across] = off_truth(&scene, &found(&scene).expect("it is there"));
        assert!(
            turn < 3.0 && across < 2.0,
            "{number}: {turn} deg, {across} mm"
        );
        assert_eq!(found(&Scene::of(0.0, number)), None, "{number}");
    }
}

/// What is darker than a tray right beside it is its region's: the click alone leads elsewhere.
#[test]
fn a_click_into_a_tray_that_is_no_region_leads_to_it_where_the_femur_is_known() {
    let mut scene = Scene::of(30.0, 40);
    let model = scene.models[1].as_model();
    let middle = scene.poses[1].transform(&model.bounds().centre);
    let click = scene.camera.project(&middle).expect("in front");
    shade_around(&mut scene.grey, click);
    let views = ViewOptions::default();
    let library = build_library(model, scene.camera, &views, -middle[2]).expect("built");
    let mut clicker = Clicker::open(&library.bytes, model, scene.camera).expect("valid");
    let (joint, clicked) = (scene.joint(), scene.limb(1));
    let neighbour = Neighbour {
        joint: &joint,
        clicked: &clicked,
        covered: scene.covered(),
    };
    let mut best = |neighbour| {
        let (frame, prompt) = (scene.frame(), Prompt::Click(click));
        let clicked = clicker.click(&frame, prompt, Polarity::DarkImplant, neighbour);
        clicked.ok().map(|clicked| clicked.answers[0])
    };
    let alone = best(None).map_or(f64::MAX, |answer| {
        off_truth(&scene, &answer.refined.pose)[0]
    });
    assert!(alone > 10.0, "the frame is too easy: {alone} deg");
    let answer = best(Some(&neighbour)).expect("it is there");
    let [turn, across] = off_truth(&scene, &answer.refined.pose);
    assert!(turn < 3.0 && across < 2.0, "{turn} deg, {across} mm");
}

/// Makes a frame darker to the right of a place, as a second leg does: by less than metal, but over a large part.
fn shade_around(grey: &mut [u8], at: Point) {
    let first = at.column as usize;
    for row in grey.chunks_mut(SIDE) {
        for value in &mut row[first..] {
            *value = value.saturating_sub(40);
        }
    }
}
