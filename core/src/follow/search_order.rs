//! Which frames a component is looked for in as a whole, where nothing leads to it.

use core::ops::Range;

use heapless::Vec;

#[cfg(feature = "alloc")]
use super::cell::Cell;

/// In so many frames of a run at most a component is searched.
pub const TRIES: usize = 3;
/// Frames from one that is searched to the next, at least; of a short run a part of it, as the frames of a short film are often far from each
/// other.
const SPACING: usize = 6;
const PART: usize = 4;
/// Runs of so many frames without a pose are searched in any case.
#[cfg(feature = "alloc")]
const LONG: usize = 8;

/// Frames of a run in the order in which they are searched: its middle first, then between those before.
#[must_use]
pub fn frames_to_search(run: &Range<usize>) -> Vec<usize, TRIES> {
    let mut frames: Vec<usize, TRIES> = Vec::new();
    let spacing = SPACING.min(run.len().div_ceil(PART));
    let mut parts = 2;
    while !frames.is_full() && parts <= 16 {
        for k in (1..parts).step_by(2) {
            let frame = run.start + k * run.len() / parts;
            let near = |other: &usize| other.abs_diff(frame) < spacing;
            if frame < run.end && !frames.iter().any(near) {
                // Those that find no room are of later parts, and not wanted.
                let _ = frames.push(frame);
            }
        }
        parts *= 2;
    }
    frames
}

/// Which frames are searched that lie in runs without a pose: the longest run first, long ones in any case, and short ones as long as that leads
/// somewhere. A film of a few frames, far from each other, has short ones alone; in a long one a component is hidden there for a while.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, Default)]
pub struct RunsToSearch {
    searched: alloc::vec::Vec<usize>,
    /// Frames of short runs that were searched in vain, since one was not.
    vain: usize,
}

#[cfg(feature = "alloc")]
impl RunsToSearch {
    /// The next frame of `range` that is worth searching, and the run around it in which a component was looked for or passed over, and not
    /// found; of a short one between frames in which it was, the middle alone. [`Self::searched`] takes what came of it.
    #[must_use]
    pub fn next(&self, cells: &[Cell], range: &Range<usize>) -> Option<(usize, Range<usize>)> {
        let range = clipped(range, cells);
        // What hides a component for a few frames was come up to from both sides.
        let passes =
            |run: &Range<usize>| run.len() < LONG && run.start > range.start && run.end < range.end;
        let tries = |run: &Range<usize>| if passes(run) { 1 } else { TRIES };
        self.next_of_those(&|frame| cells[frame].found().is_none(), &tries, &range)
    }

    /// The same of the frames alone in which the `other` component of the joint is known.
    #[must_use]
    pub fn next_beside<T>(
        &self,
        cells: &[Cell],
        other: &[Option<T>],
        range: &Range<usize>,
    ) -> Option<(usize, Range<usize>)> {
        let is_known = |frame: usize| other.get(frame).is_some_and(Option::is_some);
        let is_missing = |frame: usize| cells[frame].found().is_none() && is_known(frame);
        self.next_of_those(&is_missing, &|_| TRIES, &clipped(range, cells))
    }

    fn next_of_those(
        &self,
        is_missing: &dyn Fn(usize) -> bool,
        tries: &dyn Fn(&Range<usize>) -> usize,
        range: &Range<usize>,
    ) -> Option<(usize, Range<usize>)> {
        let is_worth = |run: &Range<usize>| run.len() >= LONG || self.vain < TRIES;
        let runs = missing_runs(is_missing, range).filter(is_worth);
        let each = runs.filter_map(|run| Some((self.next_of(&run, tries(&run))?, run)));
        // Of those that are as long the first.
        each.reduce(|one, other| {
            if other.1.len() > one.1.len() {
                other
            } else {
                one
            }
        })
    }

    /// A frame of a run was searched.
    pub fn searched(&mut self, frame: usize, run: &Range<usize>, is_found: bool) {
        self.searched.push(frame);
        match is_found {
            true => self.vain = 0,
            false => self.vain += usize::from(run.len() < LONG),
        }
    }

    fn next_of(&self, run: &Range<usize>, tries: usize) -> Option<usize> {
        let searched = self.searched.iter().filter(|frame| run.contains(frame));
        let may_be = searched.count() < tries;
        let mut frames = frames_to_search(run).into_iter().filter(|_| may_be);
        frames.find(|frame| !self.searched.contains(frame))
    }
}

#[cfg(feature = "alloc")]
fn clipped(range: &Range<usize>, cells: &[Cell]) -> Range<usize> {
    range.start..range.end.min(cells.len())
}

/// The runs of frames that are missing.
#[cfg(feature = "alloc")]
fn missing_runs(
    is_missing: &dyn Fn(usize) -> bool,
    range: &Range<usize>,
) -> impl Iterator<Item = Range<usize>> {
    let mut at = range.start;
    let end = range.end;
    core::iter::from_fn(move || {
        let start = (at..end).find(|&frame| is_missing(frame))?;
        at = (start..end)
            .find(|&frame| !is_missing(frame))
            .unwrap_or(end);
        Some(start..at)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(feature = "alloc")]
    use crate::follow::fake::{looked, turned};
    #[cfg(feature = "alloc")]
    use crate::follow::look::Missing;
    #[cfg(feature = "alloc")]
    use std::vec::Vec;

    #[test]
    fn the_middle_comes_first() {
        assert_eq!(frames_to_search(&(0..120))[..], [60, 30, 90]);
        assert_eq!(frames_to_search(&(0..8))[..], [4, 2, 6]);
        assert_eq!(frames_to_search(&(10..14))[..], [12, 11, 13]);
        assert_eq!(frames_to_search(&(5..7))[..], [6, 5]);
        assert_eq!(frames_to_search(&(5..6))[..], [5]);
        assert!(frames_to_search(&(5..5)).is_empty());
    }

    /// A short run is looked at in its quarters, and where the last of these lies too near to its middle, in an eighth.
    #[test]
    fn frames_of_a_short_run_lie_apart_and_within_it() {
        assert_eq!(frames_to_search(&(0..13))[..], [6, 1, 11]);
        assert_eq!(frames_to_search(&(20..34))[..], [27, 23, 32]);
        for length in 1..200 {
            for start in [0, 17] {
                let run = start..start + length;
                let frames = frames_to_search(&run);
                assert_eq!(frames[0], start + length / 2);
                let apart = SPACING.min(length.div_ceil(PART));
                for (k, frame) in frames.iter().enumerate() {
                    assert!(run.contains(frame));
                    let near = frames[..k]
                        .iter()
                        .any(|other| other.abs_diff(*frame) < apart);
                    assert!(!near, "{run:?}: {frames:?}");
                }
                // Of a run that has room for all three none is left out.
                assert!(frames.is_full() || length < 12, "{run:?}: {frames:?}");
                let moved = frames_to_search(&(0..length));
                assert!(frames.iter().map(|frame| frame - start).eq(moved));
            }
        }
    }

    /// Frames between others, at the beginning of the film and at its end are missing, and what hides a part for a while was come up to from
    /// both sides: its middle is enough.
    #[cfg(feature = "alloc")]
    #[test]
    fn a_short_run_at_an_end_of_the_film_is_searched_like_a_long_one() {
        let searched = |missing: Range<usize>| {
            let cell = |frame: usize| match missing.contains(&frame) {
                true => Cell::on_the_way(looked(Err(Missing::Hidden))),
                false => Cell::on_the_way(looked(Ok(turned(0.0, 0.3)))),
            };
            let cells: Vec<Cell> = (0..30).map(cell).collect();
            let (mut runs, mut count) = (RunsToSearch::default(), 0);
            while let Some((frame, run)) = runs.next(&cells, &(0..60)) {
                assert_eq!(run, missing);
                runs.searched(frame, &run, false);
                count += 1;
            }
            count
        };
        assert_eq!(
            [searched(0..7), searched(23..30), searched(1..8)],
            [3, 3, 1]
        );
        assert_eq!(
            [searched(1..9), searched(22..29), searched(21..29)],
            [3, 1, 3]
        );
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn beside_the_other_component_it_is_searched_where_that_is_known() {
        let cells = film();
        let known = |cells: &[Cell]| -> Vec<Option<()>> {
            let found = cells.iter().map(|cell| cell.found().map(|_| ()));
            found.collect()
        };
        let mut other = known(&cells);
        other.rotate_left(30);
        let runs = RunsToSearch::default();
        // The other one lacks 3 to 8, 15 to 19 and 30 to 39.
        assert_eq!(
            runs.next_beside(&cells, &other, &(0..40)),
            Some((25, 20..30))
        );
        assert_eq!(runs.next_beside(&cells, &other, &(0..20)), Some((9, 9..10)));
        assert_eq!(runs.next_beside(&cells, &known(&cells), &(0..40)), None);
        assert_eq!(runs.next_beside::<()>(&cells, &[], &(0..40)), None);
    }

    /// Frames 5 to 9, 20 to 29 and 33 to 38 are missing.
    #[cfg(feature = "alloc")]
    fn film() -> Vec<Cell> {
        let found = Ok(turned(0.0, 0.3));
        let cell = |frame| Cell::on_the_way(looked(frame));
        let missing = |frame| match frame {
            5..=9 | 20..=29 | 33..=38 => cell(Err(Missing::Hidden)),
            _ => cell(found),
        };
        (0..40).map(missing).collect()
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn the_longest_run_comes_first_and_short_ones_are_searched_until_it_is_in_vain() {
        let cells = film();
        let mut runs = RunsToSearch::default();
        let mut searched = Vec::new();
        while let Some((frame, run)) = runs.next(&cells, &(0..40)) {
            runs.searched(frame, &run, false);
            searched.push(frame);
        }
        assert_eq!(searched, [25, 22, 28, 36, 7]);
        assert_eq!(runs.next(&cells, &(30..40)), None);
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn what_was_found_makes_short_runs_worth_searching_again() {
        let searched = |found: Option<usize>| {
            let cell = |frame| {
                let seen = turned(0.0, 0.3);
                let seen = if frame % 5 == 3 {
                    Err(Missing::Hidden)
                } else {
                    Ok(seen)
                };
                Cell::on_the_way(looked(seen))
            };
            let mut cells: Vec<Cell> = (0..40).map(cell).collect();
            let (mut runs, mut searched) = (RunsToSearch::default(), Vec::new());
            while let Some((frame, run)) = runs.next(&cells, &(0..40)) {
                searched.push(frame);
                runs.searched(frame, &run, found == Some(frame));
                if found == Some(frame) {
                    cells[frame] = cells[0];
                }
            }
            searched
        };
        assert_eq!(searched(None), [3, 8, 13]);
        assert_eq!(searched(Some(8)), [3, 8, 13, 18, 23]);
    }
}
