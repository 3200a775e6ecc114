//! The path of X-rays through a mesh, along lines across its outline.
//!
//! A ray enters metal where it meets a triangle that faces the focus and leaves it by one that does not, so its path is the
//! signed sum of the distances to them. Only places on some hundred lines of twenty pixels are asked for. A triangle is cut by
//! each line that passes through it; both triangles beside an edge are cut at the same place, so a place between them is
//! counted once. The reciprocal of the depth is linear on the image of a triangle, however steeply that is seen.

mod course;
mod cut;
mod groups;

use core::mem::replace;
use core::ops::Range;

use course::{Course, ORIGIN};
pub use course::{INNER, POINTS, STEP};
use cut::Seen;
pub use groups::LineGroup;
use groups::{Grid, NONE, SPANNED};

use crate::camera::Camera;
use crate::image::scan::FixedPoint;
use crate::image::tiles::TILES;
use crate::math::{dot, sqrt};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Projected, RenderError, project};

/// Most lines: 16 bits number their groups.
pub const MOST_LINES: usize = NONE as usize / SPANNED;

/// A line across an outline, and the path of the rays to places on it through the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLine {
    course: Course,
    /// The triangle that was added last, from 1.
    last: u32,
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

/// Groups that [`measure`] needs as working memory for so many lines.
#[must_use]
pub const fn groups_needed(lines: usize) -> usize {
    lines * SPANNED
}

/// Working memory of [`measure`]; by default none, for whoever has no film.
#[derive(Debug, Default)]
pub struct LineMemory<'m> {
    /// The lines: as many as there are samples of an outline, at most [`MOST_LINES`].
    pub lines: &'m mut [PathLine],
    /// [`heads_needed`] numbers.
    pub heads: &'m mut [u16],
    /// [`groups_needed`] groups.
    pub groups: &'m mut [LineGroup],
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
            course: Course {
                origin,
                direction,
                first: 0,
            },
            last: 0,
            depths: [f32::INFINITY, 0.0],
            paths: [0.0; POINTS],
            open: [0; POINTS],
        }
    }

    /// The same, but what lies before a place is left out: it is taken to be as there.
    pub(crate) fn starting_at(mut self, first: usize) -> Self {
        self.course.first = first.min(ORIGIN) as u16;
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

    /// Adds the depth of a triangle that lies on both sides of the line, to the places inside it. `nearness` is the reciprocal of its
    /// corners' depths.
    #[inline(always)]
    fn add(&mut self, seen: &Seen, side: &Side, nearness: impl FnOnce() -> [f32; 3]) {
        let cuts = seen.cuts();
        let [start, end] = cuts.map(|cut| cut.first_place(self.course.first));
        if start < end {
            let nearness = nearness();
            let ends = cuts.map(|cut| [cut.along, cut.of(&nearness)]);
            self.add_places(start..end, ends, side);
        }
    }

    fn add_places(
        &mut self,
        places: Range<usize>,
        [[from, near], [to, far]]: [[f32; 2]; 2],
        side: &Side,
    ) {
        let step = (far - near) / (to - from);
        let nearness_at = |point: f32| near + (point - from) * step;
        if places.contains(&ORIGIN) {
            let depth = 1.0 / nearness_at(ORIGIN as f32);
            self.depths = [self.depths[0].min(depth), self.depths[1].max(depth)];
        }
        let first = places.start;
        // It begins here and ends there.
        for (point, step) in [(places.start, side.sign), (places.end, -side.sign)] {
            if let Some(open) = self.open.get_mut(point) {
                *open = open.wrapping_add(step);
            }
        }
        let Some(paths) = self.paths.get_mut(places) else {
            return;
        };
        // One division for all of them: about the middle place the reciprocal is a parabola, as nearly as numbers of 32 bits tell.
        let middle = (paths.len() - 1) as f32 / 2.0;
        let sign = f32::from(side.sign);
        let depth = 1.0 / nearness_at(first as f32 + middle);
        let slope = step * depth;
        if (slope * middle).abs() < NEARLY_LINEAR {
            let [a, b, c] =
                [depth - side.middle, -depth * slope, depth * slope * slope].map(|x| sign * x);
            for (k, path) in paths.iter_mut().enumerate() {
                let off = k as f32 - middle;
                *path += a + off * (b + off * c);
            }
        } else {
            for (k, path) in paths.iter_mut().enumerate() {
                let depth = 1.0 / nearness_at((first + k) as f32);
                *path += sign * (depth - side.middle);
            }
        }
    }
}

/// Relative change of depth within half of a piece of a line up to which it is taken as a parabola: what that leaves out is
/// the third power.
const NEARLY_LINEAR: f32 = 4e-3;

/// How a triangle counts.
struct Side {
    /// 1 where rays leave the part by it.
    sign: i8,
    /// Depths are counted from here, so that where the surface has a hole the sum stays small, mm.
    middle: f32,
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
    groups: &mut [LineGroup],
) -> Result<(), RenderError> {
    let images = project(model.mesh(), camera, pose, scratch)?;
    measure_by(images, (model, camera, pose), lines, heads, groups)
}

/// The same by the images of all vertices.
///
/// # Errors
/// [`RenderError`] where memory is too short.
pub(crate) fn measure_by(
    images: &[Projected],
    (model, camera, pose): (&Model<'_>, &Camera, &Pose),
    lines: &mut [PathLine],
    heads: &mut [u16],
    groups: &mut [LineGroup],
) -> Result<(), RenderError> {
    let heads = first("heads of lists", heads_needed(), heads)?;
    let groups = first("groups of lines", groups_needed(lines.len()), groups)?;
    if lines.len() > MOST_LINES {
        return Err(TooLittleMemory {
            what: "numbers of lines",
            needed: lines.len(),
            given: MOST_LINES,
        }
        .into());
    }
    for line in &mut *lines {
        let Course {
            origin, direction, ..
        } = line.course;
        *line = PathLine::at(origin, direction).starting_at(line.course.first());
    }
    let grid = Grid::of(lines.iter().map(|line| line.course), heads, groups);
    let middle = -pose.transform(&model.centre())[2] as f32;
    let image = |vertex: u32| images.get(vertex as usize).copied().unwrap_or_default();
    let mut number = 0;
    model.for_each_triangle(|triangle| {
        number += 1;
        let corners = triangle.map(image);
        let mut nearness = None;
        grid.for_each_cut(&corners, |line, seen| {
            let Some(line) = lines.get_mut(line) else {
                return;
            };
            // It may lie in several tiles with it.
            if replace(&mut line.last, number) == number {
                return;
            }
            let sign = FixedPoint::doubled_area(corners).signum() as i8;
            line.add(&seen, &Side { sign, middle }, || {
                let nearness_of = |vertex| nearness_of(model, pose, vertex);
                *nearness.get_or_insert_with(|| triangle.map(nearness_of))
            });
        });
    });
    close(lines, camera);
    Ok(())
}

fn nearness_of(model: &Model<'_>, pose: &Pose, vertex: u32) -> f32 {
    let vertex = model.vertices().get(vertex as usize);
    let vertex = vertex.copied().unwrap_or_default().map(f64::from);
    (-1.0 / (dot(&pose.rotation[2], &vertex) + pose.translation[2])) as f32
}

/// Turns sums of depths into lengths along the rays.
fn close(lines: &mut [PathLine], camera: &Camera) {
    let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
    for line in lines {
        let (x, y) = (
            (line.course.origin[0] - cx) / fx,
            (line.course.origin[1] - cy) / fy,
        );
        let slant = sqrt(1.0 + x * x + y * y) as f32;
        // Of a surface that is inside out sums are negative.
        for path in &mut line.paths {
            *path = path.abs() * slant;
        }
        let first = line.course.first();
        if let Some((before, [path, ..])) = line.paths.split_at_mut_checked(first) {
            before.fill(*path);
        }
    }
}

#[cfg(test)]
mod tests;
