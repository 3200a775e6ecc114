//! The frame itself, larger or smaller.

use crate::picture::Picture;

/// Lays a grey frame of `from` columns and rows onto the upper left corner, as large as `size`.
pub(super) fn lay(picture: &mut Picture, size: [usize; 2], grey: &[u8], from: [usize; 2]) {
    if grey.len() < from[0] * from[1] {
        return;
    }
    let width = picture.size()[0];
    let [across, down] = [0, 1].map(|axis| places(size[axis], from[axis]));
    let pixels = picture.pixels_mut();
    for (line, &(row, part)) in pixels.chunks_exact_mut(width).zip(&down) {
        let below = (row + 1).min(from[1] - 1);
        for (pixel, &(column, right)) in line.iter_mut().zip(&across) {
            let beside = (column + 1).min(from[0] - 1);
            let at = |row: usize, column: usize| f32::from(grey[row * from[0] + column]);
            let mix = |row| at(row, column) * (1.0 - right) + at(row, beside) * right;
            let value = mix(row) * (1.0 - part) + mix(below) * part;
            *pixel = [value.round() as u8; 3];
        }
    }
}

/// Of each of `count` pixels, the pixel of `from` to the left of its middle, and how far it is to the next.
fn places(count: usize, from: usize) -> Vec<(usize, f32)> {
    let place = |at: usize| {
        let middle = (at as f64 + 0.5) * from as f64 / count as f64 - 0.5;
        let middle = middle.clamp(0.0, from as f64 - 1.0);
        (middle as usize, middle.fract() as f32)
    };
    (0..count).map(place).collect()
}
