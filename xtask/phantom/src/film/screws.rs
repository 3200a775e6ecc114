//! Two bone screws below the tray.

use crate::implant::{Side, Triangles};
use glam::DVec3;
use std::f64::consts::TAU;

/// Radius and length, mm, and corners around.
const RADIUS: f64 = 2.2;
const LENGTH: f64 = 28.0;
const CORNERS: u32 = 24;
/// Where their heads are below a left tray 70 mm wide and where they point: anterior, proximal, medial.
const HEADS: [[f64; 3]; 2] = [[9.0, -4.5, 17.0], [7.0, -4.5, -18.0]];
const POINTING: [[f64; 3]; 2] = [[-0.25, -1.0, 0.2], [0.1, -1.0, -0.25]];

/// The screws, in the tray's axes.
pub(super) fn pair(side: Side, width_mm: f64) -> [Triangles; 2] {
    let mirror = if side == Side::Right { -1.0 } else { 1.0 };
    let scale = width_mm / 70.0;
    let sided = |[x, y, z]: [f64; 3]| DVec3::new(mirror * x, y, z);
    [0, 1].map(|k| rod(sided(HEADS[k]) * scale, sided(POINTING[k]).normalize()))
}

/// A closed cylinder.
fn rod(head: DVec3, along: DVec3) -> Triangles {
    let across = along.any_orthonormal_vector();
    let third = along.cross(across);
    let ring = |from: DVec3| {
        (0..CORNERS).map(move |k| {
            let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(CORNERS));
            from + RADIUS * (across * cos + third * sin)
        })
    };
    let tip = head + LENGTH * along;
    let points = ring(head).chain(ring(tip)).chain([head, tip]);
    let vertices = points.map(|point| point.as_vec3().to_array()).collect();
    let (first, last) = (2 * CORNERS, 2 * CORNERS + 1);
    let triangles = (0..CORNERS).flat_map(|k| {
        let next = (k + 1) % CORNERS;
        let (a, b, c, d) = (k, next, next + CORNERS, k + CORNERS);
        [[a, b, c], [a, c, d], [first, b, a], [last, d, c]]
    });
    Triangles {
        vertices,
        triangles: triangles.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implant::check::closed_volume;

    #[test]
    fn screws_are_closed_and_as_large_as_they_say() {
        for side in [Side::Left, Side::Right] {
            for screw in pair(side, 70.0) {
                let volume = closed_volume(&screw).unwrap();
                let whole = TAU / 2.0 * RADIUS * RADIUS * LENGTH;
                assert!((volume / whole - 1.0).abs() < 0.02, "{volume} of {whole}");
            }
        }
    }
}
