//! What a correction by a film is given up for.

use crate::pose::Pose;

/// What a correction by a film is given up for, because nothing hangs on where it would end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unless<'u> {
    /// Loss, square pixels: what is so far above it that it is not likely to fall below.
    pub(crate) hopeless: f64,
    /// Poses to which others have led: what comes to one of them.
    pub(crate) known: &'u [Pose],
}

impl Unless<'_> {
    /// For nothing.
    pub(crate) const NOTHING: Self = Self {
        hopeless: f64::INFINITY,
        known: &[],
    };
}

/// How a correction ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    /// On its own.
    Itself,
    /// Given up for what it leaves.
    Hopeless,
    /// At a pose that is known.
    Known,
}
