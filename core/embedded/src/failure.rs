//! What a call gives back: that it went well, or why not.

use fluoropose::camera::CameraError;
use fluoropose::finder::FindError;
use fluoropose::image::contour::OutlineError;
use fluoropose::image::mask::MaskError;
use fluoropose::image::runs::RunsError;
use fluoropose::implant::ImplantError;
use thiserror::Error;

/// `fluoropose_status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
    /// `FLUOROPOSE_NEAR`.
    Near = 11,
}

/// Why there is no answer; displayed, a sentence.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Failure {
    /// A pointer leads nowhere.
    #[error("a pointer is null, or its address does not suit what it leads to")]
    Pointer,
    /// Memory is too short for what was asked for.
    #[error("memory is too short for the room that was asked for")]
    Memory,
    /// The bytes are no implant.
    #[error(transparent)]
    Implant(#[from] ImplantError),
    /// The camera is none.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The points are no outline.
    #[error(transparent)]
    Outline(#[from] OutlineError),
    /// A row cannot be where it was said to be.
    #[error(transparent)]
    Rows(#[from] RunsError),
    /// A row is not as wide as the frame.
    #[error("a row has {width} pixels, and the frame of this camera {wanted}")]
    Width {
        /// Pixels of the row.
        width: usize,
        /// Columns of the frame.
        wanted: usize,
    },
    /// The silhouette is empty, or larger than there is memory for.
    #[error(transparent)]
    Silhouette(#[from] MaskError),
    /// The silhouette, or an outline that is compared with it, is larger than the session's room.
    #[error("{needed} {what} are needed; the session has room for {given}")]
    Room {
        /// What, in the plural, as `fluoropose_room` counts it.
        what: &'static str,
        /// How many this frame takes.
        needed: usize,
        /// How many there is room for.
        given: usize,
    },
    /// No pose explains it.
    #[error(transparent)]
    Find(#[from] FindError),
    /// What a search was to begin at is no pose.
    #[error(
        "what the search was to begin near is no pose: its rotation is none, or a number is none"
    )]
    Near,
    /// A call came before the one that it goes on from.
    #[error("a silhouette comes first, then the search, then what it found")]
    Order,
}

impl Failure {
    /// As C has it.
    #[must_use]
    pub fn status(&self) -> Status {
        match self {
            Self::Pointer => Status::Pointer,
            Self::Memory => Status::Memory,
            Self::Implant(_) => Status::Implant,
            Self::Camera(_) => Status::Camera,
            Self::Outline(_) => Status::Outline,
            Self::Rows(_) | Self::Width { .. } => Status::Rows,
            Self::Silhouette(_) | Self::Room { .. } => Status::Silhouette,
            Self::Find(_) => Status::NoPose,
            Self::Near => Status::Near,
            Self::Order => Status::Order,
        }
    }
}
