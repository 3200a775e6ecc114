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
    /// A third of the border pixels, and no step smaller than what they tell: for a pose that follows a film, whose
    /// uncertainty is a hundred times larger.
    Film,
    /// At most six steps from a fifth of the border pixels, without polishing: shows which minimum a start leads to. The
    /// loss is that of these pixels.
    Probe,
}

impl Effort {
    /// One of this many border pixels is a sample.
    pub(super) fn every(self) -> usize {
        match self {
            Self::Full | Self::Interactive => 1,
            Self::Film => 3,
            Self::Probe => 5,
        }
    }

    /// Most steps tried in each stage.
    pub(super) fn steps(self) -> [usize; STAGES] {
        match self {
            Self::Full | Self::Interactive => [10, 8, 14, 10],
            Self::Film => [8, 4, 4, 6],
            // It does not come from far.
            Self::Probe => [4, 0, 0, 2],
        }
    }

    /// How much larger steps may be than those of the others where a stage ends.
    pub(super) fn coarser(self) -> f64 {
        match self {
            Self::Film => 20.0,
            _ => 1.0,
        }
    }

    /// The size of a step ([`super::step::Step::size`]) that polishing ends at, on silhouettes; `None`
    /// where nothing is polished.
    pub(super) fn polished(self) -> Option<f64> {
        match self {
            Self::Full => Some(0.001),
            Self::Interactive => Some(0.02),
            Self::Film => Some(0.5),
            Self::Probe => None,
        }
    }
}
