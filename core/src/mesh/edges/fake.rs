//! Closed surfaces for tests.

use super::{
    EdgeBox, EdgeGroup, Edges, LinkMemory, MeshEdge, PackMemory, PackedBox, PackedEdge,
    PackedEdges, PackedRim, RimEdge, link, link_needed, pack_edges, packed_needed, tightened,
};
use crate::mesh::{Mesh, Model, SurfaceMark};
use crate::pose::{EulerPose, Pose};
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

/// The edges of a mesh, owned.
pub(crate) struct Linked {
    boxes: Vec<EdgeBox>,
    groups: Vec<EdgeGroup>,
    rims: Vec<RimEdge>,
    mark: SurfaceMark,
}

impl Linked {
    pub(crate) fn new(mesh: &Mesh<'_>) -> Self {
        let needs = link_needed(mesh);
        let mut boxes = vec![EdgeBox::default(); needs.groups];
        let mut groups = vec![EdgeGroup::default(); needs.groups];
        let mut rims = vec![RimEdge::default(); needs.halves];
        let memory = LinkMemory {
            halves: &mut vec![MeshEdge::default(); needs.halves],
            numbers: &mut vec![0; needs.numbers],
            boxes: &mut boxes,
            groups: &mut groups,
            rims: &mut rims,
        };
        let (edges, _) = link(mesh, memory).expect("enough memory");
        let (boxes, groups, rims) = edges.parts();
        Self {
            boxes: boxes.to_vec(),
            groups: groups.to_vec(),
            rims: rims.to_vec(),
            mark: edges.mark(),
        }
    }

    pub(crate) fn edges(&self) -> Edges<'_> {
        Edges::new(&self.boxes, &self.groups, &self.rims, self.mark).expect("as many")
    }

    pub(crate) fn packed(&self) -> Packed {
        let needs = packed_needed(&self.edges());
        let mut packed = Packed {
            boxes: vec![[0.0; 10]; needs.boxes],
            edges: vec![[0; 4]; needs.edges],
            rims: vec![[0; 3]; needs.rims],
            tight: Vec::new(),
            mark: self.mark,
        };
        let memory = PackMemory {
            boxes: &mut packed.boxes,
            edges: &mut packed.edges,
            rims: &mut packed.rims,
        };
        let small = pack_edges(&self.edges(), memory).expect("enough memory");
        assert!(small.is_some(), "few vertices");
        packed.tight = tightened(&packed.boxes, &packed.edges);
        packed
    }

    /// The mesh that they are of, with them.
    pub(crate) fn model<'m>(&'m self, mesh: Mesh<'m>) -> Model<'m> {
        Model::with_edges(mesh, self.edges()).expect("its own")
    }
}

/// Packed edges of a mesh, owned.
pub(crate) struct Packed {
    boxes: Vec<PackedBox>,
    edges: Vec<PackedEdge>,
    rims: Vec<PackedRim>,
    tight: Vec<u8>,
    mark: SurfaceMark,
}

impl Packed {
    /// The same as a stream of bytes.
    pub(crate) fn tight_edges(&self) -> Edges<'_> {
        let (boxes, edges) = (self.boxes.len(), self.edges.len());
        let tight = PackedEdges::tight(&self.tight, boxes, edges, &self.rims);
        Edges::of_packed(tight, self.mark)
    }

    pub(crate) fn edges(&self) -> Edges<'_> {
        let packed = PackedEdges::new(&self.boxes, &self.edges, &self.rims);
        Edges::of_packed(packed.expect("as many"), self.mark)
    }
}

const ROUND: u32 = 12;
const TUBE: u32 = 7;

/// A torus, a closed surface that hides parts of itself, with dents; then a smaller one
/// within its hole, inside out.
pub(crate) fn torus(dents: &[f32]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (size, turned) in [(30.0f32, false), (11.0, true)] {
        let first = vertices.len() as u32;
        for k in 0..ROUND * TUBE {
            let around = (k / TUBE) as f32 / ROUND as f32 * core::f32::consts::TAU;
            let tube = (k % TUBE) as f32 / TUBE as f32 * core::f32::consts::TAU;
            let dent = 1.0 + 0.3 * dents[k as usize % dents.len()];
            let ((s, c), (ts, tc)) = (libm::sincosf(around), libm::sincosf(tube));
            let arm = size * (1.0 + 0.4 * dent * tc);
            vertices.push([arm * c, arm * s, 0.4 * size * dent * ts]);
        }
        let at = |i: u32, j: u32| first + i % ROUND * TUBE + j % TUBE;
        for (i, j) in (0..ROUND).flat_map(|i| (0..TUBE).map(move |j| (i, j))) {
            for [a, b, c] in [
                [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
                [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
            ] {
                triangles.push(if turned { [a, c, b] } else { [a, b, c] });
            }
        }
    }
    (vertices, triangles)
}

/// A plate of which many triangles lie in one plane, with slivers between them.
pub(crate) fn plate() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let columns = [-20.0f32, -19.999_99, -5.0, 3.0, 3.000_4, 20.0];
    let count = columns.len() as u32;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (y, z) in [(-9.0f32, -1.0f32), (9.0, -1.0), (9.0, 1.0), (-9.0, 1.0)] {
        vertices.extend(columns.map(|x| [x, y, z]));
    }
    for (side, k) in (0..4).flat_map(|side| (0..count - 1).map(move |k| (side, k))) {
        let [a, b] = [side, (side + 1) % 4].map(|side| side * count + k);
        triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    for (at, turned) in [(0, false), (count - 1, true)] {
        let [a, b, c, d] = [0, 1, 2, 3].map(|side| side * count + at);
        let caps = [[a, c, b], [a, d, c]];
        triangles.extend(caps.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }));
    }
    (vertices, triangles)
}

/// Appends a box between two opposite corners, its sides looking outwards.
pub(crate) fn add_box(
    low: [f32; 3],
    high: [f32; 3],
    vertices: &mut Vec<[f32; 3]>,
    triangles: &mut Vec<[u32; 3]>,
) {
    let first = vertices.len() as u32;
    let ends = [low, high];
    vertices.extend((0..8).map(|corner| core::array::from_fn(|k| ends[corner >> k & 1][k])));
    for [a, b, c, d] in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        let sides = [[a, b, c], [a, c, d]];
        triangles.extend(sides.map(|side| side.map(|corner| first + corner)));
    }
}

/// Appends what an outline in x and z leaves between two heights along y. Its corners alone are vertices, and all of it is seen from its first.
pub(crate) fn add_prism(
    outline: &[[f32; 2]],
    heights: [f32; 2],
    vertices: &mut Vec<[f32; 3]>,
    triangles: &mut Vec<[u32; 3]>,
) {
    let (first, count) = (vertices.len() as u32, outline.len() as u32);
    for y in heights {
        vertices.extend(outline.iter().map(|&[x, z]| [x, y, z]));
    }
    for end in [0, count] {
        triangles.extend((2..count).map(|k| [0, k - 1, k].map(|corner| first + end + corner)));
    }
    for k in 0..count {
        let [a, b] = [k, (k + 1) % count].map(|corner| first + corner);
        triangles.extend([[a, b, a + count], [b, b + count, a + count]]);
    }
}

/// The outline of an ellipse for [`add_prism`], from its middle and half axes along x and z.
pub(crate) fn ellipse([x, z]: [f32; 2], [a, b]: [f32; 2]) -> Vec<[f32; 2]> {
    let place = |step: u8| {
        let (sin, cos) = libm::sincosf(core::f32::consts::TAU * f32::from(step) / 32.0);
        [x + a * cos, z + b * sin]
    };
    (0..32).map(place).collect()
}

/// Poses of any turn, moved by up to so much along each axis, mm.
pub(crate) fn placed_within(mm: f64) -> impl Strategy<Value = Pose> {
    let angle = -180.0..180.0f64;
    let shift = proptest::array::uniform3(-mm..mm);
    (angle.clone(), -90.0..90.0f64, angle, shift).prop_map(|(z, x, y, [right, up, away])| {
        Pose::from(EulerPose {
            x_mm: right,
            y_mm: up,
            z_mm: away,
            z_rot_deg: z,
            x_rot_deg: x,
            y_rot_deg: y,
        })
    })
}
