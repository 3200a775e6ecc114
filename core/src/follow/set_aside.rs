//! Poses of a followed film that lie on edges other than the component's own: set aside, so that it is looked for in their frames once more.

use alloc::vec::Vec;

use super::cell::Cell;
use super::frame_pose::FramePose;

/// A pose that is not good and scores less than this part of what good ones of the film do lies on other edges. Sides of the mirror score alike:
/// which one it is, settling tells.
const POOR: f64 = 0.6;
/// What is found in its place scores so many times more.
const BETTER: f64 = 1.25;

/// The cells without those poses; `good` has the poses of the frames in which the component is good ([`super::good_poses`]).
#[must_use]
pub fn set_aside(cells: &[Cell], good: &[Option<FramePose>]) -> Vec<Cell> {
    let least = POOR * usual_score(good);
    let is_good = |frame: usize| good.get(frame).is_some_and(Option::is_some);
    let each = cells.iter().enumerate();
    each.map(|(frame, cell)| {
        let poor = cell.found().is_some_and(|found| found.score() < least);
        match poor && !cell.fixed && !is_good(frame) {
            true => Cell::default(),
            false => *cell,
        }
    })
    .collect()
}

/// Puts what was `found` anew in the place of what had been set aside, in those frames in which it is better. Whether there are any.
pub fn take_better(cells: &mut [Cell], found: &[Cell]) -> bool {
    let mut any = false;
    for (cell, new) in cells.iter_mut().zip(found) {
        let Some(pose) = new.found() else {
            continue;
        };
        let least = cell.found().map_or(0.0, |old| BETTER * old.score());
        if !cell.fixed && *cell != *new && pose.score() > least {
            *cell = *new;
            any = true;
        }
    }
    any
}

/// The middle one of all scores; 0 of none.
fn usual_score(good: &[Option<FramePose>]) -> f64 {
    let scores = good.iter().flatten().map(FramePose::score);
    let mut scores: Vec<f64> = scores.collect();
    scores.sort_unstable_by(f64::total_cmp);
    scores.get(scores.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use std::vec;

    fn cell(deg: f64, misfit_px: f64) -> Cell {
        Cell::on_the_way(looked(Ok(turned(deg, misfit_px))))
    }

    #[test]
    fn what_is_not_good_and_scores_far_less_is_set_aside() {
        let good = cell(0.0, 0.4);
        let fixed = Cell {
            fixed: true,
            ..cell(30.0, 1.2)
        };
        let film = [good, cell(20.0, 1.2), cell(5.0, 0.5), fixed, good];
        let found = good.found().copied();
        let known = [found, None, None, None, found];
        let aside = set_aside(&film, &known);
        assert_eq!(aside, [good, Cell::default(), film[2], fixed, good]);
        let all = film.map(|cell| cell.found().copied());
        assert_eq!(set_aside(&film, &all), film);
        // Of nothing good nothing is usual.
        assert_eq!(set_aside(&film, &[]), film);
    }

    #[test]
    fn only_what_is_better_takes_its_place() {
        let [poor, better, worse] = [(20.0, 1.2), (1.0, 0.4), (40.0, 1.2)];
        let of = |(deg, px)| cell(deg, px);
        let mut film = vec![of(poor), of(poor), Cell::default(), of(poor)];
        let found = [of(better), of(worse), of(better), Cell::default()];
        assert!(take_better(&mut film, &found));
        assert_eq!(film, [of(better), of(poor), of(better), of(poor)]);
        assert!(!take_better(&mut film, &found));
    }
}
