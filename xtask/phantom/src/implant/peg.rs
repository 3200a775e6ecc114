//! A fixation peg: a square block of grid nodes bent into a round post that stands on its cut.

use super::femur_grid::Node;
use crate::table::mix;
use glam::DVec3;
use libm::{cos, sin};
use std::f64::consts::FRAC_PI_4;

/// Radius and height along the peg from its tip to the foot, in mm.
const PROFILE: [(f64, f64); 5] = [
    (0.0, 12.6),
    (1.9, 12.2),
    (2.7, 10.9),
    (3.2, 0.7),
    (4.4, 0.0),
];

/// Half the side of the block, in cells, at resolution 1.
const HALF: usize = 5;

/// A peg on a node of the distal cut.
pub(super) struct Peg {
    node: Node,
    foot: DVec3,
    half: usize,
}

impl Peg {
    /// A peg that stands on `foot`, the position of `node`.
    pub(super) fn new(node: Node, foot: DVec3, resolution: f64) -> Self {
        Self {
            node,
            foot,
            half: ((HALF as f64 * resolution) as usize).max(HALF),
        }
    }

    /// Where a node that would lie at `natural` goes: onto the peg, or towards the block's border, which stays.
    pub(super) fn bend(&self, node: Node, natural: DVec3) -> Option<DVec3> {
        let (back, across) = self.offset(node);
        let ring = back.abs().max(across.abs());
        if ring >= self.half as i64 {
            return None;
        }
        let passed = ring as f64 / self.half as f64 * PROFILE.len() as f64;
        let (radius, height) = profile(passed);
        let angle = square_angle(back, across);
        let round = self.foot + DVec3::new(-radius * sin(angle), height, radius * cos(angle));
        Some(round.lerp(natural, (passed - (PROFILE.len() - 1) as f64).max(0.0)))
    }

    /// Whether a cell lies on a diagonal of the block, and if so whether its split runs from its first node.
    pub(super) fn split(&self, cell: Node) -> Option<bool> {
        let (back, across) = self.offset(cell);
        let (far_back, far_across) = (2 * back + 1, 2 * across + 1);
        let inside = far_back.abs().max(far_across.abs()) < 2 * self.half as i64;
        (inside && far_back.abs() == far_across.abs()).then_some((far_back < 0) == (far_across < 0))
    }

    fn offset(&self, (row, column): Node) -> (i64, i64) {
        (
            row as i64 - self.node.0 as i64,
            column as i64 - self.node.1 as i64,
        )
    }
}

/// Radius and height at a place of the profile, counted in its points from the tip.
fn profile(passed: f64) -> (f64, f64) {
    let k = (passed as usize).min(PROFILE.len() - 2);
    let ((r0, h0), (r1, h1)) = (PROFILE[k], PROFILE[k + 1]);
    let t = (passed - k as f64).min(1.0);
    (mix(r0, r1, t), mix(h0, h1, t))
}

/// The angle at which a node of a square ring sits on its circle: sides become quarter circles.
fn square_angle(back: i64, across: i64) -> f64 {
    let (b, a) = (back as f64, across as f64);
    if back == 0 && across == 0 {
        0.0
    } else if a >= b.abs() {
        FRAC_PI_4 * b / a
    } else if b >= a.abs() {
        FRAC_PI_4 * (2.0 - a / b)
    } else if -a >= b.abs() {
        FRAC_PI_4 * (4.0 + b / a)
    } else {
        FRAC_PI_4 * (6.0 - a / b)
    }
}
