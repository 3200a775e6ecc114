//! What snapping is asked for, and the samples of the line that is snapped.

use crate::side::{Hand, Inside};
use crate::vertex::Vertex;

/// The greatest reach, pixels.
pub const MOST_REACH: f64 = 16.0;
/// Distance between places along a normal, pixels.
pub(super) const STEP: f64 = 0.5;
/// Number of places along a normal: those of the greatest reach to both sides, and that on the line.
pub(super) const STATES: usize = 2 * (MOST_REACH / STEP) as usize + 1;

/// Which line is snapped, and how far it may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// On which hand of an open line the implant lies. In a closed line it lies inside, and this is ignored.
    pub hand: Hand,
    /// Whether the implant is darker or brighter than what surrounds it.
    pub inside: Inside,
    /// The distance to both sides within which edges are searched, pixels: 0.5 to [`MOST_REACH`].
    pub reach: f64,
    /// The new line is simplified by at most this distance, pixels.
    pub tolerance: f64,
}

/// A sample of a line. Opaque: callers only provide the memory for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    pub(super) vertex: Vertex,
    /// Unit vector along which edges of the implant get brighter.
    pub(super) normal: [f64; 2],
    /// Distance from the sample before, pixels.
    pub(super) step: f64,
    /// Where along the normal it moves, pixels.
    pub(super) offset: f64,
    /// Whether there is an edge.
    pub(super) on_edge: bool,
}
