//! Between the views: sub-degree rotation from the score surface, and the view's record there.

use crate::library::{Library, ViewGrid, ViewRecord};
use crate::locate::bands::{self, lagrange, window};
use crate::math::{floor, solve_spd, within, wrap};
use crate::search::ViewMatch;
use crate::search::ViewSearch;

/// A view between the views of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FineView {
    /// The record there: rotations, scale, angle, offset.
    pub record: ViewRecord,
    /// Whether the silhouette fits when rotated by 180 degrees.
    pub reversed: bool,
    /// Unmatched pixels of the nearest view of the grid.
    pub unmatched: u32,
    /// Whether the best fit is at the border of the grid: the true rotation may lie beyond it,
    /// and a library about another nominal view should be tried.
    pub at_border: bool,
}

/// Half width of the neighbourhood that the quadratic is fitted to, in views. Wider ones were
/// worse: the score is no quadratic that far from its minimum.
const REACH: usize = 2;

/// Finds the rotation between the views around `candidate` and reads scale, angle and offset
/// there.
///
/// The rotation comes from the bands that the outline sweeps between neighbouring views
/// (see `bands.rs`). Where those say nothing, near a view about which the part is symmetric, it
/// is the minimum of a quadratic fitted to the scores.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn interpolate(search: &mut ViewSearch<'_, '_>, candidate: &ViewMatch) -> FineView {
    let library = search.library();
    let grid = &library.info().grid;
    let (x, y) = grid.place(candidate.view);
    let [fine_x, fine_y] = bands::solve(search, candidate).unwrap_or_else(|| {
        let score = |view| search.score(view, candidate.reversed);
        let (dx, dy) = fit_minimum(grid, score, x, y);
        [x as f64 + dx, y as f64 + dy]
    });
    let last = |count: usize| count.saturating_sub(1) as f64;
    let place = [
        within(fine_x, 0.0, last(grid.x.count)),
        match grid.is_around() {
            true => fine_y,
            false => within(fine_y, 0.0, last(grid.y.count)),
        },
    ];
    FineView {
        record: record_at(library, place),
        reversed: candidate.reversed,
        unmatched: candidate.unmatched,
        at_border: grid.is_at_border(candidate.view),
    }
}

/// Offset in steps from the view at (x, y) to the minimum of the fitted quadratic; (0, 0) where
/// the surface has none near.
fn fit_minimum(
    grid: &ViewGrid,
    mut score: impl FnMut(usize) -> u32,
    x: usize,
    y: usize,
) -> (f64, f64) {
    let mut normal = [[0.0; 6]; 6];
    let mut right = [0.0; 6];
    for v in grid.rows_about(y as isize, REACH) {
        for u in window(x, grid.x.count, REACH) {
            let (a, b) = (u as f64 - x as f64, v as f64 - y as f64);
            let terms = [1.0, a, b, a * a, a * b, b * b];
            let value = f64::from(score(grid.view(u, grid.row(v))));
            for (row, &term) in terms.iter().enumerate() {
                right[row] += term * value;
                for (column, &other) in terms.iter().enumerate() {
                    normal[row][column] += term * other;
                }
            }
        }
    }
    solve_spd(normal, right)
        .and_then(|fit| minimum_of(&fit))
        .filter(|(dx, dy)| dx.abs() <= 1.0 && dy.abs() <= 1.0)
        .unwrap_or((0.0, 0.0))
}

/// Minimum of `c0 + c1 a + c2 b + c3 a^2 + c4 a b + c5 b^2`, where it has one.
fn minimum_of(c: &[f64; 6]) -> Option<(f64, f64)> {
    let [a, b] = solve_spd([[2.0 * c[3], c[4]], [c[4], 2.0 * c[5]]], [-c[1], -c[2]])?;
    Some((a, b))
}

/// The record between the views, by biquadratic interpolation over the 3 x 3 nearest.
///
/// Axis angles are unwrapped towards the nearest view's first: an axis has a period of pi. Where the grid goes all around, so do its rows.
fn record_at(library: &Library<'_>, place: [f64; 2]) -> ViewRecord {
    let grid = &library.info().grid;
    let (column, row) = ((place[0] + 0.5) as usize, floor(place[1] + 0.5) as isize);
    let centre = library.record(grid.view(column, grid.row(row)));
    let columns = window(column, grid.x.count, 1);
    let nodes = columns.start as isize..columns.end as isize;
    let rows = grid.rows_about(row, 1);
    // Within the grid, from wherever it was counted on.
    let rounds = match grid.is_around() {
        true => floor(place[1] / grid.y.count as f64),
        false => 0.0,
    };
    let mut mean = ViewRecord {
        x_deg: grid.x.at(place[0]),
        y_deg: grid.y.at(place[1] - rounds * grid.y.count as f64),
        angle: centre.angle,
        area: centre.area,
        elongation: centre.elongation,
        ..ViewRecord::default()
    };
    for v in rows.clone() {
        let down = lagrange(&rows, v, place[1]);
        for u in columns.clone() {
            let record = library.record(grid.view(u, grid.row(v)));
            let weight = lagrange(&nodes, u as isize, place[0]) * down;
            mean.scale += weight * record.scale;
            mean.angle += weight * wrap(record.angle - centre.angle, core::f64::consts::PI);
            mean.offset[0] += weight * record.offset[0];
            mean.offset[1] += weight * record.offset[1];
        }
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::CanonicalSpec;
    use crate::library::ViewAxis;
    use crate::library::fake::{plain_library_of, plain_library_on, spots};
    use crate::search::kernels::Kernels;
    use crate::search::{
        Query, ViewSearchMemory, query_bytes_needed, scores_needed, search_bytes_needed,
    };
    use proptest::prelude::*;

    #[test]
    fn the_minimum_of_a_bowl_is_found_between_the_views() {
        let axis = |count| ViewAxis {
            first: -3.0,
            step: 1.0,
            count,
        };
        let grid = ViewGrid {
            x: axis(7),
            y: axis(9),
        };
        for (mx, my) in [(3.3, 4.2), (2.6, 4.45), (3.0, 3.9)] {
            let mut surface = [0u32; 63];
            for (view, score) in surface.iter_mut().enumerate() {
                let (x, y) = grid.place(view);
                let (a, b) = (x as f64 - mx, y as f64 - my);
                *score = (80.0 + 300.0 * a * a + 90.0 * a * b + 150.0 * b * b) as u32;
            }
            let (x, y) = (libm::round(mx), libm::round(my));
            let (dx, dy) = fit_minimum(&grid, |view| surface[view], x as usize, y as usize);
            assert!((x + dx - mx).abs() < 0.02, "{mx}: {}", x + dx);
            assert!((y + dy - my).abs() < 0.02, "{my}: {}", y + dy);
        }
    }

    /// Scale, angle and offset as polynomials of the place that three by three views tell.
    fn record(x: f64, y: f64) -> ViewRecord {
        let angle = 1.2 + 0.21 * x - 0.13 * y + 0.02 * x * y + 0.01 * x * x;
        ViewRecord {
            scale: 1.0 + 0.05 * x * x - 0.02 * x * y * y + 0.03 * x * x * y * y,
            // An axis has a period of half a turn, so that records of neighbours may seem far apart.
            angle: wrap(angle, core::f64::consts::PI),
            offset: [3.0 * x - y * y, 0.5 - x * x + 0.25 * x * y],
            ..ViewRecord::default()
        }
    }

    #[test]
    fn a_record_between_the_views_is_that_of_their_polynomials() {
        let spec = CanonicalSpec::new(64, 900).expect("possible");
        let views = std::vec![std::vec![1; spec.words_needed()]; 20];
        let own = |x: usize, y: usize| record(x as f64, y as f64);
        let bytes = plain_library_of(&views, 5, spec, own);
        let library = Library::open(&bytes).expect("valid");
        let jumps = (0..4).filter(|&x| (own(x, 0).angle - own(x + 1, 0).angle).abs() > 1.0);
        assert_eq!(jumps.count(), 1, "the angle wraps within the grid");
        let places = (0..=40).flat_map(|x| (0..=30).map(move |y| [x, y]));
        for place in places.map(|place| place.map(|at| f64::from(at) / 10.0)) {
            let (found, expected) = (record_at(&library, place), record(place[0], place[1]));
            assert!((found.scale - expected.scale).abs() < 1e-9, "{place:?}");
            let off = wrap(found.angle - expected.angle, core::f64::consts::PI);
            assert!(off.abs() < 1e-9, "{place:?}: {off}");
            for k in 0..2 {
                assert!((found.offset[k] - expected.offset[k]).abs() < 1e-9);
            }
            let rotations = [found.x_deg, found.y_deg];
            assert_eq!(rotations, place.map(|at| at - 2.0));
            // Of the nearest view.
            let [x, y] = place.map(|at| (at + 0.5) as u32);
            assert_eq!(found.area, 1 + 5 * y + x);
        }
    }

    /// Rows of four views each, 45 degrees apart, all around.
    const ROWS: usize = 8;

    /// What is between the views of a library that begins with a row of `views`, about a view of that row.
    fn fine_from(
        first: usize,
        views: &[std::vec::Vec<u32>],
        silhouette: &[u32],
        candidate: (usize, usize),
    ) -> FineView {
        let spec = CanonicalSpec::new(64, 900).expect("possible");
        let axis = |first, step, count| ViewAxis { first, step, count };
        let grid = ViewGrid {
            x: axis(-3.0, 2.0, 4),
            y: axis(-180.0, 45.0, ROWS),
        };
        let turned: std::vec::Vec<_> = (0..4 * ROWS)
            .map(|view| views[(view + 4 * first) % views.len()].clone())
            .collect();
        let record = |x: usize, y: usize| {
            let [x, y] = [x, (y + first) % ROWS].map(|at| at as f64);
            ViewRecord {
                scale: 1.0 + 0.1 * x + 0.03 * y * y,
                angle: wrap(0.7 * y + 0.2 * x, core::f64::consts::PI),
                offset: [x * y, 3.0 - y],
                ..ViewRecord::default()
            }
        };
        let bytes = plain_library_on(&turned, grid, spec, record);
        let library = Library::open(&bytes).expect("valid");
        let mut rotated = silhouette.to_vec();
        crate::canonical::reverse(silhouette, &mut rotated);
        let mut prepared = std::vec![0; query_bytes_needed(&spec)];
        let query = Query::new(&spec, silhouette, &rotated, &mut prepared).expect("long enough");
        let memory = ViewSearchMemory {
            bounds: &mut std::vec![0; scores_needed(turned.len())],
            sketches: &mut std::vec![0; search_bytes_needed(&spec)],
        };
        let mut search =
            ViewSearch::new(&library, &query, &Kernels::PORTABLE, memory).expect("long enough");
        let (x, y) = candidate;
        let view = grid.view(x, (y + ROWS - first) % ROWS);
        interpolate(
            &mut search,
            &ViewMatch {
                view,
                reversed: false,
                unmatched: 0,
            },
        )
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        /// The model turned about its own y by some rows of views: what is between them is the same, wherever the library begins.
        #[test]
        fn where_a_library_of_all_sides_begins_does_not_matter(
            views in proptest::collection::vec(spots(64), 4 * ROWS), silhouette in spots(64),
            first in 1..ROWS, x in 0..4usize, y in 0..ROWS,
        ) {
            let [one, other] = [0, first].map(|first| fine_from(first, &views, &silhouette, (x, y)));
            prop_assert_eq!(one.at_border, other.at_border);
            let (one, other) = (one.record, other.record);
            let turned = one.y_deg - other.y_deg - 45.0 * first as f64;
            prop_assert!(wrap(turned, 360.0).abs() < 1e-6, "{} {}", one.y_deg, other.y_deg);
            prop_assert!((-180.0..180.0).contains(&other.y_deg));
            prop_assert!((one.x_deg - other.x_deg).abs() < 1e-6 && (one.scale - other.scale).abs() < 1e-6);
            prop_assert!(wrap(one.angle - other.angle, core::f64::consts::PI).abs() < 1e-6);
            prop_assert!((0..2).all(|k| (one.offset[k] - other.offset[k]).abs() < 1e-6));
        }
    }

    #[test]
    fn a_surface_without_a_minimum_near_leaves_the_view_as_it_is() {
        let axis = |count| ViewAxis {
            first: 0.0,
            step: 1.0,
            count,
        };
        let grid = ViewGrid {
            x: axis(7),
            y: axis(9),
        };
        type Surface = fn(f64, f64) -> f64;
        let surfaces: [(Surface, (f64, f64)); 5] = [
            (|_, _| 50.0, (0.0, 0.0)),
            (|a, b| 900.0 + 40.0 * a * a - 30.0 * b * b, (0.0, 0.0)),
            (|a, b| 900.0 + 100.0 * a + 10.0 * b, (0.0, 0.0)),
            // Just within a step, and beyond.
            (
                |a, b| 20.0 * (a - 1.0) * (a - 1.0) + 20.0 * b * b,
                (1.0, 0.0),
            ),
            (
                |a, b| 20.0 * (a - 1.5) * (a - 1.5) + 20.0 * b * b,
                (0.0, 0.0),
            ),
        ];
        for (surface, (dx, dy)) in surfaces {
            // In the middle, and where the views around lie to one side.
            for (x, y) in [(3, 4), (1, 7)] {
                let score = |view: usize| {
                    let (u, v) = grid.place(view);
                    surface(u as f64 - x as f64, v as f64 - y as f64) as u32
                };
                let (found_x, found_y) = fit_minimum(&grid, score, x, y);
                // The minimum itself may lie by rounding beyond the step.
                let found = [found_x, found_y];
                let near = |to: [f64; 2]| (0..2).all(|k| (found[k] - to[k]).abs() < 1e-6);
                assert!(near([dx, dy]) || dx == 1.0 && near([0.0; 2]), "{found:?}");
            }
        }
    }
}
