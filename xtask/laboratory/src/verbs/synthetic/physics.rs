//! How a synthetic film is made, as options.

use anyhow::{Result, ensure};
use fluoropose_phantom::film::{Cement, Display, Exposure, Field, Physics, Sampling, Unsharp};

use crate::options::Pair;

/// Pixels of a blur at most: it takes time by its width. Parts of the light and attenuations a mm; quanta, as a multiple of the usual number.
const MOST_PX: f64 = 100.0;
const MOST: f64 = 10.0;
const MOST_QUANTA: f64 = 1e6;

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
    /// For a number below zero, or above what a film can be; names its option.
    pub(super) fn physics(&self) -> Result<Physics> {
        let mut physics = Physics {
            sampling: Sampling::EXACT,
            ..Physics::default()
        };
        physics.display = self.display.unwrap_or_default();
        let set = |option: &str, to: &mut f64, value: Option<f64>, most: f64| -> Result<()> {
            if let Some(value) = value {
                within(option, value, most)?;
                *to = value;
            }
            Ok(())
        };
        set("--blur", &mut physics.blur.detector_px, self.blur, MOST_PX)?;
        set("--scatter", &mut physics.scatter.share, self.scatter, MOST)?;
        set("--glare", &mut physics.scatter.glare, self.glare, MOST)?;
        set(
            "--hardening",
            &mut physics.alloys.hardening,
            self.hardening,
            MOST,
        )?;
        if let Some(Pair([femur, tibia])) = self.opacity {
            set("--opacity", &mut physics.alloys.femur, Some(femur), MOST)?;
            set("--opacity", &mut physics.alloys.tibia, Some(tibia), MOST)?;
        }
        if let Some(exposure) = self.exposure {
            ensure!(exposure > 0.0, "an exposure of {exposure} shows nothing");
            within("--exposure", exposure, MOST_QUANTA)?;
            physics.exposure = Exposure(exposure);
        }
        if let Some(Pair([amount, sigma_px])) = self.unsharp {
            within("--unsharp", amount, MOST)?;
            within("--unsharp", sigma_px, MOST_PX)?;
            physics.unsharp = Some(Unsharp { amount, sigma_px });
        }
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

fn within(option: &str, value: f64, most: f64) -> Result<()> {
    ensure!(
        (0.0..=most).contains(&value),
        "{option} is {value}; it must be 0 to {most}"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_film_has_is_refused_and_named() {
        #[derive(clap::Parser)]
        struct Verb {
            // What the options go with.
            #[arg(long, group = "drawn")]
            activity: bool,
            #[command(flatten)]
            physics: PhysicsOptions,
        }
        let told = |words: &str| {
            let words = ["film", "--activity"]
                .into_iter()
                .chain(words.split_whitespace());
            let verb = <Verb as clap::Parser>::try_parse_from(words).unwrap();
            assert!(verb.activity);
            verb.physics
                .physics()
                .map_or_else(|error| error.to_string(), |_| String::new())
        };
        assert_eq!(
            told("--blur 1.2 --scatter 0.4 --unsharp 0.8,3 --exposure 0.3 --opacity 0.7,0.2"),
            ""
        );
        // A blur so wide would be drawn for hours.
        assert_eq!(told("--blur 1e6"), "--blur is 1000000; it must be 0 to 100");
        for wrong in [
            "--blur nan",
            "--scatter 50",
            "--glare inf",
            "--unsharp 0.8,1e9",
            "--exposure inf",
            "--opacity 1,nan",
        ] {
            let option = wrong.split(' ').next().unwrap();
            assert!(told(wrong).starts_with(option), "{wrong}: {}", told(wrong));
        }
    }
}
