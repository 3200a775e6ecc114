//! By how much the pose of a frame is more likely than another one.

#[cfg(feature = "alloc")]
use super::side_samples::SideSample;
use super::sides::Rival;
#[cfg(feature = "alloc")]
use super::sides::{Side, SideStep};

/// By how much another pose of a frame is less likely than its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideMargin {
    /// What the other pose is.
    pub rival: Rival,
    /// 1 is what a frame says that decides by itself.
    pub margin: f64,
}

#[cfg(feature = "alloc")]
impl SideMargin {
    /// The same where either pose may be the right one.
    pub(super) fn open(self) -> Self {
        Self {
            margin: 0.0,
            ..self
        }
    }
}

/// By how much the other pose of a frame is less likely, by the nearest frame that was seen with it; `None` where there is
/// none.
#[cfg(feature = "alloc")]
pub(super) fn side_margin(
    samples: &[SideSample],
    steps: &[SideStep],
    frame: usize,
) -> Option<SideMargin> {
    let nearest = nearest(samples, frame)?;
    let rival = samples[nearest].rival;
    samples[nearest].free()?;
    let step = steps.get(nearest)?;
    let margin = match (rival, step.side) {
        // Nothing went over to what leaves less.
        (Rival::Elsewhere, Side::Mirrored) => 0.0,
        _ => step.margin,
    };
    Some(SideMargin { rival, margin })
}

/// The more likely of two other poses of a frame.
#[cfg(feature = "alloc")]
pub(super) fn nearer_rival(
    one: Option<SideMargin>,
    other: Option<SideMargin>,
) -> Option<SideMargin> {
    let both = one.into_iter().chain(other);
    both.min_by(|one, other| one.margin.total_cmp(&other.margin))
}

/// The sample that is nearest to a frame.
#[cfg(feature = "alloc")]
pub(super) fn nearest(samples: &[SideSample], frame: usize) -> Option<usize> {
    (0..samples.len()).min_by_key(|&k| samples[k].frame.abs_diff(frame))
}
