//! What drawing an implant takes, from any side: memory that is known when a program is built.

use crate::image::mask::words_needed;
use crate::math::{cross, dot, subtract};
use crate::mesh::Model;
use crate::mesh::edges::MeshEdge;
use crate::render::scratch_for;

/// Silhouette edges of an implant and how often they cross rows of a frame, from the side where they are most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContourNeeds {
    /// Silhouette edges.
    pub edges: usize,
    /// Crossings of a row, in the mean over the implant's rows, rounded up.
    pub crossings_a_row: usize,
}

impl ContourNeeds {
    /// Vertices of working memory that drawing takes: [`crate::refine::RefineMemory::projected`]. `rows` are those of the
    /// frame, or of the part of it that is cropped.
    #[must_use]
    pub const fn scratch(&self, vertices: usize, rows: usize) -> usize {
        scratch_for(vertices, rows, self.edges)
    }

    /// Words of [`crate::refine::RefineMemory::drawn`].
    #[must_use]
    pub const fn words(&self, columns: usize, rows: usize) -> usize {
        words_needed(columns, rows)
    }
}

/// Directions that are looked from: evenly over the sphere.
const DIRECTIONS: usize = 600;

/// Counts the silhouette edges of a model with edges from all sides; nothing of one without.
#[must_use]
pub fn contour_needed(model: &Model<'_>) -> ContourNeeds {
    let mut most = ContourNeeds::default();
    let Some(edges) = model.edges() else {
        return most;
    };
    for number in 0..DIRECTIONS {
        // A spiral (Swinbank and Purser, Q. J. R. Meteorol. Soc. 132, 2006).
        let height = 1.0 - (2 * number + 1) as f64 / DIRECTIONS as f64;
        let ring = crate::math::sqrt(1.0 - height * height);
        let (sin, cos) = crate::math::sin_cos(2.399_963_229_728_653 * number as f64);
        let view = [ring * cos, height, ring * sin];
        let (mut count, mut length) = (0, 0.0);
        let mut look_at = |edge: MeshEdge| {
            if is_silhouette(model, &edge, &view) {
                count += 1;
                length += length_seen(model, &edge, &view);
            }
        };
        let linked = edges.groups().flat_map(|(_, group)| group.edges());
        linked.for_each(&mut look_at);
        if let Some((packed, _)) = edges.packed() {
            packed.for_each_edge(look_at);
        }
        // As if every edge ran across the rows; a part of a frame has as many as the part may be long.
        let rows = 2.0 * model.bounds().radius;
        most.edges = most.edges.max(count + edges.rims().count());
        most.crossings_a_row = most.crossings_a_row.max((length / rows) as usize + 1);
    }
    most
}

fn place(model: &Model<'_>, vertex: u32) -> [f64; 3] {
    let vertex = model.vertices().get(vertex as usize);
    vertex.copied().unwrap_or_default().map(f64::from)
}

/// How long an edge is as it is seen along a unit vector, mm.
fn length_seen(model: &Model<'_>, edge: &MeshEdge, view: &[f64; 3]) -> f64 {
    let side = subtract(&place(model, edge.to), &place(model, edge.from));
    crate::math::norm(&cross(&side, view))
}

fn is_silhouette(model: &Model<'_>, edge: &MeshEdge, view: &[f64; 3]) -> bool {
    let [from, to, forth, back] =
        [edge.from, edge.to, edge.forth, edge.back].map(|vertex| place(model, vertex));
    let along = subtract(&to, &from);
    let a = dot(&cross(&along, &subtract(&forth, &from)), view);
    let b = dot(&cross(&subtract(&back, &from), &along), view);
    (a > 0.0) != (b > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::edges::fake::{Linked, add_box};
    use std::vec::Vec;

    /// From any side a box has six silhouette edges, two of each direction.
    #[test]
    fn of_a_box_six_edges_are_seen_and_as_long_as_from_where_they_are_longest() {
        for sides in [[20.0f32, 20.0, 20.0], [90.0, 20.0, 6.0], [40.0, 40.0, 2.0]] {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            add_box(
                [5.0; 3],
                sides.map(|side| side + 5.0),
                &mut vertices,
                &mut triangles,
            );
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let sides = sides.map(f64::from);
            // Along a unit vector an edge is seen as long as is left of it across: all sides, by small steps.
            let mut longest = 0.0f64;
            for (k, j) in (0..200).flat_map(|k| (0..200).map(move |j| (k, j))) {
                let height = (f64::from(k) + 0.5) / 200.0;
                let ring = crate::math::sqrt(1.0 - height * height);
                let (sin, cos) =
                    crate::math::sin_cos(f64::from(j) / 200.0 * core::f64::consts::FRAC_PI_2);
                let view = [ring * cos, height, ring * sin];
                let seen = sides
                    .iter()
                    .zip(view)
                    .map(|(side, x)| 2.0 * side * crate::math::sqrt(1.0 - x * x));
                longest = longest.max(seen.sum());
            }
            let rows = crate::math::norm(&sides);
            let linked = Linked::new(&mesh);
            let needs = contour_needed(&linked.model(mesh));
            let expected = (longest / rows) as usize + 1;
            assert_eq!((needs.edges, needs.crossings_a_row), (6, expected));
            let packed = linked.packed();
            for edges in [packed.edges(), packed.tight_edges()] {
                let model = Model::with_edges(mesh, edges).expect("its own");
                assert_eq!(contour_needed(&model), needs);
            }
            assert_eq!(contour_needed(&Model::new(mesh)), ContourNeeds::default());
        }
    }
}
