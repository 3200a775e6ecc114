//! The score surface: unmatched pixels of every view, and the views that fit.

use core::ops::Range;

use heapless::Vec;
use thiserror::Error;

use crate::library::{Library, ViewGrid};
use crate::memory::{TooLittleMemory, first};
use crate::shortlist::smallest;

/// Why nothing was matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MatchError {
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// Silhouette and library differ in their canonical frames.
    #[error(
        "the silhouette was brought to another canonical frame than the library's views: size and area must be the library's"
    )]
    Canonical,
}

/// Unmatched pixels of every view in both directions of the principal axis, in borrowed memory: the score surface.
#[derive(Clone, Copy, Debug)]
pub struct Scores<'a> {
    grid: ViewGrid,
    straight: &'a [u32],
    reversed: &'a [u32],
}

/// A view of a library that a silhouette was compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewMatch {
    /// Number of the view.
    pub view: usize,
    /// Whether the silhouette fits when rotated by 180 degrees.
    pub reversed: bool,
    /// Canonical pixels set in one of the two and not in the other.
    pub unmatched: u32,
}

/// Scores of a library of `views` views: one for each view and direction of the principal axis.
#[must_use]
pub const fn scores_needed(views: usize) -> usize {
    2 * views
}

/// The views around a view of a grid and itself, up to nine, row by row in rising order.
pub(crate) fn rows_around(grid: &ViewGrid, view: usize) -> RowsAround {
    let (x, y) = grid.place(view);
    let last = grid.y.count.saturating_sub(1);
    // A row before the first is the last where the grid goes all around, else there is none.
    let around = (y == 0 || y == last) && grid.is_around();
    let beyond = |row: usize| if around { row } else { NO_ROW };
    let rows = match y {
        0 => [0, if last > 0 { 1 } else { NO_ROW }, beyond(last)],
        _ if y == last => [beyond(0), y - 1, y],
        _ => [y - 1, y, y + 1],
    };
    let left = x.saturating_sub(1);
    RowsAround {
        rows,
        at: 0,
        left,
        across: grid.x.count,
        columns: (x + 2).min(grid.x.count) - left,
    }
}

/// The number of a row that there is not.
const NO_ROW: usize = usize::MAX;

/// See [`rows_around`].
#[derive(Clone, Debug)]
pub(crate) struct RowsAround {
    rows: [usize; 3],
    at: usize,
    left: usize,
    across: usize,
    columns: usize,
}

impl Iterator for RowsAround {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        loop {
            let row = *self.rows.get(self.at)?;
            self.at += 1;
            if row != NO_ROW {
                let start = row * self.across + self.left;
                return Some(start..start + self.columns);
            }
        }
    }
}

/// The eight views around a view of a grid, or as many as there are.
pub(crate) fn neighbours(grid: &ViewGrid, view: usize) -> impl Iterator<Item = usize> {
    let near = rows_around(grid, view).flatten();
    near.filter(move |&neighbour| neighbour != view)
}

impl<'a> Scores<'a> {
    /// Fills the surface with the score of every view in both directions.
    pub(crate) fn fill(
        library: &Library<'_>,
        scores: &'a mut [u32],
        score: impl Fn(usize, bool) -> u32,
    ) -> Result<Self, MatchError> {
        let scores = first("scores", scores_needed(library.views()), scores)?;
        let (straight, reversed) = scores.split_at_mut(library.views());
        for (view, (a, b)) in straight.iter_mut().zip(&mut *reversed).enumerate() {
            (*a, *b) = (score(view, false), score(view, true));
        }
        Ok(Self {
            grid: library.info().grid,
            straight,
            reversed,
        })
    }

    /// The grid of views behind the scores.
    #[must_use]
    pub fn grid(&self) -> &ViewGrid {
        &self.grid
    }

    /// Unmatched pixels of all views for one direction of the axis, in view order.
    #[must_use]
    pub fn surface(&self, reversed: bool) -> &[u32] {
        if reversed {
            self.reversed
        } else {
            self.straight
        }
    }

    fn all(&self) -> impl Iterator<Item = ViewMatch> + '_ {
        [false, true].into_iter().flat_map(|reversed| {
            let surface = self.surface(reversed).iter().enumerate();
            surface.map(move |(view, &unmatched)| ViewMatch {
                view,
                reversed,
                unmatched,
            })
        })
    }

    /// The `K` views with the fewest unmatched pixels, best first. Ties keep view order, the
    /// straight direction first.
    #[must_use]
    pub fn best<const K: usize>(&self) -> Vec<ViewMatch, K> {
        smallest(self.all(), |candidate| candidate.unmatched)
    }

    /// The best `K` local minima of the score surfaces: views that none of their eight
    /// neighbours beats. These are the rival poses; the views beside a minimum are not.
    #[must_use]
    pub fn minima<const K: usize>(&self) -> Vec<ViewMatch, K> {
        let minima = self.all().filter(|candidate| self.is_minimum(candidate));
        smallest(minima, |candidate| candidate.unmatched)
    }

    fn is_minimum(&self, candidate: &ViewMatch) -> bool {
        let surface = self.surface(candidate.reversed);
        neighbours(&self.grid, candidate.view).all(|neighbour| match surface.get(neighbour) {
            // Of equal neighbours the first counts.
            Some(&score) if neighbour < candidate.view => candidate.unmatched < score,
            Some(&score) => candidate.unmatched <= score,
            None => true,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::ViewAxis;
    use proptest::prelude::*;

    fn axis(count: usize) -> ViewAxis {
        ViewAxis {
            first: 0.0,
            step: 1.0,
            count,
        }
    }

    properties! {
        #[test]
        fn the_best_are_the_head_of_the_sorted_list(
            scores in proptest::collection::vec(0u32..40, 48)
        ) {
            let (straight, reversed) = scores.split_at(24);
            let surface = Scores { grid: ViewGrid { x: axis(4), y: axis(6) }, straight, reversed };
            let mut sorted: std::vec::Vec<ViewMatch> = surface.all().collect();
            sorted.sort_by_key(|candidate| candidate.unmatched);
            prop_assert_eq!(&surface.best::<7>()[..], &sorted[..7]);
            // Every minimum is at most its neighbours, and the best view is one.
            let minima = surface.minima::<48>();
            prop_assert_eq!(minima.first().map(|m| m.unmatched), Some(sorted[0].unmatched));
            for minimum in &minima {
                let (x, y) = surface.grid.place(minimum.view);
                for (other, &score) in surface.surface(minimum.reversed).iter().enumerate() {
                    let (ox, oy) = surface.grid.place(other);
                    if ox.abs_diff(x) <= 1 && oy.abs_diff(y) <= 1 {
                        prop_assert!(score >= minimum.unmatched);
                    }
                }
            }
        }

        /// Few scores, so that many are equal: of neighbours that are the first is one, and none after it.
        #[test]
        fn minima_are_all_that_no_neighbour_beats(
            scores in proptest::collection::vec(0u32..4, 48),
            around in any::<bool>(),
        ) {
            let (straight, reversed) = scores.split_at(24);
            let turns = if around { 60.0 } else { 1.0 };
            let y = ViewAxis { step: turns, ..axis(6) };
            let surface = Scores { grid: ViewGrid { x: axis(4), y }, straight, reversed };
            let beside = |a: usize, b: usize| {
                let ([x, y], [other_x, other_y]) = ([a % 4, a / 4], [b % 4, b / 4]);
                let rows = y.abs_diff(other_y);
                x.abs_diff(other_x) <= 1 && (rows <= 1 || around && rows == 5)
            };
            let mut naive = std::vec::Vec::new();
            for (reversed, scores) in [(false, straight), (true, reversed)] {
                for (view, &unmatched) in scores.iter().enumerate() {
                    let mut others = scores.iter().enumerate().filter(|&(other, _)| other != view && beside(view, other));
                    if others.all(|(other, &score)| (unmatched, view) < (score, other)) {
                        naive.push(ViewMatch { view, reversed, unmatched });
                    }
                }
            }
            naive.sort_by_key(|one| one.unmatched);
            prop_assert_eq!(&surface.minima::<48>()[..], &naive[..]);
        }
    }
}
