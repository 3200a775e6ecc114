//! Nearest points of a surface to a few hundred points at once, without an index of the surface.

use super::sample::{BLOCK, GROUP, SAMPLES, Samples};
use super::triangle::{corners, normal};
use crate::math::{Vector3, add, dot, scale, sqrt, subtract};
use crate::mesh::surface::Mesh;

/// Points nearer to a triangle than this lie on it, mm: the direction to it is its normal.
const TINY: f64 = 1e-12;

/// The way from the nearest point of a surface to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    /// Square of its length, square mm.
    pub(super) squared: f64,
    /// Unit vector along it, of either sign; zero where no triangle gives one.
    pub(super) direction: Vector3,
    /// Its component along `direction`, mm.
    pub(super) along: f64,
}

impl Foot {
    /// Nothing found yet.
    pub(super) const NONE: Self = Self {
        squared: f64::INFINITY,
        direction: [0.0; 3],
        along: 0.0,
    };
}

/// The larger of two numbers that are not NaN; `f64::max` would look for NaN at twice the time.
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// A box with edges along the axes.
#[derive(Clone, Copy)]
struct Box3 {
    low: Vector3,
    high: Vector3,
}

impl Box3 {
    const NONE: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn round(points: &[Vector3]) -> Self {
        points
            .iter()
            .fold(Self::NONE, |Self { low, high }, point| Self {
                low: core::array::from_fn(|k| smaller(low[k], point[k])),
                high: core::array::from_fn(|k| larger(high[k], point[k])),
            })
    }

    /// Square of the least distance between points of two boxes.
    fn gap_squared(&self, other: &Self) -> f64 {
        let gap = |k: usize| {
            let apart = larger(self.low[k] - other.high[k], other.low[k] - self.high[k]);
            larger(apart, 0.0)
        };
        let gaps = [gap(0), gap(1), gap(2)];
        dot(&gaps, &gaps)
    }
}

/// Neighbouring points: a box around them, and the greatest square of the distances found so far.
#[derive(Clone, Copy)]
struct Cluster {
    bounds: Box3,
    reach: f64,
}

impl Cluster {
    const NONE: Self = Self {
        bounds: Box3::NONE,
        reach: 0.0,
    };

    fn of(points: &[Vector3], feet: &[Foot]) -> Self {
        Self {
            bounds: Box3::round(points),
            reach: farthest(feet.iter().map(|foot| foot.squared)),
        }
    }

    /// Whether something inside `bounds` may be nearer to one of the points.
    fn may_gain(&self, bounds: &Box3) -> bool {
        self.bounds.gap_squared(bounds) < self.reach
    }
}

fn farthest(squares: impl Iterator<Item = f64>) -> f64 {
    squares.fold(0.0, larger)
}

/// Finds the feet of `points` on the surface, exactly. Neighbours in the list of points must be
/// neighbours in space, as those of the samples are.
///
/// The triangle of the nearest sample bounds each search. Then every triangle is read once; boxes
/// around blocks and groups of points keep nearly all of them from nearly all points.
pub(super) fn feet(
    mesh: &Mesh<'_>,
    samples: &Samples,
    points: &[Vector3; SAMPLES],
    feet: &mut [Foot; SAMPLES],
) {
    for (point, foot) in points.iter().zip(feet.iter_mut()) {
        *foot = Foot::NONE;
        let triangle = &samples.triangles[nearest_sample(samples, point)];
        approach(point, &corners(mesh, triangle, &samples.origin), foot);
    }
    let mut blocks = [Cluster::NONE; SAMPLES / BLOCK];
    let mut groups = [Cluster::NONE; SAMPLES / GROUP];
    let parts = points.chunks_exact(BLOCK).zip(feet.chunks_exact(BLOCK));
    for (block, (points, feet)) in blocks.iter_mut().zip(parts) {
        *block = Cluster::of(points, feet);
    }
    let parts = points.chunks_exact(GROUP).zip(feet.chunks_exact(GROUP));
    for (group, (points, feet)) in groups.iter_mut().zip(parts) {
        *group = Cluster::of(points, feet);
    }
    for triangle in mesh.triangles() {
        let triangle = corners(mesh, triangle, &samples.origin);
        let bounds = Box3::round(&triangle);
        let groups = groups.chunks_exact_mut(BLOCK / GROUP);
        let parts = points.chunks_exact(BLOCK).zip(feet.chunks_exact_mut(BLOCK));
        for ((block, groups), (points, feet)) in blocks.iter_mut().zip(groups).zip(parts) {
            if block.may_gain(&bounds) && approach_block(points, &triangle, &bounds, groups, feet) {
                block.reach = farthest(groups.iter().map(|group| group.reach));
            }
        }
    }
}

/// Lets the points of a block look at one triangle; whether it was nearer to any of them.
fn approach_block(
    points: &[Vector3],
    triangle: &[Vector3; 3],
    bounds: &Box3,
    groups: &mut [Cluster],
    feet: &mut [Foot],
) -> bool {
    let mut gained = false;
    let parts = points.chunks_exact(GROUP).zip(feet.chunks_exact_mut(GROUP));
    for (group, (points, feet)) in groups.iter_mut().zip(parts) {
        if !group.may_gain(bounds) {
            continue;
        }
        let mut nearer = false;
        for (&point, foot) in points.iter().zip(feet.iter_mut()) {
            let here = Box3 {
                low: point,
                high: point,
            };
            if here.gap_squared(bounds) < foot.squared {
                nearer |= approach(&point, triangle, foot);
            }
        }
        if nearer {
            group.reach = farthest(feet.iter().map(|foot| foot.squared));
            gained = true;
        }
    }
    gained
}

/// Finds the feet of `points` on the tangent planes of the samples nearest to them.
pub(super) fn feet_on_tangents(
    samples: &Samples,
    points: &[Vector3; SAMPLES],
    feet: &mut [Foot; SAMPLES],
) {
    for (point, foot) in points.iter().zip(feet.iter_mut()) {
        let nearest = nearest_sample(samples, point);
        let direction = samples.normals[nearest];
        let along = dot(&direction, point) - dot(&direction, &samples.points[nearest]);
        *foot = Foot {
            squared: along * along,
            direction,
            along,
        };
    }
}

fn nearest_sample(samples: &Samples, point: &Vector3) -> usize {
    let mut least = f64::INFINITY;
    let mut nearest = 0;
    for (number, sample) in samples.points.iter().enumerate() {
        let offset = subtract(point, sample);
        let squared = dot(&offset, &offset);
        if squared < least {
            least = squared;
            nearest = number;
        }
    }
    nearest
}

/// Replaces the foot where the triangle is nearer, and says whether it is.
fn approach(point: &Vector3, triangle: &[Vector3; 3], foot: &mut Foot) -> bool {
    let (nearest, inside) = closest(point, triangle);
    let offset = subtract(point, &nearest);
    let squared = dot(&offset, &offset);
    // A NaN, of a triangle too thin for its arithmetic, is never nearer.
    let nearer = squared < foot.squared;
    if nearer {
        let length = sqrt(squared);
        let direction = if inside || length < TINY {
            normal(triangle)
        } else {
            scale(&offset, 1.0 / length)
        };
        *foot = Foot {
            squared,
            direction,
            along: dot(&offset, &direction),
        };
    }
    nearer
}

/// The point of a triangle that is nearest to `p`, and whether it lies off its edges.
///
/// By the Voronoi regions of corners and edges: Ericson, *Real-Time Collision Detection*,
/// section 5.1.5.
fn closest(p: &Vector3, &[a, b, c]: &[Vector3; 3]) -> (Vector3, bool) {
    let minus = |x: &Vector3, y: &Vector3| subtract(x, y);
    let (ab, ac) = (minus(&b, &a), minus(&c, &a));
    let ap = minus(p, &a);
    let (d1, d2) = (dot(&ab, &ap), dot(&ac, &ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, false);
    }
    let bp = minus(p, &b);
    let (d3, d4) = (dot(&ab, &bp), dot(&ac, &bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, false);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (add(&a, &scale(&ab, d1 / (d1 - d3))), false);
    }
    let cp = minus(p, &c);
    let (d5, d6) = (dot(&ab, &cp), dot(&ac, &cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, false);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (add(&a, &scale(&ac, d2 / (d2 - d6))), false);
    }
    let va = d3 * d6 - d5 * d4;
    let (from_b, from_c) = (d4 - d3, d5 - d6);
    if va <= 0.0 && from_b >= 0.0 && from_c >= 0.0 {
        let along = scale(&minus(&c, &b), from_b / (from_b + from_c));
        return (add(&b, &along), false);
    }
    let part = 1.0 / (va + vb + vc);
    let inside = add(&scale(&ab, vb * part), &scale(&ac, vc * part));
    (add(&a, &inside), true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::norm;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn point() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-10.0..10.0f64)
    }

    properties! {
        #[test]
        fn no_point_of_the_triangle_is_nearer(
            p in point(), triangle in prop::array::uniform3(point()),
            s in 0.0..1.0f64, t in 0.0..1.0f64
        ) {
            let (nearest, _) = closest(&p, &triangle);
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let weights = [1.0 - s - t, s, t];
            let other: Vector3 = core::array::from_fn(|k| {
                (0..3).map(|corner| weights[corner] * triangle[corner][k]).sum()
            });
            let away = |q: &Vector3| norm(&subtract(&p, q));
            prop_assert!(away(&nearest) <= away(&other) + 1e-9);
            // It is a point of the triangle: in its plane and not beyond its corners.
            let off = subtract(&nearest, &triangle[0]);
            prop_assert!(dot(&off, &normal(&triangle)).abs() < 1e-6);
        }
    }

    properties! {
        /// Ends are whole numbers, and so are the places that are nearest to each other.
        #[test]
        fn boxes_are_as_far_apart_as_their_nearest_places(
            ends in proptest::array::uniform4(proptest::array::uniform3(-5..5i32)),
        ) {
            let [a, b, c, d] = ends.map(|end| end.map(f64::from));
            let mut naive = 0;
            for k in 0..3 {
                let between = |a: [i32; 3], b: [i32; 3]| a[k].min(b[k])..=a[k].max(b[k]);
                let places = between(ends[0], ends[1])
                    .flat_map(|one| between(ends[2], ends[3]).map(move |other| one.abs_diff(other)));
                naive += places.min().map_or(0, |gap| gap * gap);
            }
            let (one, other) = (Box3::round(&[a, b]), Box3::round(&[c, d]));
            prop_assert_eq!(one.gap_squared(&other), f64::from(naive));
            prop_assert_eq!(other.gap_squared(&one), f64::from(naive));
            // What is nearer than the farthest foot may gain, what is as near may not.
            let cluster = |reach: f64| Cluster { bounds: one, reach };
            prop_assert!(!cluster(f64::from(naive)).may_gain(&other));
            prop_assert!(cluster(f64::from(naive) + 0.5).may_gain(&other));
        }
    }

    properties! {
        /// Of a point off the triangle the foot is the way itself, of one on it, whose way tells nothing, the normal.
        #[test]
        fn a_foot_is_the_way_from_the_nearest_point(
            triangle in prop::array::uniform3(point()), p in point(), weights in prop::array::uniform3(0u8..3),
        ) {
            prop_assume!(norm(&normal(&triangle)) > 0.0);
            let mut foot = Foot::NONE;
            prop_assert!(approach(&p, &triangle, &mut foot));
            let (nearest, _) = closest(&p, &triangle);
            let way = subtract(&p, &nearest);
            prop_assert!((foot.squared - dot(&way, &way)).abs() < 1e-9);
            prop_assert!((norm(&foot.direction) - 1.0).abs() < 1e-9);
            prop_assert!(norm(&subtract(&scale(&foot.direction, foot.along), &way)) < 1e-6);
            // It is not replaced by another that is no nearer.
            prop_assert!(!approach(&p, &triangle, &mut foot));

            // Corners, points of sides and of the inside.
            let whole = weights.map(f64::from).iter().sum::<f64>().max(1.0);
            let on: Vector3 = core::array::from_fn(|k| {
                (0..3).map(|corner| f64::from(weights[corner]) / whole * triangle[corner][k]).sum()
            });
            prop_assume!(weights != [0; 3]);
            let mut foot = Foot::NONE;
            approach(&on, &triangle, &mut foot);
            prop_assert!(foot.squared < 1e-12 && (norm(&foot.direction) - 1.0).abs() < 1e-9, "{:?}", foot);
            if foot.squared < TINY * TINY {
                prop_assert!((dot(&foot.direction, &normal(&triangle)).abs() - 1.0).abs() < 1e-9);
            }
        }
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        /// Oracle: every triangle for every point. Of images in any plane, and of ones all over the place.
        #[test]
        fn feet_are_those_of_every_triangle(
            vertices in prop::collection::vec(prop::array::uniform3(-50.0f32..50.0), 9..40),
            height in -30.0..30.0f64, spread in prop_oneof![Just(1.0), 0.1..4.0f64],
        ) {
            let triangles: Vec<[u32; 3]> = (2..vertices.len() as u32).map(|k| [k - 2, k - 1, k]).collect();
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let samples = Samples::new(&mesh).expect("it has an area");
            let images = samples.points.map(|[x, y, z]| [spread * x, spread * y, 2.0 * height - z]);
            let mut found = [Foot::NONE; SAMPLES];
            feet(&mesh, &samples, &images, &mut found);
            for (image, foot) in images.iter().zip(&found) {
                let mut expected = Foot::NONE;
                for triangle in &triangles {
                    approach(image, &corners(&mesh, triangle, &samples.origin), &mut expected);
                }
                // Of two triangles that share the place either may be asked: they differ by rounding.
                prop_assert!((foot.squared - expected.squared).abs() <= 1e-12 * expected.squared);
            }
            // On tangents: of the sample that is nearest.
            feet_on_tangents(&samples, &images, &mut found);
            for (image, foot) in images.iter().zip(&found) {
                let away = |number: &usize| norm(&subtract(image, &samples.points[*number]));
                let nearest = (0..SAMPLES).min_by(|a, b| away(a).total_cmp(&away(b))).expect("some");
                let along = dot(&samples.normals[nearest], &subtract(image, &samples.points[nearest]));
                prop_assert!((foot.along - along).abs() < 1e-9 && (foot.squared - along * along).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_triangle_without_area_is_its_edge() {
        let line = [[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let mut foot = Foot::NONE;
        approach(&[1.5, 3.0, 0.0], &line, &mut foot);
        assert!((foot.squared - 9.0).abs() < 1e-12);
        assert!((foot.along.abs() - 3.0).abs() < 1e-12);
        let spot = [[1.0, 1.0, 1.0]; 3];
        let mut foot = Foot::NONE;
        approach(&[1.0, 1.0, 3.0], &spot, &mut foot);
        assert_eq!(foot.squared, 4.0);
    }
}
