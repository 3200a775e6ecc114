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
