//! Where a line lies, and its places.

/// Distance between places on a line, pixels.
pub const STEP: f64 = 0.25;
/// The first place: this far inside the line's origin, pixels.
pub const INNER: f64 = 12.0;
/// Places on a line; the last is 8 pixels outside.
pub const POINTS: usize = 81;
/// The place that is the line's origin.
pub(super) const ORIGIN: usize = (INNER / STEP) as usize;

/// Where a line lies, and from where on it is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Course {
    /// Continuous image coordinates of the origin, and the unit direction outwards.
    pub(super) origin: [f64; 2],
    pub(super) direction: [f64; 2],
    /// The first place that is measured; those before it are taken to be as it is.
    pub(super) first: u16,
}

impl Course {
    pub(super) fn first(&self) -> usize {
        usize::from(self.first)
    }

    /// The pixel that a place lies in.
    pub(super) fn pixel(&self, point: usize) -> [i32; 2] {
        let along = STEP * point as f64 - INNER;
        [0, 1].map(|axis| floor(self.origin[axis] + along * self.direction[axis]))
    }
}

/// The whole number below, of what is no farther out than coordinates may be.
fn floor(x: f64) -> i32 {
    const BEYOND: i32 = 1 << 20;
    (x + f64::from(BEYOND)) as i32 - BEYOND
}
