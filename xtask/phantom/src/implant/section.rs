//! Cross-sections of the tibial keel: a round stem with two fins that point outwards and back.

use super::outline::wrapped;
use glam::DVec2;
use libm::{atan2, cos, exp, sin};
use std::f64::consts::TAU;

/// Direction of the fins, from anterior, in radians (115 degrees).
const FIN: f64 = 2.007;
/// Half the angle of the stem's circle that a fin carries outwards whole, in radians.
const TIP: f64 = 0.30;
/// The angle beyond it over which the fin's flank returns to the circle.
const FLANK: f64 = 0.42;

/// Angles of the points of every ring, the same number on each, so that rings join point to point.
pub(super) struct Ring {
    /// Direction from the stem's axis at the plate's underside, from anterior towards medial, radians.
    pub(super) polar: Vec<f64>,
    /// The place on the stem's circle that each direction comes from.
    circle: Vec<f64>,
}

impl Ring {
    /// `points` directions, closer together at the fins, the plate's sides and the notch; radius and fin length are those at the plate.
    pub(super) fn new(points: usize, radius: f64, fin: f64) -> Self {
        let polar = directions(points);
        let circle = polar
            .iter()
            .map(|&angle| place_on_circle(angle, radius, fin))
            .collect();
        Self { polar, circle }
    }

    /// The cross-section `(x, z)` in mm, about the stem's axis.
    pub(super) fn section(&self, radius: f64, fin: f64) -> Vec<DVec2> {
        self.circle
            .iter()
            .map(|&angle| section_point(angle, radius, fin))
            .collect()
    }
}

fn section_point(angle: f64, radius: f64, fin: f64) -> DVec2 {
    let middle = nearest_fin(angle);
    let carried = fin * share(wrapped(angle - middle).abs());
    unit(angle) * radius + unit(middle) * carried
}

fn unit(angle: f64) -> DVec2 {
    DVec2::new(cos(angle), sin(angle))
}

fn nearest_fin(angle: f64) -> f64 {
    if wrapped(angle) < 0.0 { -FIN } else { FIN }
}

/// The share of the fin's length at an angle off its middle: the hollow flank of a fin.
fn share(off: f64) -> f64 {
    let rest = 1.0 - ((off - TIP) / FLANK).clamp(0.0, 1.0);
    rest * rest
}

/// Inverts the direction of [`section_point`] by bisection: it rises with the place on the circle.
fn place_on_circle(polar: f64, radius: f64, fin: f64) -> f64 {
    let middle = nearest_fin(polar);
    let off = wrapped(polar - middle);
    if off.abs() >= TIP + FLANK {
        return polar;
    }
    let (mut low, mut high) = (0.0, TIP + FLANK);
    for _ in 0..60 {
        let place = (low + high) / 2.0;
        let seen = atan2(
            radius * sin(place),
            radius * cos(place) + fin * share(place),
        );
        if seen < off.abs() {
            low = place
        } else {
            high = place
        }
    }
    middle + if off < 0.0 { -low } else { low }
}

/// Directions spread by a density: equal steps of its integral.
fn directions(points: usize) -> Vec<f64> {
    const FINE: usize = 7200;
    let mut passed = Vec::with_capacity(FINE + 1);
    let mut sum = 0.0;
    for k in 0..=FINE {
        passed.push(sum);
        sum += density(TAU * (k as f64 + 0.5) / FINE as f64);
    }
    let whole = passed[FINE];
    let mut k = 0;
    (0..points)
        .map(|m| {
            let wanted = whole * (m as f64 + 0.5) / points as f64;
            while passed[k + 1] <= wanted {
                k += 1;
            }
            let part = (wanted - passed[k]) / (passed[k + 1] - passed[k]);
            TAU * (k as f64 + part) / FINE as f64
        })
        .collect()
}

fn density(angle: f64) -> f64 {
    let bump = |centre: f64, width: f64| {
        let x = wrapped(angle - centre) / width;
        exp(-x * x)
    };
    let fins = bump(FIN, 0.16) + bump(-FIN, 0.16);
    let sides = bump(1.5, 0.3) + bump(-1.5, 0.3);
    1.0 + 2.6 * fins + 1.1 * sides + 1.2 * bump(std::f64::consts::PI, 0.5)
}
