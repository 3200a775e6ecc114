//! What a call gives back: that it went well, or why not.

use core::fmt;

use fluoropose::camera::CameraError;
use fluoropose::finder::FindError;
use fluoropose::image::contour::OutlineError;
use fluoropose::image::mask::MaskError;
use fluoropose::image::runs::RunsError;
use fluoropose::implant::ImplantError;

/// `fluoropose_status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// `FLUOROPOSE_OK`.
    Ok = 0,
    /// `FLUOROPOSE_POINTER`.
    Pointer = 1,
    /// `FLUOROPOSE_MEMORY`.
    Memory = 2,
    /// `FLUOROPOSE_IMPLANT`.
    Implant = 3,
    /// `FLUOROPOSE_CAMERA`.
    Camera = 4,
    /// `FLUOROPOSE_OUTLINE`.
    Outline = 5,
    /// `FLUOROPOSE_ROWS`.
    Rows = 6,
    /// `FLUOROPOSE_SILHOUETTE`.
    Silhouette = 7,
    /// `FLUOROPOSE_NO_POSE`.
    NoPose = 8,
    /// `FLUOROPOSE_ORDER`.
    Order = 9,
    /// `FLUOROPOSE_MORE`.
    More = 10,
}

/// Why there is no answer; displayed, a sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// Memory is too short for what was asked for.
    Memory,
    /// The bytes are no implant.
    Implant(ImplantError),
    /// The camera is none.
    Camera(CameraError),
    /// The points are no outline.
    Outline(OutlineError),
    /// A row cannot be where it was said to be.
    Rows(RunsError),
    /// The silhouette is empty, or larger than there is memory for.
    Silhouette(MaskError),
    /// No pose explains it.
    Find(FindError),
    /// A call came before the one that it goes on from.
    Order,
}

impl Failure {
    /// As C has it.
    #[must_use]
    pub fn status(&self) -> Status {
        match self {
            Self::Memory => Status::Memory,
            Self::Implant(_) => Status::Implant,
            Self::Camera(_) => Status::Camera,
            Self::Outline(_) => Status::Outline,
            Self::Rows(_) => Status::Rows,
            Self::Silhouette(_) => Status::Silhouette,
            Self::Find(_) => Status::NoPose,
            Self::Order => Status::Order,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory => f.write_str("memory is too short for the room that was asked for"),
            Self::Implant(error) => error.fmt(f),
            Self::Camera(error) => error.fmt(f),
            Self::Outline(error) => error.fmt(f),
            Self::Rows(error) => error.fmt(f),
            Self::Silhouette(error) => error.fmt(f),
            Self::Find(error) => error.fmt(f),
            Self::Order => {
                f.write_str("a silhouette comes first, then the search, then what it found")
            }
        }
    }
}

impl From<ImplantError> for Failure {
    fn from(error: ImplantError) -> Self {
        Self::Implant(error)
    }
}

impl From<CameraError> for Failure {
    fn from(error: CameraError) -> Self {
        Self::Camera(error)
    }
}

impl From<OutlineError> for Failure {
    fn from(error: OutlineError) -> Self {
        Self::Outline(error)
    }
}

impl From<RunsError> for Failure {
    fn from(error: RunsError) -> Self {
        Self::Rows(error)
    }
}

impl From<MaskError> for Failure {
    fn from(error: MaskError) -> Self {
        Self::Silhouette(error)
    }
}

impl From<FindError> for Failure {
    fn from(error: FindError) -> Self {
        Self::Find(error)
    }
}
