use super::*;
use crate::joint::kinematics::coronal_tilt_deg;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::EulerPose;
use proptest::prelude::*;
use std::string::ToString as _;
use std::vec::Vec as List;

fn pose(z_rot_deg: f64, x_rot_deg: f64, y_rot_deg: f64) -> Pose {
    Pose::from(EulerPose {
        x_mm: -28.0,
        y_mm: -18.0,
        z_mm: -1085.0,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    })
}

fn candidate(pose: Pose, residual_px: f64) -> RivalPose {
    RivalPose { pose, residual_px }
}

fn mirrored(pose: &Pose) -> Pose {
    let plane = SymmetryPlane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        deviation_mm: 0.0,
    };
    mirror_pose(pose, &plane)
}

/// A knee filmed from the side, the femur out of plane enough for its mirror image to tilt away.
fn knee() -> (Pose, Pose) {
    (pose(8.0, 5.7, -1.2), pose(-84.0, 0.6, -9.1))
}

const NOTHING: ChoiceContext<'_> = ChoiceContext {
    counterpart: None,
    is_counterpart_doubtful: false,
    neighbours: &[],
};

#[test]
fn nothing_is_chosen_of_nothing_and_one_is_the_only_one() {
    assert_eq!(choose(&[], &NOTHING), None);
    let (femur, tibia) = knee();
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful: false,
        neighbours: &[femur],
    };
    let choice = choose(&[candidate(tibia, f64::NAN)], &context).expect("one");
    assert_eq!((choice.index, choice.reason), (0, Reason::Only));
    assert!(choice.is_decided());
    assert_eq!(choice.to_string(), "the only pose found");
}

#[test]
fn a_decisive_residual_decides_against_tilt_and_time() {
    let (femur, tibia) = knee();
    let wrong = mirrored(&tibia);
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful: false,
        neighbours: &[tibia],
    };
    let both = |px| [candidate(tibia, px), candidate(wrong, 1.0)];
    let choice = choose(&both(DECISIVE_RATIO), &context).expect("two");
    assert_eq!(choice.index, 1);
    assert_eq!(choice.to_string(), "residual 1.000 px against 1.300 px");
    let choice = choose(&both(DECISIVE_RATIO - 1e-9), &context).expect("two");
    assert_eq!(choice.index, 0);
    assert!(matches!(choice.reason, Reason::Tilt { .. }));
}

/// Its tilt tells which to prefer, and the other stays open; what is reliable decides.
#[test]
fn a_femur_that_is_doubtful_itself_rules_out_nothing() {
    let (femur, tibia) = knee();
    let wrong = mirrored(&tibia);
    let both = [candidate(tibia, 1.1), candidate(wrong, 1.0)];
    let beside = |is_counterpart_doubtful| ChoiceContext {
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful,
        neighbours: &[],
    };
    let [good, doubtful] =
        [false, true].map(|doubtful| choose(&both, &beside(doubtful)).expect("two"));
    assert_eq!((good.index, good.open), (0, None));
    assert_eq!((doubtful.index, doubtful.reason), (0, good.reason));
    assert_eq!(
        doubtful.open.map(|open| (open.index, open.other_px)),
        Some((1, 1.0))
    );
    let near = ChoiceContext {
        neighbours: &[tibia],
        ..beside(true)
    };
    assert!(choose(&both, &near).expect("two").is_decided());
    // In a film: of one frame alone nothing is decided, beside one that is decided by itself the film may.
    let frame = |candidates, is_counterpart_doubtful| FilmFrame {
        candidates,
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful,
    };
    let decided = |film: &[FilmFrame<'_>]| {
        let mut choices = std::vec![None; film.len()];
        choose_film(
            film,
            &mut std::vec![FilmStep::default(); film.len()],
            &mut choices,
        )
        .expect("as many");
        let first = choices[0].expect("one");
        (first.index, first.is_decided())
    };
    assert_eq!(decided(&[frame(&both, true); 3]), (0, false));
    assert_eq!(
        decided(&[frame(&both, true), frame(&both, false)]),
        (0, true)
    );
}

/// A tray turned by 79 degrees fits better and tilts less.
#[test]
fn what_makes_no_knee_is_ruled_out_by_what_does_and_is_doubtful_else() {
    let (femur, right) = knee();
    let turned = |deg: f64| {
        let about = EulerPose::from([0.0, 0.0, 0.0, 0.0, 0.0, deg]);
        right.compose(&Pose::from(about))
    };
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let (wrong, tilted) = (candidate(turned(-79.0), 1.0), candidate(right, 1.2));
    let choice = choose(&[wrong, tilted], &context).expect("two");
    assert_eq!((choice.index, choice.no_knee_deg), (1, None));
    let Reason::Knee { other_deg, .. } = choice.reason else {
        panic!("{choice}")
    };
    assert!(other_deg > 70.0 && choice.is_decided());
    assert!(
        choice.to_string().ends_with("which no knee does"),
        "{choice}"
    );
    // Decisively better it stays, and is doubtful; so it is alone, where tilts say nothing.
    for candidates in [
        &[wrong, candidate(right, 1.3)][..],
        &[wrong],
        &[wrong, candidate(turned(-75.0), 1.1)],
    ] {
        let choice = choose(candidates, &context).expect("some");
        assert_eq!(choice.index, 0);
        assert!(choice.no_knee_deg.is_some_and(|deg| deg > 70.0));
        assert!(!matches!(
            choice.reason,
            Reason::Knee { .. } | Reason::Tilt { .. }
        ));
    }
    // So it is over a film, and with the femur sought.
    let film = [FilmFrame {
        candidates: &[wrong, candidate(turned(-75.0), 1.1)],
        counterpart: context.counterpart,
        is_counterpart_doubtful: false,
    }];
    let mut choices = [None];
    choose_film(&film, &mut [FilmStep::default()], &mut choices).expect("memory as needed");
    assert!(choices[0].is_some_and(|choice| choice.no_knee_deg.is_some()));
    let sought = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(turned(-79.0))),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let choice = choose(&[candidate(femur, 1.0)], &sought).expect("one");
    assert!(choice.no_knee_deg.is_some());
    assert_eq!(choose(&[wrong], &NOTHING).expect("one").no_knee_deg, None);
}

/// That one is the likelier to be wrong.
#[test]
fn what_makes_no_knee_with_a_femur_that_is_doubtful_itself_is_not_doubtful() {
    let (femur, right) = knee();
    let about = EulerPose::from([0.0, 0.0, 0.0, 0.0, 0.0, -79.0]);
    let turned = [candidate(right.compose(&Pose::from(about)), 1.0)];
    let counterpart = Some(Counterpart::Femur(femur));
    let [known, doubtful] = [false, true].map(|is_counterpart_doubtful| {
        let context = ChoiceContext {
            counterpart,
            is_counterpart_doubtful,
            neighbours: &[],
        };
        let film = [FilmFrame {
            candidates: &turned,
            counterpart,
            is_counterpart_doubtful,
        }];
        let mut choices = [None];
        choose_film(&film, &mut [FilmStep::default()], &mut choices).expect("memory as needed");
        let alone = choose(&turned, &context).expect("one");
        [Some(alone), choices[0]].map(|choice| choice.and_then(|choice| choice.no_knee_deg))
    });
    assert!(known.iter().all(Option::is_some) && doubtful.iter().all(Option::is_none));
}

#[test]
fn a_perfect_fit_beats_any_other_but_not_another_perfect_fit() {
    let (_, tibia) = knee();
    let both = |px| [candidate(mirrored(&tibia), px), candidate(tibia, 0.0)];
    let choice = choose(&both(1e-12), &NOTHING).expect("two");
    assert_eq!(choice.index, 1);
    assert!(matches!(choice.reason, Reason::Residual { .. }));
    let choice = choose(&both(0.0), &NOTHING).expect("two");
    assert!(!choice.is_decided());
}

#[test]
fn the_smaller_tilt_decides_in_either_role() {
    let (femur, tibia) = knee();
    let wrong = mirrored(&tibia);
    let right_deg = coronal_tilt_deg(&femur, &tibia);
    let wrong_deg = coronal_tilt_deg(&femur, &wrong);
    assert!(wrong_deg.abs() - right_deg.abs() > TILT_MARGIN_DEG);
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Femur(femur)),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let candidates = [candidate(wrong, 0.9), candidate(tibia, 1.0)];
    let choice = choose(&candidates, &context).expect("two");
    assert_eq!(choice.index, 1);
    let reason = Reason::Tilt {
        chosen_deg: right_deg,
        other_deg: wrong_deg,
    };
    assert_eq!(choice.reason, reason);

    // Two femurs against one tibia: turned about the tibia's anteroposterior axis.
    let tilted = |deg| {
        tibia.compose(&Pose::from(EulerPose {
            x_rot_deg: deg,
            ..EulerPose::default()
        }))
    };
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(tibia)),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let femurs = [candidate(tilted(6.3), 0.9), candidate(tilted(-1.2), 1.0)];
    let choice = choose(&femurs, &context).expect("two");
    assert_eq!(choice.index, 1);
    assert_eq!(choice.to_string(), "coronal tilt 1.2 deg against -6.3 deg");
}

#[test]
fn tilts_of_opposite_sign_and_like_size_leave_it_to_time() {
    let tibia = pose(0.0, 0.0, 0.0);
    let femurs = [
        candidate(pose(0.0, 4.0, 0.0), 1.0),
        candidate(pose(0.0, -5.9, 0.0), 1.1),
    ];
    let neighbours = [pose(0.0, -3.0, 0.0), pose(0.0, -5.0, 0.0)];
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(tibia)),
        is_counterpart_doubtful: false,
        neighbours: &neighbours,
    };
    let choice = choose(&femurs, &context).expect("two");
    assert_eq!(choice.index, 1);
    assert_eq!(
        choice.to_string(),
        "turned 1.9 deg from the neighbouring frames against 8.0 deg"
    );
}

/// One of two poses is always nearer to another picture; of a film it is so by what it moved.
#[test]
fn a_picture_far_from_both_poses_tells_nothing_of_them() {
    let both = [
        candidate(pose(0.0, 9.0, 0.0), 0.812),
        candidate(pose(0.0, -9.0, 0.0), 0.8),
    ];
    for (moved_deg, is_decided) in [(1.0, true), (6.0, true), (60.0, false), (150.0, false)] {
        let neighbours = [pose(0.0, 9.0 + moved_deg, 0.0)];
        let context = ChoiceContext {
            neighbours: &neighbours,
            ..NOTHING
        };
        let choice = choose(&both, &context).expect("two");
        assert_eq!(choice.is_decided(), is_decided, "{moved_deg}: {choice}");
        assert_eq!(choice.index, usize::from(!is_decided), "{choice}");
    }
}

#[test]
fn what_nothing_tells_apart_is_said_to_be_undecided() {
    let candidates = [
        candidate(pose(0.0, 1.0, 0.0), 0.812),
        candidate(pose(0.0, -1.0, 0.0), 0.8),
    ];
    let neighbours = [pose(0.0, 0.5, 0.0)];
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(pose(0.0, 0.0, 0.0))),
        is_counterpart_doubtful: false,
        neighbours: &neighbours,
    };
    let choice = choose(&candidates, &context).expect("two");
    assert_eq!(choice.index, 1);
    assert!(!choice.is_decided());
    assert_eq!(
        choice.to_string(),
        "undecided: residual 0.800 px against 0.812 px, and nothing else tells the poses apart"
    );
}

#[test]
fn each_rule_leaves_the_rest_to_the_next() {
    // Ruled out by residual, by tilt and by time, in this order; the last is the reason.
    let candidates = [
        candidate(pose(0.0, 0.0, 0.0), 2.0),
        candidate(pose(0.0, 9.0, 0.0), 1.0),
        candidate(pose(0.0, 1.0, 30.0), 1.1),
        candidate(pose(0.0, 1.0, 3.0), 1.2),
    ];
    let neighbours = [pose(0.0, 1.0, 0.0)];
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(pose(0.0, 0.0, 0.0))),
        is_counterpart_doubtful: false,
        neighbours: &neighbours,
    };
    let choice = choose(&candidates, &context).expect("four");
    assert_eq!(choice.index, 3);
    assert!(matches!(choice.reason, Reason::Turn { .. }), "{choice:?}");
}

#[test]
fn a_rule_that_leaves_two_is_the_reason_and_the_other_is_named() {
    // As on network masks: the mirror image fits best, tilt rules it out, and one that is mirrored
    // in its turn alone remains.
    let candidates = [
        candidate(pose(0.0, 5.2, 18.0), 1.0),
        candidate(pose(0.0, 0.4, 18.0), 1.23),
        candidate(pose(0.0, 0.1, 0.0), 1.04),
        candidate(pose(0.0, 5.4, 0.0), 1.25),
    ];
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(pose(0.0, 0.0, 0.0))),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let choice = choose(&candidates, &context).expect("four");
    assert_eq!(choice.index, 2);
    assert_eq!(choice.open.map(|open| open.index), Some(1));
    let text = choice.to_string();
    assert_eq!(
        text,
        "coronal tilt -0.1 deg against -4.9 deg; another pose is open: residual 1.040 px against 1.230 px"
    );
}

#[test]
fn of_many_the_best_few_contend() {
    let mut candidates: List<_> = (0..20)
        .map(|k| candidate(pose(0.0, 10.0 + f64::from(k), 0.0), 1.2))
        .collect();
    candidates.push(candidate(pose(0.0, 1.0, 0.0), 1.1));
    let context = ChoiceContext {
        counterpart: Some(Counterpart::Tibia(pose(0.0, 0.0, 0.0))),
        is_counterpart_doubtful: false,
        neighbours: &[],
    };
    let choice = choose(&candidates, &context).expect("many");
    assert_eq!(choice.index, 20);
    assert!(choice.is_decided());
}

#[test]
fn no_sentence_has_a_negative_zero() {
    let reason = Reason::Tilt {
        chosen_deg: -0.04,
        other_deg: -6.3,
    };
    assert_eq!(reason.to_string(), "coronal tilt 0.0 deg against -6.3 deg");
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![8 => 0.0..3.0f64, 1 => Just(f64::NAN), 1 => Just(f64::INFINITY), 1 => Just(0.0)]
}

fn any_pose() -> impl Strategy<Value = Pose> {
    let angle = prop_oneof![9 => -20.0..20.0f64, 1 => Just(f64::NAN)];
    prop::array::uniform3(angle).prop_map(|[z, x, y]| pose(z, x, y))
}

fn any_candidates() -> impl Strategy<Value = List<RivalPose>> {
    prop::collection::vec((any_pose(), any_number()), 0..12).prop_map(|all| {
        all.into_iter()
            .map(|(pose, px)| candidate(pose, px))
            .collect()
    })
}

properties! {
    #[test]
    fn whatever_comes_a_candidate_is_chosen(
        candidates in any_candidates(), other in any_pose(),
        neighbours in prop::collection::vec(any_pose(), 0..3), role in 0..3
    ) {
        let counterpart = match role {
            0 => None,
            1 => Some(Counterpart::Femur(other)),
            _ => Some(Counterpart::Tibia(other)),
        };
        let context = ChoiceContext { counterpart, is_counterpart_doubtful: false, neighbours: &neighbours };
        match choose(&candidates, &context) {
            None => prop_assert!(candidates.is_empty()),
            Some(choice) => {
                prop_assert!(choice.index < candidates.len());
                prop_assert!(!choice.to_string().is_empty());
                prop_assert!(choice.open.is_none_or(|open| open.index < candidates.len() && open.index != choice.index));
                prop_assert_eq!(choice.reason == Reason::Only, candidates.len() == 1);
            }
        }
    }

    #[test]
    fn the_order_of_candidates_does_not_matter(
        residuals in prop::collection::vec(0.5..1.5f64, 2..6), turn in 0usize..6,
        angles in prop::collection::vec(prop::array::uniform3(-20.0..20.0f64), 6)
    ) {
        let mut candidates: List<_> = residuals.iter().zip(&angles)
            .map(|(&px, &[z, x, y])| candidate(pose(z, x, y), px)).collect();
        let (femur, tibia) = knee();
        let neighbours = [tibia];
        let context = ChoiceContext { counterpart: Some(Counterpart::Femur(femur)), is_counterpart_doubtful: false, neighbours: &neighbours };
        let first = choose(&candidates, &context).expect("some");
        let chosen = candidates[first.index];
        let turn = turn % candidates.len();
        candidates.rotate_left(turn);
        let second = choose(&candidates, &context).expect("some");
        prop_assert_eq!(candidates[second.index], chosen);
        prop_assert_eq!(first.reason, second.reason);
        let open = |choice: &Choice| choice.open.map(|open| (open.chosen_px, open.other_px));
        prop_assert_eq!(open(&first), open(&second));
    }

    #[test]
    fn a_reason_holds_what_it_says(
        px in 0.7..1.5f64, tilts in prop::array::uniform2(-8.0..8.0f64), near in -8.0..8.0f64
    ) {
        let candidates = [
            candidate(pose(0.0, tilts[0], 0.0), 1.0), candidate(pose(0.0, tilts[1], 0.0), px),
        ];
        let neighbours = [pose(0.0, near, 0.0)];
        let tibia = pose(0.0, 0.0, 0.0);
        let context = ChoiceContext { counterpart: Some(Counterpart::Tibia(tibia)), is_counterpart_doubtful: false, neighbours: &neighbours };
        let Choice { index, reason, open, no_knee_deg } = choose(&candidates, &context).expect("two");
        let (chosen, other) = (index, 1 - index);
        let px = |k: usize| candidates[k].residual_px;
        let by_tilt = tilts[other].abs() - tilts[chosen].abs();
        let by_turn = (tilts[other] - near).abs() - (tilts[chosen] - near).abs();
        let turns = [chosen, other].map(|k| (tilts[k] - near).abs());
        let margin = turns[0].min(turns[1]).max(TURN_MARGIN_DEG);
        let ratio = px(other) / px(chosen);
        prop_assert_eq!((open.is_some(), no_knee_deg), (!reason.is_decided(), None));
        match reason {
            // Nothing is turned by more than a knee.
            Reason::Only | Reason::Film { .. } | Reason::Knee { .. } => prop_assert!(false),
            Reason::Residual { chosen_px, other_px } => {
                prop_assert!(ratio >= DECISIVE_RATIO);
                prop_assert_eq!([chosen_px, other_px], [px(chosen), px(other)]);
            }
            Reason::Tilt { chosen_deg, .. } => {
                prop_assert!(ratio < DECISIVE_RATIO && 1.0 / ratio < DECISIVE_RATIO);
                prop_assert!(by_tilt >= TILT_MARGIN_DEG - 1e-9);
                prop_assert!((chosen_deg + tilts[chosen]).abs() < 1e-9);
            }
            Reason::Turn { .. } => {
                prop_assert!(by_tilt.abs() < TILT_MARGIN_DEG + 1e-9);
                prop_assert!(by_turn >= margin - 1e-6);
            }
            Reason::Undecided { .. } => {
                prop_assert_eq!(open.map(|open| open.index), Some(other));
                prop_assert!((1.0..DECISIVE_RATIO).contains(&ratio));
                prop_assert!(by_tilt.abs() < TILT_MARGIN_DEG + 1e-9);
                prop_assert!(by_turn.abs() < margin + 1e-6);
            }
        }
    }
}
