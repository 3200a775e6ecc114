//! Which way the triangles beside an edge face, measured from their vertices.

use super::tight::{EdgePlaces, Group};

/// Calls a function for each edge of a group that may be on the contour, with whether the triangles beside it, first that which runs it
/// forth, face the camera, where that is certain of both: of the camera's place in model coordinates, margins (for each mm of the longest
/// side; beside that; how far planes are from where they seem with [`ROUNDINGS`] of the way to a vertex, mm), and of the surface's vertices.
pub(crate) type Facing = fn(
    &[f32; 3],
    [f32; 3],
    (&Group<'_>, &[[f32; 3]]),
    &mut dyn FnMut(EdgePlaces, Option<[bool; 2]>),
);

/// See [`Facing`].
pub(super) fn contour_of(
    place: &[f32; 3],
    margins: [f32; 3],
    (group, vertices): (&Group<'_>, &[[f32; 3]]),
    visit: &mut dyn FnMut(EdgePlaces, Option<[bool; 2]>),
) {
    for &edge in group.edges() {
        let [from, to, forth, back] = group.edge(edge);
        let corner = |vertex: u16| vertices.get(usize::from(vertex));
        let (Some(from), Some(to), Some(forth), Some(back)) =
            (corner(from), corner(to), corner(forth), corner(back))
        else {
            continue;
        };
        let corners = [from, to, forth, back];
        match surely_off(place, margins, corners) {
            // One of them is below zero, so both triangles face the camera, or neither does: by the bits of their signs in a third of the
            // instructions of two comparisons.
            Some([forth, back]) if (forth.to_bits() ^ back.to_bits()) >> 31 != 0 => {}
            Some([forth, back]) => visit(edge, Some([forth < 0.0, back > 0.0])),
            None => visit(edge, None),
        }
    }
}

/// Twelve roundings to 32 bits of the three components of a way, together, as part of its length.
pub(crate) const ROUNDINGS: f32 = 12.0 * 1.75 * f32::EPSILON;

/// How far the camera is from the planes of the triangles forth and back beside an edge, each times a doubled area, of its ends and both third
/// corners, where both signs are certain. It faces the first below zero, the second above.
///
/// Doubled area times distance from the plane is a determinant of two sides and the way from the camera. Sides are
/// differences of numbers of 32 bits, so they err by one rounding of themselves alone, and the determinant by less than
/// twelve roundings of the product of three lengths; a doubled area is below the product of its longest side with itself. That
/// side is no longer than the two that are measured together.
#[inline(always)]
fn surely_off(
    place: &[f32; 3],
    margins: [f32; 3],
    [from, to, forth, back]: [&[f32; 3]; 4],
) -> Option<[f32; 2]> {
    let (edge, way) = (minus(to, from), minus(place, from));
    // Both determinants are of the edge as it is run forth, the way and one more side.
    let across = [
        way[1] * edge[2] - way[2] * edge[1],
        way[2] * edge[0] - way[0] * edge[2],
        way[0] * edge[1] - way[1] * edge[0],
    ];
    let along = length(&edge);
    let forth = from_plane(&across, along, &minus(forth, from), margins)?;
    let back = from_plane(&across, along, &minus(back, from), margins)?;
    Some([forth, back])
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

#[cfg(test)]
mod tests {
    use super::super::tight::GroupRoom;
    use super::*;
    use proptest::array::{uniform3, uniform4};
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Six times the volume of a triangle and a place, of whole numbers so small that 32 bits hold it.
    fn volume([a, b, c]: [[i32; 3]; 3], place: [i32; 3]) -> i32 {
        let from = |p: [i32; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let ([x, y, z], [d, e, f], [g, h, i]) = (from(place), from(b), from(c));
        x * (e * i - f * h) + y * (f * g - d * i) + z * (d * h - e * g)
    }

    fn whole() -> impl Strategy<Value = [i32; 3]> {
        uniform3(-9..=9)
    }

    fn floats(place: [i32; 3]) -> [f32; 3] {
        place.map(|x| x as f32)
    }

    properties! {
        #[test]
        fn an_edge_is_on_the_contour_where_one_of_its_triangles_faces_the_camera(
            corners in vec(whole(), 3..9), edges in vec(uniform4(0..9u16), 1..16), camera in uniform3(-60..=60),
        ) {
            let vertices: Vec<[f32; 3]> = corners.iter().copied().map(floats).collect();
            let mut room = GroupRoom::EMPTY;
            let group = room.listed(&edges);
            let mut found = Vec::new();
            let mut visit = |edge, faces| found.push((group.edge(edge), faces));
            contour_of(&floats(camera), [0.0; 3], (&group, &vertices), &mut visit);
            let known = edges.iter().filter(|edge| edge.iter().all(|&vertex| usize::from(vertex) < corners.len()));
            let expected: Vec<_> = known
                .filter_map(|edge| {
                    let [from, to, forth, back] = edge.map(|vertex| corners[usize::from(vertex)]);
                    let volumes = [volume([from, to, forth], camera), volume([to, from, back], camera)];
                    let faces = volumes.map(|volume| volume < 0);
                    match volumes.contains(&0) {
                        true => Some((*edge, None)),
                        false => (faces[0] != faces[1]).then_some((*edge, Some(faces))),
                    }
                })
                .collect();
            prop_assert_eq!(found, expected);
        }

        /// By the longest side itself: what is measured is no shorter, and no longer than twice the root of three times that.
        #[test]
        fn a_side_is_certain_beyond_its_margin(
            corners in uniform4(whole()), camera in uniform3(-60..=60), margins in uniform3(prop_oneof![Just(0.0f32), 0.0..200.0f32]),
        ) {
            let [from, to, forth, back] = corners;
            let squared = |p: [i32; 3], q: [i32; 3]| (0..3).map(|k| (p[k] - q[k]).pow(2)).sum::<i32>();
            let beyond = |third: [i32; 3], factor: f64| {
                let sides = [squared(from, to), squared(to, third), squared(third, from)];
                let longest = crate::math::sqrt(f64::from(sides.into_iter().fold(0, i32::max)));
                let [per_mm, least, rounding] = margins.map(f64::from);
                let (own, twice) = (factor * longest * per_mm, factor * factor * longest * longest * rounding / 10.0);
                f64::from(volume([from, to, third], camera).abs()) - own - twice - least
            };
            let [per_mm, least, rounding] = margins;
            let places = corners.map(floats);
            let told = surely_off(&floats(camera), [per_mm, least, rounding / 10.0], places.each_ref());
            let both = |factor: f64| beyond(forth, factor).min(beyond(back, factor));
            if told.is_some() {
                prop_assert!(both(1.0) > -1e-3);
            } else {
                prop_assert!(both(12f64.sqrt()) < 1e-3);
            }
        }
    }
}
