//! The unknowns of an estimate: how many there are, and which is which.

/// Most components of a film.
pub const MOST_COMPONENTS: usize = 4;

/// Contrast times curvature, the logarithm of the blur, those of the attenuations, by how much edges were enhanced, and the
/// logarithm of the radius.
pub(super) const UNKNOWNS: usize = 4 + MOST_COMPONENTS;
pub(super) const CURVATURE: usize = 0;
pub(super) const BLUR: usize = 1;
pub(super) const AMOUNT: usize = 2 + MOST_COMPONENTS;
pub(super) const RADIUS: usize = AMOUNT + 1;
/// Unknowns that one profile depends on.
pub(super) const OF_A_PROFILE: usize = 5;

pub(super) type Vector = [f64; UNKNOWNS];
pub(super) type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

/// At least so many profiles tell anything.
pub(super) const LEAST_PROFILES: usize = 40;

/// What is known of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayKnowledge {
    /// The profiles tell it.
    Told,
    /// They do not: components contradict each other, and an unsharp mask may pass for a curve. The film is taken to be linear.
    Untold,
    /// One component alone tells of a curve, or of an unsharp mask that passes for one. The film is taken to be in the middle, and
    /// both are covered by its covariance.
    Either,
    /// A person stated it.
    Stated,
}
