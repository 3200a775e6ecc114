//! Sub-degree rotation from the bands that the outline sweeps between neighbouring views.
//!
//! Where the neighbour one step ahead is set and the one behind is not, or conversely,
//! lies the band that the outline sweeps as the object turns. How many pixels of that band a
//! silhouette covers, counted positive in the one part and negative in the other, is a linear
//! functional of the silhouette that grows smoothly with the rotation: unlike the number of
//! unmatched pixels it has no kink at the best view. The functional is evaluated for the 3 x 3
//! nearest views, interpolated between them, and set equal to its value for the silhouette; one
//! equation for each axis of the grid.

use crate::image::mask::Word;
use crate::library::Library;

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

/// The functional of one grid axis: its value for the 3 x 3 nearest views and the silhouette.
struct Functional {
    nodes: [[f64; 3]; 3],
    target: f64,
}

/// The nearest views on both axes.
struct Neighbourhood {
    x: core::ops::Range<usize>,
    y: core::ops::Range<usize>,
}

impl Neighbourhood {
    fn functional(
        &self,
        library: &Library<'_>,
        canonical: &[Word],
        ahead: usize,
        behind: usize,
    ) -> Functional {
        let grid = &library.info().grid;
        // Pixels set ahead alone minus pixels set behind alone: what both have cancels.
        let covered =
            |pixels: &dyn Fn(usize) -> u32| f64::from(pixels(ahead)) - f64::from(pixels(behind));
        let mut nodes = [[0.0; 3]; 3];
        for (v, row) in self.y.clone().zip(&mut nodes) {
            for (u, node) in self.x.clone().zip(row) {
                let view = grid.view(u, v);
                *node = covered(&|end| library.overlap(view, end));
            }
        }
        Functional {
            nodes,
            target: covered(&|end| library.covered(end, canonical)),
        }
    }

    /// How much each node weighs at a place, biquadratic.
    fn weights(&self, [x, y]: [f64; 2]) -> Weights {
        let [columns, rows] = [(&self.x, x), (&self.y, y)].map(|(nodes, at)| {
            core::array::from_fn::<f64, 3, _>(|k| lagrange(nodes, nodes.start + k, at))
        });
        rows.map(|row| columns.map(|column| row * column))
    }
}

type Weights = [[f64; 3]; 3];

impl Functional {
    /// Interpolated value minus target.
    fn residual(&self, weights: &Weights) -> f64 {
        let all = weights.as_flattened().iter().zip(self.nodes.as_flattened());
        all.fold(-self.target, |value, (weight, node)| value + weight * node)
    }
}

/// Steps of Newton's method; it gains digits at every one and starts within a step.
const ITERATIONS: usize = 8;
/// Half width of the central difference, in steps of the grid.
const DIFFERENCE: f64 = 1e-3;

/// The place between the views, in steps of the grid, at which both functionals agree with the
/// silhouette; `None` where there is none within one step of the view at `start` (a part that
/// looks alike on both sides of a view has no band there).
pub(crate) fn solve(
    library: &Library<'_>,
    canonical: &[Word],
    start: (usize, usize),
) -> Option<[f64; 2]> {
    let grid = &library.info().grid;
    let near = Neighbourhood {
        x: window(start.0, grid.x.count, 1),
        y: window(start.1, grid.y.count, 1),
    };
    if near.x.len() < 3 || near.y.len() < 3 {
        return None;
    }
    let along = |u: usize, v: usize| grid.view(u, v);
    let (left, right) = (near.x.start, near.x.end - 1);
    let (above, below) = (near.y.start, near.y.end - 1);
    let functionals = [
        near.functional(
            library,
            canonical,
            along(right, start.1),
            along(left, start.1),
        ),
        near.functional(
            library,
            canonical,
            along(start.0, below),
            along(start.0, above),
        ),
    ];
    let origin = [start.0 as f64, start.1 as f64];
    let mut place = origin;
    for _ in 0..ITERATIONS {
        let step = newton_step(&near, &functionals, place)?;
        let before = place;
        for ((place, step), origin) in place.iter_mut().zip(step).zip(origin) {
            *place = (*place - step).max(origin - 1.0).min(origin + 1.0);
        }
        if place == before {
            // All steps after this one are the same.
            break;
        }
    }
    let moved = [place[0] - origin[0], place[1] - origin[1]];
    moved.iter().all(|m| m.abs() < 1.0).then_some(place)
}

fn newton_step(
    near: &Neighbourhood,
    functionals: &[Functional; 2],
    [x, y]: [f64; 2],
) -> Option<[f64; 2]> {
    let h = DIFFERENCE;
    let places = [[x, y], [x + h, y], [x - h, y], [x, y + h], [x, y - h]];
    let [here, right, left, below, above] = places.map(|place| {
        let weights = near.weights(place);
        functionals.each_ref().map(|one| one.residual(&weights))
    });
    let slopes = |ahead: [f64; 2], behind: [f64; 2]| {
        [
            (ahead[0] - behind[0]) / (2.0 * h),
            (ahead[1] - behind[1]) / (2.0 * h),
        ]
    };
    let ([f, g], [a, c], [b, d]) = (here, slopes(right, left), slopes(below, above));
    let determinant = a * d - b * c;
    let scale = (a * a + b * b) * (c * c + d * d);
    // Nearly parallel equations say nothing of one direction.
    if determinant * determinant <= 1e-3 * scale {
        return None;
    }
    Some([(f * d - b * g) / determinant, (a * g - c * f) / determinant])
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn a_window_stays_on_its_axis() {
        assert_eq!(window(0, 9, 2), 0..5);
        assert_eq!(window(4, 9, 2), 2..7);
        assert_eq!(window(8, 9, 2), 4..9);
        assert_eq!(window(1, 3, 2), 0..3);
        assert_eq!(window(0, 1, 1), 0..1);
    }
}
