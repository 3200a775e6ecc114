use super::*;
use crate::follow::fake::turned;
use crate::follow::sides::choose_sides;
#[cfg(feature = "alloc")]
use crate::math::{Matrix3, multiply, norm, rotation_by, scale};
#[cfg(feature = "alloc")]
use proptest::array::{uniform2, uniform3};
#[cfg(feature = "alloc")]
use proptest::prelude::*;
use std::vec::Vec;

/// A film that speaks for the other side in all frames but the one that a person gave.
#[test]
fn a_pose_that_a_person_gave_is_no_place_to_go_over() {
    let samples: Vec<SideSample> = (0..6)
        .map(|frame| SideSample {
            frame: 4 * frame,
            own: turned(0.0, 0.8),
            // The given frame's mirror image fits best of all.
            rival: Rival::Mirrored,
            other: Some(turned(17.0, if frame == 0 { 0.1 } else { 0.3 })),
            fixed: frame == 0,
        })
        .collect();
    let evidence: Vec<SideEvidence> = samples.iter().map(|s| s.evidence(|_| None)).collect();
    let mut steps = [SideStep::default(); 6];
    choose_sides(&evidence, &mut steps);
    let runs: Vec<(Range<usize>, Anchor)> = runs_to_go_over(&samples, &steps, 24).collect();
    assert_eq!(runs.len(), 1);
    assert_ne!(runs[0].1.frame, 0);
}

/// A limb that swings by ten degrees a frame, and in one of them is seen from the other side of its mirror.
#[cfg(feature = "alloc")]
#[test]
fn frames_to_which_the_trail_rocks_are_seen_from_both_sides() {
    let film = |rocks_at: Option<usize>| -> Vec<usize> {
        let cell = |frame: usize| {
            let mut found = turned(if rocks_at == Some(frame) { 5.0 } else { 0.0 }, 0.5);
            let swing = rotation_by(&[0.0, 0.0, 0.17 * frame as f64]);
            found.pose.rotation = multiply(&swing, &found.pose.rotation);
            Cell::from(&Anchor::found(frame, found))
        };
        let cells: Vec<Cell> = (0..32).map(cell).collect();
        frames_for_sides(&cells).collect()
    };
    assert_eq!(film(None), [2, 7, 12, 17, 22, 27]);
    assert_eq!(film(Some(14)), [2, 7, 12, 13, 14, 15, 16, 17, 22, 27]);
    assert_eq!(film(Some(15)), [2, 7, 12, 13, 14, 15, 16, 17, 22, 27]);
    assert_eq!(film(Some(20)), [2, 7, 12, 17, 18, 19, 20, 21, 22, 27]);
}

/// Halfway between two frames that were seen one side is left for the other.
#[test]
fn a_run_reaches_halfway_to_those_beside_it_and_goes_from_its_best_frame() {
    let runs = |sides: [bool; 5]| -> Vec<(Range<usize>, usize)> {
        let numbers = [2, 8, 15, 20, 29];
        let samples = numbers.map(|frame| SideSample {
            frame,
            own: turned(0.0, 0.8),
            rival: Rival::Mirrored,
            // The later the better.
            other: Some(turned(17.0, 1.0 - 0.02 * frame as f64)),
            fixed: false,
        });
        let mut steps = [SideStep::default(); 5];
        for (step, goes_over) in steps.iter_mut().zip(sides) {
            step.side = if goes_over { Side::Mirrored } else { Side::Own };
        }
        let runs = runs_to_go_over(&samples, &steps, 40);
        runs.map(|(run, anchor)| (run, anchor.frame)).collect()
    };
    assert_eq!(runs([false, true, true, false, false]), [(6..18, 15)]);
    assert_eq!(
        runs([true, false, true, false, true]),
        [(0..6, 2), (12..18, 15), (25..40, 29)]
    );
    assert_eq!(runs([true; 5]), [(0..40, 29)]);
    assert!(runs([false; 5]).is_empty());
}

/// Sides nine degrees apart; two thirds of the way to the rejected one that is twice as near.
#[cfg(feature = "alloc")]
#[test]
fn a_pose_has_left_the_chosen_side_where_the_rejected_one_is_twice_as_near() {
    let left = |side, other: f64, now: f64, rival| {
        let sample = SideSample {
            frame: 3,
            own: turned(0.0, 0.3),
            rival,
            other: Some(turned(other, 0.3)),
            fixed: false,
        };
        let chosen = sample.chosen_but_left(side, &turned(now, 0.3));
        chosen.map(|found| {
            if found == sample.own {
                Side::Own
            } else {
                Side::Mirrored
            }
        })
    };
    let mirrored = Rival::Mirrored;
    assert_eq!(left(Side::Own, 9.0, 5.95, mirrored), None);
    assert_eq!(left(Side::Own, 9.0, 6.05, mirrored), Some(Side::Own));
    assert_eq!(left(Side::Mirrored, 9.0, 3.05, mirrored), None);
    assert_eq!(
        left(Side::Mirrored, 9.0, 2.95, mirrored),
        Some(Side::Mirrored)
    );
    // Of sides that are one, and of what is no mirror image, none is left.
    assert_eq!(left(Side::Own, 4.01, 4.0, mirrored), Some(Side::Own));
    assert_eq!(left(Side::Own, 3.99, 4.0, mirrored), None);
    assert_eq!(left(Side::Own, 9.0, 9.0, Rival::Elsewhere), None);
}

/// Sides ten degrees apart, between which a trail turns on: as far as it has turned, they are less sure to be told apart, the less the
/// farther it is; halfway nothing is told. A limb's swing in the image plane changes nothing of it.
#[cfg(feature = "alloc")]
#[test]
fn how_sure_a_trail_went_over_follows_from_how_far_it_turned_out_of_the_plane() {
    let sample = |own: f64, other: f64, swing: f64| {
        let seen = |deg: f64| {
            let mut found = turned(deg, 0.5);
            let swung = rotation_by(&[0.0, 0.0, swing]);
            found.pose.rotation = multiply(&swung, &found.pose.rotation);
            found
        };
        SideSample {
            frame: 0,
            own: seen(own),
            rival: Rival::Mirrored,
            other: Some(seen(other)),
            fixed: false,
        }
    };
    for swing in [0.0, 0.4, -1.2] {
        for (turn, sure) in [
            (0.0, 1.0),
            (4.0, 1.0),
            (5.0, 1.0),
            (8.0, 0.4),
            (9.0, 0.2),
            (10.0, 0.0),
        ] {
            let before = sample(0.0, 10.0, 0.0);
            for (now, went_over) in [
                (sample(turn, 10.0 + turn, swing), false),
                (sample(10.0 + turn, turn, swing), true),
            ] {
                let told = now.went_over_since(&before);
                assert!((told.1 - sure).abs() < 1e-6, "{swing} {turn}: {told:?}");
                assert!(
                    sure == 0.0 || told.0 == went_over,
                    "{swing} {turn}: {told:?}"
                );
                let elsewhere = SideSample {
                    rival: Rival::Elsewhere,
                    ..now
                };
                assert_eq!(elsewhere.went_over_since(&before), (false, 1.0));
                let alone = SideSample { other: None, ..now };
                assert_eq!(alone.went_over_since(&before), (false, 1.0));
            }
        }
    }
}

#[cfg(feature = "alloc")]
properties! {
    /// Two ways on either side of a mirror, each turning a little from frame to frame; a model's axes and a camera's are any.
    #[test]
    fn a_trail_that_jumped_is_known_by_the_ways_on_both_sides(
        model in uniform3(-1.8..1.8f64), camera in uniform3(-1.8..1.8f64),
        axis in uniform3(-1.0..1.0f64), apart in 0.6..2.6f64,
        turns in uniform2(uniform3(-0.12..0.12f64)), jumped in any::<bool>(),
    ) {
        prop_assume!(norm(&axis) > 0.1);
        let [model, camera] = [model, camera].map(|turn| rotation_by(&turn));
        let mirrored = rotation_by(&scale(&axis, apart / norm(&axis)));
        let posed = |rotation: &Matrix3| {
            let mut found = turned(0.0, 0.5);
            found.pose.rotation = multiply(&camera, &multiply(rotation, &model));
            found
        };
        let sample = |frame: usize, [own, other]: [&Matrix3; 2]| SideSample {
            frame,
            own: posed(own),
            rival: Rival::Mirrored,
            other: Some(posed(other)),
            fixed: false,
        };
        let [one, other] = [(&turns[0], &rotation_by(&[0.0; 3])), (&turns[1], &mirrored)]
            .map(|(turn, side)| multiply(&rotation_by(turn), side));
        let before = sample(0, [&rotation_by(&[0.0; 3]), &mirrored]);
        let behind = sample(8, if jumped { [&other, &one] } else { [&one, &other] });
        let evidence = evidence_of(&[before, behind], |_, _| None);
        prop_assert_eq!([evidence[0].went_over, evidence[1].went_over], [false, jumped]);
    }

    /// Where the limb swings in the image plane by more than its sides are apart.
    #[test]
    fn a_trail_that_jumped_is_known_however_the_limb_swings(
        model in uniform3(-1.8..1.8f64), shift in uniform3(-90.0..90.0f64),
        apart in 0.08..1.2f64, swing in -0.9..0.9f64, turn in uniform3(-0.1..0.1f64), jumped in any::<bool>(),
    ) {
        let model = rotation_by(&model);
        let part_at = |swing: f64, tilt: f64, turn: f64| {
            let mut found = turned(0.0, 0.5);
            let tilted = multiply(&rotation_by(&[tilt + turn * apart, 0.0, 0.0]), &model);
            found.pose.rotation = multiply(&rotation_by(&[0.0, 0.0, swing]), &tilted);
            found.pose.translation = core::array::from_fn(|k| found.pose.translation[k] + shift[k] * swing);
            found
        };
        let sample = |frame, own, other| SideSample { frame, own, rival: Rival::Mirrored, other: Some(other), fixed: false };
        let before = sample(0, part_at(0.0, 0.0, 0.0), part_at(0.0, apart, 0.0));
        let [one, other] = [part_at(swing, 0.0, turn[0]), part_at(swing, apart, turn[1])];
        let behind = if jumped { sample(8, other, one) } else { sample(8, one, other) };
        let evidence = evidence_of(&[before, behind], |_, _| None);
        prop_assert_eq!(evidence[1].went_over, jumped);
    }
}
