//! A film followed by a caller that gives frames when they are asked for, as the page does.

use fluoropose::follow::{
    Conclusion, Following, KnownFemur, State, Subject, Why, elsewhere, frame_pose_at, mirrored_pose,
};
use fluoropose::image::frame::Frame;
use fluoropose::math::{add, apply, multiply, rotation_by, subtract};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers};
use fluoropose_phantom::film::motion::{Position, deep_knee_bend};
use fluoropose_phantom::implant::{Side, Triangles};
use fluoropose_tests::{coarse_parts, surface};

use crate::track::{camera, frame};

/// Of a frame, pixels.
const SIDE: usize = 512;
/// Of a film by which a leaning femur is told.
const FRAMES: usize = 6;
/// Grey value of a frame in which nothing is.
const EMPTY: u8 = 200;

/// Frames of a component's film, given when they are asked for.
struct Given<'f> {
    part: &'f Triangles,
    frames: &'f [Vec<u8>],
    asked: Vec<usize>,
    /// Frames that were searched as a whole, and what is found in those that are not empty.
    searched: Vec<usize>,
    there: Option<Pose>,
    /// Whether the part's planes of symmetry are known.
    has_planes: bool,
}

impl<'f> Given<'f> {
    fn new(part: &'f Triangles, frames: &'f [Vec<u8>]) -> Self {
        Self {
            part,
            frames,
            asked: Vec::new(),
            searched: Vec::new(),
            there: None,
            has_planes: true,
        }
    }

    /// Gives all frames that are asked for.
    fn go_on(&mut self, following: &mut Following) {
        self.give(following, usize::MAX);
    }

    /// Gives so many of the frames that are asked for.
    fn give(&mut self, following: &mut Following, most: usize) {
        let model = surface(self.part.clone());
        let model = model.as_model();
        let camera = camera(SIDE);
        let planes = symmetry_planes(model.mesh());
        let planes: &[_] = if self.has_planes { &planes } else { &[] };
        let subject = Subject::new(&model, planes, &camera);
        let mut buffers = RefineBuffers::default();
        for _ in 0..most {
            let Some(number) = following.wanted() else {
                return;
            };
            if following.is_search() {
                self.searched.push(number);
                let is_empty = self.frames[number].iter().all(|&grey| grey == EMPTY);
                following.searched(self.there.filter(|_| !is_empty));
                continue;
            }
            self.asked.push(number);
            let frame = Frame::new(&self.frames[number], SIDE, SIDE, SIDE).expect("fits");
            let image = ImageTarget {
                frame: &frame,
                unknown: None,
                polarity: Polarity::DarkImplant,
                film: None,
            };
            let mut memory = buffers.borrow(&model, &camera);
            following
                .take(&subject, &image, &mut memory)
                .expect("drawn");
        }
    }
}

fn assert_followed(film: &[Conclusion], truth: &[EulerPose], fixed: &[usize]) {
    for (frame, (one, truth)) in film.iter().zip(truth).enumerate() {
        let (pose, truth) = (
            one.pose.expect("every frame is visible"),
            Pose::from(*truth),
        );
        let turn = geodesic_deg(&pose.rotation, &truth.rotation);
        assert!(turn < 2.0, "frame {frame}: {turn} {one:?}");
        assert_eq!(one.state == State::Fixed, fixed.contains(&frame));
        let is_between = frame > 0 && frame + 1 < film.len();
        let agrees = if is_between {
            Why::Agrees
        } else {
            Why::AgreesAlone
        };
        assert!(
            one.state != State::Followed || one.why == agrees,
            "frame {frame}: {one:?}"
        );
        assert!(one.state != State::Fixed || pose == truth, "frame {frame}");
    }
    // Where the film is not known, a turn may count as undetermined.
    let doubtful = film.iter().filter(|one| one.state == State::Doubtful);
    assert!(doubtful.count() <= 1, "{film:?}");
}

#[test]
fn frames_that_are_asked_for_one_by_one_are_followed_alike() {
    let [thigh, tray] = coarse_parts();
    let motion = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1);
    let frames: Vec<Vec<u8>> = (0..FRAMES)
        .map(|number| {
            let Position { femur, tibia, .. } = motion[number];
            let parts = [(&thigh, femur, 120.0), (&tray, tibia, 70.0)];
            frame(SIDE, parts, number)
        })
        .collect();
    let truth = |of: fn(usize, &[Position]) -> EulerPose| {
        let poses = (0..FRAMES).map(|number| of(number, &motion));
        poses.collect::<Vec<EulerPose>>()
    };
    let femurs = truth(|number, film| film[number].femur);
    let tibiae = truth(|number, film| film[number].tibia);
    let follow =
        |part: &Triangles, truth: &[EulerPose], fixed: &[usize], femur: Option<KnownFemur>| {
            let middle = surface(part.clone()).as_model().bounds().centre;
            let mut following = Following::new(middle, FRAMES, 0..FRAMES);
            for &frame in fixed {
                following.give(frame, truth[frame].into(), true);
            }
            let mut given = Given::new(part, &frames);
            given.go_on(&mut following);
            let mut first = given.asked.clone();
            first.sort_unstable();
            first.dedup();
            assert_eq!(first, (0..FRAMES).collect::<Vec<_>>());
            // At once, or after both sides were seen.
            if femur.is_some() {
                following.see_sides();
                given.go_on(&mut following);
            }
            following.choose_sides(femur);
            given.go_on(&mut following);
            following
        };
    // From one end; from both, so that two ways meet.
    let femur = follow(&thigh, &femurs, &[0], None);
    assert_followed(&femur.conclude(&[]), &femurs, &[0]);
    let known = KnownFemur {
        poses: femur.conclude(&[]).iter().map(|one| one.pose).collect(),
        axes: Pose::IDENTITY,
    };
    let ends = [0, FRAMES - 1];
    let tibia = follow(&tray, &tibiae, &ends, Some(known.clone()));
    let middles = femur.middles();
    assert_followed(&tibia.conclude(&middles), &tibiae, &ends);
    // With a femur of which less was known, and with one that leans so far that it tells the other side.
    let tibia = follow(&tray, &tibiae, &[0], Some(known.clone()));
    for (deg, stands) in [(0.3, true), (-25.0, false)] {
        let mut early = follow(&tray, &tibiae, &[0], Some(leaning(&known, deg)));
        assert_eq!(early.stands_with(Some(known.clone())), stands, "{deg}");
        let same = early.conclude(&middles) == tibia.conclude(&middles);
        assert_eq!(same, stands, "{deg}");
    }
}

/// The femur turned about its model's x, degrees.
fn leaning(femur: &KnownFemur, deg: f64) -> KnownFemur {
    let turn = Pose::from(EulerPose {
        x_rot_deg: deg,
        ..EulerPose::default()
    });
    let lean = |pose: &Option<Pose>| pose.map(|pose| pose.compose(&turn));
    KnownFemur {
        poses: femur.poses.iter().map(lean).collect(),
        axes: femur.axes,
    }
}

#[test]
fn from_a_false_pose_turned_to_any_side_the_right_one_is_seen_elsewhere() {
    let [thigh, tray] = coarse_parts();
    let at = &deep_knee_bend(80, Side::Left, &thigh, 70.0, 1)[30];
    let grey = frame(
        SIDE,
        [(&thigh, at.femur, 120.0), (&tray, at.tibia, 70.0)],
        0,
    );
    let frame = Frame::new(&grey, SIDE, SIDE, SIDE).expect("fits");
    let image = ImageTarget {
        frame: &frame,
        unknown: None,
        polarity: Polarity::DarkImplant,
        film: None,
    };
    let camera = camera(SIDE);
    for (part, truth) in [
        (&thigh, Pose::from(at.femur)),
        (&tray, Pose::from(at.tibia)),
    ] {
        let model = surface(part.clone());
        let model = model.as_model();
        let planes = symmetry_planes(model.mesh());
        let subject = Subject::new(&model, &planes, &camera);
        let mut buffers = RefineBuffers::default();
        let mut memory = buffers.borrow(&model, &camera);
        for side in 0..8 {
            let (sin, cos) = (f64::from(side) * 0.7 + 0.2).sin_cos();
            let turn = rotation_by(&[0.14 * cos, 0.14 * sin, 0.0]);
            // About the middle of the component, as far as it lies off the view's axis.
            let middle = truth.transform(&model.bounds().centre);
            let turned = Pose {
                rotation: multiply(&turn, &truth.rotation),
                translation: add(
                    &apply(&turn, &subtract(&truth.translation, &middle)),
                    &middle,
                ),
            };
            let own = frame_pose_at(&subject, &image, &turned, &mut memory).expect("drawn");
            let other = elsewhere(&subject, &image, (&own, None), &mut memory).expect("found");
            let off = geodesic_deg(&other.pose.rotation, &truth.rotation);
            assert!(off < 2.0, "side {side}: {off} degrees");
            // Where it and its mirror image are known, what else there is leaves more.
            let mirrored = mirrored_pose(&subject, &image, &other, &mut memory);
            let known = (&other, mirrored.as_ref());
            let else_there = elsewhere(&subject, &image, known, &mut memory);
            let ratio = else_there.map(|there| there.misfit_px / other.misfit_px);
            assert!(
                ratio.is_none_or(|ratio| ratio > 1.1),
                "side {side}: {ratio:?}"
            );
        }
    }
}

/// A femur that rests for some frames, is gone for ten, and rests elsewhere for eight; its poses before and after.
fn interrupted(before: usize) -> (Triangles, [Pose; 2], Vec<Vec<u8>>) {
    let [thigh, tray] = coarse_parts();
    let motion = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1);
    let [first, last] = [&motion[0], &motion[60]];
    let seen = |at: &Position| {
        frame(
            SIDE,
            [(&thigh, at.femur, 120.0), (&tray, at.tibia, 70.0)],
            0,
        )
    };
    let mut frames = vec![seen(first); before];
    frames.extend(vec![vec![EMPTY; SIDE * SIDE]; 10]);
    frames.extend(vec![seen(last); 8]);
    let poses = [first.femur.into(), last.femur.into()];
    (thigh, poses, frames)
}

/// A tray at rest that a person set on either side of its mirror, whose mirror images nobody can look at.
#[test]
fn a_frame_to_which_both_ends_of_the_film_come_otherwise_is_compared_with_the_other_end() {
    let [thigh, tray] = coarse_parts();
    let Position { femur, tibia, .. } = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1)[0];
    let frames = vec![frame(SIDE, [(&thigh, femur, 120.0), (&tray, tibia, 70.0)], 0); FRAMES];
    let owned = surface(tray.clone());
    let model = owned.as_model();
    let plane = symmetry_planes(model.mesh())[0];
    let right = Pose::from(tibia);
    let sides = [right, mirror_pose(&right, &plane)];
    let mut following = Following::new(model.bounds().centre, FRAMES, 0..FRAMES);
    following.give(0, sides[0], true);
    following.give(FRAMES - 1, sides[1], true);
    let mut given = Given::new(&tray, &frames);
    given.has_planes = false;
    given.go_on(&mut following);
    following.choose_sides(None);
    given.go_on(&mut following);
    following.compare_sides(1..FRAMES - 1);
    given.go_on(&mut following);
    let off = |pose: &Pose, side: usize| geodesic_deg(&pose.rotation, &sides[side].rotation);
    for frame in 1..FRAMES - 1 {
        let own = following.cells()[frame].found().expect("seen").pose;
        let rival = following.rival(frame).expect("the other way").pose;
        let side = usize::from(off(&own, 1) < off(&own, 0));
        assert!(
            off(&own, side) < 5.0 && off(&rival, 1 - side) < 5.0,
            "{frame}: {own:?} {rival:?}"
        );
    }
}

#[test]
fn what_was_lost_is_looked_for_in_whole_frames_and_followed_from_there() {
    let (thigh, [before, after], frames) = interrupted(2);
    let middle = surface(thigh.clone()).as_model().bounds().centre;
    let mut following = Following::new(middle, frames.len(), 0..frames.len());
    following.give(0, before, true);
    following.search_where_lost();
    let mut given = Given::new(&thigh, &frames);
    given.there = Some(after);
    given.go_on(&mut following);
    assert_eq!(given.searched, [11, 6, 17, 7]);
    let found: Vec<usize> = (0..frames.len())
        .filter(|&frame| following.cells()[frame].found().is_some())
        .collect();
    assert_eq!(found, [0, 1, 12, 13, 14, 15, 16, 17, 18, 19]);
    following.choose_sides(None);
    given.go_on(&mut following);
    following.compare_sides([17].into_iter());
    given.go_on(&mut following);
    assert_eq!(given.asked.last(), Some(&17));
    assert!(following.rival(14).is_none());
}

#[test]
fn what_is_lost_after_all_is_looked_for_beside_the_other_component_and_settled_again() {
    let (thigh, [before, after], frames) = interrupted(2);
    let middle = surface(thigh.clone()).as_model().bounds().centre;
    let follow = |searches: bool| {
        let mut following = Following::new(middle, frames.len(), 0..frames.len());
        following.give(0, before, true);
        if searches {
            following.search_where_lost();
        }
        following.choose_sides(None);
        let mut given = Given::new(&thigh, &frames);
        given.go_on(&mut following);
        following.choose_sides(None);
        given.go_on(&mut following);
        // The other one is good in some frames, in one of which nothing is.
        let other: Vec<Option<Pose>> = (0..frames.len())
            .map(|frame| (frame == 5 || frame >= 12).then_some(before))
            .collect();
        let seen = given.asked.len();
        (given.there, given.searched) = (Some(after), Vec::new());
        following.look_beside((other, &[]), None);
        assert_eq!(following.wanted(), searches.then_some(16));
        assert_eq!(following.beside(), searches.then_some(&before));
        given.go_on(&mut following);
        let found = following.cells().iter().map(|cell| cell.found().is_some());
        (
            found.collect::<Vec<bool>>(),
            given.searched,
            following,
            given.asked.len() > seen,
        )
    };
    let (found, searched, following, _) = follow(true);
    assert_eq!(searched, [16, 5]);
    let is_there = |frame: usize| !(2..12).contains(&frame);
    assert_eq!(found, (0..frames.len()).map(is_there).collect::<Vec<_>>());
    assert!(following.cells()[0].fixed);
    // It is settled with what was found: that is good, and asked for what it tells of the film.
    assert!(following.good(&[])[14].is_some());
    let asked = following.to_ask(&[]);
    assert!(asked.len() >= 4 && asked.iter().all(|&(frame, _)| is_there(frame)));
    let (found, searched, _, is_seen) = follow(false);
    assert!(searched.is_empty() && !is_seen);
    assert_eq!(found.iter().filter(|found| **found).count(), 2);
}

#[test]
fn who_stops_keeps_what_was_seen() {
    let (thigh, [before, _], frames) = interrupted(6);
    let middle = surface(thigh.clone()).as_model().bounds().centre;
    let mut following = Following::new(middle, frames.len(), 0..frames.len());
    following.give(0, before, true);
    let mut given = Given::new(&thigh, &frames);
    given.give(&mut following, 4);
    following.stop();
    assert_eq!(following.wanted(), None);
    let conclusions = following.conclude(&[]);
    let posed = conclusions.iter().filter(|one| one.pose.is_some()).count();
    assert_eq!(posed, 4);
    assert_eq!(conclusions[4].state, State::Unsolved);
}
