//! Triangles by where they lie on the part: what is asked of a few pixels passes over most of them.

use core::ops::Range;

use crate::camera::Camera;
use crate::math::{Vector3, dot};
use crate::pose::Pose;

/// Triangles in a group: of fewer more would be asked, of more fewer passed over.
const IN_GROUP: usize = 16;
/// What rounding may add to where a corner's image is, pixels; it is thousandths.
const ROUNDED_PX: f64 = 1.0;
/// Farther from the frame's corner than any image of a corner.
const FAR_PX: f64 = 1_048_576.0;

/// Triangles that lie near each other, and a ball around them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleGroup {
    /// Model coordinates, mm.
    middle: [f32; 3],
    /// No corner is farther from the middle, mm.
    radius: f32,
    /// The last group of a surface may have fewer; the others are one corner thrice, which nothing lies across.
    triangles: [[u32; 3]; IN_GROUP],
}

impl TriangleGroup {
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Columns and rows between which all its images are; `None` where the ball reaches the focus.
    #[inline]
    pub(crate) fn image(&self, camera: &Camera, pose: &Pose) -> Option<[Range<i32>; 2]> {
        let middle = self.middle.map(f64::from);
        let [x, y, z]: Vector3 =
            core::array::from_fn(|k| dot(&pose.rotation[k], &middle) + pose.translation[k]);
        let radius = f64::from(self.radius);
        let near = -z - radius;
        if near <= 0.0 {
            return None;
        }
        let (nearer, farther) = (1.0 / near, 1.0 / (radius - z));
        let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
        // The least and the greatest tangent of a box around the ball.
        let range = |aside: f64, focal: f64, principal: f64| {
            let [low, high] = [aside - radius, aside + radius];
            let low = low * if low < 0.0 { nearer } else { farther };
            let high = high * if high > 0.0 { nearer } else { farther };
            let first = principal + focal * low - ROUNDED_PX;
            let last = principal + focal * high + ROUNDED_PX;
            // Rounded down and up, or farther.
            let pixel = |x: f64| x.clamp(-FAR_PX, FAR_PX) as i32;
            pixel(first - 1.0)..pixel(last + 2.0)
        };
        Some([range(x, fx, cx), range(-y, fy, cy)])
    }
}

#[cfg(feature = "alloc")]
mod gathered {
    use alloc::vec::Vec;

    use super::{IN_GROUP, TriangleGroup};
    use crate::math::{norm, subtract};
    use crate::mesh::surface::Mesh;

    impl TriangleGroup {
        /// All triangles of a surface.
        pub(in crate::mesh) fn all(mesh: &Mesh<'_>) -> Vec<Self> {
            let place = Places::of(mesh);
            let triangles = mesh.triangles().iter();
            let mut order: Vec<(u32, [u32; 3])> = triangles
                .map(|triangle| (place.number(triangle), *triangle))
                .collect();
            order.sort_unstable();
            let of_some = |some: &[(u32, [u32; 3])]| Self::around(mesh, some);
            order.chunks(IN_GROUP).map(of_some).collect()
        }

        fn around(mesh: &Mesh<'_>, some: &[(u32, [u32; 3])]) -> Self {
            let first = some.first().map_or(0, |(_, triangle)| triangle[0]);
            let mut triangles = [[first; 3]; IN_GROUP];
            for (to, (_, triangle)) in triangles.iter_mut().zip(some) {
                *to = *triangle;
            }
            let corners = || triangles.iter().flatten().map(|&corner| at(mesh, corner));
            let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
            for corner in corners() {
                for ((low, high), x) in low.iter_mut().zip(&mut high).zip(corner) {
                    (*low, *high) = (low.min(x), high.max(x));
                }
            }
            let middle: [f32; 3] = core::array::from_fn(|k| low[k].midpoint(high[k]));
            let away =
                |corner: [f32; 3]| norm(&subtract(&corner.map(f64::from), &middle.map(f64::from)));
            let radius = corners().map(away).fold(0.0, f64::max) as f32;
            Self {
                middle,
                radius: radius.next_up(),
                triangles,
            }
        }
    }

    fn at(mesh: &Mesh<'_>, corner: u32) -> [f32; 3] {
        let corner = mesh.vertices().get(corner as usize);
        corner.copied().unwrap_or_default()
    }

    /// Numbers of places that are near each other where these are (Morton's order).
    struct Places<'m> {
        mesh: &'m Mesh<'m>,
        lowest: f64,
        steps: f64,
    }

    const BITS: u32 = 10;

    impl<'m> Places<'m> {
        fn of(mesh: &'m Mesh<'m>) -> Self {
            let radius = mesh.bounds().radius;
            let steps = f64::from(1u32 << BITS) / (2.0 * radius).max(f64::MIN_POSITIVE);
            Self {
                mesh,
                lowest: -radius,
                steps,
            }
        }

        fn number(&self, triangle: &[u32; 3]) -> u32 {
            let corners = triangle.map(|corner| at(self.mesh, corner).map(f64::from));
            let last = f64::from((1u32 << BITS) - 1);
            let along = |k: usize| {
                let middle = corners.iter().map(|corner| corner[k]).sum::<f64>() / 3.0;
                let away = middle - self.mesh.bounds().centre[k] - self.lowest;
                (away * self.steps).clamp(0.0, last) as u32
            };
            (0..3).map(|k| spread(along(k)) << k).sum()
        }
    }

    /// Bits with two gaps after each.
    fn spread(bits: u32) -> u32 {
        (0..BITS).fold(0, |sum, k| sum | (bits >> k & 1) << (3 * k))
    }
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::edges::fake;
    use crate::pose::EulerPose;
    use crate::render::{Projected, project};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    fn camera() -> Camera {
        Camera::new(640, 400, [1500.0, 1480.0], [127.3, 229.1]).expect("valid")
    }

    properties! {
        /// Every triangle is in one group, and has no corner's image outside of its columns and rows, wherever the part is.
        #[test]
        fn a_group_says_where_the_images_of_its_triangles_are(
            halves in proptest::array::uniform3(0.5..40.0f32),
            count in 1usize..400,
            turn in proptest::array::uniform3(-180.0..180.0f64),
            [x, y] in proptest::array::uniform2(-300.0..300.0f64),
            z in -1500.0..-110.0f64,
        ) {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            let mut corner = halves.map(|x| -x);
            for k in 0..count.div_ceil(12) {
                let next = core::array::from_fn(|axis| corner[axis] + 0.1 + ((k * (axis + 2)) % 7) as f32);
                fake::add_box(corner, next, &mut vertices, &mut triangles);
                corner = core::array::from_fn(|axis| -halves[axis] + ((k * 37 * (axis + 1)) % 53) as f32 / 53.0 * halves[axis]);
            }
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let [z_rot_deg, x_rot_deg, y_rot_deg] = turn;
            let pose = Pose::from(EulerPose { x_mm: x, y_mm: y, z_mm: z, z_rot_deg, x_rot_deg, y_rot_deg });
            let mut images = vec![Projected::default(); vertices.len()];
            prop_assume!(project(&mesh, &camera(), &pose, &mut images).is_ok());
            let groups = TriangleGroup::all(&mesh);
            let is_padding = |[a, b, c]: &[u32; 3]| a == b && b == c;
            let mut found: Vec<[u32; 3]> = groups.iter().flat_map(|group| group.triangles()).copied().filter(|one| !is_padding(one)).collect();
            found.sort_unstable();
            let mut all = triangles.clone();
            all.sort_unstable();
            prop_assert_eq!(found, all);
            for group in &groups {
                let Some(image) = group.image(&camera(), &pose) else { continue };
                for corner in group.triangles().iter().flatten() {
                    let pixel = images[*corner as usize].units().map(|x| (x / 4096.0).floor() as i32);
                    prop_assert!(image.iter().zip(pixel).all(|(range, at)| range.contains(&at)), "{:?} {:?}", image, pixel);
                }
            }
        }
    }

    /// A ball is no larger than what it is around, and one that reaches the focus says nothing.
    #[test]
    fn a_group_of_a_small_part_is_small() {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        fake::add_box([-1.0; 3], [1.0; 3], &mut vertices, &mut triangles);
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let groups = TriangleGroup::all(&mesh);
        assert_eq!(groups.len(), 1);
        let at = |z_mm: f64| {
            let pose = Pose::from(EulerPose {
                z_mm,
                ..EulerPose::default()
            });
            groups[0].image(&camera(), &pose)
        };
        // Corners are 1.73 mm off, and two pixels are for rounding.
        let [columns, rows] = at(-1000.0).expect("in front");
        assert!(columns.start > 121 && columns.end < 135, "{columns:?}");
        assert!(rows.start > 222 && rows.end < 236, "{rows:?}");
        assert!(at(-1.7).is_none() && at(-1.8).is_some() && at(5.0).is_none());
    }

    #[test]
    fn numbers_of_near_places_are_near() {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in 0..64u8 {
            let low = [k % 4, k / 4 % 4, k / 16].map(|x| 10.0 * f32::from(x));
            fake::add_box(low, low.map(|x| x + 1.0), &mut vertices, &mut triangles);
        }
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let groups = TriangleGroup::all(&mesh);
        // Twelve triangles a box: a group of sixteen has those of two neighbours, or where a number's higher bits change of farther ones.
        let near = groups.iter().filter(|group| group.radius < 9.0).count();
        assert!(4 * near > 3 * groups.len(), "{near} of {}", groups.len());
    }
}
