use super::*;
use crate::follow::fake::turned;
use crate::math::{radians, rotation_by};
use proptest::prelude::*;
use std::vec::Vec;

const MIDDLE: Vector3 = [2.0, -1.0, 3.0];

fn at(deg: f64, x_mm: f64) -> FramePose {
    let mut found = turned(0.0, 0.4);
    // About the axis of view, so that the middle does not go along it.
    found.pose.rotation = rotation_by(&[0.0, 0.0, radians(deg)]);
    let centre = found.pose.transform(&MIDDLE);
    for (shift, off) in found
        .pose
        .translation
        .iter_mut()
        .zip([centre[0] - x_mm, centre[1], 0.0])
    {
        *shift -= off;
    }
    found
}

/// Where a trail leads: degrees about the view, and mm to the right.
fn led(trail: &Trail, frame: usize) -> [f64; 2] {
    let pose = trail.expect(frame, &MIDDLE).pose;
    let turn = crate::math::atan2(pose.rotation[1][0], pose.rotation[0][0]);
    [crate::math::degrees(turn), pose.transform(&MIDDLE)[0]]
}

fn ordinary(trail: &Trail, frame: usize) -> [f64; 2] {
    let expected = trail.expect(frame, &MIDDLE);
    [expected.turn_deg, expected.shift_mm]
}

fn assert_near(found: [f64; 2], wanted: [f64; 2]) {
    let is_near = (0..2).all(|k| (found[k] - wanted[k]).abs() < 1e-6);
    assert!(is_near, "{found:?} {wanted:?}");
}

fn begun(found: &FramePose) -> Trail {
    Trail::begin(20, &found.pose, Usual::of(found))
}

#[test]
fn motion_goes_on_for_two_frames_either_way_and_then_rests() {
    let frame = |forward: bool, away: usize| if forward { 20 + away } else { 20 - away };
    for forward in [true, false] {
        let frame = |away: usize| frame(forward, away);
        let mut trail = begun(&at(1.0, 4.0));
        // Of one frame no motion is known.
        for away in [1, 2, 9] {
            assert_near(led(&trail, frame(away)), [1.0, 4.0]);
            let times = away as f64;
            assert_near(ordinary(&trail, frame(away)), [8.0 * times, 15.0 * times]);
            // Three hundredths of the distance.
            let depth_mm = trail.expect(frame(away), &MIDDLE).depth_mm;
            assert!((depth_mm - 0.03 * 997.0).abs() < 1e-9, "{depth_mm}");
        }
        trail.take(frame(1), Some(&at(2.0, 7.0)), true, &MIDDLE);
        assert_near(led(&trail, frame(2)), [3.0, 10.0]);
        assert_near(led(&trail, frame(3)), [4.0, 13.0]);
        for away in [4, 12] {
            assert_near(led(&trail, frame(away)), [4.0, 13.0]);
        }
        // Three frames on: a third of that each frame.
        trail.take(frame(4), Some(&at(5.0, 10.0)), true, &MIDDLE);
        assert_near(led(&trail, frame(5)), [6.0, 11.0]);
        assert_near(led(&trail, frame(9)), [7.0, 12.0]);
        // Of what lies farther off no motion is known.
        trail.take(frame(8), Some(&at(30.0, 0.0)), true, &MIDDLE);
        assert_near(led(&trail, frame(9)), [30.0, 0.0]);
        assert!(ordinary(&trail, frame(9))[0] >= 8.0);
    }
}

#[test]
fn a_trail_is_lost_after_three_frames_in_vain_and_found_with_the_next() {
    let mut trail = begun(&at(0.0, 0.0));
    for k in 1..=4 {
        assert_eq!(trail.is_lost(), k > 3);
        trail.take(20 + k, None, true, &MIDDLE);
        assert_eq!(trail.missed(), k);
    }
    trail.take(25, Some(&at(0.0, 0.0)), true, &MIDDLE);
    assert_eq!((trail.missed(), trail.is_lost()), (0, false));
}

#[test]
fn what_is_usual_follows_ordinary_poses_by_a_fifth() {
    let mut trail = begun(&at(0.0, 0.0));
    let mut other = at(0.0, 0.0);
    (
        other.misfit_px,
        other.contrast.step,
        other.contrast.strength,
    ) = (0.9, 2.0, 0.5);
    let before = *trail.usual();
    trail.take(21, Some(&other), false, &MIDDLE);
    trail.take(22, None, true, &MIDDLE);
    assert_eq!(*trail.usual(), before);
    trail.take(23, Some(&other), true, &MIDDLE);
    let Usual {
        misfit_px,
        step,
        strength,
    } = *trail.usual();
    assert_near([misfit_px, step], [0.5, 1.2]);
    assert_near([strength, 0.0], [0.9, 0.0]);
}

#[test]
fn a_pose_costs_its_misfit_in_usual_ones_and_what_it_lacks_beyond_a_seventh() {
    let usual = Usual {
        misfit_px: 0.4,
        step: 1.0,
        strength: 0.8,
    };
    let cost = |misfit_px: f64, strength: f64| {
        let mut found = turned(0.0, misfit_px);
        found.contrast.strength = strength;
        usual.cost(&found)
    };
    for (misfit_px, strength, wanted) in [
        (1.0, 0.8, 2.0),
        (0.0, 0.8, 0.0),
        (1.0, 1.0, 2.0),
        (0.5, 0.7, 1.0),
        (0.5, 0.6, 1.8),
        (0.0, 0.0, 6.8),
    ] {
        let found = cost(misfit_px, strength);
        assert!(
            (found - wanted).abs() < 1e-9,
            "{misfit_px} {strength}: {found}"
        );
    }
    for most in [0.3, 1.0, 4.0] {
        assert!((cost(usual.most_px(most), 0.8) - most).abs() < 1e-9);
    }
}

#[test]
fn the_way_in_the_image_plane_is_that_at_one_distance() {
    let pose = |translation| Pose {
        translation,
        ..Pose::IDENTITY
    };
    let a = pose([30.0, -20.0, -1000.0]);
    // Along the ray nothing is gone.
    let [deg, mm] = apart(&a, &pose([36.0, -24.0, -1200.0]), &[0.0; 3]);
    assert!(deg < 1e-9 && mm < 1e-9, "{mm}");
    let [_, mm] = apart(&a, &pose([30.0 + 3.0, -20.0 + 4.0, -1000.0]), &[0.0; 3]);
    assert!((mm - 5.0).abs() < 1e-9, "{mm}");
    let way = in_plane(&[1.0, 2.0, -10.0], &[6.0, 2.0, -20.0]);
    assert_eq!(way, [2.0, -1.0, 0.0]);
}

properties! {
    /// The naive way keeps all errors and takes the last eight. The part moves along a line and turns about the view; each error is how far
    /// it lies off what goes on evenly.
    #[test]
    fn four_times_the_usual_error_of_the_last_eight_frames_is_in_the_ordinary(
        steps in proptest::collection::vec((-5.0..5.0f64, -9.0..9.0f64), 2..14), away in 1usize..4,
    ) {
        let (mut places, mut errors) = (std::vec![[0.0; 2]], Vec::new());
        let mut trail = begun(&at(0.0, 0.0));
        for (k, &(deg, mm)) in steps.iter().enumerate() {
            let place = [deg, mm];
            trail.take(21 + k, Some(&at(deg, mm)), true, &MIDDLE);
            let last = places[k];
            let before = if k > 0 { places[k - 1] } else { last };
            errors.push([0, 1].map(|n| (place[n] - (2.0 * last[n] - before[n])).abs()));
            places.push(place);
        }
        let wanted = [0, 1].map(|n| {
            let mut last: Vec<f64> = errors.iter().rev().take(8).map(|error| error[n]).collect();
            last.sort_by(f64::total_cmp);
            let usual = last[last.len() / 2];
            (4.0 * usual).max([2.0, 3.0][n]) * away as f64
        });
        let found = ordinary(&trail, 20 + steps.len() + away);
        prop_assert!((0..2).all(|n| (found[n] - wanted[n]).abs() < 1e-5), "{found:?} {wanted:?}");
    }
}
