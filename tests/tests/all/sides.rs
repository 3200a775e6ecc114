//! The rules that tell a pose from its mirror image, on the reference poses of a real study.

use fluoropose::finder::choice::{
    ChoiceContext, Counterpart, FilmFrame, FilmStep, Reason, RivalPose, TILT_MARGIN_DEG, choose,
    choose_film,
};
use fluoropose::joint::kinematics::coronal_tilt_deg;
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::Pose;
use fluoropose_laboratory::files::{Component, Study, read_model, read_poses};
use fluoropose_tests::study;

/// A reference pose and its mirror image.
type Sides = [Pose; 2];

/// Reference poses of a component and their mirror images in its plane of symmetry.
fn both_sides(component: &Component) -> Vec<Sides> {
    let model = read_model(&component.model).expect("a model");
    let planes = symmetry_planes(model.as_model().mesh());
    let plane = planes.first().expect("a plane of symmetry");
    let path = component.reference.as_deref().expect("reference poses");
    let poses = read_poses(path).expect("poses").into_iter();
    poses
        .map(|pose| pose.expect("a pose in each frame"))
        .map(|pose| [pose, mirror_pose(&pose, plane)])
        .collect()
}

/// Both sides of femur and tibia in all 16 frames, where the study is present.
fn left8() -> Option<(Vec<Sides>, Vec<Sides>)> {
    let study = Study::read(&study("left8")?).expect("a study");
    let of = |name: &str| {
        let component = study.components.iter().find(|c| c.name == name);
        let sides = both_sides(component.expect("the component"));
        assert_eq!(sides.len(), 16);
        sides
    };
    Some((of("femur"), of("tibia")))
}

/// The right pose and its mirror image, which fits a little better, as on network masks.
fn candidates(sides: &Sides) -> [RivalPose; 2] {
    [(sides[0], 1.0), (sides[1], 0.9)].map(|(pose, residual_px)| RivalPose { pose, residual_px })
}

#[test]
fn with_the_femur_known_the_tilt_finds_the_tibia_in_all_frames() {
    let Some((femur, tibia)) = left8() else {
        return;
    };
    for (frame, ([femur, _], sides)) in femur.iter().zip(&tibia).enumerate() {
        let [right, wrong] = sides.map(|tibia| coronal_tilt_deg(femur, &tibia));
        println!("frame {frame:2}: tilt {right:5.2}, mirrored tibia {wrong:5.2} deg");
        assert!((-3.1..0.1).contains(&right) && (-8.2..-4.4).contains(&wrong));
        let context = ChoiceContext {
            counterpart: Some(Counterpart::Femur(*femur)),
            is_counterpart_doubtful: false,
            neighbours: &[],
        };
        let choice = choose(&candidates(sides), &context).expect("two");
        assert_eq!(choice.index, 0);
        assert!(matches!(choice.reason, Reason::Tilt { .. }));
    }
}

/// In the other role the rule is weaker: in the last frames the mirrored femur has the smaller
/// tilt. The margin keeps it from being chosen for that.
#[test]
fn with_the_tibia_known_the_tilt_never_decides_for_a_mirrored_femur() {
    let Some((femur, tibia)) = left8() else {
        return;
    };
    let mut decided = 0;
    for (frame, (sides, [tibia, _])) in femur.iter().zip(&tibia).enumerate() {
        let [right, wrong] = sides.map(|femur| coronal_tilt_deg(&femur, tibia));
        println!("frame {frame:2}: tilt {right:5.2}, mirrored femur {wrong:5.2} deg");
        let context = ChoiceContext {
            counterpart: Some(Counterpart::Tibia(*tibia)),
            is_counterpart_doubtful: false,
            neighbours: &[],
        };
        let choice = choose(&candidates(sides), &context).expect("two");
        let known = wrong.abs() - right.abs() >= TILT_MARGIN_DEG;
        assert!(
            known || right.abs() - wrong.abs() < TILT_MARGIN_DEG,
            "frame {frame}"
        );
        assert_eq!(choice.is_decided(), known, "frame {frame}: {choice}");
        match choice.reason {
            Reason::Tilt {
                chosen_deg,
                other_deg,
            } => {
                assert_eq!(choice.index, 0, "margin {TILT_MARGIN_DEG}");
                assert_eq!((chosen_deg, other_deg), (right, wrong));
                decided += 1;
            }
            // What fits better is shown, and that nothing told it from the other.
            reason => {
                assert!(
                    matches!(reason, Reason::Undecided { .. }),
                    "frame {frame}: {choice}"
                );
                assert_eq!(choice.index, 1);
            }
        }
    }
    assert_eq!(decided, 4);
}

#[test]
fn the_neighbouring_frame_tells_the_sides_apart() {
    let Some((femur, tibia)) = left8() else {
        return;
    };
    for part in [femur, tibia] {
        for pair in part.windows(2) {
            let neighbours = [pair[0][0]];
            let context = ChoiceContext {
                counterpart: None,
                is_counterpart_doubtful: false,
                neighbours: &neighbours,
            };
            let choice = choose(&candidates(&pair[1]), &context).expect("two");
            assert_eq!(choice.index, 0, "{choice}");
            assert!(matches!(choice.reason, Reason::Turn { .. }));
        }
    }
}

/// One frame in which the femur is known decides the film of the tibia.
#[test]
fn one_frame_decides_the_film() {
    let Some((femur, tibia)) = left8() else {
        return;
    };
    let candidates: Vec<_> = tibia.iter().map(candidates).collect();
    for known in 0..16 {
        let frame = |(at, candidates): (usize, &'_ [RivalPose; 2])| {
            let counterpart = (at == known).then(|| Counterpart::Femur(femur[at][0]));
            (candidates.to_vec(), counterpart)
        };
        let frames: Vec<_> = candidates.iter().enumerate().map(frame).collect();
        let frames: Vec<_> = frames
            .iter()
            .map(|(candidates, counterpart)| FilmFrame {
                candidates,
                counterpart: *counterpart,
                is_counterpart_doubtful: false,
            })
            .collect();
        let mut choices = [None; 16];
        choose_film(&frames, &mut [FilmStep::default(); 16], &mut choices).expect("16 frames");
        for choice in choices.iter().flatten() {
            assert!(
                choice.index == 0 && choice.is_decided(),
                "{known}: {choice}"
            );
        }
    }
}
