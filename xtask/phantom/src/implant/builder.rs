//! Collects vertices and triangles, then scales and mirrors them into the mesh that is handed out.

use super::parameters::{Side, Size};
use super::triangles::Triangles;
use glam::DVec3;

/// A mesh under construction: a left part at the drawing's own size, in millimetres.
#[derive(Default)]
pub(super) struct Builder {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    /// Adds a vertex and returns its index.
    pub(super) fn vertex(&mut self, position: DVec3) -> u32 {
        self.vertices.push(position);
        (self.vertices.len() - 1) as u32
    }

    /// Adds a triangle, counter-clockwise seen from outside.
    pub(super) fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.triangles.push([a, b, c]);
    }

    /// Adds a quadrilateral, counter-clockwise, split along its shorter diagonal.
    pub(super) fn quad(&mut self, a: u32, b: u32, c: u32, d: u32) {
        let span = |p: u32, q: u32| self.position(p).distance_squared(self.position(q));
        if span(a, c) <= span(b, d) {
            self.quad_along(a, b, c, d);
        } else {
            self.quad_along(b, c, d, a);
        }
    }

    /// Adds a quadrilateral, counter-clockwise, split from `a` to `c`.
    pub(super) fn quad_along(&mut self, a: u32, b: u32, c: u32, d: u32) {
        self.triangle(a, b, c);
        self.triangle(a, c, d);
    }

    fn position(&self, index: u32) -> DVec3 {
        self.vertices[index as usize]
    }

    /// Scales to the size's mediolateral width, centres mediolaterally and mirrors for a right knee.
    pub(super) fn finish(self, side: Side, size: Size) -> Triangles {
        let low = self
            .vertices
            .iter()
            .fold(f64::INFINITY, |low, v| low.min(v.z));
        let high = self
            .vertices
            .iter()
            .fold(f64::NEG_INFINITY, |high, v| high.max(v.z));
        let scale = size.width_mm() / (high - low);
        let middle = DVec3::new(0.0, 0.0, (low + high) / 2.0);
        let mirror = if side == Side::Right { -1.0 } else { 1.0 };
        let place = |v: &DVec3| {
            let p = (*v - middle) * scale;
            [(p.x * mirror) as f32, p.y as f32, p.z as f32]
        };
        let turn = |t: [u32; 3]| {
            if side == Side::Right {
                [t[0], t[2], t[1]]
            } else {
                t
            }
        };
        Triangles {
            vertices: self.vertices.iter().map(place).collect(),
            triangles: self.triangles.into_iter().map(turn).collect(),
        }
    }
}
