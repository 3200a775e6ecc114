//! The tibial tray: closed rings from the tip of the stem, up the finned keel, out under the plate, over its rim
//! and in again over the recess that takes the polyethylene insert.

use super::builder::Builder;
use super::outline;
use super::section::Ring;
use glam::{DVec2, DVec3};
use libm::{cos, sin};
use std::f64::consts::FRAC_PI_2;

/// Heights in mm: underside of the plate, floor of the recess, tip of the stem.
const UNDERSIDE: f64 = -3.0;
const FLOOR: f64 = 0.6;
const STEM_TIP: f64 = -41.0;
/// Radius of the stem at the plate, of the stem above its rounded tip, and of the fillet at the plate.
const STEM_RADIUS: f64 = 7.6;
const TIP_RADIUS: f64 = 5.6;
const FILLET: f64 = 1.2;
/// How far the fins reach beyond the stem at the plate, and how far down they run.
const FIN_LENGTH: f64 = 19.0;
const FIN_DEPTH: f64 = 25.0;
/// The keel leans back by this much per mm (3 degrees).
const LEAN: f64 = 0.0524;

/// The plate's edge from its underside to the recess: (distance inwards from the outline, height) in mm.
const EDGE: [(f64, f64); 13] = [
    (1.1, -3.0),
    (0.45, -2.85),
    (0.1, -2.45),
    (0.0, -1.9),
    (0.0, 0.1),
    (0.0, 2.1),
    (0.12, 2.6),
    (0.45, 2.92),
    (0.95, 3.0),
    (2.0, 3.0),
    (2.35, 2.85),
    (2.45, 2.5),
    (2.55, 0.9),
];

/// Numbers at resolution 1: points of a ring, rings of the tip, the stem, the underside and the floor.
const POINTS: f64 = 124.0;
const TIP_RINGS: f64 = 4.0;
const STEM_RINGS: f64 = 17.0;
const UNDER_RINGS: f64 = 5.0;
const FLOOR_RINGS: f64 = 5.0;

/// A left tibial tray at the drawing's own size.
pub(super) fn build(resolution: f64) -> Builder {
    let count = |base: f64| ((base * resolution + 0.5) as usize).max(2);
    let ring = Ring::new(count(POINTS), STEM_RADIUS + FILLET, FIN_LENGTH);
    let mut rings = stem(&ring, count(TIP_RINGS), count(STEM_RINGS));
    rings.extend(underside(&ring, count(UNDER_RINGS)));
    rings.extend(
        EDGE.iter()
            .map(|&(inwards, height)| edge(&ring, inwards, height)),
    );
    rings.extend(floor(&ring, count(FLOOR_RINGS)));
    let bottom = DVec3::new(lean(STEM_TIP), STEM_TIP, 0.0);
    stack(&rings, bottom, DVec3::new(0.0, FLOOR, 0.0))
}

fn lean(height: f64) -> f64 {
    LEAN * (height - UNDERSIDE)
}

fn at(point: DVec2, height: f64) -> DVec3 {
    DVec3::new(point.x, height, point.y)
}

/// The rounded tip, the stem with its fins, and the fillet below the plate.
fn stem(ring: &Ring, tip_rings: usize, stem_rings: usize) -> Vec<Vec<DVec3>> {
    let dome = STEM_TIP + TIP_RADIUS * 0.7;
    let top = UNDERSIDE - FILLET;
    let mut rings = Vec::new();
    for k in 1..=tip_rings {
        let angle = FRAC_PI_2 * k as f64 / tip_rings as f64;
        rings.push(keel(
            ring,
            dome - (dome - STEM_TIP) * cos(angle),
            TIP_RADIUS * sin(angle),
            0.0,
        ));
    }
    for k in 1..=stem_rings {
        let part = k as f64 / stem_rings as f64;
        let radius = TIP_RADIUS + (STEM_RADIUS - TIP_RADIUS) * part;
        let height = dome + (top - dome) * part;
        rings.push(keel(ring, height, radius, fin_length(height)));
    }
    for k in 1..=2 {
        let angle = FRAC_PI_2 * k as f64 / 2.0;
        let radius = STEM_RADIUS + FILLET * (1.0 - cos(angle));
        rings.push(keel(ring, top + FILLET * sin(angle), radius, FIN_LENGTH));
    }
    rings
}

/// Fins are longest at the plate and run out along a hollow curve.
fn fin_length(height: f64) -> f64 {
    let below = ((UNDERSIDE - FILLET - height) / FIN_DEPTH).clamp(0.0, 1.0);
    let straight = 1.0 - below;
    FIN_LENGTH * straight * straight * (1.0 + 0.9 * below)
}

fn keel(ring: &Ring, height: f64, radius: f64, fin: f64) -> Vec<DVec3> {
    let axis = DVec2::new(lean(height), 0.0);
    ring.section(radius, fin)
        .into_iter()
        .map(|point| at(point + axis, height))
        .collect()
}

/// From the keel's foot straight out to the edge.
fn underside(ring: &Ring, rings: usize) -> Vec<Vec<DVec3>> {
    let from = ring.section(STEM_RADIUS + FILLET, FIN_LENGTH);
    (1..rings)
        .map(|k| {
            let part = k as f64 / rings as f64;
            let between = |(&angle, &foot): (&f64, &DVec2)| {
                at(foot.lerp(outline::inset(angle, EDGE[0].0), part), UNDERSIDE)
            };
            ring.polar.iter().zip(&from).map(between).collect()
        })
        .collect()
}

fn edge(ring: &Ring, inwards: f64, height: f64) -> Vec<DVec3> {
    ring.polar
        .iter()
        .map(|&angle| at(outline::inset(angle, inwards), height))
        .collect()
}

/// The floor of the recess, from its wall towards the middle.
fn floor(ring: &Ring, rings: usize) -> Vec<Vec<DVec3>> {
    (0..rings)
        .map(|k| {
            let part = 1.0 - k as f64 / rings as f64;
            ring.polar
                .iter()
                .map(|&angle| at(outline::inset(angle, 2.85) * part, FLOOR))
                .collect()
        })
        .collect()
}

/// Joins the rings from below upwards and closes both ends with a fan.
fn stack(rings: &[Vec<DVec3>], bottom: DVec3, top: DVec3) -> Builder {
    let mut builder = Builder::default();
    let (below, above) = (builder.vertex(bottom), builder.vertex(top));
    let indices: Vec<Vec<u32>> = rings
        .iter()
        .map(|ring| ring.iter().map(|&point| builder.vertex(point)).collect())
        .collect();
    let points = rings[0].len();
    let (first, last) = (&indices[0], &indices[indices.len() - 1]);
    for m in 0..points {
        let next = (m + 1) % points;
        builder.triangle(below, first[m], first[next]);
        for pair in indices.windows(2) {
            builder.quad(pair[0][m], pair[1][m], pair[1][next], pair[0][next]);
        }
        builder.triangle(above, last[next], last[m]);
    }
    builder
}
