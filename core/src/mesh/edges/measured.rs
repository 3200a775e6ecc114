//! Which way a triangle faces, measured from its vertices.

/// Whether a triangle faces the camera, where that is certain: of the camera's place in model coordinates, margins (for each
/// mm of the longest side; beside that; how far planes are from where they seem, mm) and corners.
pub(crate) type Facing = fn(&[f32; 3], [f32; 3], [&[f32; 3]; 3]) -> Option<bool>;

/// Twelve roundings to 32 bits, as part of a number.
const ROUNDINGS: f32 = 12.0 * f32::EPSILON;

/// See [`Facing`].
///
/// Doubled area times distance from the plane is a determinant of two sides and the way from the camera. Sides are
/// differences of numbers of 32 bits, so they err by one rounding of themselves alone, and the determinant by less than
/// twelve roundings of the product of three lengths; a doubled area is below the product of its longest side with itself.
pub(super) fn faces_surely(
    place: &[f32; 3],
    [per_mm, least, rounding]: [f32; 3],
    [a, b, c]: [&[f32; 3]; 3],
) -> Option<bool> {
    let minus = |p: &[f32; 3], q: &[f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    // No less than the length.
    let length = |p: &[f32; 3]| p[0].abs() + p[1].abs() + p[2].abs();
    let ([p, q], way) = ([minus(b, a), minus(c, a)], minus(place, a));
    let normal = [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ];
    let from_plane = normal[0] * way[0] + normal[1] * way[1] + normal[2] * way[2];
    let longest = length(&p).max(length(&q)).max(length(&minus(c, b)));
    let rounding = rounding + ROUNDINGS * length(&way);
    let margin = longest * per_mm + least + longest * longest * rounding;
    (from_plane.abs() > margin).then_some(from_plane < 0.0)
}
