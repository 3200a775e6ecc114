//! The path of X-rays through a mesh, along lines across its outline.
//!
//! A ray enters metal where it meets a triangle that faces the focus and leaves it by one that does not, so its path is the
//! signed sum of the distances to them. Only places on some hundred lines of twenty pixels are asked for. A triangle is cut by
//! each line that passes through it; both triangles beside an edge are cut at the same place, so a place between them is
//! counted once. The reciprocal of the depth is linear on the image of a triangle, however steeply that is seen.

use core::ops::Range;

use crate::camera::Camera;
use crate::image::scan::{FixedPoint, touched_box};
use crate::image::tiles::{TILES, Tiles};
use crate::math::{dot, sqrt};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Projected, RenderError, project};

/// Distance between places on a line, pixels.
pub const STEP: f64 = 0.25;
/// The first place: this far inside the line's origin, pixels.
pub const INNER: f64 = 12.0;
/// Places on a line; the last is 8 pixels outside.
pub const POINTS: usize = 81;
/// The place that is the line's origin.
const ORIGIN: usize = (INNER / STEP) as usize;
/// Tiles have sides of eight pixels at least: a line has places in no more than [`SPANNED`] of them.
const LEAST_PLACES: u32 = 3;
const SPANNED: usize = 8;
/// Places that are passed over where both ends lie in one tile.
const STRIDE: usize = 5;
/// Head of an empty list.
const NONE: u16 = u16::MAX;
/// Most lines: 16 bits number the places of eight tiles for each.
pub const MOST_LINES: usize = NONE as usize / SPANNED;

/// A line across an outline, and the path of the rays to places on it through the part.
// What every triangle asks of a line comes first and lies together: most are answered by it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct PathLine {
    /// Continuous image coordinates of the origin, and the unit direction outwards.
    origin: [f64; 2],
    direction: [f64; 2],
    /// The next line in each tile that this one has places in, as [`SPANNED`] times its number and which of its tiles it is.
    next: [u16; SPANNED],
    /// The triangle that was added last, from 1.
    last: u32,
    /// The first place that is measured; those before it are taken to be as it is.
    first: u16,
    /// Least and greatest depth of the surface behind the origin, mm; the second is 0 where there is none.
    depths: [f32; 2],
    /// mm.
    paths: [f32; POINTS],
    /// By how much the number of surfaces left minus those entered grows at each place: zeros where the surface is closed.
    open: [i8; POINTS],
}

impl Default for PathLine {
    fn default() -> Self {
        Self::at([0.0; 2], [1.0, 0.0])
    }
}

/// Working memory of [`measure`]; by default none, for whoever has no film.
#[derive(Debug, Default)]
pub struct LineMemory<'m> {
    /// The lines: as many as there are samples of an outline, at most [`MOST_LINES`].
    pub lines: &'m mut [PathLine],
    /// [`heads_needed`] numbers.
    pub heads: &'m mut [u16],
}

/// Numbers that [`measure`] needs as working memory.
#[must_use]
pub const fn heads_needed() -> usize {
    TILES * TILES
}

impl PathLine {
    /// A line from an origin in a direction of unit length, without paths.
    #[must_use]
    pub fn at(origin: [f64; 2], direction: [f64; 2]) -> Self {
        Self {
            origin,
            direction,
            next: [NONE; SPANNED],
            last: 0,
            first: 0,
            depths: [f32::INFINITY, 0.0],
            paths: [0.0; POINTS],
            open: [0; POINTS],
        }
    }

    /// The same, but what lies before a place is left out: it is taken to be as there.
    pub(crate) fn starting_at(mut self, first: usize) -> Self {
        self.first = first.min(ORIGIN) as u16;
        self
    }

    /// The path through the part at each place, mm. `None` where the surface is not closed under the line.
    #[must_use]
    pub fn paths(&self) -> Option<&[f32; POINTS]> {
        self.open
            .iter()
            .all(|&open| open == 0)
            .then_some(&self.paths)
    }

    /// Least and greatest distance from the camera plane of the surface behind the line's origin, mm; `None` where there is none.
    #[must_use]
    pub fn depths(&self) -> Option<[f64; 2]> {
        let depths = self.depths.map(f64::from);
        (depths[1] > 0.0).then_some(depths)
    }

    fn measured(&self) -> Range<usize> {
        usize::from(self.first)..POINTS
    }

    fn pixel(&self, point: usize) -> [i32; 2] {
        let along = STEP * point as f64 - INNER;
        [0, 1].map(|axis| floor(self.origin[axis] + along * self.direction[axis]))
    }

    /// How far beside the line a place is, pixels.
    fn across(&self, [column, row]: [f64; 2]) -> f64 {
        let [right, down] = self.direction;
        (column - self.origin[0]) * down - (row - self.origin[1]) * right
    }

    /// How far along the line a place is, pixels.
    fn along(&self, [column, row]: [f64; 2]) -> f64 {
        let [right, down] = self.direction;
        (column - self.origin[0]) * right + (row - self.origin[1]) * down
    }

    /// Adds the depth of a triangle to the places inside it. `nearness` is the reciprocal of its corners' depths.
    fn add(&mut self, corners: &[[f64; 2]; 3], side: &Side, nearness: impl FnOnce() -> [f64; 3]) {
        let across = corners.map(|corner| self.across(corner));
        let [a, b, c] = across.map(|across| across > 0.0);
        if a == b && b == c {
            return;
        }
        // The line cuts both edges of the corner that is alone on its side.
        let alone = if b == c { 0 } else { 1 + usize::from(a == b) };
        let along = corners.map(|corner| self.along(corner));
        let mut cuts = [(alone + 1) % 3, (alone + 2) % 3]
            .map(|other| Cut::between(alone, other, &across))
            .map(|cut| (cut.of(&along), cut));
        if cuts[0].0 > cuts[1].0 {
            cuts.swap(0, 1);
        }
        let places = self.measured();
        let [start, end] = cuts.map(|(along, _)| first_place(along, &places));
        if start < end {
            let nearness = nearness();
            let ends = cuts.map(|(along, cut)| [along, cut.of(&nearness)]);
            self.add_places(start..end, ends, side);
        }
    }

    fn add_places(
        &mut self,
        places: Range<usize>,
        [[from, near], [to, far]]: [[f64; 2]; 2],
        side: &Side,
    ) {
        let per_px = (far - near) / (to - from);
        let nearness_at = |point: usize| near + (STEP * point as f64 - INNER - from) * per_px;
        if places.contains(&ORIGIN) {
            let depth = (1.0 / nearness_at(ORIGIN)) as f32;
            self.depths = [self.depths[0].min(depth), self.depths[1].max(depth)];
        }
        let first = places.start;
        // It begins here and ends there.
        for (point, step) in [(places.start, side.sign), (places.end, -side.sign)] {
            if let Some(open) = self.open.get_mut(point) {
                *open = open.wrapping_add(step);
            }
        }
        let Some(paths) = self.paths.get_mut(places.clone()) else {
            return;
        };
        // One division for all of them: about the middle place the reciprocal is a parabola, as nearly as numbers of 32 bits tell.
        let middle = (places.len() - 1) as f64 / 2.0;
        let (near, step) = (nearness_at(first) + middle * STEP * per_px, STEP * per_px);
        let depth = 1.0 / near;
        let slope = step * depth;
        if (slope * middle).abs() < NEARLY_LINEAR {
            let sign = f64::from(side.sign);
            let [a, b, c] = [depth - side.middle, -depth * slope, depth * slope * slope]
                .map(|x| (sign * x) as f32);
            let middle = middle as f32;
            for (k, path) in paths.iter_mut().enumerate() {
                let off = k as f32 - middle;
                *path += a + off * (b + off * c);
            }
        } else {
            for (point, path) in places.clone().zip(paths) {
                let depth = 1.0 / nearness_at(point);
                *path += (f64::from(side.sign) * (depth - side.middle)) as f32;
            }
        }
    }
}

/// Relative change of depth within half of a piece of a line up to which it is taken as a parabola: what that leaves out is
/// the third power.
const NEARLY_LINEAR: f64 = 4e-3;

/// Number of the first of these places that is not before this one along a line, pixels; their end where none is.
fn first_place(along: f64, places: &Range<usize>) -> usize {
    let place = (along + INNER) / STEP;
    let whole = place.clamp(places.start as f64, places.end as f64) as usize;
    (whole + usize::from((whole as f64) < place)).min(places.end)
}

/// Where a line cuts an edge of a triangle.
#[derive(Clone, Copy)]
struct Cut {
    /// The corners on this side of the line and beyond, in this order whichever of its triangles asks.
    near: usize,
    far: usize,
    /// Which part of the way from the first to the second.
    part: f64,
}

impl Cut {
    /// Between a corner and one on the other side of the line.
    fn between(one: usize, other: usize, across: &[f64; 3]) -> Self {
        let (near, far) = if across[one] > 0.0 {
            (other, one)
        } else {
            (one, other)
        };
        let part = across[near] / (across[near] - across[far]);
        Self { near, far, part }
    }

    /// Between the values of its ends.
    fn of(&self, values: &[f64; 3]) -> f64 {
        values[self.near] + self.part * (values[self.far] - values[self.near])
    }
}

/// How a triangle counts.
struct Side {
    /// 1 where rays leave the part by it.
    sign: i8,
    /// Depths are counted from here, so that where the surface has a hole the sum stays small, mm.
    middle: f64,
}

/// Writes the path through `model` at `pose` to each line; `scratch` is the working memory of [`crate::render::render`].
///
/// The surface may be any, of any winding: where it does not close, a line says so.
///
/// # Errors
/// [`RenderError`] where a vertex has no image, or memory is too short.
pub fn measure(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    scratch: &mut [Projected],
    lines: &mut [PathLine],
    heads: &mut [u16],
) -> Result<(), RenderError> {
    let heads = first("heads of lists", heads_needed(), heads)?;
    if lines.len() > MOST_LINES {
        return Err(TooLittleMemory {
            what: "numbers of lines",
            needed: lines.len(),
            given: MOST_LINES,
        }
        .into());
    }
    let images = project(model.mesh(), camera, pose, scratch)?;
    let tiles = enter(lines, heads);
    let middle = -pose.transform(&model.centre())[2];
    let image = |vertex: u32| images.get(vertex as usize).copied().unwrap_or_default();
    for (number, triangle) in model.triangles().iter().enumerate() {
        let corners = triangle.map(image);
        let Some([columns, rows]) = tiles.under(touched_box(corners)) else {
            continue;
        };
        let sign = FixedPoint::doubled_area(corners).signum() as i8;
        if sign == 0 {
            continue;
        }
        let side = Side { sign, middle };
        let mut nearness = None;
        let places = corners.map(|corner| corner.place().map(f64::from));
        for row in rows {
            for column in columns.clone() {
                let mut node = heads[row * TILES + column];
                while let Some(line) = lines.get_mut(usize::from(node) / SPANNED) {
                    node = line.next[usize::from(node) % SPANNED];
                    if line.last != number as u32 + 1 {
                        line.last = number as u32 + 1;
                        line.add(&places, &side, || {
                            *nearness.get_or_insert_with(|| {
                                triangle.map(|vertex| nearness_of(model, pose, vertex))
                            })
                        });
                    }
                }
            }
        }
    }
    close(lines, camera);
    Ok(())
}

/// Enters each line in the lists of the tiles that it has places in.
fn enter(lines: &mut [PathLine], heads: &mut [u16]) -> Tiles {
    // All places of a line lie between its ends.
    let ends = lines
        .iter()
        .flat_map(|line| [usize::from(line.first), POINTS - 1].map(|point| line.pixel(point)));
    let mut tiles = Tiles::around(ends, LEAST_PLACES);
    heads.fill(NONE);
    for (number, line) in lines.iter_mut().enumerate() {
        *line = PathLine::at(line.origin, line.direction).starting_at(line.measured().start);
        let (mut entered, mut before) = (0, None);
        let mut points = line.measured();
        while let Some(point) = points.next() {
            let tile = tiles.mark(line.pixel(point));
            // A tile that has both ends of a piece has all of it.
            if tiles.tile(line.pixel((point + STRIDE).min(POINTS - 1))) == tile {
                points.start += STRIDE - 1;
            }
            if before == Some(tile) || entered == SPANNED {
                continue;
            }
            before = Some(tile);
            let head = &mut heads[tile[1] * TILES + tile[0]];
            line.next[entered] = *head;
            *head = (number * SPANNED + entered) as u16;
            entered += 1;
        }
    }
    tiles
}

/// The whole number below, of what is no farther out than coordinates may be.
fn floor(x: f64) -> i32 {
    const BEYOND: i32 = 1 << 20;
    (x + f64::from(BEYOND)) as i32 - BEYOND
}

fn nearness_of(model: &Model<'_>, pose: &Pose, vertex: u32) -> f64 {
    let vertex = model.vertices().get(vertex as usize);
    let vertex = vertex.copied().unwrap_or_default().map(f64::from);
    -1.0 / (dot(&pose.rotation[2], &vertex) + pose.translation[2])
}

/// Turns sums of depths into lengths along the rays.
fn close(lines: &mut [PathLine], camera: &Camera) {
    let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
    for line in lines {
        let (x, y) = ((line.origin[0] - cx) / fx, (line.origin[1] - cy) / fy);
        let slant = sqrt(1.0 + x * x + y * y) as f32;
        // Of a surface that is inside out sums are negative.
        for path in &mut line.paths {
            *path = path.abs() * slant;
        }
        let first = usize::from(line.first);
        if let Some((before, [path, ..])) = line.paths.split_at_mut_checked(first) {
            before.fill(*path);
        }
    }
}

#[cfg(test)]
mod tests;
