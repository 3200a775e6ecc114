use super::super::{FILM_MARGIN_DEG, choose};
use super::*;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::rotation_zxy;
use proptest::prelude::*;
use std::vec;
use std::vec::Vec as List;

fn pose(x: f64, y: f64) -> Pose {
    Pose {
        rotation: rotation_zxy(-84.0, x, y),
        translation: [0.0, 0.0, -1000.0],
    }
}

fn mirrored(pose: &Pose) -> Pose {
    let plane = SymmetryPlane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        deviation_mm: 0.0,
    };
    mirror_pose(pose, &plane)
}

/// A film of frames with candidates, and without the other component.
fn chosen(film: &[List<RivalPose>]) -> List<Option<Choice>> {
    let frame = |candidates| FilmFrame {
        candidates,
        counterpart: None,
        is_counterpart_doubtful: false,
    };
    let frames: List<_> = film.iter().map(|all| frame(all.as_slice())).collect();
    let mut choices = vec![None; frames.len()];
    let mut steps = vec![FilmStep::default(); frames.len()];
    choose_film(&frames, &mut steps, &mut choices).expect("memory as needed");
    choices
}

/// The right pose of a slowly turning part, then its mirror image, which fits a little better.
fn ambiguous(frame: usize) -> List<RivalPose> {
    let right = pose(1.0 + 0.1 * frame as f64, -9.0 + 0.3 * frame as f64);
    vec![
        RivalPose {
            pose: right,
            residual_px: 1.0,
        },
        RivalPose {
            pose: mirrored(&right),
            residual_px: 0.95,
        },
    ]
}

#[test]
fn one_decided_frame_decides_the_film() {
    for anchor in [0, 7, 15] {
        let mut film: List<_> = (0..16).map(ambiguous).collect();
        film[anchor][1].residual_px = 1.4;
        let choices = chosen(&film);
        for (frame, choice) in choices.iter().enumerate() {
            let choice = choice.expect("two candidates");
            assert_eq!(choice.index, 0, "frame {frame}");
            assert!(choice.is_decided());
            let residual = matches!(choice.reason, Reason::Residual { .. });
            assert_eq!(residual, frame == anchor);
        }
    }
}

/// The same frames by far turns about other axes each: one of the poses is always nearer to those beside it, and says nothing.
#[test]
fn single_pictures_are_no_film() {
    let far = |frame: usize| {
        let turn = crate::pose::rotation_zxy(137.5 * frame as f64, 53.0 * frame as f64, 71.0);
        let turned = |candidate: RivalPose| RivalPose {
            pose: Pose {
                rotation: crate::math::multiply(&turn, &candidate.pose.rotation),
                ..candidate.pose
            },
            ..candidate
        };
        ambiguous(frame).into_iter().map(turned).collect()
    };
    for anchor in [0, 7, 15] {
        let mut pictures: List<List<_>> = (0..16).map(far).collect();
        pictures[anchor][1].residual_px = 1.4;
        for (frame, choice) in chosen(&pictures).iter().enumerate() {
            let choice = choice.expect("two candidates");
            assert_eq!(
                choice.is_decided(),
                frame == anchor,
                "frame {frame}: {choice}"
            );
        }
    }
}

/// Two takes in one folder: each is decided by its own frames, but for the two between which it jumps.
#[test]
fn a_cut_between_two_takes_leaves_the_rest_of_both_decided() {
    let turn = crate::pose::rotation_zxy(100.0, 0.0, 0.0);
    let mut film: List<_> = (0..16).map(ambiguous).collect();
    for candidate in film[8..].iter_mut().flatten() {
        candidate.pose.rotation = crate::math::multiply(&turn, &candidate.pose.rotation);
    }
    for anchor in [2, 12] {
        film[anchor][1].residual_px = 1.4;
    }
    for (frame, choice) in chosen(&film).iter().enumerate() {
        let choice = choice.expect("two candidates");
        assert_eq!(choice.index, 0, "frame {frame}: {choice}");
        assert!(choice.is_decided() || [7, 8].contains(&frame), "{frame}");
    }
}

#[test]
fn a_film_without_a_decided_frame_is_consistent_and_undecided() {
    let mut film: List<_> = (0..16).map(ambiguous).collect();
    for frame in [3, 4, 9] {
        film[frame][1].residual_px = 1.1;
    }
    let choices = chosen(&film);
    for choice in choices.iter().flatten() {
        assert_eq!(choice.index, 1);
        assert!(!choice.is_decided());
    }
}

#[test]
fn of_two_smooth_films_the_one_that_turns_less_is_not_preferred() {
    // The second turns by 0.5 degrees a frame, the first by 1.5, and fits a little better.
    let at = |frame: usize| {
        [(1.5, 1.0), (0.5, 1.05)]
            .map(|(speed, residual_px)| RivalPose {
                pose: pose(0.0, 20.0 * speed + speed * frame as f64),
                residual_px,
            })
            .to_vec()
    };
    let film: List<_> = (0..30).map(at).collect();
    for choice in chosen(&film).iter().flatten() {
        assert_eq!(choice.index, 0);
        assert!(!choice.is_decided());
    }
}

#[test]
fn where_the_poses_meet_the_film_may_cross_and_says_so() {
    // The part turns through the view in which it is its own mirror image.
    let at = |frame: usize| {
        let right = pose(0.0, frame as f64 - 8.0);
        [(right, 1.0), (mirrored(&right), 1.0)]
            .map(|(pose, residual_px)| RivalPose { pose, residual_px })
            .to_vec()
    };
    let mut film: List<_> = (0..17).map(at).collect();
    film[0][1].residual_px = 2.0;
    let choices = chosen(&film);
    let decided: List<_> = choices.iter().flatten().map(|c| c.is_decided()).collect();
    assert!(decided[..6].iter().all(|&decided| decided));
    assert!(
        !decided[8] && !decided[16],
        "beyond the crossing both sides are as smooth"
    );
}

#[test]
fn frames_without_poses_have_no_choice_and_do_not_break_the_chain() {
    let mut film: List<_> = (0..12).map(ambiguous).collect();
    film[0][1].residual_px = 1.4;
    film[4].clear();
    film[5].clear();
    film[11].clear();
    let choices = chosen(&film);
    for (frame, choice) in choices.iter().enumerate() {
        assert_eq!(choice.is_none(), film[frame].is_empty());
        assert!(choice.is_none_or(|c| c.index == 0 && c.is_decided()));
    }
    assert_eq!(chosen(&[]), []);
    assert_eq!(chosen(&[vec![], vec![]]), [None, None]);
}

#[test]
fn a_frame_that_its_film_decided_is_as_good_as_what_it_goes_with() {
    let choice = |reason| Choice {
        index: 0,
        reason,
        open: None,
        no_knee_deg: None,
    };
    let by_film = choice(Reason::Film { saved_deg: 5.0 });
    let (yes, no) = (Some(true), Some(false));
    assert!(rests_on_doubt(1, &by_film, &[no, yes, no]));
    // The nearest ones count, across frames without a pose.
    assert!(rests_on_doubt(2, &by_film, &[yes, no, yes, None, no]));
    assert!(!rests_on_doubt(2, &by_film, &[no, None, yes, None, yes]));
    assert!(!rests_on_doubt(1, &by_film, &[yes, yes, no]));
    assert!(rests_on_doubt(0, &by_film, &[yes, no]));
    assert!(!rests_on_doubt(0, &by_film, &[yes, None]));
    let by_tilt = choice(Reason::Tilt {
        chosen_deg: 0.0,
        other_deg: 5.0,
    });
    assert!(!rests_on_doubt(1, &by_tilt, &[no, yes, no]));
}

#[test]
fn memory_of_another_length_is_refused() {
    let frames = [FilmFrame::default(); 3];
    let error = choose_film(&frames, &mut [FilmStep::default(); 2], &mut [None; 3]);
    let error = error.expect_err("too few steps");
    assert_eq!(
        std::string::ToString::to_string(&error),
        "a film of 3 frames needs 3 steps and choices but 2 and 3 were given"
    );
}

/// All ways through a film of open frames and their costs.
fn all_ways(film: &[List<RivalPose>]) -> List<(List<usize>, f64)> {
    let mut ways = vec![(List::new(), 0.0)];
    for (at, frame) in film.iter().enumerate() {
        let best = frame
            .iter()
            .map(|c| c.residual_px)
            .fold(f64::INFINITY, f64::min);
        let mut longer = List::new();
        for (way, cost) in &ways {
            for (k, candidate) in frame.iter().enumerate() {
                let own = (candidate.residual_px / best - 1.0) / (DECISIVE_RATIO - 1.0);
                let last = (0..at).rev().find(|&last| !film[last].is_empty());
                let link = last.map_or(0.0, |last| {
                    let from: &RivalPose = &film[last][way[last]];
                    let turn = geodesic_deg(&from.pose.rotation, &candidate.pose.rotation);
                    (turn / (at - last) as f64 - FREE_DEG).max(0.0)
                });
                let mut way = way.clone();
                way.push(k);
                longer.push((way, cost + own * RESIDUAL_DEG + link));
            }
        }
        if frame.is_empty() {
            longer = ways;
            longer.iter_mut().for_each(|(way, _)| way.push(0));
        }
        ways = longer;
    }
    ways
}

/// The frames that a way goes from and to, and what that costs.
fn links_of(film: &[List<RivalPose>], way: &[usize]) -> List<(usize, usize, f64)> {
    let seen: List<usize> = (0..film.len()).filter(|&at| !film[at].is_empty()).collect();
    let rotation = |at: usize| film[at][way[at]].pose.rotation;
    let link = |pair: &[usize]| {
        let turn = geodesic_deg(&rotation(pair[0]), &rotation(pair[1]));
        let jump = turn / (pair[1] - pair[0]) as f64 - FREE_DEG;
        (pair[0], pair[1], jump.max(0.0))
    };
    seen.windows(2).map(link).collect()
}

fn film() -> impl Strategy<Value = List<List<RivalPose>>> {
    let candidate =
        (-10.0..10.0f64, -10.0..10.0f64, 1.0..1.29f64).prop_map(|(x, y, residual_px)| {
            let pose = pose(x, y);
            RivalPose { pose, residual_px }
        });
    let frame = prop_oneof![
        5 => prop::collection::vec(candidate.clone(), 2..4),
        1 => prop::collection::vec(candidate.clone(), 1),
        1 => Just(List::new()),
    ];
    prop::collection::vec(frame, 1..6)
}

properties! {
    #[test]
    fn no_other_way_through_the_film_is_cheaper(film in film()) {
        let choices = chosen(&film);
        let ways = all_ways(&film);
        let taken: List<usize> = choices.iter().map(|c| c.map_or(0, |c| c.index)).collect();
        let cost = |way: &[usize]| ways.iter().find(|(w, _)| w == way).expect("listed").1;
        let least = ways.iter().map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
        prop_assert!((cost(&taken) - least).abs() < 1e-9);
        let anchored = film.iter().any(|frame| frame.len() == 1);
        let mean = least / film.iter().filter(|frame| !frame.is_empty()).count().saturating_sub(1).max(1) as f64;
        let links = links_of(&film, &taken);
        for (at, choice) in choices.iter().enumerate() {
            let Some(Choice { index, reason, open, .. }) = choice else { continue };
            let other = ways.iter().filter(|(way, _)| way[at] != *index).map(|(_, cost)| *cost);
            let saved = other.fold(f64::INFINITY, f64::min) - least;
            let beside: List<f64> = links.iter().filter(|(from, to, _)| [*from, *to].contains(&at)).map(|link| link.2).collect();
            let own = beside.len() as f64 * beside.iter().copied().fold(f64::INFINITY, f64::min);
            let margin = own.max(mean).max(FILM_MARGIN_DEG);
            if film[at].len() == 1 {
                prop_assert_eq!(*reason, Reason::Only);
            } else if let Some(open) = open {
                prop_assert!(!anchored || saved < margin + 1e-9);
                prop_assert_eq!(open.chosen_px, film[at][*index].residual_px);
                prop_assert_eq!(open.other_px, film[at][open.index].residual_px);
                prop_assert_ne!(open.index, *index);
            } else {
                prop_assert!(anchored && saved >= margin - 1e-9);
            }
            if let Reason::Film { saved_deg } = reason {
                prop_assert!((saved_deg - saved).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn frames_that_decide_themselves_keep_their_choice(
        film in film(), residuals in prop::collection::vec(1.0..3.0f64, 24), femur in -5.0..5.0f64
    ) {
        let mut film = film;
        for (candidate, &px) in film.iter_mut().flatten().zip(&residuals) {
            candidate.residual_px = px;
        }
        let counterpart = Some(Counterpart::Femur(pose(femur, 0.0)));
        let frames: List<_> = film.iter()
            .map(|candidates| FilmFrame { candidates, counterpart, is_counterpart_doubtful: false }).collect();
        let mut choices = vec![None; frames.len()];
        let mut steps = vec![FilmStep::default(); frames.len()];
        choose_film(&frames, &mut steps, &mut choices).expect("memory as needed");
        for (frame, choice) in frames.iter().zip(choices) {
            let context = super::super::ChoiceContext { counterpart, is_counterpart_doubtful: false, neighbours: &[] };
            let alone = choose(frame.candidates, &context);
            if alone.is_none_or(|alone| alone.is_decided()) {
                prop_assert_eq!(choice, alone);
            } else {
                prop_assert!(choice.is_some());
            }
        }
    }

    #[test]
    fn no_input_makes_it_panic(
        film in prop::collection::vec(prop::collection::vec(
            (-20.0..20.0f64, prop_oneof![Just(f64::NAN), Just(f64::INFINITY), 0.0..2.0f64]), 0..12), 0..6)
    ) {
        let film: List<List<RivalPose>> = film.iter().map(|frame| frame.iter().map(|&(x, residual_px)| {
            let x = if x > 19.0 { f64::NAN } else { x };
            RivalPose { pose: pose(x, 0.0), residual_px }
        }).collect()).collect();
        for (frame, choice) in film.iter().zip(chosen(&film)) {
            prop_assert_eq!(choice.is_none(), frame.is_empty());
            prop_assert!(choice.is_none_or(|choice| choice.index < frame.len()));
        }
    }
}
