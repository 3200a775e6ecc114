//! The depth of the surface behind the occluding contour.
//!
//! Where the model was drawn from its silhouette edges, they are the contour, and the depth is the
//! middle of all edges in and beside a border pixel. The nearest alone would be truer and worse: of a
//! plate seen edge-on now the front rim and now the back one is nearest, and refinement stops where
//! they change places (starts 2 degrees off stayed 1.5 degrees off). Otherwise front and back of
//! the surface meet at the contour, and the depth is the middle of all that covers the border pixel,
//! so holes and mixed winding do not matter. Where lines across the outline are measured anyway, they tell the same.

use super::border::BorderPixel;
use super::outline::{Depth, DrawnModel};
use super::places::Places;
use crate::image::scan::pixel_box;
use crate::image::tiles::Tiles;
use crate::math::dot;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Images, Projected, for_each_span, remains};

impl DrawnModel<'_> {
    /// Writes the depth behind each border pixel. `places` says which row each is in.
    pub(super) fn measure_depth(
        &self,
        scratch: &mut [Projected],
        places: &Places<'_>,
        border: &mut [BorderPixel],
    ) {
        if self.sampling.depth == Depth::Lines {
            return;
        }
        let Some(remains) = remains(self.model, self.camera, self.pose, scratch) else {
            return;
        };
        let axis = Axis::of(self.pose);
        let depth = |vertex| axis.depth_of(self.model, vertex);
        let by_edges = self.sampling.depth == Depth::Edges
            && remains.contour(|(vertices, images)| {
                let [from, to] = images;
                let images = [from.place(), to.place()];
                self.lay_edge((vertices, &depth), images, places, border);
            });
        if !by_edges {
            self.cover_with_triangles(remains.images, places, border);
        }
    }

    /// Gives an edge's depth to the border pixels that it passes.
    fn lay_edge(
        &self,
        (vertices, depth): ([u32; 2], &dyn Fn(u32) -> f32),
        [from, to]: [[f32; 2]; 2],
        places: &Places<'_>,
        border: &mut [BorderPixel],
    ) {
        // Of `from_fn` and `map` some compilers leave loops.
        let along = [to[0] - from[0], to[1] - from[1]];
        // Less than two pixels apart: where the edge passes a border pixel, one of them is in it or
        // beside it. The last is the first of another edge.
        let steps = (along[0].abs().max(along[1].abs()) / 2.0) as usize + 1;
        let mut depths = None;
        for step in 0..steps {
            let fraction = step as f32 / steps as f32;
            let point = [from[0] + fraction * along[0], from[1] + fraction * along[1]];
            let Some(place) = self.pixel(point) else {
                continue;
            };
            places.around(border, place, |pixel| {
                let [near, far] =
                    *depths.get_or_insert_with(|| [depth(vertices[0]), depth(vertices[1])]);
                pixel.cover(near + fraction * (far - near));
            });
        }
    }

    /// The pixel of a point, unless it lies at the frame's border. Left of the frame and above it numbers are zero, as what is no number is.
    fn pixel(&self, [column, row]: [f32; 2]) -> Option<[usize; 2]> {
        let (column, row) = (column as usize, row as usize);
        let last = |side: usize| side.saturating_sub(1);
        let inside = (1..last(self.drawn.width())).contains(&column)
            && (1..last(self.drawn.height())).contains(&row);
        inside.then_some([column, row])
    }

    /// By itself, because its tiles take up a part of the stack that silhouettes drawn from edges need not have.
    #[inline(never)]
    fn cover_with_triangles(
        &self,
        mut images: Images<'_>,
        places: &Places<'_>,
        border: &mut [BorderPixel],
    ) {
        if !self.all && images.make_all().is_err() {
            // What was drawn has images: it is not reached.
            return;
        }
        let pixels = border
            .iter()
            .map(|pixel| [pixel.column, pixel.row].map(i32::from));
        let tiles = Tiles::of(pixels, 0);
        let (width, height) = (self.drawn.width(), self.drawn.height());
        let wanted = |corners| tiles.meets(&pixel_box(corners));
        let visit = |triangle: &[u32; 3], row: usize, from: i64, to: i64| {
            let cut = |column: i64| column.clamp(0, width as i64) as usize;
            let mut depth = None;
            places.within(border, row, cut(from)..cut(to), |pixel| {
                pixel.cover(*depth.get_or_insert_with(|| self.depth_of(triangle)));
            });
        };
        match images.all() {
            // Of a frame each step asks all triangles.
            Some(all) if cfg!(feature = "frames") => {
                let image = |vertex: u32| all.get(vertex as usize).copied();
                let image = |vertex| image(vertex).unwrap_or(Projected::NONE);
                for_each_span(self.model, image, height, wanted, visit);
            }
            _ => for_each_span(
                self.model,
                |vertex| images.of(vertex),
                height,
                wanted,
                visit,
            ),
        }
    }

    /// Mean distance of a triangle's corners from the camera plane, mm.
    fn depth_of(&self, triangle: &[u32; 3]) -> f32 {
        let vertices = self.model.vertices();
        let sum: f64 = triangle
            .iter()
            .filter_map(|&index| vertices.get(index as usize))
            .map(|vertex| dot(&self.pose.rotation[2], &vertex.map(f64::from)))
            .sum();
        (-sum / 3.0 - self.pose.translation[2]) as f32
    }
}

/// Away from the camera in the model's axes, in 32 bits: depths of a contour need not be as exact as images.
struct Axis {
    away: [f32; 3],
    middle: f32,
}

impl Axis {
    fn of(pose: &Pose) -> Self {
        Self {
            away: pose.rotation[2].map(|x| -x as f32),
            middle: -pose.translation[2] as f32,
        }
    }

    /// Distance of a vertex from the camera plane, mm.
    fn depth_of(&self, model: &Model<'_>, vertex: u32) -> f32 {
        let [x, y, z] = model
            .vertices()
            .get(vertex as usize)
            .copied()
            .unwrap_or_default();
        self.away[0] * x + self.away[1] * y + self.away[2] * z + self.middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::image::mask::{MaskMut, words_needed};
    use crate::mesh::edges::fake::Linked;
    use crate::refine::outline::Sampling;
    use crate::refine::places_needed;
    use crate::render::{render, scratch_needed};
    use std::vec;
    use std::vec::Vec;

    const SIDE: usize = 256;
    const RADIUS: f64 = 30.0;
    const DISTANCE: f64 = 400.0;
    /// Meridians, and circles of latitude.
    const ROUND: u32 = 120;
    const ACROSS: u32 = 60;

    fn sphere() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in 0..ROUND * (ACROSS + 1) {
            let around = f64::from(k % ROUND) / f64::from(ROUND) * core::f64::consts::TAU;
            let down = f64::from(k / ROUND) / f64::from(ACROSS) * core::f64::consts::PI;
            let (s, c) = libm::sincos(around);
            let (ring, height) = libm::sincos(down);
            vertices.push([ring * c, height, ring * s].map(|x| (RADIUS * x) as f32));
        }
        let at = |i: u32, j: u32| j * ROUND + i % ROUND;
        for (i, j) in (0..ROUND).flat_map(|i| (0..ACROSS).map(move |j| (i, j))) {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        // The poles are one point each.
        let one = |v: u32| match v / ROUND {
            0 => 0,
            j if j == ACROSS => ACROSS * ROUND,
            _ => v,
        };
        let triangles = triangles.into_iter().map(|t| t.map(one)).collect();
        (vertices, triangles)
    }

    fn depths(model: &Model<'_>) -> Vec<([u16; 2], f64)> {
        let camera = Camera::new(SIDE, SIDE, [1500.0; 2], [127.3, 129.1]).expect("valid");
        let pose = Pose {
            translation: [0.0, 0.0, -DISTANCE],
            ..Pose::IDENTITY
        };
        let mut scratch = vec![Projected::default(); scratch_needed(model)];
        let mut words = vec![0; words_needed(SIDE, SIDE)];
        let mut drawn = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        render(model, &camera, &pose, &mut scratch, &mut drawn).expect("in front");
        let drawn = drawn.into_mask();
        let outliner = DrawnModel {
            model,
            camera: &camera,
            pose: &pose,
            drawn: &drawn,
            sampling: Sampling::ALL,
            all: false,
        };
        // What the memory held before does not matter.
        let mut places = vec![7; places_needed(SIDE)];
        let mut border = vec![BorderPixel::default(); 4096];
        let border = outliner
            .border(&mut scratch, &mut places, &mut border)
            .expect("room");
        let known = border.iter().filter(|pixel| pixel.is_on_surface());
        let known: Vec<_> = known
            .map(|p| ([p.column, p.row], f64::from(p.depth())))
            .collect();
        assert_eq!(known.len(), border.len());
        known
    }

    #[test]
    fn edges_and_triangles_agree_on_the_depth_of_a_spheres_contour() {
        let (vertices, triangles) = sphere();
        let plain = Model::from_triangles(&vertices, &triangles).expect("valid");
        let linked = Linked::new(plain.mesh());
        let (by_edges, by_triangles) = (depths(&linked.model(*plain.mesh())), depths(&plain));
        // Where rays touch the sphere.
        let truth = DISTANCE - RADIUS * RADIUS / DISTANCE;
        assert_eq!(by_edges.len(), by_triangles.len());
        for ((place, edge), (other, triangle)) in by_edges.iter().zip(&by_triangles) {
            assert_eq!(place, other);
            // The contour goes to and fro over two rows of facets of 1.6 mm; a pixel inside it the
            // sphere is 3 mm nearer and farther.
            assert!((edge - truth).abs() < 3.2, "{edge} for {truth}");
            assert!((triangle - truth).abs() < 3.5, "{triangle} for {truth}");
        }
    }
}
