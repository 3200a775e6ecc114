//! What is known of a component in a frame.

/// What is known of a component in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// A person gave the pose: nothing changes it.
    Fixed,
    /// Found, and to be trusted.
    Followed,
    /// Not found, and taken from the frames on both sides.
    Interpolated,
    /// Found, and to be looked at.
    Doubtful,
    /// Looked for and not there: out of the frame, or hidden.
    Untrackable,
    /// Never reached.
    Unsolved,
}

impl State {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Fixed,
        Self::Followed,
        Self::Interpolated,
        Self::Doubtful,
        Self::Untrackable,
        Self::Unsolved,
    ];

    /// The word for it in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Followed => "followed",
            Self::Interpolated => "interpolated",
            Self::Doubtful => "doubtful",
            Self::Untrackable => "untrackable",
            Self::Unsolved => "unsolved",
        }
    }
}
