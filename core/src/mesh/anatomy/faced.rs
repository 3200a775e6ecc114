//! What of a surface faces a direction.

use crate::math::{Vector3, add, cross, dot, norm, scale, sin_cos, subtract};
use crate::mesh::surface::Mesh;

/// Faces within 15 degrees of a direction, or of its opposite, face it: their cosine.
pub(super) const FACING: f64 = 0.965_925_826_289_068_3;

pub(super) fn vertices<'m>(mesh: &Mesh<'m>) -> impl Iterator<Item = Vector3> + Clone + 'm {
    mesh.vertices().iter().map(|vertex| vertex.map(f64::from))
}

/// How far points reach along an axis.
pub(super) fn reach(points: impl Iterator<Item = Vector3>, axis: &Vector3) -> (f64, f64) {
    points
        .map(|point| dot(&point, axis))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
}

/// Middle, doubled area and normal times doubled area of every triangle.
pub(super) fn faces<'m>(
    mesh: &Mesh<'m>,
) -> impl Iterator<Item = (Vector3, f64, Vector3)> + Clone + 'm {
    let corners = mesh.vertices();
    mesh.triangles().iter().map(move |triangle| {
        let [a, b, c] = triangle.map(|vertex| corners[vertex as usize].map(f64::from));
        let normal = cross(&subtract(&b, &a), &subtract(&c, &a));
        let middle = scale(&add(&add(&a, &b), &c), 1.0 / 3.0);
        (middle, norm(&normal), normal)
    })
}

/// The first of two perpendicular directions turned towards the second, radians.
pub(super) fn between(first: &Vector3, second: &Vector3, turn: f64) -> Vector3 {
    let (sin, cos) = sin_cos(turn);
    add(&scale(first, cos), &scale(second, sin))
}

/// What of a surface faces a direction or its opposite, to within an angle of this cosine: normals turned towards it, as long as their
/// areas, summed, and the doubled area.
pub(super) fn facing(mesh: &Mesh<'_>, along: &Vector3, cosine: f64) -> (Vector3, f64) {
    let near = faces(mesh)
        .filter(|(_, area, normal)| *area > 0.0 && dot(normal, along).abs() > cosine * area);
    near.fold(([0.0; 3], 0.0), |(sum, all), (_, area, normal)| {
        let sign = if dot(&normal, along) < 0.0 { -1.0 } else { 1.0 };
        (add(&sum, &scale(&normal, sign)), all + area)
    })
}

/// Directions that are tried beside the first, over half a turn.
const AROUND: u32 = 36;

/// Cosine of 5 degrees, within which two directions are one.
const ONE_DIRECTION: f64 = 0.996_194_698_091_745_5;

/// `first`, perpendicular to `across`, where no direction farther than 5 degrees from it has more of the surface within 15 degrees, else that
/// direction: a long stem turns more of its surface forwards and backwards than a plate has, but all round.
pub(super) fn most_faced(mesh: &Mesh<'_>, across: &Vector3, first: Vector3) -> Vector3 {
    let second = cross(across, &first);
    let mut best = (first, 0.0);
    for step in 0..AROUND {
        let turn = core::f64::consts::PI * f64::from(step) / f64::from(AROUND);
        let along = between(&first, &second, turn);
        let (sum, area) = facing(mesh, &along, FACING);
        if area > best.1 {
            best = (sum, area);
        }
    }
    let square = subtract(&best.0, &scale(across, dot(&best.0, across)));
    let length = norm(&square);
    if length > 0.0 && dot(&square, &first).abs() < ONE_DIRECTION * length {
        return scale(&square, 1.0 / length);
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{atan2, degrees};
    use proptest::prelude::*;
    use std::vec::Vec;

    fn unit() -> impl Strategy<Value = Vector3> {
        let vector = proptest::array::uniform3(-1.0..1.0f64);
        let vector = vector.prop_filter("a direction", |vector| norm(vector) > 0.1);
        vector.prop_map(|vector| scale(&vector, 1.0 / norm(&vector)))
    }

    properties! {
        /// Oracle: angles. Whichever way its triangles run, and from whichever side it is looked at.
        #[test]
        fn what_faces_a_direction_is_within_an_angle_of_it(
            vertices in proptest::collection::vec(proptest::array::uniform3(-9.0..9.0f32), 30), along in unit(), most_deg in 5.0..80.0f64,
        ) {
            let triangles: Vec<[u32; 3]> = (0..10).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let cosine = sin_cos(most_deg.to_radians()).1;
            let (mut sum, mut all) = ([0.0; 3], 0.0);
            for (middle, area, normal) in faces(&mesh) {
                let angle_deg = degrees(atan2(norm(&cross(&normal, &along)), dot(&normal, &along)));
                if angle_deg.min(180.0 - angle_deg) < most_deg {
                    sum = if angle_deg < 90.0 { add(&sum, &normal) } else { subtract(&sum, &normal) };
                    all += area;
                }
                // Ways to its corners make up nothing, in the middle alone, and are square to the normal.
                let mut placed = triangles.iter().map(|corners| corners.map(|corner| vertices[corner as usize].map(f64::from)));
                let is_middle = placed.any(|corners| {
                    let off = corners.map(|corner| subtract(&corner, &middle));
                    norm(&add(&add(&off[0], &off[1]), &off[2])) < 1e-9 && dot(&off[0], &normal).abs() < 1e-9 * (1.0 + area)
                });
                prop_assert!(is_middle);
            }
            let (found, area) = facing(&mesh, &along, cosine);
            prop_assert!(norm(&subtract(&found, &sum)) < 1e-9 && (area - all).abs() < 1e-9);
            let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
            let (again, _) = facing(&Mesh::new(&vertices, &turned).expect("valid"), &along, cosine);
            let (back, _) = facing(&mesh, &scale(&along, -1.0), cosine);
            prop_assert!(norm(&subtract(&again, &found)) < 1e-9 && norm(&add(&back, &found)) < 1e-9);
        }

        /// Of a strip that is folded about the direction across: no direction that is square to that has more of it.
        #[test]
        fn no_direction_square_to_another_is_faced_by_more(
            across in unit(), sizes in proptest::collection::vec((0.0..180.0f64, 1.0..9.0f64), 1..7), start in 0.0..180.0f64,
        ) {
            let first = super::super::perpendicular(&across);
            let second = cross(&across, &first);
            let mut vertices = Vec::new();
            for &(angle_deg, size) in &sizes {
                // A triangle that faces that way.
                let along = between(&first, &second, angle_deg.to_radians());
                let aside = scale(&cross(&across, &along), size);
                let away = scale(&along, 40.0);
                vertices.extend([away, add(&away, &aside), add(&away, &across)].map(|corner| corner.map(|x| x as f32)));
            }
            let triangles: Vec<[u32; 3]> = (0..sizes.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let found = most_faced(&mesh, &across, between(&first, &second, start.to_radians()));
            prop_assert!((norm(&found) - 1.0).abs() < 1e-9 && dot(&found, &across).abs() < 1e-3);
            let within = |along: &Vector3, deg: f64| facing(&mesh, along, sin_cos(deg.to_radians()).1).1;
            // What lies within 10 degrees of any direction is in a window of 15 that is tried, and what is in the best one lies within 30 of the
            // sum of that, which may be 5 from the first direction.
            for step in 0..36 {
                let along = between(&first, &second, f64::from(step) * core::f64::consts::PI / 36.0);
                prop_assert!(within(&along, 10.0) <= within(&found, 35.0) + 1e-6, "{}", step);
            }
        }
    }
}
