//! Disturbed masks: outlines as a hand would have traced them, and parts that are hidden.
//!
//! Everything is reproducible: each frame has its own stream of the random numbers of one seed.

use anyhow::{Result, ensure};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{MAX_SIDE, Mask};
use fluoropose::image::silhouette::{OutlineOrigin, Silhouette};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::curve::{Curve, Sampling, curves, widened};
use super::fill::{Painted, filled};
use super::jitter::{Correlation, Waves};
use super::occluder::Occluder;
use crate::mask_buffer::MaskBuffer;

/// How masks are disturbed before poses are found.
#[derive(clap::Args, Clone, Copy, Debug, PartialEq)]
#[group(skip)]
#[command(group = clap::ArgGroup::new("disturbed").args(["jitter", "occlude"]).multiple(true))]
pub struct DisturbanceOptions {
    /// Move each outline along its normal by Gaussian noise of this standard deviation, pixels
    #[arg(
        long,
        value_name = "PX",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub jitter: f64,
    /// Correlation length l of that noise, pixels: its autocorrelation is exp(-d^2 / (2 l^2)) of the way
    /// d along the outline
    #[arg(
        long,
        value_name = "PX",
        default_value_t = 10.0,
        allow_negative_numbers = true,
        requires = "jitter"
    )]
    pub correlation: f64,
    /// Hide this part of the outline's length behind a random occluder, 0 to 0.9
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub occlude: f64,
    /// Do not tell which pixels the occluder hides
    #[arg(long, requires = "occlude")]
    pub unmarked: bool,
    /// Seed of jitter and occluders
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "disturbed")]
    pub noise_seed: u64,
}

impl Default for DisturbanceOptions {
    /// No disturbance.
    fn default() -> Self {
        Self {
            jitter: 0.0,
            correlation: 10.0,
            occlude: 0.0,
            unmarked: false,
            noise_seed: 1,
        }
    }
}

/// A mask after a disturbance, and what is not known of it.
#[derive(Clone, Debug)]
pub struct Disturbed {
    /// The mask.
    pub mask: MaskBuffer,
    /// Pixels that are told to say nothing.
    pub unknown: Option<MaskBuffer>,
    /// Pixels that say nothing, told or not.
    pub hidden: Option<MaskBuffer>,
    /// Who laid the outline, before the disturbance.
    pub origin: OutlineOrigin,
}

impl Disturbed {
    /// Calls `look` with the mask and what is unknown of it.
    ///
    /// # Errors
    /// Where the two differ in size, and those of `look`.
    pub fn see<T>(&self, look: impl FnOnce(Silhouette<'_>) -> Result<T>) -> Result<T> {
        let mask = self.mask.mask();
        match &self.unknown {
            None => look(Silhouette::from(&mask).laid_by(self.origin)),
            Some(unknown) => look(Silhouette::new(&mask, &unknown.mask())?.laid_by(self.origin)),
        }
    }
}

/// A drawing from which a jittered outline is taken is this many times as fine as the frame, so
/// that the jitter and one rounding to pixels are all the noise there is.
const FINE: usize = 4;

/// Standard deviation of the filter that smooths outlines, pixels of the mask, for masks of the
/// frame's own pixels and for fine ones.
const SMOOTHING: f64 = 2.0;
const FINE_SMOOTHING: f64 = 4.0;

/// No noise is larger than this many standard deviations, nearly; with the reach of the
/// smoothing it says how far outlines are continued beyond the frame's border.
const LARGEST: f64 = 6.0;

impl DisturbanceOptions {
    /// Whether the numbers are possible.
    ///
    /// # Errors
    /// Names the option.
    pub fn check(&self) -> Result<()> {
        ensure!(
            (0.0..=20.0).contains(&self.jitter),
            "--jitter is {}; it must be 0 to 20 pixels",
            self.jitter
        );
        ensure!(
            (1.0..=1000.0).contains(&self.correlation),
            "--correlation is {}; it must be 1 to 1000 pixels",
            self.correlation
        );
        ensure!(
            (0.0..=0.9).contains(&self.occlude),
            "--occlude is {}; it must be 0 to 0.9 of the outline",
            self.occlude
        );
        Ok(())
    }

    /// Whether masks stay as they are.
    pub fn is_none(&self) -> bool {
        self.jitter == 0.0 && self.occlude == 0.0
    }

    /// How many times as finely as a frame of this size a known model is to be drawn for
    /// [`Self::disturb_drawn`].
    pub fn fineness(&self, width: usize, height: usize) -> usize {
        let largest = MAX_SIDE / (width.max(height) + 2 * self.margin(1));
        if self.jitter > 0.0 {
            largest.clamp(1, FINE)
        } else {
            1
        }
    }

    /// The random numbers of a frame.
    pub fn random(&self, frame: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.noise_seed);
        random.set_stream(frame);
        random
    }

    /// Disturbs a mask of which `unknown` is not known from the start; the same for the same
    /// seed and `frame`.
    ///
    /// # Errors
    /// For outlines of more corners than are kept, and masks of different sizes.
    pub fn disturb(
        &self,
        mask: &Mask<'_>,
        unknown: Option<&Mask<'_>>,
        frame: u64,
    ) -> Result<Disturbed> {
        let mut disturbed = self.disturb_drawn(mask, 1, frame)?;
        disturbed.origin = OutlineOrigin::Hand;
        if let Some(unknown) = unknown.map(MaskBuffer::copy_of) {
            let with = |mask: Option<MaskBuffer>| match mask {
                Some(mask) => mask.combined(&unknown, |a, b| a | b),
                None => Ok(unknown.clone()),
            };
            disturbed.unknown = Some(with(disturbed.unknown)?);
            disturbed.hidden = Some(with(disturbed.hidden)?);
        }
        Ok(disturbed)
    }

    /// Disturbs a mask that was drawn `factor` times as finely as the frame; the result has the
    /// frame's own pixels.
    ///
    /// # Errors
    /// For outlines of more corners than are kept.
    pub fn disturb_drawn(&self, fine: &Mask<'_>, factor: usize, frame: u64) -> Result<Disturbed> {
        let mut mask = MaskBuffer::copy_of(fine);
        let mut hidden = None;
        let mut random = self.random(frame);
        let size = [fine.width() / factor, fine.height() / factor];
        if self.is_none() && factor == 1 {
            return Ok(Disturbed {
                mask,
                unknown: None,
                hidden,
                origin: OutlineOrigin::Drawn,
            });
        }
        let curves = self.curves(fine, factor)?;
        if self.jitter > 0.0 || factor > 1 {
            mask = self.jittered(&curves, size, &mut random)?;
        }
        if self.occlude > 0.0
            && let Some(occluder) = Occluder::draw(&curves, self.occlude, size, &mut random)
        {
            let pixels = occluder.hidden(size[0], size[1])?;
            mask = occluder.before(&mask.mask(), &pixels)?;
            hidden = Some(pixels);
        }
        Ok(Disturbed {
            mask,
            unknown: hidden.clone().filter(|_| !self.unmarked),
            hidden,
            origin: OutlineOrigin::Drawn,
        })
    }

    /// The outlines of a mask `factor` times as fine as the frame, in the frame's pixels; they go
    /// on beyond the frame where it cuts them.
    ///
    /// # Errors
    /// For outlines of more corners than are kept.
    pub fn curves(&self, fine: &Mask<'_>, factor: usize) -> Result<Vec<Curve>> {
        let margin = self.margin(factor);
        let smoothing = if factor == 1 {
            SMOOTHING
        } else {
            FINE_SMOOTHING
        };
        let wide = widened(fine, margin)?;
        curves(&wide.mask(), Sampling { factor, margin }, smoothing)
    }

    fn margin(&self, factor: usize) -> usize {
        let noise = (LARGEST * self.jitter).ceil() as usize;
        factor * noise + (LARGEST * FINE_SMOOTHING) as usize
    }

    /// The mask within the curves, each moved along its normals.
    fn jittered(
        &self,
        curves: &[Curve],
        [width, height]: [usize; 2],
        random: &mut ChaCha8Rng,
    ) -> Result<MaskBuffer> {
        let correlation = Correlation {
            length: self.correlation,
        };
        let moved: Vec<(Vec<Point>, bool)> = curves
            .iter()
            .map(|curve| {
                let waves = Waves::draw(self.jitter, correlation, curve.length, random);
                (waves.displaced(curve), curve.hole)
            })
            .collect();
        let painted: Vec<Painted<'_>> = moved
            .iter()
            .map(|(points, hole)| (points.as_slice(), *hole))
            .collect();
        filled(&painted, width, height)
    }
}

#[cfg(test)]
mod tests;
