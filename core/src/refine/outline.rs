//! The model's occluding contour as drawn: border pixels, their normals, and the depth of the
//! surface behind them.
//!
//! Works on what was drawn, not on edges of the mesh, so holes and mixed winding do not matter.
//! At the occluding contour the front and the back of the surface meet; the depth taken is the
//! middle of all that covers the border pixel.

use crate::mask::{Mask, WORD_BITS, Word};
use crate::math::{dot, sqrt};
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::raster::{Projected, for_each_span};
use crate::scan::pixel_box;
use core::ops::Range;

/// A sample of the model's outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BorderPixel {
    pub(super) column: u16,
    pub(super) row: u16,
    /// Outward unit normal: to the right and downwards.
    pub(super) normal: [f32; 2],
    /// Arc length of the outline in this pixel, pixels.
    pub(super) weight: f32,
    /// Least and greatest distance of the surface from the camera plane, mm.
    near: f32,
    far: f32,
    /// How far the target's outline is beyond the model's, pixels; NaN where it was not found.
    pub(super) residual: f32,
    /// How fast the outline moves along the normal with each parameter of a step.
    pub(super) jacobian: [f32; 6],
}

impl BorderPixel {
    /// Continuous image coordinates of the pixel's centre.
    pub(super) fn place(&self) -> [f64; 2] {
        [f64::from(self.column) + 0.5, f64::from(self.row) + 0.5]
    }

    /// Whether a triangle covers the pixel, so that the depth behind it is known.
    pub(super) fn is_on_surface(&self) -> bool {
        self.far > 0.0
    }

    /// Distance of the contour from the camera plane, mm.
    pub(super) fn depth(&self) -> f64 {
        f64::from(self.near + self.far) / 2.0
    }
}

/// A model as drawn at a pose.
pub(super) struct Outliner<'a> {
    pub(super) mesh: &'a Mesh<'a>,
    pub(super) pose: &'a Pose,
    pub(super) drawn: &'a Mask<'a>,
}

impl Outliner<'_> {
    /// Fills `border` with as many border pixels as it holds and gives them. `places` has a
    /// number for each pixel of the frame, all zero before and after.
    pub(super) fn border<'b>(
        &self,
        projected: &[Projected],
        places: &mut [u16],
        border: &'b mut [BorderPixel],
    ) -> &'b mut [BorderPixel] {
        let count = self.find(places, border);
        let tiles = Tiles::of(border.get(..count).unwrap_or_default());
        self.measure_depth(projected, &tiles, places, border);
        let border = border.get_mut(..count).unwrap_or_default();
        let width = self.drawn.width();
        for pixel in &*border {
            places[usize::from(pixel.row) * width + usize::from(pixel.column)] = 0;
        }
        border
    }

    /// Lists border pixels and writes their number, from 1, to their places.
    fn find(&self, places: &mut [u16], border: &mut [BorderPixel]) -> usize {
        let width = self.drawn.width();
        let room = border.len().min(usize::from(u16::MAX));
        let mut count = 0;
        // The frame's own border is no border of the model: what is cut off is not known.
        for row in 1..self.drawn.height().saturating_sub(1) {
            for column in border_columns(self.drawn, row) {
                if column == 0 || column + 1 >= width || count == room {
                    continue;
                }
                let Some(pixel) = sample_at(self.drawn, column, row) else {
                    continue;
                };
                border[count] = pixel;
                count += 1;
                places[row * width + column] = count as u16;
            }
        }
        count
    }

    fn measure_depth(
        &self,
        projected: &[Projected],
        tiles: &Tiles,
        places: &[u16],
        border: &mut [BorderPixel],
    ) {
        let (width, height) = (self.drawn.width(), self.drawn.height());
        let wanted = |corners| tiles.meet(pixel_box(corners));
        let visit = |triangle: &[u32; 3], row: usize, from: i64, to: i64| {
            let cut = |column: i64| column.clamp(0, width as i64) as usize;
            let (from, to) = (cut(from), cut(to));
            if from >= to {
                return;
            }
            let row_places = places.get(row * width + from..row * width + to);
            let mut depth = None;
            for &place in row_places.unwrap_or_default() {
                if place == 0 {
                    continue;
                }
                let depth = *depth.get_or_insert_with(|| self.depth_of(triangle));
                if let Some(pixel) = border.get_mut(usize::from(place) - 1) {
                    pixel.near = pixel.near.min(depth);
                    pixel.far = pixel.far.max(depth);
                }
            }
        };
        for_each_span(self.mesh, projected, height, wanted, visit);
    }

    /// Mean distance of a triangle's corners from the camera plane, mm.
    fn depth_of(&self, triangle: &[u32; 3]) -> f32 {
        let vertices = self.mesh.vertices();
        let sum: f64 = triangle
            .iter()
            .filter_map(|&index| vertices.get(index as usize))
            .map(|vertex| dot(&self.pose.rotation[2], &vertex.map(f64::from)))
            .sum();
        (-sum / 3.0 - self.pose.translation[2]) as f32
    }
}

/// Tiles of one side that cover all border pixels: most triangles meet none that has any.
struct Tiles {
    /// Of the first tile.
    column: i32,
    row: i32,
    /// Binary logarithm of the side.
    places: u32,
    /// For each row of tiles, which have a border pixel.
    marked: [u128; TILES],
}

const TILES: usize = u128::BITS as usize;

impl Tiles {
    fn of(border: &[BorderPixel]) -> Self {
        let extent = |of: fn(&BorderPixel) -> u16| {
            let least = border.iter().map(of).min().unwrap_or(0);
            let most = border.iter().map(of).max().unwrap_or(0);
            (i32::from(least), usize::from(most - least))
        };
        let (column, width) = extent(|pixel| pixel.column);
        let (row, height) = extent(|pixel| pixel.row);
        let mut tiles = Self {
            column,
            row,
            places: (width.max(height) / TILES)
                .checked_ilog2()
                .map_or(0, |log| log + 1),
            marked: [0; TILES],
        };
        for pixel in border {
            let right = (i32::from(pixel.column) - column) >> tiles.places;
            let down = (i32::from(pixel.row) - row) >> tiles.places;
            tiles.marked[down as usize] |= 1 << right;
        }
        tiles
    }

    /// Whether a tile that has border pixels has some in a box of columns and rows.
    fn meet(&self, [columns, rows]: [Range<i32>; 2]) -> bool {
        if columns.is_empty() || rows.is_empty() {
            return false;
        }
        let tile = |pixel: i32, first: i32| {
            let tile = (pixel - first) >> self.places;
            tile.clamp(-1, TILES as i32)
        };
        let (left, right) = (
            tile(columns.start, self.column),
            tile(columns.end - 1, self.column),
        );
        let (top, bottom) = (tile(rows.start, self.row), tile(rows.end - 1, self.row));
        let last = TILES as i32 - 1;
        if right < 0 || bottom < 0 || left > last || top > last {
            return false;
        }
        let (left, right) = (left.max(0) as u32, right.min(last) as u32);
        let wanted = (u128::MAX >> (TILES as u32 - 1 - (right - left))) << left;
        let rows = self
            .marked
            .get(top.max(0) as usize..=bottom.min(last) as usize);
        rows.unwrap_or_default().iter().any(|row| row & wanted != 0)
    }
}

/// Columns of a row's pixels that are set and have a neighbour, of four, that is not.
fn border_columns<'m>(mask: &Mask<'m>, row: usize) -> impl Iterator<Item = usize> + use<'m> {
    let (own, above, below) = (mask.row(row), mask.row(row - 1), mask.row(row + 1));
    let word = |words: &[Word], at: usize| words.get(at).copied().unwrap_or(0);
    (0..own.len()).flat_map(move |at| {
        let middle = word(own, at);
        let before = at.checked_sub(1).map_or(0, |at| word(own, at));
        let left = middle << 1 | before >> (WORD_BITS - 1);
        let right = middle >> 1 | word(own, at + 1) << (WORD_BITS - 1);
        let mut bits = middle & !(left & right & word(above, at) & word(below, at));
        core::iter::from_fn(move || {
            let bit = bits.trailing_zeros() as usize;
            bits &= bits.wrapping_sub(1);
            (bit < WORD_BITS).then_some(at * WORD_BITS + bit)
        })
    })
}

/// Half width of the window from which a normal is read, pixels.
const WINDOW: isize = 3;

/// The outline in a border pixel: its outward normal, from the slope of the mask smoothed over
/// 7 x 7 pixels, and its arc length, from the sides that face outside: along a border with the
/// normal `n` there are `|n_x|` vertical and `|n_y|` horizontal sides for each pixel of length,
/// and `n_x^2 + n_y^2 = 1`.
fn sample_at(mask: &Mask<'_>, column: usize, row: usize) -> Option<BorderPixel> {
    let set = |right: isize, down: isize| {
        let column = column.checked_add_signed(right);
        let row = row.checked_add_signed(down);
        matches!((column, row), (Some(column), Some(row)) if mask.get(column, row))
    };
    let mut slope = [0i32; 2];
    for down in -WINDOW..=WINDOW {
        for right in -WINDOW..=WINDOW {
            if set(right, down) {
                // A tent weighs the middle most.
                let tent = ((WINDOW + 1 - right.abs()) * (WINDOW + 1 - down.abs())) as i32;
                slope[0] -= tent * right as i32;
                slope[1] -= tent * down as i32;
            }
        }
    }
    let length = sqrt(f64::from(slope[0] * slope[0] + slope[1] * slope[1]));
    if length == 0.0 {
        return None;
    }
    let normal = slope.map(|component| f64::from(component) / length);
    let sides = [(1, 0), (-1, 0), (0, 1), (0, -1)];
    let weight: f64 = sides
        .into_iter()
        .filter(|&(right, down)| !set(right, down))
        .map(|(right, down)| (normal[0] * right as f64 + normal[1] * down as f64).max(0.0))
        .sum();
    Some(BorderPixel {
        column: column as u16,
        row: row as u16,
        normal: normal.map(|component| component as f32),
        weight: weight as f32,
        near: f32::INFINITY,
        far: 0.0,
        residual: f32::NAN,
        jacobian: [0.0; 6],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mask::{MaskMut, words_needed};

    const SIDE: usize = 200;

    #[test]
    fn a_discs_border_has_its_circumference_and_radial_normals() {
        let (centre, radius) = (99.7, 80.3);
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        for row in 0..SIDE {
            for column in 0..SIDE {
                let (x, y) = (column as f64 + 0.5 - centre, row as f64 + 0.5 - centre);
                mask.set(column, row, x * x + y * y < radius * radius);
            }
        }
        let mask = mask.into_mask();
        let mut length = 0.0;
        for row in 1..SIDE - 1 {
            for column in border_columns(&mask, row) {
                let set = |c: usize, r: usize| mask.get(c, r);
                let inside = set(column - 1, row)
                    && set(column + 1, row)
                    && set(column, row - 1)
                    && set(column, row + 1);
                assert!(set(column, row) && !inside);
                let sample = sample_at(&mask, column, row).expect("a slope");
                length += f64::from(sample.weight);
                let (x, y) = (column as f64 + 0.5 - centre, row as f64 + 0.5 - centre);
                let along = (x * f64::from(sample.normal[0]) + y * f64::from(sample.normal[1]))
                    / libm::hypot(x, y);
                assert!(along > 0.97, "normal off by {} rad", libm::acos(along));
            }
        }
        let circumference = 2.0 * core::f64::consts::PI * radius;
        assert!((length / circumference - 1.0).abs() < 0.02, "{length}");
    }
}
