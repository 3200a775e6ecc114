//! A model that owns its memory, for callers that have an allocator.

use alloc::vec;
use alloc::vec::Vec;

use crate::mesh::edges::{
    EdgeBox, EdgeGroup, Edges, LinkMemory, MeshEdge, RimEdge, SurfaceFaults, link, link_needed,
    turn,
};
use crate::mesh::model::Model;
use crate::mesh::revolution::Revolution;
use crate::mesh::surface::{Bounds, Mesh, MeshError, SurfaceMark};
use crate::mesh::symmetry::revolution;

/// Vertices, triangles and the edges that silhouettes are drawn from.
///
/// It keeps the two vectors that it was given and reads them three numbers at a time. Triangles that run against their neighbours are
/// turned: a ray's path through the part is a sum over those that it enters and leaves by.
#[derive(Clone, Debug)]
pub struct OwnedModel {
    vertices: Vec<f32>,
    triangles: Vec<u32>,
    bounds: Bounds,
    edges: OwnedEdges,
    faults: SurfaceFaults,
    revolution: Option<Revolution>,
}

#[derive(Clone, Debug)]
struct OwnedEdges {
    boxes: Vec<EdgeBox>,
    groups: Vec<EdgeGroup>,
    rims: Vec<RimEdge>,
    mark: SurfaceMark,
}

impl OwnedModel {
    /// Takes vertices (x, y and z of each, mm) and triangles (three vertex numbers each). One or two numbers left over at
    /// the end of either are not read. Vertices of no triangle, as those of another part in the same list, are left out: they are
    /// nowhere on the surface, and would be of its size and shape.
    ///
    /// # Errors
    /// [`MeshError`] names the vertex or triangle at fault.
    pub fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Self, MeshError> {
        let drawn = Self::drawn(vertices, triangles)?;
        let revolution = revolution(drawn.as_model().mesh());
        Ok(Self {
            revolution,
            ..drawn
        })
    }

    /// The same of a model that is drawn and nothing else: whether it is round is not looked at, which uncertainties and remarks have to know.
    ///
    /// # Errors
    /// As for [`OwnedModel::new`].
    pub fn drawn(mut vertices: Vec<f32>, mut triangles: Vec<u32>) -> Result<Self, MeshError> {
        Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0)?;
        leave_out_strays(&mut vertices, triangles.as_chunks_mut().0);
        let mesh = Mesh::new(vertices.as_chunks().0, triangles.as_chunks().0)?;
        let bounds = mesh.bounds();
        let (mut edges, faults, mut numbers) = linked(&mesh);
        if faults.flipped > 0 {
            let corners = vertices.as_chunks().0;
            let given = triangles.as_chunks_mut().0;
            turn(corners.len(), &mut numbers, given);
            edges = linked(&Mesh::checked(corners, given, bounds)).0;
        }
        Ok(Self {
            vertices,
            triangles,
            bounds,
            edges,
            faults,
            revolution: None,
        })
    }

    /// What was found wrong with the surface as it was given; nothing of it changes what is drawn.
    #[must_use]
    pub fn faults(&self) -> SurfaceFaults {
        self.faults
    }

    /// The model, borrowed.
    #[must_use]
    pub fn as_model(&self) -> Model<'_> {
        let mesh = Mesh::checked(
            self.vertices.as_chunks().0,
            self.triangles.as_chunks().0,
            self.bounds,
        );
        let OwnedEdges {
            boxes,
            groups,
            rims,
            mark,
        } = &self.edges;
        let model = match Edges::new(boxes, groups, rims, *mark) {
            Some(edges) => Model::linked(mesh, edges),
            None => Model::new(mesh),
        };
        model.with_revolution(self.revolution.as_ref())
    }
}

/// Takes out the vertices of no triangle and numbers the others anew, in their order.
fn leave_out_strays(vertices: &mut Vec<f32>, triangles: &mut [[u32; 3]]) {
    let mut numbers = vec![None; vertices.len() / 3];
    for &vertex in triangles.as_flattened() {
        numbers[vertex as usize] = Some(vertex);
    }
    if numbers.iter().all(Option::is_some) {
        return;
    }
    let mut kept = Vec::new();
    for (number, corner) in numbers.iter_mut().zip(vertices.as_chunks::<3>().0) {
        if number.is_some() {
            *number = Some((kept.len() / 3) as u32);
            kept.extend_from_slice(corner);
        }
    }
    *vertices = kept;
    for vertex in triangles.as_flattened_mut() {
        *vertex = numbers[*vertex as usize].unwrap_or_default();
    }
}

/// The edges of a mesh in memory of their own, what was counted on the way, and the numbers that were worked in.
fn linked(mesh: &Mesh<'_>) -> (OwnedEdges, SurfaceFaults, Vec<u32>) {
    let needs = link_needed(mesh);
    let mut kept = OwnedEdges {
        boxes: vec![EdgeBox::default(); needs.groups],
        groups: vec![EdgeGroup::default(); needs.groups],
        rims: vec![RimEdge::default(); needs.halves],
        mark: mesh.mark(),
    };
    let mut numbers = vec![0; needs.numbers];
    let memory = LinkMemory {
        halves: &mut vec![MeshEdge::default(); needs.halves],
        numbers: &mut numbers,
        boxes: &mut kept.boxes,
        groups: &mut kept.groups,
        rims: &mut kept.rims,
    };
    let used = link(mesh, memory).map(|(edges, faults)| {
        let (boxes, _, rims) = edges.parts();
        (boxes.len(), rims.len(), faults)
    });
    // There is as much memory as was asked for.
    let (groups, rims, faults) = used.unwrap_or_default();
    kept.boxes.truncate(groups);
    kept.groups.truncate(groups);
    kept.rims.truncate(rims);
    kept.rims.shrink_to_fit();
    (kept, faults, numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{cross, dot};
    use crate::mesh::edges::fake::torus;
    use proptest::prelude::*;

    #[test]
    fn numbers_stay_where_they_came_and_a_closed_surface_has_no_faults() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let triangles = vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
        let (first, address) = (vertices[3], vertices.as_ptr());
        let owned = OwnedModel::new(vertices, triangles).expect("valid");
        let model = owned.as_model();
        assert_eq!(model.vertices().as_ptr().cast(), address);
        assert_eq!(
            (model.vertices()[1][0], model.triangles().len()),
            (first, 4)
        );
        assert_eq!(owned.faults(), SurfaceFaults::default());
    }

    #[test]
    fn what_runs_against_its_neighbours_is_turned_and_told() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let closed = vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
        let mut mixed = closed.clone();
        mixed.swap(4, 5);
        mixed.swap(9, 10);
        let [as_it_was, turned] = [closed, mixed]
            .map(|triangles| OwnedModel::new(vertices.clone(), triangles).expect("valid"));
        assert_eq!(turned.faults().flipped, 2);
        let direction = |owned: &OwnedModel| {
            let model = owned.as_model();
            let corner = |vertex: u32| model.vertices()[vertex as usize].map(f64::from);
            let of = |[a, b, c]: &[u32; 3]| dot(&corner(*a), &cross(&corner(*b), &corner(*c)));
            assert!(model.edges().is_some());
            model.triangles().iter().map(of).collect::<Vec<_>>()
        };
        assert_eq!(direction(&turned), direction(&as_it_was));
    }

    /// Whatever else stands in its list of vertices, before it, between or behind.
    #[test]
    fn a_part_is_the_same_with_vertices_of_another_in_its_list() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let far = [90.0, -400.0, 7.0];
        let alone = OwnedModel::new(corners.concat(), triangles.concat()).expect("valid");
        let with_others: Vec<f32> = corners
            .iter()
            .flat_map(|corner| [far, *corner, far])
            .flatten()
            .collect();
        let numbers = triangles
            .concat()
            .iter()
            .map(|vertex| 3 * vertex + 1)
            .collect();
        let among = OwnedModel::new(with_others, numbers).expect("valid");
        let [alone, among] = [&alone, &among].map(OwnedModel::as_model);
        assert_eq!(among.bounds(), alone.bounds());
        assert_eq!(among.digest(), alone.digest());
    }

    properties! {
        /// Of a torus within another, and of any triangles.
        #[test]
        fn what_was_turned_runs_as_its_neighbours_do(
            turned in proptest::collection::vec(any::<bool>(), 336),
            corners in proptest::collection::vec(proptest::array::uniform3(0u32..12), 1..30),
            is_torus in any::<bool>(),
        ) {
            let (vertices, mut given) = torus(&[0.0]);
            if !is_torus {
                given = corners;
            }
            for (triangle, &turned) in given.iter_mut().zip(&turned) {
                if turned {
                    triangle.swap(1, 2);
                }
            }
            let drawn = |triangles: &[[u32; 3]]| {
                // All vertices are named, so that none gets another number.
                let all = (0..vertices.len() as u32).map(|vertex| [vertex; 3]);
                let triangles: Vec<[u32; 3]> = triangles.iter().copied().chain(all).collect();
                OwnedModel::drawn(vertices.concat(), triangles.concat()).expect("valid")
            };
            let once = drawn(&given);
            let found = &once.as_model().triangles()[..given.len()];
            let are_turned = given.iter().zip(found).filter(|(own, found)| own != found);
            prop_assert_eq!(are_turned.clone().count(), once.faults().flipped);
            for ([a, b, c], found) in are_turned {
                prop_assert_eq!(&[*a, *c, *b], found);
            }
            let again = drawn(found);
            prop_assert_eq!(again.faults().flipped, 0);
            prop_assert_eq!(&again.as_model().triangles()[..given.len()], found);
            if is_torus {
                // Each of the two runs as one of its triangles did.
                prop_assert_eq!(once.edges.rims.len(), 0);
            }
        }
    }

    #[test]
    fn an_open_surface_has_rims() {
        let vertices = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let owned = OwnedModel::new(vertices, vec![0, 1, 2]).expect("valid");
        assert_eq!(owned.faults().rims, 3);
    }
}
