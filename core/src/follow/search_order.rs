//! Which frames a component is looked for in as a whole, where nothing leads to it.

use core::ops::Range;

use heapless::Vec;

use super::cell::Cell;

/// In so many frames of a run at most a component is searched.
pub const TRIES: usize = 3;
/// Frames from one that is searched to the next, at least; of a short run a part of it, as the frames of a short film are often far from each
/// other.
const SPACING: usize = 6;
const PART: usize = 4;
/// Runs of so many frames without a pose are searched in any case.
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

/// Which runs of frames without a pose are searched: long ones, and short ones as long as that leads somewhere. A film of a few frames, far
/// from each other, has short ones alone; in a long one a component is hidden there for a while.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunsToSearch {
    /// Frames of short runs that were searched in vain.
    vain: usize,
}

impl RunsToSearch {
    /// The first run of frames of `range` in which a component was looked for or passed over, and not found, that is worth searching.
    #[must_use]
    pub fn next(&self, cells: &[Cell], range: &Range<usize>) -> Option<Range<usize>> {
        let end = range.end.min(cells.len());
        let mut at = range.start;
        while at < end {
            let start = (at..end).find(|&frame| cells[frame].found().is_none())?;
            let next = (start..end).find(|&frame| cells[frame].found().is_some());
            let run = start..next.unwrap_or(end);
            if run.len() >= LONG || self.vain < TRIES {
                return Some(run);
            }
            at = run.end;
        }
        None
    }

    /// A frame of a run was searched in vain.
    pub fn missed(&mut self, run: &Range<usize>) {
        self.vain += usize::from(run.len() < LONG);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::follow::look::Missing;
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

    #[test]
    fn long_runs_are_searched_and_short_ones_until_it_is_in_vain() {
        let found = Ok(turned(0.0, 0.3));
        let cell = |frame| Cell::on_the_way(looked(frame));
        let cells: Vec<Cell> = (0..40)
            .map(|frame| match frame {
                5..=9 | 20..=29 => cell(Err(Missing::Hidden)),
                _ => cell(found),
            })
            .collect();
        let mut runs = RunsToSearch::default();
        runs.missed(&(20..30));
        for _ in 0..TRIES {
            assert_eq!(runs.next(&cells, &(0..40)), Some(5..10));
            runs.missed(&(5..10));
        }
        assert_eq!(runs.next(&cells, &(0..40)), Some(20..30));
        assert_eq!(runs.next(&cells, &(23..40)), None);
        assert_eq!(runs.next(&cells, &(30..40)), None);
    }
}
