//! On which side of an edge the implant lies.

/// Whether the implant is darker or brighter than what surrounds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inside {
    /// The implant is darker, as a fluoroscope shows it.
    Dark,
    /// The implant is brighter, as in an inverted frame.
    Bright,
}

/// On which hand of a path the implant lies, seen along the path from its first point on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hand {
    /// On the left: the outline is traced anticlockwise on the screen.
    Left,
    /// Unknown: edges of either sign are followed.
    Either,
    /// On the right: the outline is traced clockwise on the screen.
    Right,
}
