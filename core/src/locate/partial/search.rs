//! From the known outline to hypotheses: every view of a coarse grid, then the neighbours of the best.

use heapless::Vec;

use super::fit::Known;
use super::hypothesis::{Hypothesis, keep, transfer};
use super::outline::{OutlinePoints, Piece};
use super::scale_levels::ScaleLevels;
use super::similarity::Similarity;
use super::slide::{Fit, Samples, Slide, Sums, slide};
use super::units::{FARTHEST, NEAREST, Units};
use super::view::{ViewMemory, view_outline};
use crate::library::{Library, ViewAxis, ViewGrid};

/// Between the views of the coarse grid, degrees, about.
const COARSE_DEG: f64 = 4.0;
/// Hypotheses kept of one view.
pub(super) const PER_VIEW: usize = 3;
/// Places kept of one window along a stretch of a view.
const PER_WINDOW: usize = 6;
/// Most samples of a view.
pub(super) const VIEW_SAMPLES: usize = 512;
/// Numbers borrowed for views: two for each sample, which is held twice, and two sums for each place.
pub(super) const VIEW_NUMBERS: usize = 6 * VIEW_SAMPLES;
/// One sample in this many is compared when places are compared for the first time.
const FIRST_LOOK: usize = 2;

/// The search for views that explain a partial outline.
pub(super) struct PartialSearch<'a> {
    pub(super) known: Known<'a>,
    pub(super) library: &'a Library<'a>,
    pub(super) levels: ScaleLevels<'a>,
    pub(super) units: Units,
}

/// Every how many views of an axis the coarse grid has one, and its first.
fn coarse(axis: &ViewAxis) -> (usize, usize) {
    let every = ((COARSE_DEG / axis.step + 0.5) as usize).max(1);
    (every, (axis.count.saturating_sub(1) % every) / 2)
}

/// Views of the coarse grid.
pub(super) fn coarse_views(library: &Library<'_>) -> usize {
    let grid = library.info().grid;
    let count = |axis: &ViewAxis| {
        let (every, first) = coarse(axis);
        (axis.count - first).div_ceil(every)
    };
    count(&grid.x) * count(&grid.y)
}

impl PartialSearch<'_> {
    /// Fits every view of the coarse grid and returns its hypotheses in `found`.
    pub(super) fn coarse<'h>(
        &self,
        memory: &mut ViewMemory<'_>,
        numbers: &mut [f32],
        found: &'h mut [Hypothesis],
    ) -> &'h mut [Hypothesis] {
        let grid = self.library.info().grid;
        let ((every_x, first_x), (every_y, first_y)) = (coarse(&grid.x), coarse(&grid.y));
        let mut used = 0;
        for y in (first_y..grid.y.count).step_by(every_y) {
            for x in (first_x..grid.x.count).step_by(every_x) {
                let view = grid.view(x, y);
                for hypothesis in self.at_view(view, memory, numbers) {
                    if let Some(place) = found.get_mut(used) {
                        *place = hypothesis;
                        used += 1;
                    }
                }
            }
        }
        found.get_mut(..used).unwrap_or_default()
    }

    /// The best hypotheses of one view.
    fn at_view(
        &self,
        view: usize,
        memory: &mut ViewMemory<'_>,
        numbers: &mut [f32],
    ) -> Vec<Hypothesis, PER_VIEW> {
        let mut refined = Vec::new();
        let Some(outline) = view_outline(self.library, view, &self.units, memory) else {
            return refined;
        };
        let mut rough: Vec<Hypothesis, PER_VIEW> = Vec::new();
        for piece in outline.pieces() {
            for window in self.levels.windows() {
                for fit in self.places(view, &piece, window, numbers) {
                    let (similarity, limit) = (fit.similarity, last_score(&rough));
                    let hypothesis = self.judged(
                        view,
                        &outline,
                        similarity,
                        self.units.wide,
                        FIRST_LOOK,
                        limit,
                    );
                    self.keep(&mut rough, hypothesis);
                }
            }
        }
        for hypothesis in rough {
            let improved = self.improved(view, &outline, hypothesis.similarity, &COARSE_CAPS);
            self.keep(
                &mut refined,
                self.judged(
                    view,
                    &outline,
                    improved,
                    self.units.narrow,
                    1,
                    f64::INFINITY,
                ),
            );
        }
        refined
    }

    fn keep<const K: usize>(&self, list: &mut Vec<Hypothesis, K>, new: Hypothesis) {
        keep(list, new, |other| other.is_like(&new, self.units.apart));
    }

    /// Where a window fits a stretch of a view, at all scales that the object's distance allows.
    fn places(
        &self,
        view: usize,
        piece: &Piece<'_>,
        window: usize,
        numbers: &mut [f32],
    ) -> Vec<Fit, PER_WINDOW> {
        let mut best = Vec::new();
        let (low, high) = self.scales(view);
        let (samples, sums) = numbers.split_at_mut((4 * VIEW_SAMPLES).min(numbers.len()));
        let Some(along) = repeated(piece, samples) else {
            return best;
        };
        let (re, im) = sums.split_at_mut(sums.len() / 2);
        let mut sums = Sums { re, im };
        let how = Slide {
            places: if piece.closed {
                piece.points.len()
            } else {
                usize::MAX
            },
            apart: APART,
            stretch: STRETCH,
        };
        for (level, scale) in self.levels.levels(low, high) {
            let part = self.levels.samples(window, level, piece.points.len());
            slide(part, along, &how, scale, &mut sums, &mut best);
        }
        best.retain(|fit| (low..=high).contains(&fit.similarity.scale()));
        best
    }

    /// Least and greatest scale of a view, pixel widths per canonical pixel.
    fn scales(&self, view: usize) -> (f64, f64) {
        let nominal = self.units.nominal(self.library, view);
        (nominal / FARTHEST, nominal / NEAREST)
    }

    fn judged(
        &self,
        view: usize,
        outline: &OutlinePoints<'_>,
        similarity: Similarity,
        cap: f64,
        every: usize,
        limit: f64,
    ) -> Hypothesis {
        let score = self
            .known
            .disagreement(outline, &similarity, cap, every, limit);
        Hypothesis {
            view,
            similarity,
            score,
        }
    }

    /// Some steps towards the best similarity near by; `caps` from 0 (narrow) to 1 (wide).
    fn improved(
        &self,
        view: usize,
        outline: &OutlinePoints<'_>,
        start: Similarity,
        caps: &[f64],
    ) -> Similarity {
        let (low, high) = self.scales(view);
        let mut similarity = start;
        for wideness in caps {
            let cap = self.units.narrow + wideness * (self.units.wide - self.units.narrow);
            match self.known.improve(outline, &similarity, cap) {
                Some(next) if (low..=high).contains(&next.scale()) => similarity = next,
                _ => break,
            }
        }
        similarity
    }

    /// The best hypothesis among the views around that of `seed`: those two steps away, then the
    /// neighbours of the best of them.
    pub(super) fn fine(&self, seed: &Hypothesis, memory: &mut ViewMemory<'_>) -> Hypothesis {
        let mut best = *seed;
        let grid = &self.library.info().grid;
        for reach in [2, 1] {
            let centre = best;
            for (right, down) in AROUND {
                let Some(view) = neighbour(grid, centre.view, right * reach, down * reach) else {
                    continue;
                };
                let Some(outline) = view_outline(self.library, view, &self.units, memory) else {
                    continue;
                };
                let (from, to) = (self.library.record(centre.view), self.library.record(view));
                let start = transfer(&from, &to, &centre.similarity);
                let improved = self.improved(view, &outline, start, &FINE_CAPS);
                let (cap, limit) = (self.units.narrow, best.score);
                let hypothesis = self.judged(view, &outline, improved, cap, 1, limit);
                if hypothesis.score < best.score {
                    best = hypothesis;
                }
            }
        }
        best
    }
}

/// The view at a distance in views; `None` beyond a grid that does not go all around.
fn neighbour(grid: &ViewGrid, view: usize, right: isize, down: isize) -> Option<usize> {
    let (x, y) = grid.place(view);
    let x = x.checked_add_signed(right).filter(|&x| x < grid.x.count)?;
    let y = y as isize + down;
    let is_there = grid.is_around() || (0..grid.y.count as isize).contains(&y);
    is_there.then(|| grid.view(x, grid.row(y)))
}

/// What the score of a hypothesis must be below to have a place in a list.
fn last_score(list: &Vec<Hypothesis, PER_VIEW>) -> f64 {
    let last = list.last().filter(|_| list.is_full());
    last.map_or(f64::INFINITY, |last| last.score)
}

/// Samples by which two places along a view differ at least.
const APART: usize = 5;
/// Windows fit a view when their scale is within this factor of the level's.
const STRETCH: f64 = 1.2;
/// See [`PartialSearch::improved`].
const COARSE_CAPS: [f64; 5] = [1.0, 0.7, 0.4, 0.1, 0.0];
const FINE_CAPS: [f64; 3] = [0.1, 0.0, 0.0];
/// The eight directions to neighbours.
const AROUND: [(isize, isize); 8] = [
    (-1, -1),
    (0, -1),
    (1, -1),
    (-1, 0),
    (1, 0),
    (-1, 1),
    (0, 1),
    (1, 1),
];

/// A piece's points in two lists, those of a closed one twice; `None` where they do not fit.
fn repeated<'n>(piece: &Piece<'_>, numbers: &'n mut [f32]) -> Option<Samples<'n>> {
    let times = 1 + usize::from(piece.closed);
    let count = times * piece.points.len();
    let (x, y) = numbers.split_at_mut(numbers.len() / 2);
    let (x, y) = (x.get_mut(..count)?, y.get_mut(..count)?);
    let points = piece.points.iter().cycle();
    for ((x, y), point) in x.iter_mut().zip(&mut *y).zip(points) {
        [*x, *y] = point.at;
    }
    Some(Samples { x, y })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_at_an_end_of_a_grid_that_goes_all_around_has_neighbours_at_the_other() {
        let (around, window) = (ViewGrid::sphere(15.0), ViewGrid::default());
        let at = |grid: &ViewGrid, from: (usize, usize), right, down| {
            let view = neighbour(grid, grid.view(from.0, from.1), right, down);
            view.map(|view| grid.place(view))
        };
        assert_eq!(at(&around, (3, 0), 1, -2), Some((4, 22)));
        assert_eq!(at(&around, (3, 23), -1, 1), Some((2, 0)));
        assert_eq!(at(&around, (0, 5), -1, 0), None);
        assert_eq!(at(&window, (3, 0), 0, -1), None);
        assert_eq!(at(&window, (3, 40), 0, 1), None);
        assert_eq!(at(&window, (3, 39), 2, 1), Some((5, 40)));
    }

    #[test]
    fn no_view_of_an_axis_is_far_from_the_coarse_grid() {
        let steps = [0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.9, 4.1, 8.0, 15.0];
        for (step, count) in steps
            .iter()
            .flat_map(|&step| (1..50).map(move |n| (step, n)))
        {
            let axis = ViewAxis {
                first: -7.0,
                step,
                count,
            };
            let (every, first) = coarse(&axis);
            // Of whole steps that which is nearest to four degrees.
            let off = |every: usize| (every as f64 * step - 4.0).abs();
            assert!(every == 1 || off(every) <= off(every - 1));
            assert!(off(every) <= off(every + 1));
            let places: std::vec::Vec<usize> = (first..count).step_by(every).collect();
            for view in 0..count {
                let nearest = places.iter().map(|place| place.abs_diff(view)).min();
                assert!(
                    nearest.is_some_and(|away| 2 * away <= every),
                    "{step} {count}"
                );
            }
            // As far from one end as from the other, but for a step.
            let last = places.last().map_or(0, |last| count - 1 - last);
            assert!(first.abs_diff(last) <= 1, "{step} {count}");
        }
    }
}
