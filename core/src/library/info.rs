//! What a library is of: its grid of views, its camera, and what is kept of each view.

use core::ops::Range;

use crate::camera::Camera;
use crate::canonical::CanonicalSpec;
use crate::math::{Vector3, round, within};
use crate::mesh::ModelDigest;

/// One axis of the grid of views: `first`, `first + step`, ... degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewAxis {
    /// First rotation, degrees.
    pub first: f64,
    /// Step between neighbours, degrees; positive.
    pub step: f64,
    /// Number of rotations.
    pub count: usize,
}

impl ViewAxis {
    /// The rotation at a place on the axis, degrees; between whole places too.
    #[must_use]
    pub fn at(&self, place: f64) -> f64 {
        self.first + place * self.step
    }

    /// The axis moved by `degrees`.
    #[must_use]
    pub fn shifted(self, degrees: f64) -> Self {
        Self {
            first: self.first + degrees,
            ..self
        }
    }
}

/// The grid of views: rotations about x and about y, `R = Rz Rx Ry`. View number
/// `y * x_axis.count + x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewGrid {
    /// Rotations about x.
    pub x: ViewAxis,
    /// Rotations about y.
    pub y: ViewAxis,
}

impl Default for ViewGrid {
    /// The 31 x 41 = 1271 views of Walker et al. 1996: x from -15 to 15, y from -20 to 20 degrees, one degree apart.
    fn default() -> Self {
        let axis = |reach: i32| ViewAxis {
            first: f64::from(-reach),
            step: 1.0,
            count: 2 * reach as usize + 1,
        };
        Self {
            x: axis(15),
            y: axis(20),
        }
    }
}

impl ViewGrid {
    /// Views from all sides, `step_deg` degrees apart: x from one pole to the other, y all around. `step_deg` is brought
    /// to a whole part of 180 degrees, from 1 to 15. Towards the poles, where x is near 90 or -90 degrees, views lie closer
    /// than they need to.
    #[must_use]
    pub fn sphere(step_deg: f64) -> Self {
        let count = round(180.0 / within(step_deg, 1.0, 15.0));
        let step = 180.0 / count;
        Self {
            x: ViewAxis {
                first: step / 2.0 - 90.0,
                step,
                count: count as usize,
            },
            y: ViewAxis {
                first: -180.0,
                step,
                count: 2 * count as usize,
            },
        }
    }

    /// Views from all sides as fine as refinement needs its starts: 2.5 degrees apart, for canonical frames of
    /// [`CanonicalSpec::COARSE`].
    #[must_use]
    pub fn everywhere() -> Self {
        Self::sphere(2.5)
    }

    /// Whether rotations about y go all around, so that the last are neighbours of the first.
    #[must_use]
    pub fn is_around(&self) -> bool {
        let reach = self.y.step * self.y.count as f64;
        (reach - 360.0).abs() < 0.5 * self.y.step
    }

    /// Whether views are missing beside one: it lies at an end of an axis that has several, and does not go all around there.
    pub(crate) fn is_at_border(&self, view: usize) -> bool {
        let (x, y) = self.place(view);
        let at_end =
            |at: usize, axis: &ViewAxis| axis.count > 1 && (at == 0 || at + 1 == axis.count);
        // Beyond a pole lie views from the other side.
        let is_pole = || self.is_around() && self.x.at(x as f64).abs() + self.x.step > 90.0;
        at_end(x, &self.x) && !is_pole() || at_end(y, &self.y) && !self.is_around()
    }

    /// The rows about one, `reach` to either side: fewer where there are not so many, and at the ends as many to one side. Of a grid that goes all
    /// around they are counted on beyond its ends ([`Self::row`]).
    pub(crate) fn rows_about(&self, y: isize, reach: usize) -> Range<isize> {
        let (length, count) = (2 * reach + 1, self.y.count);
        if length <= count && self.is_around() {
            return y - reach as isize..y + reach as isize + 1;
        }
        let length = length.min(count) as isize;
        let first = (y - reach as isize).clamp(0, count as isize - length);
        first..first + length
    }

    /// The row that is meant by a number of [`Self::rows_about`].
    pub(crate) fn row(&self, number: isize) -> usize {
        number
            .checked_rem_euclid(self.y.count as isize)
            .unwrap_or(0) as usize
    }

    /// Number of views.
    #[must_use]
    pub fn views(&self) -> usize {
        self.x.count * self.y.count
    }

    /// Place of a view on both axes.
    #[must_use]
    pub fn place(&self, view: usize) -> (usize, usize) {
        let columns = self.x.count;
        let (x, y) = (view.checked_rem(columns), view.checked_div(columns));
        (x.unwrap_or(0), y.unwrap_or(0))
    }

    /// Rotations of a view about x and y, degrees.
    #[must_use]
    pub fn rotations(&self, view: usize) -> [f64; 2] {
        let (x, y) = self.place(view);
        [self.x.at(x as f64), self.y.at(y as f64)]
    }

    /// The view at a place on both axes.
    #[must_use]
    pub fn view(&self, x: usize, y: usize) -> usize {
        y * self.x.count + x
    }
}

/// What a library was made from and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LibraryInfo {
    /// Canonical frame of every view.
    pub canonical: CanonicalSpec,
    /// Rotations of the views, degrees.
    pub grid: ViewGrid,
    /// Distance from the focus to the reference point in every view, mm.
    pub distance: f64,
    /// The point of the model that stands on the optical axis in every view, model
    /// coordinates, mm: the middle of its bounding box.
    pub reference: Vector3,
    /// Focal length of the views before canonical form, pixels.
    pub focal: f64,
    /// The camera that the library was made for. Poses from another one remain right; the
    /// perspective of the views is then that of [`Self::distance`] all the same.
    pub camera: Camera,
    /// Digest of the model, by which a library recognises it ([`crate::mesh::Mesh::digest`]).
    pub model: ModelDigest,
}

/// One view's record: what was taken away to reach canonical form, in pixels of a camera of
/// focal length [`LibraryInfo::focal`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewRecord {
    /// Rotation about x, degrees.
    pub x_deg: f64,
    /// Rotation about y, degrees.
    pub y_deg: f64,
    /// Canonical pixels per view pixel.
    pub scale: f64,
    /// Direction of the principal axis, radians, y up.
    pub angle: f64,
    /// From the projected reference point to the centroid, pixels to the right and upwards.
    pub offset: [f64; 2],
    /// Area of the silhouette before canonical form, pixels.
    pub area: u32,
    /// See [`crate::canonical::CanonicalForm::elongation`].
    pub elongation: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(step: f64, count: usize) -> ViewGrid {
        let y = ViewAxis {
            first: -180.0,
            step,
            count,
        };
        ViewGrid { x: y, y }
    }

    #[test]
    fn a_grid_goes_all_around_where_its_last_views_are_a_step_from_the_first() {
        for (step, count, around) in [
            (10.0, 36, true),
            (10.0, 35, false),
            (10.0, 37, false),
            // As good as a step: to less than half of one.
            (10.13, 36, true),
            (10.15, 36, false),
            (9.87, 36, true),
            (9.85, 36, false),
            (1.0, 41, false),
            (360.0, 1, true),
        ] {
            assert_eq!(grid(step, count).is_around(), around, "{step} {count}");
        }
        assert!(!ViewGrid::default().is_around());
        assert!(ViewGrid::everywhere().is_around());
    }

    /// Of all sides none lies at a border; all around a window about x one does at the ends of that alone.
    #[test]
    fn views_are_missing_beyond_the_ends_of_what_does_not_go_all_around() {
        let borders = |grid: ViewGrid| -> std::vec::Vec<(usize, usize)> {
            let views = (0..grid.views()).filter(|&view| grid.is_at_border(view));
            views.map(|view| grid.place(view)).collect()
        };
        for step_deg in [2.5, 7.0, 15.0] {
            assert!(borders(ViewGrid::sphere(step_deg)).is_empty());
        }
        let x = ViewAxis {
            first: -2.0,
            step: 2.0,
            count: 3,
        };
        let belt = ViewGrid {
            x,
            ..ViewGrid::sphere(15.0)
        };
        assert!(borders(belt).iter().all(|&(x, _)| x != 1));
        assert_eq!(borders(belt).len(), 2 * belt.y.count);
        let window = ViewGrid { x, y: x };
        assert_eq!(borders(window).len(), 8);
        let line = ViewGrid {
            y: ViewAxis { count: 1, ..x },
            ..window
        };
        assert_eq!(borders(line), [(0, 0), (2, 0)]);
    }

    #[test]
    fn rows_about_one_go_on_where_the_grid_does() {
        let around = ViewGrid::sphere(15.0);
        let rows = |grid: &ViewGrid, y: isize| -> std::vec::Vec<usize> {
            grid.rows_about(y, 1).map(|row| grid.row(row)).collect()
        };
        assert_eq!(rows(&around, 0), [23, 0, 1]);
        assert_eq!(rows(&around, 23), [22, 23, 0]);
        assert_eq!(rows(&around, -1), [22, 23, 0]);
        let window = ViewGrid::default();
        assert_eq!(rows(&window, 0), [0, 1, 2]);
        assert_eq!(rows(&window, 40), [38, 39, 40]);
        let few = ViewGrid {
            y: ViewAxis {
                step: 180.0,
                count: 2,
                ..around.y
            },
            ..around
        };
        assert_eq!(rows(&few, 1), [0, 1]);
    }

    #[test]
    fn a_sphere_has_views_from_all_sides_in_whole_parts_of_half_a_turn() {
        for (wanted, step, columns) in [
            (0.2, 1.0, 180),
            (2.5, 2.5, 72),
            (7.0, 180.0 / 26.0, 26),
            (15.0, 15.0, 12),
            (90.0, 15.0, 12),
        ] {
            let grid = ViewGrid::sphere(wanted);
            assert_eq!((grid.x.step, grid.y.step), (step, step), "{wanted}");
            assert_eq!((grid.x.count, grid.y.count), (columns, 2 * columns));
            // Half a step from pole to pole, and a step from the last to the first.
            let last = |axis: &ViewAxis| axis.at((axis.count - 1) as f64);
            assert!((grid.x.first + 90.0 - step / 2.0).abs() < 1e-9);
            assert!((last(&grid.x) - 90.0 + step / 2.0).abs() < 1e-9);
            assert!((last(&grid.y) + step - grid.y.first - 360.0).abs() < 1e-9);
            assert!(grid.is_around());
        }
    }

    #[test]
    fn each_view_has_its_place_and_rotations() {
        let mut grid = grid(2.0, 4);
        grid.x = ViewAxis {
            first: -3.0,
            step: 1.5,
            count: 3,
        };
        assert_eq!(grid.views(), 12);
        let places = (0..4).flat_map(|y| (0..3).map(move |x| (x, y)));
        for (view, (x, y)) in places.enumerate() {
            assert_eq!((grid.view(x, y), grid.place(view)), (view, (x, y)));
            let rotations = [1.5 * x as f64 - 3.0, 2.0 * y as f64 - 180.0];
            assert_eq!(grid.rotations(view), rotations);
        }
        assert_eq!(grid.y.shifted(7.0).at(0.5), -172.0);
    }
}
