//! What refinement is given: cameras, where they stand, and what they saw.

use crate::camera::Camera;
use crate::film::FilmModel;
use crate::image::crop::Crop;
use crate::image::display::DisplayCurve;
use crate::image::grey::Grey;
use crate::image::mask::Mask;
use crate::image::silhouette::Silhouette;
use crate::pose::Pose;

/// One camera and what it saw of the implant.
#[derive(Clone, Copy, Debug)]
pub struct CameraView<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// `camera_from_world`: [`Pose::IDENTITY`] for the only camera, or for that whose frame is
    /// the world's.
    pub placement: Pose,
    /// What the model is brought onto.
    pub target: Target<'a>,
}

impl<'a> CameraView<'a> {
    /// The only camera of a single-plane study: poses are `camera_from_model`.
    #[must_use]
    pub fn only(camera: &'a Camera, target: impl Into<Target<'a>>) -> Self {
        Self {
            camera,
            placement: Pose::IDENTITY,
            target: target.into(),
        }
    }
}

/// Pixels around a border pixel that its normal and the place of the drawing's own outline are read from.
const BESIDE: usize = 4;

/// What a camera saw.
#[derive(Clone, Copy, Debug)]
pub enum Target<'a> {
    /// A traced silhouette.
    Silhouette(Silhouette<'a>),
    /// The grey frame itself.
    Image(ImageTarget<'a>),
}

impl Target<'_> {
    /// What the film makes of the implant, where that is known.
    pub(super) fn film(&self) -> Option<&FilmModel> {
        match self {
            Self::Silhouette(_) => None,
            Self::Image(image) => image.film.as_ref(),
        }
    }

    /// How far the target's outline is known to lie off the implant's everywhere, pixels.
    pub(super) fn offset_px(&self) -> f64 {
        match self {
            Self::Silhouette(silhouette) => silhouette.common_offset().px,
            Self::Image(_) => 0.0,
        }
    }

    /// Whether what is drawn comes so near to the side of a part of the frame that samples of its outline would not see what
    /// they see in the frame.
    pub(super) fn hides(&self, drawn: &Mask<'_>) -> bool {
        match self {
            Self::Silhouette(silhouette) => {
                let crop = silhouette.crop();
                crop.is_some_and(|crop| crop.is_near_side(drawn, BESIDE))
            }
            Self::Image(_) => false,
        }
    }

    /// Pixels of the frame to the left of the part of it that is held, above it, to the right and below.
    pub(super) fn beyond(&self) -> [usize; 4] {
        let crop = match self {
            Self::Silhouette(silhouette) => silhouette.crop(),
            Self::Image(_) => None,
        };
        crop.map_or([0; 4], Crop::beyond)
    }

    /// Columns and rows of the frame that come before those of the part of it that is held.
    pub(super) fn before(&self) -> [usize; 2] {
        let [left, above, ..] = self.beyond();
        [left, above]
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> (usize, usize) {
        match self {
            Self::Silhouette(silhouette) => (silhouette.mask().width(), silhouette.mask().height()),
            Self::Image(image) => image.frame.size(),
        }
    }
}

impl<'a> From<Silhouette<'a>> for Target<'a> {
    fn from(silhouette: Silhouette<'a>) -> Self {
        Self::Silhouette(silhouette)
    }
}

impl<'a> From<&'a Mask<'a>> for Target<'a> {
    fn from(mask: &'a Mask<'a>) -> Self {
        Self::Silhouette(mask.into())
    }
}

impl<'a> From<ImageTarget<'a>> for Target<'a> {
    fn from(image: ImageTarget<'a>) -> Self {
        Self::Image(image)
    }
}

/// Whether metal is darker or brighter than what surrounds it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Polarity {
    /// As a fluoroscope shows it: what absorbs is dark.
    #[default]
    DarkImplant,
    /// As a radiograph is usually displayed: what absorbs is bright.
    BrightImplant,
}

impl Polarity {
    /// That of a frame in which the implant is brighter than what surrounds it, or is not.
    #[must_use]
    pub const fn of(is_bright: bool) -> Self {
        match is_bright {
            true => Self::BrightImplant,
            false => Self::DarkImplant,
        }
    }
}

/// A grey frame whose edges the model's outline is brought onto.
#[derive(Clone, Copy)]
pub struct ImageTarget<'a> {
    /// The frame.
    pub frame: &'a dyn Grey,
    /// Pixels whose edges are not the implant's: the other component, the frame's diaphragm.
    pub unknown: Option<&'a Mask<'a>>,
    /// Which side of an edge the implant is on.
    pub polarity: Polarity,
    /// What the film makes of the implant, where its constants are known: edges are then where physics puts them, and depth
    /// has no bias. Without it they are taken to be on the outline, and the uncertainty is as wide as that is wrong.
    pub film: Option<FilmModel>,
    /// There is none.
    #[cfg(not(feature = "frames"))]
    pub none: NoFrame,
}

/// What no value is of: without the feature `frames` nothing can be a frame's, and the compiler leaves out what is done with one.
#[cfg(not(feature = "frames"))]
#[derive(Clone, Copy, Debug)]
pub struct NoFrame(core::convert::Infallible);

#[cfg(all(test, feature = "frames"))]
impl<'a> ImageTarget<'a> {
    /// A frame in which metal is dark and of whose film nothing is known.
    pub(crate) fn dark(frame: &'a dyn Grey) -> Self {
        Self {
            frame,
            unknown: None,
            polarity: Polarity::DarkImplant,
            film: None,
        }
    }
}

impl ImageTarget<'_> {
    /// The curve that shows the frame as it is displayed, metal dark.
    pub(super) fn display(&self) -> DisplayCurve {
        DisplayCurve::new(0.0, self.polarity == Polarity::BrightImplant)
    }

    /// The curve by which intensities are read, where the film is known.
    pub(super) fn curve(&self) -> DisplayCurve {
        let inverted = self.polarity == Polarity::BrightImplant;
        match self.film {
            Some(film) => film.curve(inverted),
            None => self.display(),
        }
    }
}

impl core::fmt::Debug for ImageTarget<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("ImageTarget")
            .field("size", &self.frame.size())
            .field("polarity", &self.polarity)
            .field("film", &self.film)
            .finish_non_exhaustive()
    }
}
