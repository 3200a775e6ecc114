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
pub(crate) fn lagrange(nodes: &core::ops::Range<isize>, at: isize, x: f64) -> f64 {
    nodes
        .clone()
        .filter(|&other| other != at)
        .map(|other| (x - other as f64) / (at as f64 - other as f64))
        .product()
}

/// The 3 x 3 views around one, row by row.
struct Neighbourhood {
    views: [usize; 9],
    /// The place of the view in the middle; of a grid that goes all around its row may be counted on beyond the ends.
    middle: [f64; 2],
    /// Which of the nine lie ahead of the view along x and behind it, and the same along y.
    ends: [usize; 4],
}

impl Neighbourhood {
    /// `None` where there are fewer views.
    fn new(grid: &ViewGrid, view: usize) -> Option<Self> {
        let (x, y) = grid.place(view);
        let columns = window(x, grid.x.count, 1);
        let rows = grid.rows_about(y as isize, 1);
        if columns.len() < 3 || rows.len() < 3 {
            return None;
        }
        let row = |node: usize| grid.row(rows.start + (node / 3) as isize);
        let at = core::array::from_fn(|node| grid.view(columns.start + node % 3, row(node)));
        let middle = [(columns.start + 1) as f64, (rows.start + 1) as f64];
        let (x, y) = (x - columns.start, 3 * (y as isize - rows.start) as usize);
        Some(Self {
            views: at,
            middle,
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
    use crate::canonical::{CanonicalSpec, reverse};
    use crate::image::mask::{MaskMut, Word};
    use crate::library::ViewAxis;
    use crate::library::fake::{plain_library, spots};
    use crate::search::kernels::Kernels;
    use crate::search::{
        Query, ViewSearchMemory, query_bytes_needed, scores_needed, search_bytes_needed,
    };
    use core::f64::consts::PI;
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

    /// A functional without curvature, of these slopes, that is zero at a place.
    fn plane([along_x, along_y]: [f64; 2], [x, y]: [f64; 2]) -> Functional {
        let constant = -(along_x * x + along_y * y);
        Functional {
            terms: [[constant, along_y, 0.0], [along_x, 0.0, 0.0], [0.0; 3]],
        }
    }

    properties! {
        /// However long the slopes are: what counts is the angle between them.
        #[test]
        fn one_step_solves_two_planes_that_are_not_nearly_parallel(
            start in proptest::array::uniform2(-1.0..1.0f64),
            solution in proptest::array::uniform2(-1.0..1.0f64),
            direction in -PI..PI,
            between in prop_oneof![0.0..0.06f64, 0.06..PI - 0.06, PI - 0.06..PI],
            lengths in proptest::array::uniform2(-7.0..7.0f64),
        ) {
            let slopes = |angle: f64, length: f64| {
                let (sin, cos) = libm::sincos(angle);
                [cos, sin].map(|along| along * libm::exp(length))
            };
            let functionals = [
                plane(slopes(direction, lengths[0]), solution),
                plane(slopes(direction + between, lengths[1]), solution),
            ];
            let sine = libm::sin(between);
            let step = newton_step(&functionals, start);
            // Not where rounding decides.
            if (sine * sine - 1e-3).abs() > 1e-9 {
                prop_assert_eq!(step.is_some(), sine * sine > 1e-3, "{}", between);
            }
            if let Some(step) = step {
                for axis in 0..2 {
                    prop_assert!((start[axis] - step[axis] - solution[axis]).abs() < 1e-9);
                }
            }
        }
    }

    fn grid(columns: usize, rows: usize) -> ViewGrid {
        let axis = |count| ViewAxis {
            first: 0.0,
            step: 1.0,
            count,
        };
        ViewGrid {
            x: axis(columns),
            y: axis(rows),
        }
    }

    #[test]
    fn a_neighbourhood_is_three_by_three_and_its_ends_lie_beside_the_view() {
        let sizes = (1..6).flat_map(|columns| (1..6).map(move |rows| (columns, rows)));
        for (columns, rows) in sizes {
            let grid = grid(columns, rows);
            for view in 0..grid.views() {
                let near = Neighbourhood::new(&grid, view);
                assert_eq!(near.is_some(), columns >= 3 && rows >= 3);
                let Some(near) = near else {
                    continue;
                };
                let (x, y) = grid.place(view);
                let middle = [x.clamp(1, columns - 2), y.clamp(1, rows - 2)];
                assert_eq!(near.middle, middle.map(|at| at as f64));
                let [column, row] = middle;
                for (node, view) in near.views.into_iter().enumerate() {
                    let place = (column + node % 3 - 1, row + node / 3 - 1);
                    assert_eq!(grid.place(view), place);
                }
                let ends = near.ends.map(|end| grid.place(near.views[end]));
                let across = [(column + 1, y), (column - 1, y)];
                assert_eq!(ends, [across[0], across[1], (x, row + 1), (x, row - 1)]);
            }
        }
    }

    const SIZE: usize = 64;

    fn with_search<T>(
        views: &[std::vec::Vec<Word>],
        silhouette: &[Word],
        look: impl FnOnce(&mut ViewSearch<'_, '_>) -> T,
    ) -> T {
        let spec = CanonicalSpec::new(SIZE, 900).expect("possible");
        let bytes = plain_library(views, 4, spec);
        let library = Library::open(&bytes).expect("valid");
        let mut rotated = silhouette.to_vec();
        reverse(silhouette, &mut rotated);
        let mut prepared = std::vec![0; query_bytes_needed(&spec)];
        let query = Query::new(&spec, silhouette, &rotated, &mut prepared).expect("long enough");
        let memory = ViewSearchMemory {
            bounds: &mut std::vec![0; scores_needed(views.len())],
            sketches: &mut std::vec![0; search_bytes_needed(&spec)],
        };
        let search = ViewSearch::new(&library, &query, &Kernels::PORTABLE, memory);
        look(&mut search.expect("long enough"))
    }

    fn common(a: &[Word], b: &[Word]) -> f64 {
        let both = a.iter().zip(b).map(|(a, b)| (a & b).count_ones());
        f64::from(both.sum::<u32>())
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Of what is set ahead alone and of what is set behind alone, a view's pixels less the silhouette's, one by one.
        #[test]
        fn functionals_count_the_pixels_of_the_bands(
            views in proptest::collection::vec(spots(SIZE), 16),
            silhouette in spots(SIZE),
            view in 0..16usize,
        ) {
            let mut rotated = silhouette.clone();
            reverse(&silhouette, &mut rotated);
            let near = Neighbourhood::new(&grid(4, 4), view).expect("large enough");
            let found = with_search(&views, &silhouette, |search| {
                [false, true].map(|reversed| near.functionals(search, reversed))
            });
            for (functionals, silhouette) in found.iter().zip([&silhouette, &rotated]) {
                for (axis, functional) in functionals.iter().enumerate() {
                    let [ahead, behind] = [0, 1].map(|end| &views[near.views[near.ends[2 * axis + end]]]);
                    for (node, &view) in near.views.iter().enumerate() {
                        let band = |own: &[Word]| common(ahead, own) - common(behind, own);
                        let place = [(node % 3) as f64 - 1.0, (node / 3) as f64 - 1.0];
                        prop_assert_eq!(functional.at(place).value, band(&views[view]) - band(silhouette));
                    }
                }
            }
        }

        #[test]
        fn a_view_lies_at_its_own_place(
            views in proptest::collection::vec(spots(SIZE), 16),
            view in 0..16usize,
        ) {
            let (x, y) = grid(4, 4).place(view);
            let candidate = ViewMatch { view, reversed: false, unmatched: 0 };
            let own = with_search(&views, &views[view], |search| solve(search, &candidate));
            // `None` where views around it are alike.
            prop_assert!(own.is_none_or(|place| place == [x as f64, y as f64]), "{:?}", own);
        }
    }

    /// A rectangle that lies this many pixels to the right and down.
    fn rectangle([right, down]: [usize; 2]) -> std::vec::Vec<Word> {
        let mut words = std::vec![0; SIZE * SIZE / 32];
        let mut mask = MaskMut::new(&mut words, SIZE, SIZE).expect("fits");
        for row in down..down + 30 {
            mask.fill_span(row, right as i64, right as i64 + 24);
        }
        words
    }

    /// Its bands are as wide as it moved, so that nothing is lost to rounding.
    #[test]
    fn what_lies_half_way_between_two_views_is_found_there() {
        let views: std::vec::Vec<_> = (0..16)
            .map(|view| rectangle([8 + 4 * (view % 4), 6 + 4 * (view / 4)]))
            .collect();
        let mut found = 0;
        for (view, axis) in (0..16).flat_map(|view| [(view, 0), (view, 1)]) {
            let at = [view % 4, view / 4];
            // Beside the axis along which it moves it lies in the middle of three.
            if !(1..=2).contains(&at[1 - axis]) {
                continue;
            }
            for ahead in [false, true] {
                if at[axis] == if ahead { 3 } else { 0 } {
                    continue;
                }
                let mut place = [8 + 4 * at[0], 6 + 4 * at[1]];
                let mut expected = at.map(|at| at as f64);
                if ahead {
                    place[axis] += 2;
                    expected[axis] += 0.5;
                } else {
                    place[axis] -= 2;
                    expected[axis] -= 0.5;
                }
                let candidate = ViewMatch {
                    view,
                    reversed: false,
                    unmatched: 0,
                };
                let solved = with_search(&views, &rectangle(place), |search| {
                    solve(search, &candidate)
                });
                let solved = solved.expect("there is one");
                for k in 0..2 {
                    assert!((solved[k] - expected[k]).abs() < 1e-9, "{solved:?} {at:?}");
                }
                found += 1;
            }
        }
        assert_eq!(found, 24);
    }
}
