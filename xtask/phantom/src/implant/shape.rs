//! The surfaces of the femoral component as functions of a place `(s, z)`.
//!
//! `s` runs from the tip of the anterior flange (0) over the five bone cuts to the tip of the posterior condyles (5); a whole
//! number is an edge between two cuts: 0..1 anterior, 1..2 anterior chamfer, 2..3 distal, 3..4 posterior chamfer,
//! 4..5 posterior. `z` is mediolateral in mm, lateral negative. Lengths are those of a part about 70 mm wide.

use super::arcs::ArcChain;
use crate::table::{Table, mix, smooth_step};
use glam::DVec3;
use libm::{cos, sin};

/// The largest value of `s`.
pub(super) const LAST_CUT: f64 = 5.0;

/// Corners of the box that the bone is cut to, `[x, y]` in mm, one at each whole `s`.
const BOX: [[f64; 2]; 6] = [
    [36.4, 37.0],
    [31.5, -2.0],
    [17.0, -15.0],
    [-4.5, -15.0],
    [-12.2, -7.5],
    [-12.2, 11.5],
];

/// Direction of the outer surface's normal above each corner of the box, in degrees; 0 is anterior, -90 distal.
const NORMAL_DEG: [f64; 6] = [28.0, -20.0, -69.0, -112.0, -156.0, -215.0];

/// J-curve of the lateral and the medial condyle: (end direction in degrees, radius in mm), posterior first. The medial
/// posterior radius is larger; the lateral trochlea stands further out.
const LATERAL_ARCS: [(f64, f64); 5] = [
    (-137.0, 20.2),
    (-70.0, 31.9),
    (-20.0, 37.0),
    (-2.0, 62.0),
    (28.0, 42.0),
];
const MEDIAL_ARCS: [(f64, f64); 5] = [
    (-134.0, 21.4),
    (-70.0, 31.0),
    (-20.0, 35.4),
    (-2.0, 60.0),
    (28.0, 41.0),
];

/// Distance of the outer edges from the middle, without the rolled rim.
const LATERAL_EDGE: Table = Table(&[
    (0.0, 17.0),
    (0.5, 21.0),
    (1.0, 25.0),
    (1.5, 29.5),
    (2.0, 32.0),
    (2.6, 32.4),
    (3.6, 31.6),
    (5.0, 29.2),
]);
const MEDIAL_EDGE: Table = Table(&[
    (0.0, 15.5),
    (0.5, 19.0),
    (1.0, 23.5),
    (1.5, 29.0),
    (2.0, 32.6),
    (2.6, 33.6),
    (3.6, 33.4),
    (5.0, 31.6),
]);

/// Distance of the crest of each condyle (of the trochlea's lip, further up) from the middle.
const LATERAL_CREST: Table = Table(&[
    (0.0, 11.5),
    (1.0, 16.0),
    (2.0, 20.5),
    (3.0, 21.0),
    (5.0, 19.8),
]);
const MEDIAL_CREST: Table = Table(&[
    (0.0, 10.5),
    (1.0, 15.0),
    (2.0, 21.0),
    (3.0, 22.0),
    (5.0, 21.2),
]);

/// Depth of the patellar groove below the crests, which runs out into the intercondylar notch.
const GROOVE: Table = Table(&[
    (0.0, 1.0),
    (0.5, 3.2),
    (1.0, 4.6),
    (1.5, 5.4),
    (2.0, 5.8),
    (3.0, 6.2),
    (5.0, 6.2),
]);

/// Coronal radius of each condyle outside its crest.
const CROWN_RADIUS: [f64; 2] = [22.0, 25.0];

/// Half the width of the intercondylar notch, and how much wider it is at the posterior tips.
pub(super) const NOTCH_RADIUS: f64 = 9.8;
const NOTCH_FLARE: f64 = 1.2;

/// Length of one unit of `s` on the distal cut, in mm.
pub(super) const DISTAL_CUT: f64 = BOX[2][0] - BOX[3][0];

/// The sagittal curves, worked out once.
pub(super) struct Shape {
    lateral: ArcChain,
    medial: ArcChain,
}

impl Shape {
    /// Works out the curves.
    pub(super) fn new() -> Self {
        let start = NORMAL_DEG[5];
        Self {
            lateral: ArcChain::from_origin_arc(start, &LATERAL_ARCS),
            medial: ArcChain::from_origin_arc(start, &MEDIAL_ARCS),
        }
    }

    /// A point of the bearing surface.
    pub(super) fn outer(&self, s: f64, z: f64) -> DVec3 {
        let (lateral, from_lateral) = sagittal(&self.lateral, s);
        let (medial, from_medial) = sagittal(&self.medial, s);
        let towards_medial = smooth_step((z + 10.0) / 20.0);
        let normal = mix(from_lateral, from_medial, towards_medial);
        let below = depth(s, z);
        DVec3::new(
            mix(lateral[0], medial[0], towards_medial) - below * cos(normal),
            mix(lateral[1], medial[1], towards_medial) - below * sin(normal),
            z,
        )
    }
}

/// The point of a J-curve at `s` and the direction of its normal in radians.
fn sagittal(chain: &ArcChain, s: f64) -> ([f64; 2], f64) {
    let (cut, part) = cut_of(s);
    let from = NORMAL_DEG[cut].to_radians();
    let to = NORMAL_DEG[cut + 1].to_radians();
    let normal = chain.direction_between(from, to, part);
    (chain.point(normal), normal)
}

/// A point of the box cuts: the surface towards the bone.
pub(super) fn inner(s: f64, z: f64) -> DVec3 {
    let (cut, part) = cut_of(s);
    let (a, b) = (BOX[cut], BOX[cut + 1]);
    DVec3::new(mix(a[0], b[0], part), mix(a[1], b[1], part), z)
}

/// The cut `s` lies on and the part of it that has passed.
fn cut_of(s: f64) -> (usize, f64) {
    let cut = (s.max(0.0) as usize).min(4);
    (cut, s - cut as f64)
}

/// How far the surface lies below the crest's J-curve.
fn depth(s: f64, z: f64) -> f64 {
    let (crest, radius) = if z < 0.0 {
        (LATERAL_CREST.at(s), CROWN_RADIUS[0])
    } else {
        (MEDIAL_CREST.at(s), CROWN_RADIUS[1])
    };
    let from_crest = z.abs() - crest;
    if from_crest < 0.0 {
        GROOVE.at(s) * (1.0 + cos(std::f64::consts::PI * z.abs() / crest)) / 2.0
    } else {
        from_crest * from_crest / (2.0 * radius)
    }
}

/// Lateral (negative) and medial edge at `s`.
pub(super) fn edges(s: f64) -> [f64; 2] {
    [-LATERAL_EDGE.at(s), MEDIAL_EDGE.at(s)]
}

/// Half the width of the notch where its walls run straight, at `s`.
pub(super) fn notch_half_width(s: f64) -> f64 {
    NOTCH_RADIUS + NOTCH_FLARE * smooth_step((s - 3.0) / 2.0)
}
