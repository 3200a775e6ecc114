//! Sub-degree rotation from the bands that the outline sweeps between neighbouring views.
//!
//! Where the neighbour one step ahead is set and the one behind is not, or conversely,
//! lies the band that the outline sweeps as the object turns. How many pixels of that band a
//! silhouette covers, counted positive in the one part and negative in the other, is a linear
//! functional of the silhouette that grows smoothly with the rotation: unlike the number of
//! unmatched pixels it has no kink at the best view. The functional is evaluated for the 3 x 3
//! nearest views, interpolated between them, and set equal to its value for the silhouette; one
//! equation for each axis of the grid.

use crate::library::{Library, ViewGrid};
use crate::search::{ViewMatch, ViewSearch};

/// First to last node of the 3 (or fewer) nearest to `at` on an axis of `count` views.
pub(crate) fn window(at: usize, count: usize, reach: usize) -> core::ops::Range<usize> {
    let length = (2 * reach + 1).min(count);
    let first = at.saturating_sub(reach).min(count - length);
    first..first + length
}

/// Lagrange's weight of the node `at` among consecutive whole `nodes`, for the place `x`.
pub(crate) fn lagrange(nodes: &core::ops::Range<usize>, at: usize, x: f64) -> f64 {
    nodes
        .clone()
        .filter(|&other| other != at)
        .map(|other| (x - other as f64) / (at as f64 - other as f64))
        .product()
}

/// The 3 x 3 views around one, row by row.
struct Neighbourhood {
    views: [usize; 9],
    /// The place of the view in the middle.
    middle: [f64; 2],
    /// Which of the nine lie ahead of the view along x and behind it, and the same along y.
    ends: [usize; 4],
}

impl Neighbourhood {
    /// `None` where there are fewer views.
    fn new(grid: &ViewGrid, view: usize) -> Option<Self> {
        let (x, y) = grid.place(view);
        let columns = window(x, grid.x.count, 1);
        let rows = window(y, grid.y.count, 1);
        if columns.len() < 3 || rows.len() < 3 {
            return None;
        }
        let at =
            core::array::from_fn(|node| grid.view(columns.start + node % 3, rows.start + node / 3));
        let (x, y) = (x - columns.start, 3 * (y - rows.start));
        Some(Self {
            views: at,
            middle: [columns.start + 1, rows.start + 1].map(|at| at as f64),
            ends: [y + 2, y, 6 + x, x],
        })
    }

    /// Pixels that each of the ends has in common with each view.
    fn overlaps(&self, library: &Library<'_>) -> [[u32; 9]; 4] {
        let mut common = [[0; 9]; 4];
        for index in 0..self.ends.len() {
            let (known, rest) = common.split_at_mut(index);
            let (Some(own), Some(&end)) = (rest.first_mut(), self.ends.get(index)) else {
                break;
            };
            let Some(&view) = self.views.get(end) else {
                break;
            };
            for (node, (pixels, &other)) in own.iter_mut().zip(&self.views).enumerate() {
                // What two ends have in common is counted once.
                let known = self.ends.iter().zip(&*known).find(|(end, _)| **end == node);
                let known = known.and_then(|(_, row)| row.get(end));
                *pixels = known
                    .copied()
                    .unwrap_or_else(|| library.overlap(view, other));
            }
        }
        common
    }

    /// The functionals along x and y.
    fn functionals(&self, search: &mut ViewSearch<'_, '_>, reversed: bool) -> [Functional; 2] {
        let common = self.overlaps(search.library());
        // Of an end its own pixels less those that it has not in common with the silhouette, less the silhouette's:
        // twice what both have.
        let mut covered = [0.0; 4];
        for ((covered, row), &end) in covered.iter_mut().zip(&common).zip(&self.ends) {
            let view = self.views.get(end).copied().unwrap_or(0);
            let pixels = row.get(end).copied().unwrap_or(0);
            *covered = f64::from(pixels) - f64::from(search.score(view, reversed));
        }
        let [right, left, below, above] = &common;
        [
            Functional::new(right, left, (covered[0] - covered[1]) / 2.0),
            Functional::new(below, above, (covered[2] - covered[3]) / 2.0),
        ]
    }
}

/// The functional of one grid axis, less its value for the silhouette: a biquadratic polynomial through the 3 x 3 nearest
/// views. All its terms are whole quarters, so they are exact.
struct Functional {
    /// By powers of the steps from the view in the middle: along x, and in each of these along y.
    terms: [[f64; 3]; 3],
}

/// Value of a functional at a place, and its slopes along x and y.
struct Slopes {
    value: f64,
    along: [f64; 2],
}

impl Functional {
    /// From the pixels that the views have in common with that ahead and with that behind. Those set ahead alone minus
    /// those set behind alone: what both have cancels.
    fn new(ahead: &[u32; 9], behind: &[u32; 9], target: f64) -> Self {
        let mut nodes = [[0.0; 3]; 3];
        let pixels = ahead.iter().zip(behind);
        for (node, (&ahead, &behind)) in nodes.as_flattened_mut().iter_mut().zip(pixels) {
            *node = f64::from(ahead) - f64::from(behind) - target;
        }
        let [[a, b, c], [d, e, f], [g, h, i]] = nodes.map(parabola);
        Self {
            terms: [[a, d, g], [b, e, h], [c, f, i]].map(parabola),
        }
    }

    fn at(&self, [x, y]: [f64; 2]) -> Slopes {
        let [constant, linear, square] = self.terms.map(|[a, b, c]| {
            let slope = b + y * c;
            (a + y * slope, slope + y * c)
        });
        let along_x = linear.0 + x * square.0;
        Slopes {
            value: constant.0 + x * along_x,
            along: [
                along_x + x * square.0,
                constant.1 + x * (linear.1 + x * square.1),
            ],
        }
    }
}

/// The terms of the parabola through values at -1, 0 and 1, by rising power.
fn parabola([behind, here, ahead]: [f64; 3]) -> [f64; 3] {
    [here, (ahead - behind) / 2.0, (ahead + behind) / 2.0 - here]
}

/// Steps of Newton's method; it gains digits at every one and starts within a step.
const ITERATIONS: usize = 8;

/// The place between the views, in steps of the grid, at which both functionals agree with the
/// silhouette; `None` where there is none within one step of the candidate's view (a part that
/// looks alike on both sides of a view has no band there).
pub(crate) fn solve(search: &mut ViewSearch<'_, '_>, candidate: &ViewMatch) -> Option<[f64; 2]> {
    let grid = &search.library().info().grid;
    let (x, y) = grid.place(candidate.view);
    let near = Neighbourhood::new(grid, candidate.view)?;
    let functionals = near.functionals(search, candidate.reversed);
    let start = [x as f64 - near.middle[0], y as f64 - near.middle[1]];
    let mut place = start;
    for _ in 0..ITERATIONS {
        let step = newton_step(&functionals, place)?;
        let before = place;
        for ((place, step), start) in place.iter_mut().zip(step).zip(start) {
            *place = (*place - step).max(start - 1.0).min(start + 1.0);
        }
        if place == before {
            // All steps after this one are the same.
            break;
        }
    }
    let inside = place
        .iter()
        .zip(start)
        .all(|(at, start)| (at - start).abs() < 1.0);
    let [x, y] = near.middle;
    inside.then_some([x + place[0], y + place[1]])
}

fn newton_step(functionals: &[Functional; 2], place: [f64; 2]) -> Option<[f64; 2]> {
    let [one, other] = functionals
        .each_ref()
        .map(|functional| functional.at(place));
    let ([a, b], [c, d]) = (one.along, other.along);
    let determinant = a * d - b * c;
    let scale = (a * a + b * b) * (c * c + d * d);
    // Nearly parallel equations say nothing of one direction.
    if determinant * determinant <= 1e-3 * scale {
        return None;
    }
    let (f, g) = (one.value, other.value);
    Some([(f * d - b * g) / determinant, (a * g - c * f) / determinant])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lagrange_reproduces_parabolas() {
        let nodes = 4..7;
        let parabola = |x: f64| 2.0 - 3.0 * x + 0.5 * x * x;
        for x in [4.0, 4.7, 5.5, 6.2] {
            let value: f64 = nodes
                .clone()
                .map(|n| lagrange(&nodes, n, x) * parabola(n as f64))
                .sum();
            assert!((value - parabola(x)).abs() < 1e-12);
        }
    }

    properties! {
        #[test]
        fn a_functional_has_its_nodes_and_slopes(
            ahead in proptest::array::uniform9(0u32..20_000),
            behind in proptest::array::uniform9(0u32..20_000),
            target in -9000i32..9000,
            place in proptest::array::uniform2(-1.0..1.0f64),
        ) {
            let target = f64::from(target) / 2.0;
            let functional = Functional::new(&ahead, &behind, target);
            for node in 0..9 {
                let value = functional.at([(node % 3) as f64 - 1.0, (node / 3) as f64 - 1.0]).value;
                let expected = f64::from(ahead[node]) - f64::from(behind[node]) - target;
                prop_assert_eq!(value, expected);
            }
            let Slopes { along, .. } = functional.at(place);
            for (axis, slope) in along.into_iter().enumerate() {
                // Central differences of a parabola are its slopes.
                let value = |step: f64| {
                    let mut moved = place;
                    moved[axis] += step;
                    functional.at(moved).value
                };
                let difference = value(0.5) - value(-0.5);
                prop_assert!((difference - slope).abs() < 1e-6, "{} {}", difference, slope);
            }
        }
    }

    #[test]
    fn a_window_stays_on_its_axis() {
        assert_eq!(window(0, 9, 2), 0..5);
        assert_eq!(window(4, 9, 2), 2..7);
        assert_eq!(window(8, 9, 2), 4..9);
        assert_eq!(window(1, 3, 2), 0..3);
        assert_eq!(window(0, 1, 1), 0..1);
    }
}
