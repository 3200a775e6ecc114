//! The outline of the tibial plate: a kidney with a posterior notch, in polar form about the stem's axis.

use crate::table::{mix, smooth_step};
use glam::DVec2;
use libm::{cos, exp, fabs, pow, sin};
use std::f64::consts::{PI, TAU};

/// Half axes of the outline in mm: anterior, posterior on the lateral and on the medial side, mediolateral.
const ANTERIOR: f64 = 21.0;
const POSTERIOR_LATERAL: f64 = 27.0;
const POSTERIOR_MEDIAL: f64 = 27.8;
const SIDEWAYS: f64 = 36.5;
/// Exponents of the superellipses in front and behind: 2 is an ellipse, more is boxier.
const EXPONENT_FRONT: f64 = 2.05;
const EXPONENT_BACK: f64 = 2.6;
/// Posterior notch: depth in mm and half width in radians.
const NOTCH_DEPTH: f64 = 12.5;
const NOTCH_ANGLE: f64 = 0.47;

/// A point of the outline, `(x, z)` in mm. The angle runs from anterior (0) to medial.
fn point(angle: f64) -> DVec2 {
    let (along, exponent) = if cos(angle) < 0.0 {
        let medial = smooth_step(sin(angle) + 0.5);
        (
            mix(POSTERIOR_LATERAL, POSTERIOR_MEDIAL, medial),
            EXPONENT_BACK,
        )
    } else {
        (ANTERIOR, EXPONENT_FRONT)
    };
    let sum = pow(fabs(cos(angle)) / along, exponent) + pow(fabs(sin(angle)) / SIDEWAYS, exponent);
    let from_notch = fabs(fabs(wrapped(angle)) - PI) / NOTCH_ANGLE;
    let radius = pow(sum, -1.0 / exponent) - NOTCH_DEPTH * exp(-pow(from_notch, 3.6));
    DVec2::new(cos(angle), sin(angle)) * radius
}

/// A point of the outline moved inwards at a right angle, in mm.
pub(super) fn inset(angle: f64, by: f64) -> DVec2 {
    let along = point(angle + 1e-4) - point(angle - 1e-4);
    point(angle) + DVec2::new(-along.y, along.x).normalize() * by
}

/// An angle brought to -pi..pi.
pub(super) fn wrapped(angle: f64) -> f64 {
    let turned = angle % TAU;
    if turned > PI {
        turned - TAU
    } else if turned < -PI {
        turned + TAU
    } else {
        turned
    }
}
