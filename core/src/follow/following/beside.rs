//! What is known where a component that is lost, or lies on other edges, is looked for beside the other one of its joint.

use alloc::vec::Vec;
use core::mem::{replace, take};
use core::ops::Range;

use crate::follow::cell::Cell;
use crate::follow::frame_pose::FramePose;
use crate::follow::search_order::RunsToSearch;
use crate::follow::set_aside::{set_aside, take_better};
use crate::pose::Pose;

/// What is known where a component is looked for beside the other one of its joint.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside {
    /// Where the other one is good.
    other: Vec<Option<Pose>>,
    /// Where this one is, and all of its film as it was before.
    good: Vec<Option<FramePose>>,
    before: Vec<Cell>,
}

impl Beside {
    /// Begins with a film's cells, where the component is `good` and the `other` one is.
    pub(super) fn new(
        cells: &[Cell],
        good: Vec<Option<FramePose>>,
        other: Vec<Option<Pose>>,
    ) -> Self {
        Self {
            other,
            good,
            before: cells.to_vec(),
        }
    }

    /// The next frame in which it was not found or lies on other edges, with the run around it, and the other component's pose there. What lies on
    /// other edges is set aside.
    pub(super) fn next(
        &self,
        cells: &mut Vec<Cell>,
        runs: &RunsToSearch,
        range: &Range<usize>,
    ) -> Option<(usize, Range<usize>, Pose)> {
        *cells = set_aside(cells, &self.good);
        let (frame, run) = runs.next_beside(cells, &self.other, range)?;
        Some((frame, run, self.other[frame]?))
    }

    /// Ends it: of what was found, what is better than what was there before. Whether there is any.
    pub(super) fn end(&mut self, cells: &mut Vec<Cell>) -> bool {
        let anew = replace(cells, take(&mut self.before));
        take_better(cells, &anew)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};

    #[test]
    fn what_lies_on_other_edges_is_looked_for_and_taken_where_it_is_better() {
        let cell = |deg: f64, misfit_px: f64| Cell::on_the_way(looked(Ok(turned(deg, misfit_px))));
        let (good, poor) = (cell(0.0, 0.3), cell(20.0, 1.3));
        let film = [good, poor, good, good];
        let known = film.map(|cell| cell.found().copied().filter(|found| found.misfit_px < 1.0));
        let other = [None, Some(Pose::IDENTITY), Some(Pose::IDENTITY), None];
        let begin = || Beside::new(&film, known.to_vec(), other.to_vec());
        let runs = RunsToSearch::default();
        let asked = |cells: &mut Vec<Cell>| {
            let next = begin().next(cells, &runs, &(0..4));
            next.map(|(frame, run, _)| (frame, run))
        };
        let mut cells = film.to_vec();
        assert_eq!(asked(&mut cells), Some((1, 1..2)));
        assert_eq!(cells, [good, Cell::default(), good, good]);
        // Nothing was found, or nothing better: all is as it was.
        assert!(!begin().end(&mut cells));
        assert_eq!(cells, film);
        cells[1] = cell(30.0, 1.3);
        assert!(!begin().end(&mut cells));
        assert_eq!(cells, film);
        let better = cell(1.0, 0.3);
        cells[1] = better;
        assert!(begin().end(&mut cells));
        assert_eq!(cells, [good, better, good, good]);
    }
}
