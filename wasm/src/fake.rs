//! Models of boxes for tests.

/// Appends the corners and triangles of a box between two opposite corners.
pub(crate) fn add_box(
    low: [f32; 3],
    high: [f32; 3],
    vertices: &mut Vec<f32>,
    triangles: &mut Vec<u32>,
) {
    let first = (vertices.len() / 3) as u32;
    let ends = [low, high];
    vertices.extend((0..8).flat_map(|corner| [0, 1, 2].map(|k| ends[corner >> k & 1][k])));
    for [a, b, c, d] in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        triangles.extend([a, b, c, a, c, d].map(|corner| first + corner));
    }
}
