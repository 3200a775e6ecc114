//! How exactly a pose is refined.

use super::stages::STAGES;

/// How exactly a pose is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// As exactly as the outlines allow: polishing ends where a step is below 0.001 degrees or 0.005 mm.
    #[default]
    Full,
    /// Polishing ends twenty times sooner, where a step is below 0.02 degrees or 0.1 mm: for a pose
    /// that follows a hand and is refined again when it rests.
    Interactive,
    /// At most six steps from a fifth of the border pixels, without polishing: shows which minimum a start leads to. The
    /// loss is that of these pixels.
    Probe,
}

impl Effort {
    /// One of this many border pixels is a sample.
    pub(super) fn every(self) -> usize {
        match self {
            Self::Full | Self::Interactive => 1,
            Self::Probe => 5,
        }
    }

    /// Most steps tried in each stage.
    pub(super) fn steps(self) -> [usize; STAGES] {
        match self {
            Self::Full | Self::Interactive => [10, 8, 14, 10],
            // It does not come from far.
            Self::Probe => [4, 0, 0, 2],
        }
    }

    /// The size of a step ([`super::step::Step::size`]) that polishing ends at, on silhouettes; `None`
    /// where nothing is polished.
    pub(super) fn polished(self) -> Option<f64> {
        match self {
            Self::Full => Some(0.001),
            Self::Interactive => Some(0.02),
            Self::Probe => None,
        }
    }
}
