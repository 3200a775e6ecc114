//! Points that remember where on the given outline they come from.

use fluoropose::image::contour::Point;
use fluoropose::math::floor;

/// A point that a tracing tool has made or kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Its place, pixels.
    pub at: Point,
    /// Its place along the outline that was given. `k` is point number `k`, unchanged to the last bit. `k + t`, with
    /// `t` strictly between 0 and 1, is a point that lies on side `k` (from point `k` to the next) at the fraction `t`
    /// of that side, or that was moved from there. [`NEW`] is a point without such a place.
    pub from: f64,
}

/// [`Vertex::from`] of a point that lies nowhere on the outline that was given.
pub const NEW: f64 = -1.0;

impl Vertex {
    /// Point `number` of the given outline, unchanged.
    #[must_use]
    pub fn kept(number: usize, at: Point) -> Self {
        Self {
            at,
            from: number as f64,
        }
    }

    /// A point from side `number` at the fraction `t` of it, which is brought strictly between 0 and 1.
    #[must_use]
    pub fn from_side(number: usize, t: f64, at: Point) -> Self {
        let least = 1e-9;
        Self {
            at,
            from: number as f64 + t.clamp(least, 1.0 - least),
        }
    }

    /// A point that lies nowhere on the given outline.
    #[must_use]
    pub fn new(at: Point) -> Self {
        Self { at, from: NEW }
    }

    /// The number of the given outline's point that this point is; `None` where it was made or moved.
    #[must_use]
    pub fn kept_number(&self) -> Option<usize> {
        let whole = self.from >= 0.0 && floor(self.from) == self.from;
        whole.then_some(self.from as usize)
    }
}

/// How far the line that was given lies from the line that was made, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShapeError {
    /// The greatest distance of a point of the given line from the line that was made.
    pub max: f64,
    /// The root mean square distance along the given line.
    pub rms: f64,
}
