//! How a synthetic film is made, as options.

use anyhow::{Result, ensure};
use fluoropose_phantom::film::{Cement, Display, Exposure, Field, Physics, Sampling, Unsharp};

use crate::options::Pair;

/// How a synthetic film is made.
#[derive(clap::Args)]
pub(super) struct PhysicsOptions {
    /// Display: logarithmic, linear or square-root [default: logarithmic]
    #[arg(long)]
    display: Option<Display>,
    /// Blur of the detector, standard deviation in pixels [default: 0.6]
    #[arg(long, value_name = "PX")]
    blur: Option<f64>,
    /// Scattered light as a part of the primary beam [default: 0.055]
    #[arg(long, value_name = "PART")]
    scatter: Option<f64>,
    /// Veiling glare, the same everywhere, as a part of the mean light [default: 0]
    #[arg(long, value_name = "PART")]
    glare: Option<f64>,
    /// Enhance edges by an unsharp mask: how much, and the blur of its copy in pixels
    #[arg(long, value_name = "AMOUNT,PX")]
    unsharp: Option<Pair>,
    /// Quanta that a pixel counts, as a multiple of the usual number [default: 1]
    #[arg(long, value_name = "FACTOR")]
    exposure: Option<f64>,
    /// Attenuation of femoral component and tray, per mm [default: 0.72,0.2]
    #[arg(long, value_name = "F,T")]
    opacity: Option<Pair>,
    /// Relative variance of metal's attenuation over the spectrum: how much the beam hardens [default: 0]
    #[arg(long, value_name = "PART")]
    hardening: Option<f64>,
    /// Cement between bone and implants
    #[arg(long)]
    cement: bool,
    /// Two bone screws below the tray
    #[arg(long)]
    screws: bool,
    /// A ruler on the detector
    #[arg(long)]
    ruler: bool,
    /// A flat panel, all of it lit, instead of an image intensifier's round field
    #[arg(long)]
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
