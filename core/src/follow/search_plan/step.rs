//! What is to be done next.

use crate::pose::Pose;

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchStep {
    /// Way in which metal is shown: 0 dark, 1 bright; of one that was told always 0.
    pub way: usize,
    /// Number of the component.
    pub part: usize,
    /// Number of the frame.
    pub frame: usize,
    /// What is to be done there.
    pub search: Search,
}

/// Where in a whole frame a component is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// Where something has a shape that it has from some side: few places, and nearly all that lead to it.
    Shaped,
    /// Where something is dark: many.
    Dark,
    /// At the first, then at the others.
    All,
}

/// How a component is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// In the whole frame; `depth_mm` is about how far away it is, where another one tells that.
    Whole {
        /// Distance, mm.
        depth_mm: Option<f64>,
        /// Where there.
        places: Places,
    },
    /// Where its joint leaves it beside the other one ([`crate::follow::JointSearch`]), whose silhouette is left out of sight.
    Joint(Other),
    /// In the whole frame beside the other one, whose silhouette is left out of sight.
    Beside {
        /// The other one.
        other: Other,
        /// Distance, mm.
        depth_mm: f64,
    },
    /// It is known there, and is to be followed [`super::FAR`] frames to both sides: [`super::SearchPlan::followed`] takes the answer.
    Follow {
        /// Which of the frames in which it is known.
        from: usize,
    },
}

/// Another component that is known in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Other {
    /// Number of the component.
    pub part: usize,
    /// Which of the frames in which it is known it was followed from.
    pub from: usize,
    /// `camera_from_model`.
    pub pose: Pose,
}
