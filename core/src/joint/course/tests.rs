use super::*;
use proptest::prelude::*;
use std::vec::Vec;

fn phases_of(flexion: &[f64]) -> Vec<(usize, usize, bool)> {
    let mut room = std::vec![Phase::default(); flexion.len()];
    let phases = phases(flexion, REVERSAL_DEG, &mut room).expect("room");
    phases.iter().map(|p| (p.first, p.last, p.rises)).collect()
}

#[test]
fn an_activity_falls_into_bending_and_extending() {
    let bend = [0.0, 10.0, 20.0, 19.0, 30.0, 20.0, 10.0, 0.0];
    assert_eq!(phases_of(&bend), [(0, 4, true), (4, 7, false)]);
    // One degree back is an error of measurement, five are not.
    let hesitating = [0.0, 10.0, 5.0, 15.0];
    assert_eq!(
        phases_of(&hesitating),
        [(0, 1, true), (1, 2, false), (2, 3, true)]
    );
}

#[test]
fn a_gap_ends_a_phase_and_the_next_begins_behind_it() {
    let nothing = f64::NAN;
    let gap = [nothing, 0.0, 10.0, nothing, 20.0, 30.0, nothing, 40.0];
    assert_eq!(phases_of(&gap), [(1, 2, true), (4, 5, true)]);
    assert!(phases_of(&[nothing, nothing]).is_empty());
    assert!(phases(&gap, 3.0, &mut [Phase::default(); 7]).is_err());
}

#[test]
fn nothing_is_gone_through_in_a_jump() {
    let jump = [150.0, 170.0, -175.0, -160.0];
    assert_eq!(phases_of(&jump), [(0, 1, true), (2, 3, true)]);
    assert_eq!(phases_of(&[150.0, -170.0, 150.0]), []);
}

#[test]
fn numbers_at_steps_of_flexion_are_worked_by_hand() {
    // Bent from 5 to 35 degrees and back to 15: value = flexion / 10 on the way up, 1 more on the way down.
    let flexion = [5.0, 15.0, 25.0, 35.0, 25.0, 15.0];
    let values = [0.5, 1.5, 2.5, 3.5, 3.5, 2.5];
    let phases = [
        Phase {
            first: 0,
            last: 3,
            rises: true,
        },
        Phase {
            first: 3,
            last: 5,
            rises: false,
        },
    ];
    let bins: Vec<Bin> = levels(&flexion, FLEXION_STEP_DEG)
        .map(|level| at_flexion(&flexion, &values, &phases, level))
        .collect();
    let n: Vec<(f64, usize)> = bins.iter().map(|bin| (bin.flexion_deg, bin.n)).collect();
    assert_eq!(n, [(10.0, 1), (20.0, 2), (30.0, 2)]);
    assert!((bins[0].mean - 1.0).abs() < 1e-12 && bins[0].deviation.is_nan());
    // 2.0 and 3.0; 3.0 and 3.5.
    assert!((bins[1].mean - 2.5).abs() < 1e-12);
    assert!((bins[1].deviation - 0.5f64.sqrt()).abs() < 1e-12);
    assert!((bins[2].mean - 3.25).abs() < 1e-12);
    let beyond = at_flexion(&flexion, &values, &phases, 40.0);
    assert!(beyond.n == 0 && beyond.mean.is_nan());
}

#[test]
fn a_frame_at_the_very_flexion_counts_once_and_nothing_is_taken_across_a_gap() {
    let flexion = [0.0, 10.0, 20.0];
    let phase = [Phase {
        first: 0,
        last: 2,
        rises: true,
    }];
    let at = |values: [f64; 3], level| at_flexion(&flexion, &values, &phase, level);
    for (level, value) in [(0.0, 7.0), (10.0, 8.0), (20.0, 9.0)] {
        let bin = at([7.0, 8.0, 9.0], level);
        assert_eq!((bin.n, bin.mean), (1, value));
    }
    let broken = [7.0, f64::NAN, 9.0];
    assert_eq!(at(broken, 5.0).n, 0);
    assert_eq!(at(broken, 10.0).n, 0);
    assert_eq!(at(broken, 20.0).mean, 9.0);
    assert_eq!(levels(&[f64::NAN], 10.0).count(), 0);
    let negative: Vec<f64> = levels(&[-12.0, 21.0], 10.0).collect();
    assert_eq!(negative, [-10.0, 0.0, 10.0, 20.0]);
}

#[test]
fn a_cycle_has_101_points_between_frames_and_none_beyond_them() {
    let frames: Vec<f64> = (10..=30).map(f64::from).collect();
    let mut values: Vec<f64> = frames.iter().map(|x| 3.0 * x).collect();
    let points = cycle(&frames, &values, 10.0, 30.0);
    for (k, point) in points.iter().enumerate() {
        assert!((point - (30.0 + 0.6 * k as f64)).abs() < 1e-9);
    }
    values[5] = f64::NAN;
    let points = cycle(&frames, &values, 10.0, 32.0);
    // Frame 15 is missing, so what lies strictly between 14 and 16; and all beyond frame 30.
    for (k, point) in points.iter().enumerate() {
        let at = 10.0 + 0.22 * k as f64;
        let missing = (at > 14.0 && at < 16.0) || at > 30.0;
        assert_eq!(point.is_nan(), missing, "{at}");
    }
}

/// The limits themselves: what goes back by as much as a reversal has not turned, and what goes on by as much as a jump is none.
#[test]
fn a_phase_turns_beyond_a_reversal_and_breaks_beyond_a_jump() {
    let less = |limit: f64| limit * (1.0 - f64::EPSILON);
    let more = |limit: f64| limit * (1.0 + f64::EPSILON);
    for sign in [1.0, -1.0] {
        let phases = |flexion: &[f64]| {
            let flexion: Vec<f64> = flexion.iter().map(|deg| sign * deg).collect();
            let phases = phases_of(&flexion);
            let up = |rises: bool| rises == (sign > 0.0);
            let each = phases
                .iter()
                .map(|&(first, last, rises)| (first, last, up(rises)));
            each.collect::<Vec<_>>()
        };
        for back in [less(REVERSAL_DEG), REVERSAL_DEG] {
            assert_eq!(phases(&[-8.0, 0.0, -back, 8.0]), [(0, 3, true)]);
        }
        assert_eq!(
            phases(&[-8.0, 0.0, -more(REVERSAL_DEG), 8.0]),
            [(0, 1, true), (1, 2, false), (2, 3, true)]
        );
        // What has moved by no more than a reversal before it goes the other way has not risen.
        assert_eq!(phases(&[0.0, REVERSAL_DEG, -8.0]), [(0, 2, false)]);
        assert_eq!(
            phases(&[0.0, more(REVERSAL_DEG), -8.0]),
            [(0, 1, true), (1, 2, false)]
        );
        for on in [less(JUMP_DEG), JUMP_DEG] {
            assert_eq!(phases(&[-1.0, 0.0, on]), [(0, 2, true)]);
        }
        assert_eq!(phases(&[-1.0, 0.0, more(JUMP_DEG)]), [(0, 1, true)]);
        // Of frames at the very turning point the first ends the phase.
        assert_eq!(
            phases(&[0.0, 9.0, 9.0, 0.0, 0.0, 9.0]),
            [(0, 1, true), (1, 3, false), (3, 5, true)]
        );
    }
}

properties! {
    /// Backwards, or with the sign turned, a film of one way has one phase of the other way.
    #[test]
    fn all_that_rises_is_one_phase_and_falls_backwards(
        steps in proptest::collection::vec(0.0..JUMP_DEG, 1..9), start in -60.0..60.0f64,
    ) {
        let mut flexion = std::vec![start];
        for step in &steps {
            flexion.push(flexion[flexion.len() - 1] + step);
        }
        let last = steps.len();
        prop_assume!(flexion[last] > flexion[0]);
        prop_assert_eq!(phases_of(&flexion), [(0, last, true)]);
        flexion.reverse();
        prop_assert_eq!(phases_of(&flexion), [(0, last, false)]);
    }
}

#[test]
fn before_the_first_frame_nothing_is_known_and_at_it_all() {
    let points = cycle(&[10.0, 20.0, 30.0], &[1.0, 2.0, 3.0], 0.0, 40.0);
    for (k, point) in points.iter().enumerate() {
        let at = 0.4 * k as f64;
        let is_known = (25..=75).contains(&k);
        assert_eq!(!point.is_nan(), is_known, "{at}");
        assert!(
            !is_known || (point - at / 10.0).abs() < 1e-12,
            "{at}: {point}"
        );
    }
}
