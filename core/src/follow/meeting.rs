//! Two ways through the same frames, from anchors at both ends.

use super::cell::Cell;
use super::frame_pose::FramePose;
use super::look::Looked;
use crate::pose::{Pose, geodesic_deg};

/// Two ways have come to the same pose of a frame where they are nearer than this, degrees.
const SAME_DEG: f64 = 1.0;
/// The worse of two ways that differ is no rival where its score is below this part of the better one's.
const RIVAL: f64 = 0.8;
/// What a jump of a degree costs where one way is left for the other, in scores.
const JUMP: f64 = 0.05;

/// Whether two ways have come to one pose of a frame.
#[must_use]
pub fn have_met(one: &Looked, other: &Looked) -> bool {
    match (&one.found, &other.found) {
        (Ok(one), Ok(other)) => !are_apart(&one.pose, &other.pose),
        _ => false,
    }
}

fn are_apart(one: &Pose, other: &Pose) -> bool {
    geodesic_deg(&one.rotation, &other.rotation) >= SAME_DEG
}

/// Takes the frames up to one from the first way and those behind it from the second, where that is best: `ways` are what
/// both saw in consecutive frames, `None` where one did not come. `cells` are as many.
pub fn join_ways(ways: &[[Option<Looked>; 2]], cells: &mut [Cell]) {
    let all = Ways(ways);
    let best = (0..=ways.len()).max_by(|&a, &b| all.worth(a).total_cmp(&all.worth(b)));
    for (k, cell) in cells.iter_mut().enumerate().take(ways.len()) {
        *cell = all.cell(k, usize::from(k >= best.unwrap_or(0)));
    }
}

struct Ways<'w>(&'w [[Option<Looked>; 2]]);

impl Ways<'_> {
    fn found(&self, k: usize, which: usize) -> Option<FramePose> {
        self.0.get(k)?[which]?.found.ok()
    }

    fn score(&self, k: usize, which: usize) -> f64 {
        self.found(k, which).map_or(0.0, |found| found.score())
    }

    /// What it is worth to go over before the frame `at`.
    fn worth(&self, at: usize) -> f64 {
        let first: f64 = (0..at).map(|k| self.score(k, 0)).sum();
        let second: f64 = (at..self.0.len()).map(|k| self.score(k, 1)).sum();
        let before = self.found(at.saturating_sub(1), 0);
        let behind = self.found(at.min(self.0.len().saturating_sub(1)), 1);
        let jump = match (before, behind) {
            (Some(one), Some(other)) => geodesic_deg(&one.pose.rotation, &other.pose.rotation),
            _ => 0.0,
        };
        first + second - JUMP * jump
    }

    fn cell(&self, k: usize, which: usize) -> Cell {
        let rival = self.score(k, 1 - which) >= RIVAL * self.score(k, which);
        let other = self.found(k, 1 - which).zip(self.found(k, which));
        Cell {
            looked: self.0[k][which].or(self.0[k][1 - which]),
            fixed: false,
            other_way: other
                .filter(|(other, own)| rival && are_apart(&other.pose, &own.pose))
                .map(|(other, _)| other.pose),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::follow::look::Missing;
    use std::vec::Vec;

    /// What a way saw: degrees, or nothing.
    fn seen(deg: Option<f64>, misfit_px: f64) -> Option<Looked> {
        let found = deg.map(|deg| turned(deg, misfit_px));
        Some(looked(found.ok_or(Missing::Hidden)))
    }

    /// The first frame that is taken from the second way, whose poses have other misfits.
    fn goes_over(ways: &[[Option<Looked>; 2]]) -> usize {
        let mut cells = std::vec![Cell::default(); ways.len()];
        join_ways(ways, &mut cells);
        let of_second: Vec<bool> = (cells.iter().zip(ways))
            .map(|(cell, [_, second])| cell.looked == *second)
            .collect();
        let first = of_second.iter().position(|&second| second);
        let first = first.unwrap_or(ways.len());
        assert!(of_second[first..].iter().all(|&second| second));
        first
    }

    #[test]
    fn ways_that_are_worth_the_same_are_left_for_each_other_where_they_lie_nearest() {
        for nearest in 1..5 {
            let second = |k: usize| if k == nearest { 0.5 } else { 9.0 };
            let ways: Vec<_> = (0..6)
                .map(|k| [seen(Some(0.0), 0.5), seen(Some(second(k)), 0.5)])
                .collect();
            assert_eq!(goes_over(&ways), nearest);
        }
    }

    /// A pose of full strength that leaves nothing scores 1, and a degree of a jump costs a twentieth of that.
    #[test]
    fn a_way_is_left_where_the_other_is_worth_more_than_the_jump() {
        let worst_px = crate::math::sqrt(2.0 * 2.5 * 2.5 / 6.0);
        let ways = |jump_deg: f64, better: usize| -> Vec<_> {
            let second = |k: usize| if k >= 5 - better { 0.0 } else { 2.0 * worst_px };
            (0..5)
                .map(|k| [seen(Some(0.0), worst_px), seen(Some(jump_deg), second(k))])
                .collect()
        };
        // Two frames more are worth 40 degrees.
        assert_eq!(goes_over(&ways(39.0, 2)), 3);
        assert_eq!(goes_over(&ways(19.0, 1)), 4);
        // Both ways alike cost the jump wherever they are left for each other, and the last is as good.
        assert_eq!(goes_over(&ways(60.0, 3)), 2);
        // Nothing is known of a jump from or to a frame without a pose.
        let mut gap = ways(170.0, 2);
        gap[2][0] = seen(None, 0.0);
        assert_eq!(goes_over(&gap), 3);
    }

    #[test]
    fn the_other_way_is_told_where_it_is_another_pose_and_nearly_as_good() {
        let other_way = |deg: f64, misfit_px: f64| {
            let mut cells = [Cell::default()];
            let way = [[seen(Some(0.0), 0.0), seen(Some(deg), misfit_px)]];
            Ways(&way).cell(0, 0).other_way.inspect(|pose| {
                assert_eq!(*pose, turned(deg, 0.0).pose);
                join_ways(&way, &mut cells);
                assert!(cells[0].other_way.is_some() && !cells[0].fixed);
            })
        };
        // What leaves so much scores four fifths of what leaves nothing.
        let px = crate::math::sqrt(2.0 * 0.2 * 2.5 * 2.5 / 6.0);
        assert!(other_way(1.01, 0.99 * px).is_some() && other_way(170.0, 0.0).is_some());
        assert!(other_way(0.99, 0.0).is_none() && other_way(1.01, 1.01 * px).is_none());
        let met = |one: Option<f64>, other: Option<f64>| {
            let [one, other] = [one, other].map(|deg| seen(deg, 0.4).expect("looked"));
            have_met(&one, &other)
        };
        assert!(met(Some(3.0), Some(3.99)) && !met(Some(3.0), Some(4.01)));
        assert!(!met(None, Some(3.0)) && !met(Some(3.0), None) && !met(None, None));
    }
}
