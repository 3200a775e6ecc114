//! Which edges may be on the contour that a camera sees, without looking at each.
//!
//! A triangle whose plane is `n . x = c` faces a camera at `o` where `n . o - c` has one sign, and
//! that is linear in `(n, c)`, the triangle's point in dual space (Hertzmann and Zorin, *Illustrating
//! Smooth Surfaces*, SIGGRAPH 2000). Edges whose triangles are near each other there are kept
//! together: where a box around their points lies on one side, none of them is on the contour.

use super::edge::MeshEdge;
use crate::math::{Vector3, cross, dot, norm, scale, sqrt, subtract};
use crate::mesh::Mesh;

/// Edges in a box.
pub(crate) const IN_BOX: usize = 16;
/// A box's ten numbers as 16 bits each, little-endian.
pub(super) type Halves = [[u8; 2]; 10];

/// Cosine of the angle between the normals of an edge's two triangles beyond which they count as far apart.
const SHARP: f64 = 0.9;
/// A triangle with a height below this, mm, is a sliver: its facing is decided from its vertices.
const SLIVER_MM: f64 = 0.01;

/// A box around the duals of the triangles beside some edges. Only [`super::link()`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeBox {
    /// Of unit normals, and of distances of planes from the model's origin, mm: the middle, and how far they are from it.
    pub(crate) middle: [f32; 4],
    pub(crate) reach: [f32; 4],
    /// Greatest reciprocal of a triangle's least height, 1/mm, and of its doubled area, 1/mm^2.
    pub(crate) thin: f32,
    pub(crate) small: f32,
}

/// The edges in a box. Only [`super::link()`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeGroup {
    /// Of the triangle forth of each edge, then of that back: the four numbers of its dual.
    pub(crate) duals: [[[f32; IN_BOX]; 4]; 2],
    /// The last of a surface may be fewer; the others have triangles without area.
    edges: [MeshEdge; IN_BOX],
}

impl EdgeGroup {
    pub(crate) fn edge(&self, number: usize) -> Option<&MeshEdge> {
        self.edges.get(number)
    }

    /// The edges of the group, without its padding.
    pub(crate) fn edges(&self) -> impl Iterator<Item = MeshEdge> + use<> {
        let there = |edge: &MeshEdge| edge.from != edge.to;
        self.edges.into_iter().filter(there)
    }
}

/// What a triangle adds to a box.
struct Dual {
    /// Of a triangle without area, zeros.
    point: [f64; 4],
    thin: f64,
    small: f64,
}

impl Dual {
    fn of(mesh: &Mesh<'_>, triangle: [u32; 3]) -> Self {
        let [a, b, c] = triangle.map(|vertex| place(mesh.vertices(), vertex));
        let sides = [subtract(&b, &a), subtract(&c, &b), subtract(&a, &c)];
        let longest = sides.iter().map(norm).fold(0.0, f64::max);
        let normal = cross(&sides[0], &sides[1]);
        let doubled = norm(&normal);
        let [x, y, z] = if doubled > 0.0 {
            scale(&normal, 1.0 / doubled)
        } else {
            [0.0; 3]
        };
        Self {
            point: [x, y, z, dot(&[x, y, z], &a)],
            thin: longest / doubled,
            small: 1.0 / doubled,
        }
    }

    fn beside(mesh: &Mesh<'_>, edge: &MeshEdge) -> [Self; 2] {
        let &MeshEdge { from, to, .. } = edge;
        [[from, to, edge.forth], [to, from, edge.back]].map(|triangle| Self::of(mesh, triangle))
    }
}

fn place(vertices: &[[f32; 3]], vertex: u32) -> Vector3 {
    // Indices were checked when the mesh was made.
    let vertex = vertices.get(vertex as usize).copied().unwrap_or_default();
    vertex.map(f64::from)
}

/// Brings edges together that are near each other in dual space, and writes their groups.
pub(crate) fn gather(
    mesh: &Mesh<'_>,
    edges: &mut [MeshEdge],
    boxes: &mut [EdgeBox],
    groups: &mut [EdgeGroup],
) {
    let reach = sqrt(3.0) * mesh.bounds().radius + norm(&mesh.bounds().centre);
    for edge in &mut *edges {
        edge.order = order(&Dual::beside(mesh, edge), reach);
    }
    edges.sort_unstable_by_key(|edge| (edge.order, edge.from, edge.to, edge.forth));
    let places = boxes.iter_mut().zip(groups);
    for ((bounds, group), edges) in places.zip(edges.chunks(IN_BOX)) {
        *group = EdgeGroup::default();
        *bounds = EdgeBox::round(edges.iter().flat_map(|edge| Dual::beside(mesh, edge)));
        for (at, edge) in edges.iter().enumerate() {
            let duals = Dual::beside(mesh, edge);
            group.edges[at] = *edge;
            group.edges[at].keep_needs(needs(&duals));
            for (dual, lanes) in duals.iter().zip(&mut group.duals) {
                for (lane, &x) in lanes.iter_mut().zip(&dual.point) {
                    lane[at] = x as f32;
                }
            }
        }
    }
}

/// What both triangles beside an edge need of a margin: reciprocals of the least height and of the doubled area.
fn needs([a, b]: &[Dual; 2]) -> [f32; 2] {
    let greater = |a: f64, b: f64| if a >= b { a } else { b };
    [greater(a.thin, b.thin), greater(a.small, b.small)].map(|need| need as f32)
}

/// Sorts by likeness of normals, then of planes; edges whose box would be large whatever is beside them
/// come last. `reach` is no less than the distance of any plane from the origin.
fn order([a, b]: &[Dual; 2], reach: f64) -> u32 {
    let sum: [f64; 4] = core::array::from_fn(|k| a.point[k] + b.point[k]);
    let alike: f64 = (0..3).map(|k| a.point[k] * b.point[k]).sum();
    let awkward = alike < SHARP || a.thin.max(b.thin) > 1.0 / SLIVER_MM;
    let [right, up] = unfolded([sum[0], sum[1], sum[2]]);
    let level = |value: f64, bits: u32| (value.clamp(0.0, 1.0) * f64::from((1 << bits) - 1)) as u32;
    let direction = spread(level(right, 10)) | spread(level(up, 10)) << 1;
    let along = level(0.5 + sum[3] / (4.0 * reach), 11);
    u32::from(awkward) << 31 | direction << 11 | along
}

/// A direction as a point of the unit square (the octahedral map of Meyer et al., *On
/// Floating-Point Normal Vectors*, EGSR 2010).
fn unfolded([x, y, z]: Vector3) -> [f64; 2] {
    let length = (x.abs() + y.abs() + z.abs()).max(f64::MIN_POSITIVE);
    let (x, y) = (x / length, y / length);
    let signed = |value: f64, sign: f64| if sign < 0.0 { -value } else { value };
    let (x, y) = if z < 0.0 {
        (signed(1.0 - y.abs(), x), signed(1.0 - x.abs(), y))
    } else {
        (x, y)
    };
    [x, y].map(|value| (value + 1.0) / 2.0)
}

/// Ten bits with a gap after each (Morton's order).
fn spread(bits: u32) -> u32 {
    (0..10).fold(0, |sum, k| sum | (bits >> k & 1) << (2 * k))
}

impl EdgeBox {
    /// All of it, to be packed.
    pub(super) fn numbers(&self) -> [f32; 10] {
        let Self {
            middle: [a, b, c, d],
            reach: [e, f, g, h],
            thin,
            small,
        } = *self;
        [a, b, c, d, e, f, g, h, thin, small]
    }

    /// What [`Self::numbers`] gave.
    pub(super) fn of_numbers(&[a, b, c, d, e, f, g, h, thin, small]: &[f32; 10]) -> Self {
        Self {
            middle: [a, b, c, d],
            reach: [e, f, g, h],
            thin,
            small,
        }
    }

    /// A box around this one whose numbers are the upper halves of such of 32 bits.
    #[cfg(any(feature = "alloc", test))]
    pub(super) fn halves(&self) -> Halves {
        let mut halves = self.numbers().map(upper_half);
        let (middle, others) = halves.split_at_mut(4);
        for (k, middle) in middle.iter().enumerate() {
            let moved = (self.middle[k] - whole(*middle)).abs();
            // The sum may be rounded down.
            others[k] = half_above((self.reach[k] + moved).next_up());
        }
        others[4] = half_above(self.thin);
        others[5] = half_above(self.small);
        halves.map(u16::to_le_bytes)
    }

    /// What [`Self::halves`] gave.
    #[inline(always)]
    pub(super) fn of_halves(halves: &Halves) -> Self {
        // One after the other: of an iterator some compilers leave a loop.
        let number = |at: usize| whole(u16::from_le_bytes(halves[at]));
        Self {
            middle: [number(0), number(1), number(2), number(3)],
            reach: [number(4), number(5), number(6), number(7)],
            thin: number(8),
            small: number(9),
        }
    }

    /// The smallest box that holds some triangles.
    fn round(duals: impl Iterator<Item = Dual>) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
        let (mut thin, mut small) = (0f32, 0f32);
        for dual in duals {
            for ((low, high), &x) in low.iter_mut().zip(&mut high).zip(&dual.point) {
                *low = low.min(x as f32);
                *high = high.max(x as f32);
            }
            thin = thin.max(dual.thin as f32);
            small = small.max(dual.small as f32);
        }
        let middle: [f32; 4] = core::array::from_fn(|k| (low[k] + high[k]) / 2.0);
        Self {
            middle,
            reach: core::array::from_fn(|k| (high[k] - middle[k]).max(middle[k] - low[k])),
            thin,
            small,
        }
    }
}

/// The upper half of a number's bits.
#[cfg(any(feature = "alloc", test))]
fn upper_half(number: f32) -> u16 {
    (number.to_bits() >> 16) as u16
}

/// The upper half of the least such number that is no less than one from 0 on.
#[cfg(any(feature = "alloc", test))]
fn half_above(number: f32) -> u16 {
    let half = upper_half(number);
    half + u16::from(whole(half) < number)
}

/// The number whose upper half is this, the lower one zero.
#[inline(always)]
fn whole(half: u16) -> f32 {
    f32::from_bits(u32::from(half) << 16)
}

#[cfg(test)]
mod tests;
