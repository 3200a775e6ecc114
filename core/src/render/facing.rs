//! The facing test: which of a model's triangles face the camera, decided in model coordinates.
//!
//! Facing is that of the drawn triangle, whose vertices are rounded. Three points at `p0`, `p1`, `p2`
//! in camera coordinates have an image of the doubled area
//! `fx fy det(p0, p1, p2) / (z0 z1 z2)`, where `det` is the doubled area of the triangle times the
//! distance of the camera from its plane. Rounding by up to `h` changes the image's by
//! `2 h (a + b) + 8 h^2` at most, with `a` and `b` two sides of it, columns and rows added. What is
//! nearer to edge-on than that is rounded and measured.

use crate::camera::Camera;
use crate::image::scan::{FixedPoint, MAX_COORDINATE, ROUNDING};
use crate::math::{norm, sqrt};
use crate::mesh::edges::{
    EdgeBox, EdgeGroup, Facing, IN_BOX, MeshEdge, PackedEdges, ROUNDINGS, unpacked,
};
use crate::mesh::{Bounds, Mesh};
use crate::pose::Pose;
use crate::render::project::Images;
use crate::render::reach::Reach;

/// Part of a distance that rounding to 32 bits changes at most, with some to spare.
const SINGLE: f32 = 4e-6;

/// A bit for each edge of a group.
type Bits = u16;

/// Which triangles beside edges face the camera, and of which that is certain.
struct Sides {
    certain: Bits,
    faces: Bits,
}

/// The camera in model coordinates, with the margins within which rounding may change which way a triangle faces.
pub(crate) struct FacingTest {
    /// The camera in mesh coordinates, mm.
    place: [f32; 3],
    /// How far edge-on must be, as doubled area times distance from the plane, mm^3: for each mm of the longest side, and
    /// beside that; and how far planes are from where they seem, mm.
    margins: [f32; 3],
    /// Whether it is certain that all vertices have images.
    sees_all: bool,
}

impl FacingTest {
    pub(crate) fn new(mesh: &Mesh<'_>, camera: &Camera, pose: &Pose, reach: &Reach) -> Self {
        let Bounds { centre, radius } = mesh.bounds();
        let Reach {
            near,
            far,
            aside,
            in_front,
        } = *reach;
        let place = pose.inverse().translation;
        let ([fx, fy], principal) = (camera.focal(), camera.principal_point());
        let stretch: f64 = aside.iter().map(|tan| sqrt(1.0 + tan * tan)).sum();
        let farthest = |k: usize| camera.focal()[k] * aside[k] + principal[k].abs();
        // With a thousandth for what rounding before the last does.
        let scale = 1.001 * far * far * far / (fx * fy);
        let (per_mm, least) = if in_front {
            let side_px = fx.max(fy) / near * stretch;
            (
                scale * 4.0 * ROUNDING * side_px,
                scale * 8.0 * ROUNDING * ROUNDING,
            )
        } else {
            (f64::INFINITY, f64::INFINITY)
        };
        let distance = norm(&place) + norm(&centre) + radius;
        Self {
            place: place.map(|x| x as f32),
            margins: [per_mm as f32, least as f32, SINGLE * distance as f32],
            // Well inside of what is refused.
            sees_all: in_front && (0..2).all(|k| farthest(k) < 0.99 * MAX_COORDINATE),
        }
    }

    /// Whether no vertex can lie behind the camera or too far aside.
    pub(crate) fn sees_all(&self) -> bool {
        self.sees_all
    }

    /// Calls `visit` for each edge of a group that is on the contour: its vertices, in the direction
    /// of the triangle that faces the camera.
    pub(crate) fn contour(
        &self,
        bounds: &EdgeBox,
        group: &EdgeGroup,
        images: &mut Images<'_>,
        mut visit: impl FnMut([u32; 2]),
    ) {
        let [per_mm, least, rounding] = self.margins;
        let margin = bounds.thin * per_mm + bounds.small * least + rounding;
        if self.is_clear(bounds, margin) {
            return;
        }
        let [forth, back] = group
            .duals
            .each_ref()
            .map(|duals| self.sides(duals, margin));
        let certain = forth.certain & back.certain;
        let mut wanted = !certain | (forth.faces ^ back.faces);
        while wanted != 0 {
            let at = wanted.trailing_zeros() as usize;
            wanted &= wanted - 1;
            let Some(edge) = group.edge(at) else {
                continue;
            };
            let [forth, back] = if certain >> at & 1 == 1 {
                [forth.faces, back.faces].map(|faces| faces >> at & 1 == 1)
            } else {
                self.own_faces(group, at)
                    .unwrap_or_else(|| Self::faces(edge, images))
            };
            match (forth, back) {
                (true, false) => visit([edge.from, edge.to]),
                (false, true) => visit([edge.to, edge.from]),
                _ => {}
            }
        }
    }

    /// The same of all packed edges, whose triangles are measured from their vertices.
    pub(crate) fn packed_contour(
        &self,
        (packed, measure): (&PackedEdges<'_>, Facing),
        images: &mut Images<'_>,
        mut visit: impl FnMut([u32; 2]),
    ) {
        let [per_mm, least, rounding] = self.margins;
        let is_wanted = |bounds: &EdgeBox| {
            let margin = bounds.thin * per_mm + bounds.small * least + rounding;
            !self.is_clear(bounds, margin)
        };
        // No vertex is farther than the distance that the last is a part of.
        let measured = [per_mm, least, rounding * (1.0 + ROUNDINGS / SINGLE)];
        packed.for_each_group(is_wanted, |group| {
            let own = (group, images.vertices());
            measure(&self.place, measured, own, &mut |edge, sides| {
                let edge = unpacked(&group.edge(edge));
                match sides.unwrap_or_else(|| Self::faces(&edge, images)) {
                    [true, false] => visit([edge.from, edge.to]),
                    [false, true] => visit([edge.to, edge.from]),
                    _ => {}
                }
            });
        });
    }

    /// Whether all triangles of a box turn the same way, by more than a margin in mm.
    fn is_clear(&self, bounds: &EdgeBox, margin: f32) -> bool {
        let ([x, y, z], [a, b, c, d]) = (self.place, bounds.middle);
        let [right, up, near, along] = bounds.reach;
        // One after the other: of an iterator some compilers leave a loop.
        let from_middle = -d + x * a + y * b + z * c;
        let reach = along + margin + x.abs() * right + y.abs() * up + z.abs() * near;
        from_middle.abs() > reach
    }

    /// Of triangles by their duals.
    fn sides(&self, [a, b, c, d]: &[[f32; IN_BOX]; 4], margin: f32) -> Sides {
        let [x, y, z] = self.place;
        let from_plane: [f32; IN_BOX] =
            core::array::from_fn(|k| a[k] * x + b[k] * y + c[k] * z - d[k]);
        let bits = |holds: fn(f32, f32) -> bool| {
            let bits = from_plane.iter().enumerate();
            bits.fold(0, |sum, (k, &distance)| {
                sum | Bits::from(holds(distance, margin)) << k
            })
        };
        Sides {
            certain: bits(|distance, margin| distance.abs() > margin),
            // Images are run clockwise where normals point away.
            faces: bits(|distance, _| distance < 0.0),
        }
    }

    /// Whether the triangles forth and back beside an edge of a group face the camera, where the margin that they need
    /// themselves, which is less than that of all in the box, makes it certain.
    fn own_faces(&self, group: &EdgeGroup, at: usize) -> Option<[bool; 2]> {
        let [per_mm, least, rounding] = self.margins;
        let [thin, small] = group.edge(at)?.needs();
        let margin = thin * per_mm + small * least + rounding;
        let [x, y, z] = self.place;
        let from_plane = group
            .duals
            .each_ref()
            .map(|[a, b, c, d]| a[at] * x + b[at] * y + c[at] * z - d[at]);
        let certain = from_plane.iter().all(|distance| distance.abs() > margin);
        certain.then(|| from_plane.map(|distance| distance < 0.0))
    }

    /// Whether the triangles forth and back beside an edge face the camera, by their images.
    fn faces(edge: &MeshEdge, images: &mut Images<'_>) -> [bool; 2] {
        let [from, to, forth, back] =
            [edge.from, edge.to, edge.forth, edge.back].map(|vertex| images.of(vertex));
        [[from, to, forth], [to, from, back]].map(|corners| FixedPoint::doubled_area(corners) > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Matrix3, Vector3, add, apply, cross, scale, subtract};
    use crate::mesh::edges::fake::{self, Linked};
    use crate::pose::EulerPose;
    use crate::render::project::{Projected, project};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// Silhouette edges without looking at each edge, and by the images of all triangles.
    fn contours(mesh: &Mesh<'_>, focal: f64, pose: &Pose) -> [Vec<[u32; 2]>; 2] {
        let camera = Camera::new(64, 64, [focal, 0.97 * focal], [31.0, 33.5]).expect("valid");
        let linked = Linked::new(mesh);
        let mut slots = vec![Projected::default(); mesh.vertices().len()];
        let mut images = Images::new(mesh, &camera, pose, &mut slots);
        let facing = FacingTest::new(mesh, &camera, pose, &Reach::of(&mesh.bounds(), pose));
        let mut found = Vec::new();
        for (bounds, group) in linked.edges().groups() {
            facing.contour(bounds, group, &mut images, |ends| found.push(ends));
        }
        let packed = linked.packed();
        for edges in [packed.edges(), packed.tight_edges()] {
            let mut again = Vec::new();
            let packed = edges.packed().expect("they are packed");
            facing.packed_contour(packed, &mut images, |ends| again.push(ends));
            assert_eq!(again, found);
        }
        let images = project(mesh, &camera, pose, &mut slots).expect("in front");
        let faces = |corners: [u32; 3]| {
            FixedPoint::doubled_area(corners.map(|vertex| images[vertex as usize])) > 0
        };
        let mut naive = Vec::new();
        for edge in linked.edges().groups().flat_map(|(_, group)| group.edges()) {
            let MeshEdge { from, to, .. } = edge;
            match (faces([from, to, edge.forth]), faces([to, from, edge.back])) {
                (true, false) => naive.push([from, to]),
                (false, true) => naive.push([to, from]),
                _ => {}
            }
        }
        [found, naive]
    }

    properties! {
        #[test]
        fn edges_of_a_torus_are_those_of_its_images(
            dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-40.0..40.0f64),
            focal in 1.0..9.0f64,
        ) {
            let (vertices, triangles) = fake::torus(&dents);
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let [x_mm, y_mm, nearer] = place;
            let pose = Pose::from(EulerPose {
                x_mm, y_mm, z_mm: nearer - 150.0, z_rot_deg, x_rot_deg, y_rot_deg
            });
            let [found, naive] = contours(&mesh, libm::exp(focal), &pose);
            prop_assert_eq!(found, naive);
        }
    }

    /// A rotation that lets a camera at a place look at the origin.
    fn towards_origin(place: &Vector3) -> Matrix3 {
        let unit = |way: &Vector3| scale(way, 1.0 / norm(way));
        let back = unit(place);
        let up = if back[1].abs() < 0.7 {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let right = unit(&cross(&up, &back));
        [right, cross(&back, &right), back]
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(96))]

        /// There the margins decide, which are of rounding by parts of a pixel: so much of a triangle as is seen may be all rounding.
        #[test]
        fn edges_of_triangles_that_are_seen_edge_on_are_those_of_their_images(
            dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
            pick in any::<prop::sample::Index>(),
            turn in -4.0..4.0f64,
            [far, off, focal] in [3.8..13.0f64, -16.0..4.0f64, 0.1..7.0f64],
            side in prop_oneof![Just(-1.0), Just(1.0)],
        ) {
            let (vertices, triangles) = fake::torus(&dents);
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let [a, b, c] = pick.get(&triangles).map(|vertex| vertices[vertex as usize].map(f64::from));
            let unit = |way: &Vector3| scale(way, 1.0 / norm(way));
            let normal = unit(&cross(&subtract(&b, &a), &subtract(&c, &a)));
            let first = unit(&subtract(&b, &a));
            let (sin, cos) = libm::sincos(turn);
            let along = add(&scale(&first, cos), &scale(&cross(&normal, &first), sin));
            // In the plane but for a little, the farther the more.
            let far = 60.0 + libm::exp(far);
            let above = scale(&normal, side * far / 100.0 * libm::exp(off));
            let place = add(&add(&a, &scale(&along, far)), &above);
            let rotation = towards_origin(&place);
            let pose = Pose { rotation, translation: scale(&apply(&rotation, &place), -1.0) };
            let [found, naive] = contours(&mesh, libm::exp(focal), &pose);
            prop_assert_eq!(found, naive);
        }

        /// Of what lies far from its own origin planes are less certain.
        #[test]
        fn rounding_is_allowed_for_as_far_as_camera_and_vertices_lie_from_the_origin(
            shift in proptest::array::uniform3(-900.0..900.0f32),
            angles in proptest::array::uniform3(-180.0..180.0f64),
            z_mm in -900.0..-150.0f64,
        ) {
            let (mut vertices, triangles) = fake::torus(&[0.0]);
            for vertex in &mut vertices {
                *vertex = core::array::from_fn(|k| vertex[k] + shift[k]);
            }
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let mut pose = Pose::from(EulerPose { z_rot_deg, x_rot_deg, y_rot_deg, ..EulerPose::default() });
            pose.translation = scale(&pose.transform(&mesh.bounds().centre), -1.0);
            pose.translation[2] += z_mm;
            let camera = Camera::new(64, 64, [300.0, 291.0], [31.0, 33.5]).expect("valid");
            let facing = FacingTest::new(&mesh, &camera, &pose, &Reach::of(&mesh.bounds(), &pose));
            let [.., rounding] = facing.margins.map(f64::from);
            let camera = norm(&facing.place.map(f64::from));
            for vertex in &vertices {
                let both = camera + norm(&vertex.map(f64::from));
                prop_assert!(rounding > f64::from(SINGLE) * both * 0.999_999);
            }
            let [found, naive] = contours(&mesh, 300.0, &pose);
            prop_assert_eq!(found, naive);
        }
    }

    #[test]
    fn edges_of_a_plate_edge_on_near_or_sheared_are_those_of_its_images() {
        let (vertices, triangles) = fake::plate();
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let turns = [0.0, 1e-7, 1e-4, 0.01, 0.2, 45.0, 89.999, 90.0];
        for (x_rot_deg, y_rot_deg) in turns.iter().flat_map(|&x| turns.map(|y| (x, y))) {
            for (z_mm, focal) in [(-5000.0, 9000.0), (-500.0, 20.0), (-21.5, 600.0)] {
                let mut pose = Pose::from(EulerPose {
                    x_mm: 1.7,
                    z_mm,
                    x_rot_deg,
                    y_rot_deg,
                    ..EulerPose::default()
                });
                let [found, naive] = contours(&mesh, focal, &pose);
                assert_eq!(found, naive, "{x_rot_deg} {y_rot_deg} {z_mm}");
                let [first, _, last] = pose.rotation;
                pose.rotation[0] = add(&first, &scale(&last, 0.3));
                let [found, naive] = contours(&mesh, focal, &pose);
                assert_eq!(found, naive, "{x_rot_deg} {y_rot_deg} {z_mm} bent");
            }
        }
    }
}
