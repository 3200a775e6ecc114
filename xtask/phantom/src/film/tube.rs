//! A limb or a bone: a tube with a rounded cross-section whose outline, seen from the side, is two tables.

use crate::table::{Table, smooth_step};
use libm::pow;

/// A tube along the proximal axis. Tables run over the proximal coordinate, in mm.
pub(super) struct Tube {
    /// Anterior outline.
    pub(super) front: Table,
    /// Posterior outline.
    pub(super) back: Table,
    /// Half the thickness from medial to lateral.
    pub(super) half: Table,
    /// Thickness of the dense shell.
    pub(super) wall: Table,
    /// First and last proximal coordinate.
    pub(super) range: (f64, f64),
    /// Shape of the cross-section: 2 is an ellipse, more is boxier.
    pub(super) exponent: f64,
    /// Length over which both ends fade in, mm.
    pub(super) fade: f64,
}

/// What a ray passes through, in mm.
#[derive(Clone, Copy, Default)]
pub(super) struct Chord {
    /// In the whole tube.
    pub(super) whole: f64,
    /// In the shell alone.
    pub(super) shell: f64,
}

impl Tube {
    /// The chord of a ray across the plane at `[anterior, proximal]`.
    pub(super) fn chord(&self, [x, y]: [f64; 2]) -> Chord {
        if y <= self.range.0 || y >= self.range.1 {
            return Chord::default();
        }
        let (front, back) = (self.front.at(y), self.back.at(y));
        if x >= front || x <= back {
            return Chord::default();
        }
        let end = smooth_step((y - self.range.0) / self.fade)
            * smooth_step((self.range.1 - y) / self.fade);
        let (off, reach, half) = (
            (x - (front + back) / 2.0).abs(),
            (front - back) / 2.0,
            self.half.at(y),
        );
        let wall = self.wall.at(y);
        let whole = across(off, reach, half, self.exponent);
        let hollow = across(off, reach - wall, half - wall, self.exponent);
        Chord {
            whole: end * whole,
            shell: end * (whole - hollow),
        }
    }
}

/// Thickness of a superellipse at a distance off its middle.
fn across(off: f64, reach: f64, half: f64, exponent: f64) -> f64 {
    if off >= reach || half <= 0.0 {
        return 0.0;
    }
    2.0 * half * pow(1.0 - pow(off / reach, exponent), 1.0 / exponent)
}

/// The larger of two thicknesses with a rounded change from one to the other over about `softness` mm.
pub(super) fn soft_max(a: f64, b: f64, softness: f64) -> f64 {
    (a + b + libm::sqrt((a - b) * (a - b) + softness * softness) - softness) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_bar() -> Tube {
        Tube {
            front: Table(&[(0.0, 10.0), (100.0, 10.0)]),
            back: Table(&[(0.0, -10.0), (100.0, -10.0)]),
            half: Table(&[(0.0, 10.0), (100.0, 10.0)]),
            wall: Table(&[(0.0, 4.0), (100.0, 4.0)]),
            range: (0.0, 100.0),
            exponent: 2.0,
            fade: 1.0,
        }
    }

    #[test]
    fn chords_are_those_of_a_hollow_cylinder() {
        let bar = round_bar();
        for x in [-9.0, -3.0, 0.0, 5.5, 8.0] {
            let chord = bar.chord([x, 50.0]);
            let whole = 2.0 * f64::sqrt(100.0 - x * x);
            let hollow = 2.0 * f64::sqrt(f64::max(36.0 - x * x, 0.0));
            assert!((chord.whole - whole).abs() < 1e-9);
            assert!((chord.shell - (whole - hollow)).abs() < 1e-9);
        }
        assert_eq!(bar.chord([10.5, 50.0]).whole, 0.0);
        assert_eq!(bar.chord([0.0, 101.0]).whole, 0.0);
    }

    #[test]
    fn soft_max_of_nothing_is_nothing() {
        assert_eq!(soft_max(0.0, 0.0, 9.0), 0.0);
        assert!((soft_max(80.0, 0.0, 9.0) - 80.0).abs() < 5.0);
    }
}
