//! What of a surface faces a direction.

use crate::math::{Vector3, add, cross, dot, norm, scale, sin_cos, subtract};
use crate::mesh::surface::Mesh;

/// Faces within 15 degrees of a direction, or of its opposite, face it: their cosine.
pub(super) const FACING: f64 = 0.965_925_826_289_068_3;

pub(super) fn vertices<'m>(mesh: &Mesh<'m>) -> impl Iterator<Item = Vector3> + Clone + 'm {
    mesh.vertices().iter().map(|vertex| vertex.map(f64::from))
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
