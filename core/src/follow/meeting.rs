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
