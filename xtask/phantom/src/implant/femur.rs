//! Puts the femoral component together: bearing surface, bone cuts with two pegs, and the rim between them.

use super::builder::Builder;
use super::femur_grid::{Grid, Node};
use super::peg::Peg;
use super::rim;
use super::shape::{self, Shape};
use glam::DVec3;

/// Where the pegs stand on the distal cut, as a value of `s`.
const PEG_PLACE: f64 = 2.5;

/// A left femoral component at the drawing's own size.
pub(super) fn build(resolution: f64) -> Builder {
    let grid = Grid::new(resolution);
    let pegs = [false, true].map(|medial| peg(&grid, medial, resolution));
    let shape = Shape::new();
    let mut builder = Builder::default();

    let outer = Sheet::new(&grid, &mut builder, |_, (s, z)| shape.outer(s, z));
    let inner = Sheet::new(&grid, &mut builder, |node, (s, z)| {
        let natural = shape::inner(s, z);
        pegs.iter()
            .find_map(|peg| peg.bend(node, natural))
            .unwrap_or(natural)
    });
    for (row, column) in grid.cells() {
        let [a, b, c, d] = outer.corners(row, column);
        builder.quad(a, d, c, b);
        let [a, b, c, d] = inner.corners(row, column);
        match pegs.iter().find_map(|peg| peg.split((row, column))) {
            Some(true) => builder.quad_along(a, b, c, d),
            Some(false) => builder.quad_along(b, c, d, a),
            None => builder.quad(a, b, c, d),
        }
    }
    let border = grid.border();
    rim::close(&mut builder, &outer.nodes(&border), &inner.nodes(&border));
    builder
}

fn peg(grid: &Grid, medial: bool, resolution: f64) -> Peg {
    let node = grid.peg_node(medial, PEG_PLACE);
    let (s, z) = grid.place(node);
    Peg::new(node, shape::inner(s, z), resolution)
}

/// One of the two surfaces: a vertex for each node of the grid.
struct Sheet {
    columns: usize,
    vertices: Vec<Option<(u32, DVec3)>>,
}

impl Sheet {
    fn new(
        grid: &Grid,
        builder: &mut Builder,
        position: impl Fn(Node, (f64, f64)) -> DVec3,
    ) -> Self {
        let columns = grid.last_column() + 1;
        let nodes =
            (0..=grid.last_row()).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let vertices = nodes
            .map(|node| {
                grid.has(node).then(|| {
                    let place = position(node, grid.place(node));
                    (builder.vertex(place), place)
                })
            })
            .collect();
        Self { columns, vertices }
    }

    fn node(&self, (row, column): Node) -> (u32, DVec3) {
        self.vertices[row * self.columns + column]
            .expect("a cell and the border have nodes of the grid only")
    }

    /// A cell's vertices: its first node, the next row's, that one's next column, the first row's next column.
    fn corners(&self, row: usize, column: usize) -> [u32; 4] {
        [
            (row, column),
            (row + 1, column),
            (row + 1, column + 1),
            (row, column + 1),
        ]
        .map(|node| self.node(node).0)
    }

    fn nodes(&self, border: &[Node]) -> Vec<(u32, DVec3)> {
        border.iter().map(|&node| self.node(node)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metal_is_nowhere_thinner_than_a_casting_can_be() {
        let grid = Grid::new(1.0);
        let shape = Shape::new();
        let mut thinnest = f64::INFINITY;
        for (row, column) in grid.cells() {
            let (s, z) = grid.place((row, column));
            thinnest = thinnest.min((shape.outer(s, z) - shape::inner(s, z)).length());
        }
        assert!(thinnest > 1.4, "{thinnest} mm");
    }

    #[test]
    fn bearing_surface_lies_outside_the_bone_cuts() {
        let grid = Grid::new(1.0);
        let shape = Shape::new();
        for (row, column) in grid.cells() {
            let (s, z) = grid.place((row, column));
            let inner = shape::inner(s, z);
            let out = shape.outer(s, z) - inner;
            let along = shape::inner((s + 0.01).min(5.0), z) - shape::inner((s - 0.01).max(0.0), z);
            assert!(out.dot(DVec3::Z.cross(along)) > 0.0, "at s {s}, z {z}");
        }
    }
}
