//! Frames in which a component is good as it was followed: what the other one may be looked for beside, and what tells whether the constants of
//! the film stand that it was followed with.

use alloc::vec::Vec;

use super::cell::Cell;
use super::conclusion::Conclusion;
use super::frame_pose::FramePose;
use crate::pose::Pose;

/// A component that is good in fewer frames tells nothing of the film, and one that is in many hardly more by more of them.
const LEAST_GOOD: usize = 4;
const MOST_ASKED: usize = 12;

/// The pose of each frame in which a component is good, by what is concluded of its film.
#[must_use]
pub fn good_poses(cells: &[Cell], film: &[Conclusion]) -> Vec<Option<FramePose>> {
    let good = |(cell, one): (&Cell, &Conclusion)| {
        cell.found().copied().filter(|_| one.stands_by_itself())
    };
    cells.iter().zip(film).map(good).collect()
}

/// Frames from all over the film that are asked whether its constants stand ([`FilmPool::learnt_again`](crate::film::FilmPool::learnt_again)), with
/// the poses of the component that is `good` in them; none where it is good in too few.
#[must_use]
pub fn frames_to_ask(good: &[Option<FramePose>]) -> Vec<(usize, Pose)> {
    let found = good.iter().enumerate();
    let good: Vec<(usize, Pose)> = found
        .filter_map(|(frame, found)| Some((frame, found.as_ref()?.pose)))
        .collect();
    if good.len() < LEAST_GOOD {
        return Vec::new();
    }
    let every = good.len().div_ceil(MOST_ASKED);
    good.into_iter().step_by(every).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;

    fn asked(frames: usize, is_good: fn(usize) -> bool) -> Vec<usize> {
        let one = |frame| is_good(frame).then(|| turned(0.0, 0.3));
        let good: Vec<Option<FramePose>> = (0..frames).map(one).collect();
        let asked = frames_to_ask(&good);
        asked.into_iter().map(|(frame, _)| frame).collect()
    }

    #[test]
    fn all_of_few_frames_are_asked_some_of_many_and_none_of_too_few() {
        assert_eq!(asked(12, |_| true), (0..12).collect::<Vec<_>>());
        assert_eq!(asked(13, |_| true), [0, 2, 4, 6, 8, 10, 12]);
        assert_eq!(asked(60, |_| true).len(), 12);
        assert_eq!(asked(12, |frame| frame % 3 == 1), [1, 4, 7, 10]);
        assert!(asked(12, |frame| frame % 4 == 1).is_empty());
    }
}
