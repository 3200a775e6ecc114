//! The plus-minus of a pose whose mirror image is hardly another one.
//!
//! Where both sides of a mirror meet, a frame says of both that they are one pose, and of the turn between them hardly anything. What its
//! residuals say of one of them alone is too sure of that turn.

use super::cell::Cell;
use super::side_margin::{SideMargin, nearest};
use super::side_samples::SideSample;
use crate::math::{Vector3, dot, multiply, rotation_vector, subtract, transpose};
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance};

/// A standard deviation is at least so much of what both are apart: which of them it is, nobody knows.
const PART: f64 = 0.5;

/// Widens what is known of poses whose mirror image is the same pose as far as anybody can tell, along what both are apart; what is as wide
/// already stays. `middle` is the model's.
pub(super) fn widen_where_sides_are_one(
    samples: &[SideSample],
    margins: &[Option<SideMargin>],
    cells: &mut [Cell],
    middle: &Vector3,
) {
    for (frame, (cell, margin)) in cells.iter_mut().zip(margins).enumerate() {
        let is_open = margin.is_some_and(|one| one.is_one_pose() && !one.decides());
        let sample = nearest(samples, frame).map(|at| &samples[at]);
        let both = sample.and_then(|sample| Some((sample.own.pose, sample.free()?.pose)));
        let looked = cell.looked.as_mut().filter(|_| is_open && !cell.fixed);
        let found = looked.and_then(|looked| looked.found.as_mut().ok());
        if let (Some(found), Some((own, other))) = (found, both)
            && let Some(covariance) = &mut found.covariance
        {
            widen(covariance, &step(&own, &other, middle));
        }
    }
}

/// What leads from one pose to another: turn about the middle (radians) before its shift (mm), in camera axes.
fn step(from: &Pose, to: &Pose, middle: &Vector3) -> [f64; 6] {
    let turn = rotation_vector(&multiply(&to.rotation, &transpose(&from.rotation)));
    let shift = subtract(&to.transform(middle), &from.transform(middle));
    let mut both = turn.iter().chain(&shift);
    core::array::from_fn(|_| both.next().copied().unwrap_or_default())
}

/// Adds as much of a step as makes its turn as uncertain as [`PART`] of it.
fn widen(covariance: &mut PoseCovariance, step: &[f64; 6]) {
    let turn = [step[0], step[1], step[2]];
    let squared = dot(&turn, &turn);
    let rows: [Vector3; 3] = core::array::from_fn(|row| {
        let row = covariance.matrix[row];
        [row[0], row[1], row[2]]
    });
    let along = rows.map(|row| dot(&row, &turn));
    let missing = PART * PART - dot(&along, &turn) / (squared * squared).max(f64::MIN_POSITIVE);
    if missing > 0.0 && squared > 0.0 {
        let more: Matrix6 =
            core::array::from_fn(|row| step.map(|value| missing * step[row] * value));
        let values = covariance.matrix.as_flattened_mut().iter_mut();
        for (value, more) in values.zip(more.as_flattened()) {
            *value += more;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::follow::{Rival, SideStep};
    use crate::math::{degrees, sqrt};
    use proptest::array::uniform6;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Three frames at one pose, the middle one of which has its mirror image so far off, and what is known of the turn about the vertical in
    /// the last.
    fn told(apart_deg: f64, margin: f64, fixed: bool) -> Vec<f64> {
        let own = turned(0.0, 0.3);
        let mut cells = [Cell::on_the_way(looked(Ok(own))); 3];
        cells.iter_mut().for_each(|cell| cell.fixed = fixed);
        let samples = [SideSample {
            frame: 1,
            own,
            rival: Rival::Mirrored,
            other: Some(turned(apart_deg, 0.35)),
            fixed,
        }];
        let mut steps = [SideStep::default()];
        steps[0].margin = margin;
        let margins = super::super::other_margins(&samples, &steps, &[], &cells);
        for _ in 0..2 {
            widen_where_sides_are_one(&samples, &margins, &mut cells, &[1.0, 2.0, 3.0]);
        }
        let deg = |cell: &Cell| {
            let covariance = cell.found().expect("found").covariance.expect("known");
            degrees(sqrt(
                (0..3).map(|k| covariance.matrix[k][k]).fold(0.0, f64::max),
            ))
        };
        cells.iter().map(deg).collect()
    }

    #[test]
    fn half_of_what_both_sides_are_apart_is_a_standard_deviation_and_no_more_the_second_time() {
        let alone = told(9.0, 0.5, false);
        for deg in told(1.8, 0.5, false) {
            assert!((deg - 0.9).abs() < 1e-9, "{deg}");
        }
        // Two poses; one that is certain; one that is as wide already; one that a person gave.
        assert_eq!(told(2.1, 0.5, false), alone);
        assert_eq!(told(1.8, 1.1, false), alone);
        assert_eq!(told(0.01, 0.5, false), alone);
        assert_eq!(told(1.8, 0.5, true), alone);
    }

    properties! {
        /// As wide along the turn as half of it at least, no narrower than before in any direction, and no wider than it needs to be.
        #[test]
        fn a_covariance_is_widened_along_the_step_alone_and_once(
            factor in uniform6(uniform6(-1.0..1.0f64)), step in uniform6(-1.0..1.0f64), size in 0.0..4.0f64,
        ) {
            let before = PoseCovariance {
                matrix: core::array::from_fn(|a| core::array::from_fn(|b| (0..6).map(|k| factor[a][k] * factor[b][k]).sum())),
            };
            let step = step.map(|value| size * value);
            let squared: f64 = step[..3].iter().map(|value| value * value).sum();
            let along = |covariance: &PoseCovariance| -> f64 {
                let each = (0..9).map(|k| step[k / 3] * covariance.matrix[k / 3][k % 3] * step[k % 3]);
                each.sum::<f64>() / squared.max(f64::MIN_POSITIVE)
            };
            let mut after = before;
            widen(&mut after, &step);
            let wanted = along(&before).max(PART * PART * squared);
            prop_assert!((along(&after) - wanted).abs() < 1e-9 * (1.0 + wanted), "{} {wanted}", along(&after));
            // What was added is a part of the step in all six, the same everywhere.
            let part = (along(&after) - along(&before)) / squared.max(f64::MIN_POSITIVE);
            for (row, column) in (0..36).map(|k| (k / 6, k % 6)) {
                let more = after.matrix[row][column] - before.matrix[row][column];
                prop_assert!((more - part * step[row] * step[column]).abs() < 1e-9 * (1.0 + part), "{row} {column}: {more}");
            }
            let once = after;
            widen(&mut after, &step);
            for (again, once) in after.matrix.as_flattened().iter().zip(once.matrix.as_flattened()) {
                prop_assert!((again - once).abs() < 1e-9 * (1.0 + once.abs()));
            }
        }
    }

    #[test]
    fn without_a_turn_and_where_it_is_known_worse_nothing_is_added() {
        let wide = turned(0.0, 0.3).covariance.expect("known");
        // 0.06 degrees are known to no better than 0.06.
        for step in [
            [0.0, 0.0, 0.0, 3.0, 4.0, 5.0],
            [0.0, 1e-3, 0.0, 3.0, 4.0, 5.0],
            [0.0; 6],
        ] {
            let mut after = wide;
            widen(&mut after, &step);
            assert_eq!(after, wide, "{step:?}");
        }
    }
}
