//! The frame that is searched, and the component that is searched in it.

use fluoropose::camera::Camera;
use fluoropose::film::FilmModel;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose::refine::{ImageTarget, Polarity};

/// A frame and what is known of it.
#[derive(Clone, Copy)]
pub struct Observation<'a> {
    /// The frame.
    pub frame: &'a dyn Grey,
    /// The camera that took it.
    pub camera: &'a Camera,
    /// Whether metal is dark or bright in it.
    pub polarity: Polarity,
    /// Pixels that belong to something else, such as another component that is outlined already.
    pub excluded: Option<&'a Mask<'a>>,
    /// Pixels that are known to be the joint's other component, and what its edges reach beyond it: nothing is known there of an edge. A region
    /// goes on below it.
    pub beside: Option<&'a Mask<'a>>,
    /// What the film makes of the component, where its constants are known.
    pub film: Option<FilmModel>,
}

impl<'a> Observation<'a> {
    /// What poses are refined on.
    pub(super) fn target(&self) -> ImageTarget<'a> {
        ImageTarget {
            frame: self.frame,
            unknown: self.excluded,
            polarity: self.polarity,
            film: self.film,
        }
    }
}

impl core::fmt::Debug for Observation<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Observation")
            .field("size", &self.frame.size())
            .field("polarity", &self.polarity)
            .finish_non_exhaustive()
    }
}
