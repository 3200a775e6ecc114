//! How a synthetic film is made, as options.

use anyhow::{Result, ensure};
use fluoropose_phantom::film::{Cement, Display, Exposure, Field, Physics, Sampling, Unsharp};

use crate::options::Pair;

/// How a synthetic film is made.
#[derive(clap::Args)]
pub(super) struct PhysicsOptions {
    /// Display: logarithmic, linear or square-root [default: logarithmic]
    #[arg(long, requires = "drawn")]
    display: Option<Display>,
    /// Blur of the detector, standard deviation in pixels [default: 0.6]
    #[arg(long, value_name = "PX", requires = "drawn")]
    blur: Option<f64>,
    /// Scattered light as a part of the primary beam [default: 0.055]
    #[arg(long, value_name = "PART", requires = "drawn")]
    scatter: Option<f64>,
    /// Veiling glare, the same everywhere, as a part of the mean light [default: 0]
    #[arg(long, value_name = "PART", requires = "drawn")]
    glare: Option<f64>,
    /// Enhance edges by an unsharp mask: how much, and the blur of its copy in pixels
    #[arg(long, value_name = "AMOUNT,PX", requires = "drawn")]
    unsharp: Option<Pair>,
    /// Quanta that a pixel counts, as a multiple of the usual number [default: 1]
    #[arg(long, value_name = "FACTOR", requires = "drawn")]
    exposure: Option<f64>,
    /// Attenuation of femoral component and tray, per mm [default: 0.72,0.2]
    #[arg(long, value_name = "F,T", requires = "drawn")]
    opacity: Option<Pair>,
    /// Relative variance of metal's attenuation over the spectrum: how much the beam hardens [default: 0]
    #[arg(long, value_name = "PART", requires = "drawn")]
    hardening: Option<f64>,
    /// Cement between bone and implants
    #[arg(long, requires = "drawn")]
    cement: bool,
    /// Two bone screws below the tray
    #[arg(long, requires = "drawn")]
    screws: bool,
    /// A ruler on the detector
    #[arg(long, requires = "drawn")]
    ruler: bool,
    /// A flat panel, all of it lit, instead of an image intensifier's round field
    #[arg(long, requires = "drawn")]
    flat_panel: bool,
}

impl PhysicsOptions {
    /// The film asked for.
    ///
    /// # Errors
    /// For a negative number, and what is none.
    pub(super) fn physics(&self) -> Result<Physics> {
        let mut physics = Physics {
            sampling: Sampling::EXACT,
            ..Physics::default()
        };
        physics.display = self.display.unwrap_or_default();
        let set = |to: &mut f64, value: Option<f64>| -> Result<()> {
            if let Some(value) = value {
                ensure!(value >= 0.0, "{value} is below zero");
                *to = value;
            }
            Ok(())
        };
        set(&mut physics.blur.detector_px, self.blur)?;
        set(&mut physics.scatter.share, self.scatter)?;
        set(&mut physics.scatter.glare, self.glare)?;
        set(&mut physics.alloys.hardening, self.hardening)?;
        if let Some(Pair([femur, tibia])) = self.opacity {
            set(&mut physics.alloys.femur, Some(femur))?;
            set(&mut physics.alloys.tibia, Some(tibia))?;
        }
        if let Some(exposure) = self.exposure {
            ensure!(exposure > 0.0, "an exposure of {exposure} shows nothing");
            physics.exposure = Exposure(exposure);
        }
        physics.unsharp = self
            .unsharp
            .map(|Pair([amount, sigma_px])| Unsharp { amount, sigma_px });
        physics.surroundings.cement = self.cement.then(Cement::default);
        physics.surroundings.screws = self.screws;
        physics.surroundings.ruler = self.ruler;
        physics.field = if self.flat_panel {
            Field::Flat
        } else {
            Field::Round
        };
        Ok(physics)
    }
}
