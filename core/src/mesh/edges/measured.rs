//! Which way the triangles beside an edge face, measured from their vertices.

/// Whether the triangles beside an edge, first that which runs it forth, face the camera, where that is certain of both: of the
/// camera's place in model coordinates, margins (for each mm of the longest side; beside that; how far planes are from where they
/// seem, mm), and the ends of the edge with the third corners of both triangles.
pub(crate) type Facing = fn(&[f32; 3], [f32; 3], [&[f32; 3]; 4]) -> Option<[bool; 2]>;

/// Twelve roundings to 32 bits, as part of a number.
const ROUNDINGS: f32 = 12.0 * f32::EPSILON;

/// See [`Facing`].
///
/// Doubled area times distance from the plane is a determinant of two sides and the way from the camera. Sides are
/// differences of numbers of 32 bits, so they err by one rounding of themselves alone, and the determinant by less than
/// twelve roundings of the product of three lengths; a doubled area is below the product of its longest side with itself. That
/// side is no longer than the two that are measured together.
pub(super) fn faces_surely(
    place: &[f32; 3],
    [per_mm, least, rounding]: [f32; 3],
    [from, to, forth, back]: [&[f32; 3]; 4],
) -> Option<[bool; 2]> {
    let (edge, way) = (minus(to, from), minus(place, from));
    // Both determinants are of the edge as it is run forth, the way and one more side.
    let across = [
        way[1] * edge[2] - way[2] * edge[1],
        way[2] * edge[0] - way[0] * edge[2],
        way[0] * edge[1] - way[1] * edge[0],
    ];
    let rounding = rounding + ROUNDINGS * length(&way);
    let along = length(&edge);
    let margins = [per_mm, least, rounding];
    let forth = from_plane(&across, along, &minus(forth, from), margins)?;
    let back = from_plane(&across, along, &minus(back, from), margins)?;
    Some([forth < 0.0, back > 0.0])
}

/// How far the camera is from the plane of a triangle, times its doubled area, where the sign is certain. By itself in each of the two
/// places: a call would hand all of it over in memory.
#[inline(always)]
fn from_plane(
    across: &[f32; 3],
    along: f32,
    side: &[f32; 3],
    [per_mm, least, rounding]: [f32; 3],
) -> Option<f32> {
    let longest = along + length(side);
    let margin = longest * (per_mm + longest * rounding) + least;
    let distance = across[0] * side[0] + across[1] * side[1] + across[2] * side[2];
    (distance.abs() > margin).then_some(distance)
}

#[inline(always)]
fn minus(p: &[f32; 3], q: &[f32; 3]) -> [f32; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// No less than the length.
#[inline(always)]
fn length(p: &[f32; 3]) -> f32 {
    p[0].abs() + p[1].abs() + p[2].abs()
}
