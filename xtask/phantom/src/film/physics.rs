//! What a film's grey values depend on besides the poses. The defaults are the demonstration's.

use super::display::{Display, Unsharp};

/// How a film is made. The default is the demonstration's film, byte for byte.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Physics {
    /// What attenuates how much.
    pub alloys: Alloys,
    /// What else lies in the beam.
    pub surroundings: Surroundings,
    /// Blur of focal spot and detector.
    pub blur: Blur,
    /// Light that comes from elsewhere.
    pub scatter: Scatter,
    /// The part of the detector that is lit, and how evenly.
    pub field: Field,
    /// Quanta that a pixel counts, as a multiple of the usual number.
    pub exposure: Exposure,
    /// From intensity to grey.
    pub display: Display,
    /// Edges enhanced after that.
    pub unsharp: Option<Unsharp>,
    /// How finely metal is drawn.
    pub sampling: Sampling,
}

/// Linear attenuation of the implants' alloys at the beam's mean energy, per mm, and how it varies over the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alloys {
    /// Of the femoral component: cobalt-chromium.
    pub femur: f64,
    /// Of the tibial tray: titanium.
    pub tibia: f64,
    /// Variance of the attenuation over the spectrum, divided by its mean squared; 0 is a beam of one energy, which does
    /// not harden.
    pub hardening: f64,
}

impl Default for Alloys {
    fn default() -> Self {
        Self {
            femur: 0.72,
            tibia: 0.2,
            hardening: 0.0,
        }
    }
}

/// What else lies in the beam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// The other leg beside this one, mm to the right of it in the camera's frame; far away it is out of sight.
    pub second_leg_mm: Option<f64>,
    /// A mantle of radio-opaque cement between bone and implants.
    pub cement: Option<Cement>,
    /// Two bone screws below the tray.
    pub screws: bool,
    /// A ruler on the detector.
    pub ruler: bool,
}

/// A mantle of cement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cement {
    /// How thick it is, mm.
    pub thickness_mm: f64,
    /// Linear attenuation of cement with barium sulphate, less that of the bone that it stands in, per mm.
    pub density: f64,
}

impl Default for Cement {
    fn default() -> Self {
        Self {
            thickness_mm: 1.8,
            density: 0.035,
        }
    }
}

/// Standard deviations of Gaussian blur, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// Of the focal spot: before quanta are counted.
    pub focal_px: f64,
    /// Of the detector: afterwards, so that it blurs noise too.
    pub detector_px: f64,
}

impl Default for Blur {
    fn default() -> Self {
        Self {
            focal_px: 0.35,
            detector_px: 0.6,
        }
    }
}

/// Light that comes from elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Its part of the primary beam.
    pub share: f64,
    /// How far it spreads, pixels.
    pub spread_px: f64,
    /// Veiling glare: the same everywhere, as a part of the mean of the primary beam.
    pub glare: f64,
}

impl Default for Scatter {
    fn default() -> Self {
        Self {
            share: 0.055,
            spread_px: 72.0,
            glare: 0.0,
        }
    }
}

impl Scatter {
    /// By what the display is turned down, so that more scatter does not make a brighter film: 1 for the default.
    pub(super) fn gain(&self) -> f64 {
        (1.0 + Self::default().share) / (1.0 + self.share + self.glare)
    }
}

/// The part of the detector that is lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// An image intensifier's: round, weaker towards its edge.
    #[default]
    Round,
    /// A flat panel's: all of it, evenly.
    Flat,
}

/// Quanta that a pixel counts, as a multiple of the usual number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure(pub f64);

impl Default for Exposure {
    fn default() -> Self {
        Self(1.0)
    }
}

/// How finely metal is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Samples in a pixel, in each direction.
    pub samples: usize,
    /// Least path through metal where the silhouette says that there is some, mm. It makes the outline of the
    /// demonstration's films crisp, where true metal thins out to nothing.
    pub least_path_mm: f64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            samples: 4,
            least_path_mm: 0.2,
        }
    }
}

impl Sampling {
    /// Edges true to a few hundredths of a pixel, and metal as thin as it is.
    pub const EXACT: Self = Self {
        samples: 8,
        least_path_mm: 0.0,
    };
}
