//! The wall between the bearing surface and the bone cuts: a rolled edge all round the horseshoe.

use super::builder::Builder;
use glam::DVec3;
use libm::{cos, sin};
use std::f64::consts::FRAC_PI_2;

/// Radius of the edge towards the bearing surface, where the wall is high enough for it.
const RADIUS: f64 = 2.4;
/// Steps round that radius.
const STEPS: usize = 4;
/// Bevel of the edge towards the bone.
const BEVEL: f64 = 0.5;

/// Joins an outer and an inner border, given in the same order, by rings of quadrilaterals.
///
/// Seen from outside the outer surface, the border runs with the surface on its left.
pub(super) fn close(builder: &mut Builder, outer: &[(u32, DVec3)], inner: &[(u32, DVec3)]) {
    let mut above: Vec<u32> = outer.iter().map(|&(index, _)| index).collect();
    let rings: Vec<Vec<DVec3>> = (0..outer.len()).map(|m| wall(outer, inner, m)).collect();
    for ring in 0..rings[0].len() {
        let below: Vec<u32> = rings
            .iter()
            .map(|points| builder.vertex(points[ring]))
            .collect();
        join(builder, &above, &below);
        above = below;
    }
    let last: Vec<u32> = inner.iter().map(|&(index, _)| index).collect();
    join(builder, &above, &last);
}

fn join(builder: &mut Builder, above: &[u32], below: &[u32]) {
    for m in 0..above.len() {
        let next = (m + 1) % above.len();
        builder.quad(above[next], above[m], below[m], below[next]);
    }
}

/// The points of the wall below one border node, from the bearing surface to the bone.
fn wall(outer: &[(u32, DVec3)], inner: &[(u32, DVec3)], m: usize) -> Vec<DVec3> {
    let count = outer.len();
    let (before, after) = ((m + count - 1) % count, (m + 1) % count);
    let down = inner[m].1 - outer[m].1;
    let height = down.length();
    let down = down / height;
    let along =
        (outer[after].1 - outer[m].1).normalize() + (outer[m].1 - outer[before].1).normalize();
    let out = along.cross(-down).normalize();
    let radius = RADIUS.min(0.42 * height);
    let bevel = BEVEL.min(0.2 * radius);
    let mut points: Vec<DVec3> = (1..=STEPS)
        .map(|step| {
            let angle = FRAC_PI_2 * step as f64 / STEPS as f64;
            // The surface arrives sloping down by about a quarter; the edge carries on from there.
            let drop = radius * (1.0 - cos(angle)) + 0.25 * radius * sin(angle);
            outer[m].1 + out * (radius * sin(angle)) + down * drop
        })
        .collect();
    points.push(outer[m].1 + out * radius + down * (height - bevel));
    points.push(outer[m].1 + out * (radius - bevel) + down * height);
    points
}
