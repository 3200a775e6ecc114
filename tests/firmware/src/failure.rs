//! Why there is no proof.

use core::fmt;

use fluoropose::camera::CameraError;
use fluoropose::finder::FindError;
use fluoropose::image::contour::OutlineError;
use fluoropose::image::mask::MaskError;
use fluoropose::implant::ImplantError;
use fluoropose::library::LibraryError;
use fluoropose::locate::LocateError;
use fluoropose::refine::RefineError;

/// Why there is no proof; a board has a word for it, the host all of it.
#[derive(Debug)]
pub enum Failure {
    /// The bytes in flash are no library.
    Library(LibraryError),
    /// The bytes in flash are no implant.
    Implant(ImplantError),
    /// The points in flash are no outline.
    Outline(OutlineError),
    /// The working memory holds no mask of the silhouette.
    Mask(MaskError),
    /// The calibration is none, or sees no such part.
    Camera(CameraError),
    /// No view was found.
    Locate(LocateError),
    /// No pose explains the outline.
    Find(FindError),
    /// The pose cannot be refined.
    Refine(RefineError),
    /// Nothing was found.
    NoPose,
    /// A line could not be written.
    Write,
}

impl Failure {
    /// A word for it.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Library(_) => "library",
            Self::Implant(_) => "implant",
            Self::Outline(_) => "outline",
            Self::Mask(_) => "mask",
            Self::Camera(_) => "camera",
            Self::Locate(_) => "locate",
            Self::Find(_) => "find",
            Self::Refine(_) => "refine",
            Self::NoPose => "no pose",
            Self::Write => "write",
        }
    }
}

/// What each kind of error becomes.
macro_rules! failures {
    ($($error:ty => $kind:ident),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::$kind(error)
            }
        })*
    };
}

failures!(
    LibraryError => Library,
    ImplantError => Implant,
    OutlineError => Outline,
    MaskError => Mask,
    CameraError => Camera,
    LocateError => Locate,
    FindError => Find,
    RefineError => Refine
);

impl From<fmt::Error> for Failure {
    fn from(_: fmt::Error) -> Self {
        Self::Write
    }
}
