//! How far a coarser surface lies off the model that it stands for.

use fluoropose::math::{Vector3, add, cross, dot, norm, scale, subtract};
use fluoropose::mesh::Model;
use rayon::prelude::*;

/// The greatest distance of a vertex of `model` from the surface of `coarse`, mm.
pub(super) fn deviation_mm(model: &Model<'_>, coarse: &Model<'_>) -> f64 {
    let corner = |vertex: u32| coarse.vertices()[vertex as usize].map(f64::from);
    let triangles: Vec<[Vector3; 3]> = coarse
        .triangles()
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect();
    let nearest = |vertex: &[f32; 3]| {
        let place = vertex.map(f64::from);
        let distances = triangles.iter().map(|corners| distance(&place, corners));
        distances.fold(f64::INFINITY, f64::min)
    };
    model
        .vertices()
        .par_iter()
        .map(nearest)
        .reduce(|| 0.0, f64::max)
}

/// From a point to a triangle: to its plane where the point lies above it, else to the nearest side.
fn distance(point: &Vector3, [a, b, c]: &[Vector3; 3]) -> f64 {
    let normal = cross(&subtract(b, a), &subtract(c, a));
    let sides = [(a, b), (b, c), (c, a)];
    let is_left = |(from, to): (&Vector3, &Vector3)| {
        dot(&cross(&subtract(to, from), &subtract(point, from)), &normal) >= 0.0
    };
    let length = norm(&normal);
    if length > 0.0 && sides.into_iter().all(is_left) {
        return (dot(&subtract(point, a), &normal) / length).abs();
    }
    let to_side = |(from, to): (&Vector3, &Vector3)| {
        let along = subtract(to, from);
        let square = dot(&along, &along);
        let part = if square > 0.0 {
            dot(&subtract(point, from), &along) / square
        } else {
            0.0
        };
        let nearest = add(from, &scale(&along, part.clamp(0.0, 1.0)));
        norm(&subtract(point, &nearest))
    };
    sides.into_iter().map(to_side).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_above_beside_and_beyond_a_triangle() {
        let triangle = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let off = |point: Vector3| distance(&point, &triangle);
        assert_eq!(off([1.0, 1.0, 3.0]), 3.0);
        assert_eq!(off([1.0, -2.0, 0.0]), 2.0);
        assert_eq!(off([-3.0, -4.0, 0.0]), 5.0);
        assert_eq!(off([4.0, 4.0, 0.0]), 8f64.sqrt());
        let flat = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(distance(&[1.0, 3.0, 0.0], &flat), 3.0);
    }
}
