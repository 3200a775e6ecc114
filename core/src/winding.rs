//! The silhouette of a closed surface from its silhouette edges.
//!
//! The triangles that face the camera bound each other but where one that faces it meets one that
//! does not: the sides there, run as the facing triangle runs them, are the boundary of the
//! facing part, and its winding number about a pixel's centre is the number of facing triangles
//! that cover it. The surface is closed, so as many that face away cover it too: the pixels of
//! winding number above zero are those that any triangle covers. Facing is decided by the sign of
//! the area between the rounded vertices, and crossings are those of the scan conversion, so this
//! holds exactly.

use crate::edges::MeshEdge;
use crate::mask::MaskMut;
use crate::mesh::Mesh;
use crate::scan::{Edge, FixedPoint};

/// Crossings of edges and rows and silhouette edges for which there is room at least.
const CROSSINGS: usize = 12_288;

/// Triangles of which one place of working memory tells whether they face the camera.
const TOLD: usize = 64;

/// In place of the number of silhouette edges where the surface was not drawn from them.
const NONE: u64 = u64::MAX;

/// Working memory of [`fill`].
pub(crate) fn room_needed(mesh: &Mesh<'_>) -> usize {
    1 + facing_needed(mesh.triangles()) + CROSSINGS.max(mesh.vertices().len())
}

fn facing_needed(triangles: &[[u32; 3]]) -> usize {
    triangles.len().div_ceil(TOLD)
}

/// Adds the silhouette of a closed surface to `out`. Gives `false`, and has drawn nothing, where
/// the room does not hold all crossings. Afterwards [`contour`] tells the edges from `room`.
pub(crate) fn fill(
    triangles: &[[u32; 3]],
    edges: &[MeshEdge],
    projected: &[FixedPoint],
    room: &mut [FixedPoint],
    out: &mut MaskMut<'_>,
) -> bool {
    let Some((told, room)) = room.split_first_mut() else {
        return false;
    };
    *told = NONE.into();
    let Some((facing, room)) = room.split_at_mut_checked(facing_needed(triangles)) else {
        return false;
    };
    tell_facing(triangles, projected, facing);
    let Some(count) = find_contour(edges, facing, room) else {
        return false;
    };
    let (crossings, contour) = room.split_at_mut(room.len() - count);
    let size = (out.width(), out.height());
    let edges = contour.iter().filter_map(|&kept| Kept::of(kept, edges));
    let Some(crossed) = find_crossings(edges, projected, size, crossings) else {
        return false;
    };
    let crossings = crossings.get_mut(..crossed).unwrap_or_default();
    crossings.sort_unstable_by_key(|&crossing| u64::from(crossing));
    fill_between(crossings, out);
    *told = (count as u64).into();
    true
}

/// The edges between triangles that face the camera and those that do not, from working memory as
/// [`fill`] left it; nothing where it did not draw. Each is a pair of vertices in the direction of
/// the triangle that faces the camera: at a vertex as many begin as end.
pub(crate) fn contour<'r>(
    edges: &'r [MeshEdge],
    room: &'r [FixedPoint],
) -> Option<impl Iterator<Item = [u32; 2]> + use<'r>> {
    let count = u64::from(*room.first()?);
    let first = room.len().checked_sub(usize::try_from(count).ok()?)?;
    let kept = room.get(first..)?.iter();
    Some(kept.filter_map(|&kept| {
        let Kept { edge, forth } = Kept::of(kept, edges)?;
        Some(if forth {
            [edge.from, edge.to]
        } else {
            [edge.to, edge.from]
        })
    }))
}

/// A silhouette edge in working memory.
struct Kept<'e> {
    edge: &'e MeshEdge,
    /// Whether its triangle forth is the one that faces the camera.
    forth: bool,
}

impl<'e> Kept<'e> {
    fn of(kept: FixedPoint, edges: &'e [MeshEdge]) -> Option<Self> {
        let bits = u64::from(kept);
        let edge = edges.get((bits >> 1) as usize)?;
        Some(Self {
            edge,
            forth: bits & 1 == 1,
        })
    }
}

/// A bit for each triangle: whether it faces the camera, or a surface that is inside out faces
/// away from it.
fn tell_facing(triangles: &[[u32; 3]], projected: &[FixedPoint], facing: &mut [FixedPoint]) {
    for (told, group) in facing.iter_mut().zip(triangles.chunks(TOLD)) {
        let mut bits = 0u64;
        for (bit, triangle) in group.iter().enumerate() {
            // Indices were checked when the mesh was made.
            let corners = triangle.map(|v| projected.get(v as usize).copied().unwrap_or_default());
            bits |= u64::from(FixedPoint::doubled_area(corners) > 0) << bit;
        }
        *told = bits.into();
    }
}

fn faces(facing: &[FixedPoint], triangle: u32) -> bool {
    let told = facing.get(triangle as usize / TOLD).copied();
    u64::from(told.unwrap_or_default()) >> (triangle as usize % TOLD) & 1 == 1
}

/// Keeps the silhouette edges at the end of `room`: their number, or nothing where there is no
/// room for all.
fn find_contour(
    edges: &[MeshEdge],
    facing: &[FixedPoint],
    room: &mut [FixedPoint],
) -> Option<usize> {
    let mut free = room.len();
    for (index, edge) in edges.iter().enumerate() {
        let forth = faces(facing, edge.forth);
        if forth == faces(facing, edge.back) {
            continue;
        }
        free = free.checked_sub(1)?;
        *room.get_mut(free)? = ((index as u64) << 1 | u64::from(forth)).into();
    }
    Some(room.len() - free)
}

/// Where silhouette edges cross the rows of the frame: their number, or nothing where there is no
/// room for all.
fn find_crossings<'e>(
    edges: impl Iterator<Item = Kept<'e>>,
    projected: &[FixedPoint],
    (width, height): (usize, usize),
    crossings: &mut [FixedPoint],
) -> Option<usize> {
    let mut count = 0;
    for Kept { edge, forth } in edges {
        let end = |vertex: u32| projected.get(vertex as usize).copied().unwrap_or_default();
        let (from, to) = (end(edge.from), end(edge.to));
        // Facing triangles are run clockwise: what is run upwards has them to its right.
        let enters = to.is_above(from) == forth;
        let edge = Edge::new(from, to);
        for row in edge.rows(height) {
            let column = edge.column_at(row).clamp(0, width as i64) as usize;
            *crossings.get_mut(count)? = crossing(row, column, enters);
            count += 1;
        }
    }
    Some(count)
}

/// In the order of rows and columns; where several meet, those that enter come first.
fn crossing(row: usize, column: usize, enters: bool) -> FixedPoint {
    ((row as u64) << 32 | (column as u64) << 1 | u64::from(!enters)).into()
}

/// Fills the spans of sorted crossings in which the winding number is not zero.
fn fill_between(crossings: &[FixedPoint], out: &mut MaskMut<'_>) {
    let (mut winding, mut start) = (0, 0);
    for &crossing in crossings {
        let bits = u64::from(crossing);
        let (row, column) = ((bits >> 32) as usize, i64::from(bits as u32 >> 1));
        if winding == 0 {
            start = column;
        }
        winding += if bits & 1 == 0 { 1 } else { -1 };
        if winding == 0 {
            out.fill_span(row, start, column);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::edges::{edges_needed, link};
    use crate::mask::{Word, words_needed};
    use crate::pose::{EulerPose, Pose};
    use crate::raster::{Projected, render, scratch_needed};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    const SIDE: usize = 96;
    const ROUND: u32 = 12;
    const TUBE: u32 = 7;

    /// A torus, a closed surface that hides parts of itself, with dents; then a smaller one
    /// within its hole, inside out.
    fn surface(dents: &[f32]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
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

    fn draw(mesh: &Mesh<'_>, pose: &Pose) -> Vec<Word> {
        let camera = Camera::new(SIDE, SIDE, [600.0, 580.0], [47.0, 49.5]).expect("valid");
        let mut words = vec![0; words_needed(SIDE, SIDE)];
        let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let mut scratch = vec![Projected::default(); scratch_needed(mesh)];
        render(mesh, &camera, pose, &mut scratch, &mut out).expect("in front");
        words
    }

    proptest! {
        #[test]
        fn edges_draw_what_triangles_draw(
            dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-40.0..40.0f64),
        ) {
            let (vertices, triangles) = surface(&dents);
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let mut room = vec![MeshEdge::default(); edges_needed(&mesh)];
            let edges = link(&mesh, &mut room).expect("closed");
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let [x_mm, y_mm, nearer] = place;
            let pose = Pose::from(EulerPose {
                x_mm, y_mm, z_mm: nearer - 500.0, z_rot_deg, x_rot_deg, y_rot_deg
            });
            prop_assert_eq!(draw(&mesh, &pose), draw(&mesh.with_edges(edges), &pose));
        }
    }

    #[test]
    fn without_room_for_the_crossings_triangles_are_drawn() {
        let (vertices, triangles) = surface(&[0.0]);
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let mut room = vec![MeshEdge::default(); edges_needed(&mesh)];
        let edges = link(&mesh, &mut room).expect("closed");
        let projected = vec![FixedPoint::default(); vertices.len()];
        let mut words = vec![0; words_needed(SIDE, SIDE)];
        let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        assert!(!fill(&triangles, edges, &projected, &mut [], &mut out));
    }
}
