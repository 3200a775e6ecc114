//! The constants of a film, from profiles across the outlines of its components.
//!
//! Only the shape of profiles counts: where each lies along its normal is left free, so nothing is circular with the depths of
//! the poses that they were read at. What is minimised is `sum log(1 + RSS / n)` over profiles, with the square `n` of a small
//! part of the contrast, by Gauss and Newton with weights made anew, from several curvatures, because there are local minima.

mod drawing;
mod equations;
mod guards;
mod sharpen;
mod solver;
#[cfg(feature = "alloc")]
pub(super) mod standing;
mod unknowns;

use core::fmt;

use drawing::sharpening;
use guards::Confirmed;
use solver::Fit;
use unknowns::{AMOUNT, BLUR, CURVATURE, LEAST_PROFILES, RADIUS, UNKNOWNS};
pub use unknowns::{DisplayKnowledge, MOST_COMPONENTS};

use super::clipped::Clipped;
use super::given::{DisplayKind, GivenFilm};
use super::model::{FilmConstants, FilmModel};
use super::profile::FilmProfile;
use super::sharpening::{MetalContrast, Sharpening};
use crate::math::{exp, sqrt};

/// Errors that formal ones do not know of: for the physics left out. Of the curvature for each contrast, and of logarithms.
const LEAST_DEVIATION: [f64; 3] = [0.06, 0.05, 0.1];
/// The same of the curvature where edges were enhanced: so much, and this part of it, because what an enhanced edge looks like
/// behind a curved display depends on scattered light, which edges tell roughly. Of two synthetic films with a square-root display
/// depth was 3 mm off where 0.8 mm was told without this.
const SHARPENED_DEVIATION: [f64; 2] = [0.15, 0.2];
/// The same of the curvature where no two components tell it alike.
const UNTOLD_DEVIATION: f64 = 0.6;

/// The constants of a film and how sure they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmEstimate {
    /// Those of the film.
    pub constants: FilmConstants,
    /// Attenuation of each component's metal, per mm.
    pub attenuation: [f64; MOST_COMPONENTS],
    /// What the profiles of each component show beside its metal and behind it.
    pub metal: [MetalContrast; MOST_COMPONENTS],
    /// Covariance of the curvature, the logarithm of the blur, those of the attenuations, of the amount by which edges were
    /// enhanced and of the logarithm of its radius.
    pub covariance: [[f64; UNKNOWNS]; UNKNOWNS],
    /// What is known of the display.
    pub display: DisplayKnowledge,
    /// Typical difference between the grey values beside metal and behind it.
    pub contrast: f64,
    /// Profiles that were believed.
    pub profiles: usize,
    /// Root mean square of what remains unexplained of them, grey values.
    pub residual: f64,
}

impl FilmEstimate {
    /// What the film makes of a component.
    #[must_use]
    pub fn model(&self, component: usize) -> FilmModel {
        let component = component.min(MOST_COMPONENTS - 1);
        let of = [CURVATURE, BLUR, 2 + component];
        FilmModel {
            constants: self.constants,
            attenuation: self.attenuation[component],
            contrast: self.metal[component],
            covariance: of.map(|row| of.map(|column| self.covariance[row][column])),
        }
    }
}

/// As a person would say it, without a full stop.
impl fmt::Display for FilmEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FilmConstants {
            curvature,
            blur_px,
            sharpening,
            square_px,
        } = self.constants;
        let side = square_px as f64;
        let kind = DisplayKind::of(curvature * self.contrast);
        f.write_str(match (self.display, kind) {
            (DisplayKnowledge::Untold, _) => {
                "film taken to be linear, because its frames do not tell"
            }
            (DisplayKnowledge::Either, _) => {
                "film linear with enhanced edges or logarithmic, which one component alone does not tell: depth lies between the two"
            }
            (DisplayKnowledge::Stated, DisplayKind::Linear) => "linear film, as stated",
            (_, DisplayKind::Linear) => "nearly linear film",
            (_, DisplayKind::Between) => "film between linear and logarithmic",
            (_, DisplayKind::Logarithmic) => "logarithmic film",
        })?;
        if kind == DisplayKind::Logarithmic && self.display != DisplayKnowledge::Either {
            write!(f, ", {:.0} grey values for a factor of e", 1.0 / curvature)?;
        }
        write!(f, ", blur {:.1} px", blur_px * side)?;
        if sharpening.amount > 0.0 {
            let Sharpening { amount, radius_px } = sharpening;
            let radius = radius_px * side;
            write!(
                f,
                ", edges enhanced {amount:.1} times within {radius:.1} px"
            )?;
        }
        if square_px > 1 {
            write!(f, ", read in squares of {square_px} pixels")?;
        }
        Ok(())
    }
}

/// Estimates the constants of a film from profiles of `components` components: the same film, any frames. The profiles of a
/// frame and component stand together, in order along the outline where that is known. `None` where they do not tell, as where grey values were cut off
/// ([`clipped`]).
#[must_use]
pub fn estimate(profiles: &mut [FilmProfile], components: usize) -> Option<FilmEstimate> {
    estimate_with(profiles, components, GivenFilm::default())
}

/// As [`estimate`], with what a person states of the film.
#[must_use]
pub fn estimate_with(
    profiles: &mut [FilmProfile],
    components: usize,
    given: GivenFilm,
) -> Option<FilmEstimate> {
    let contrast = contrast(profiles)?;
    if Clipped::of(profiles, contrast).is_some() {
        return None;
    }
    profiles.iter_mut().for_each(|profile| profile.used = true);
    let mut fit = Fit {
        profiles,
        components: components.min(MOST_COMPONENTS),
        contrast,
        only: None,
        every: 1,
        hold: false,
        sharpened: false,
        given,
    };
    let mut at = fit.begin()?;
    fit.improve(&mut at, 8)?;
    if fit.leave_out_costly(&at) {
        fit.improve(&mut at, 6)?;
    }
    fit.sharpen(&mut at)?;
    let Confirmed { display, half } = fit.confirmed(&mut at)?;
    let sums = fit.look(&at)?;
    if sums.count < LEAST_PROFILES {
        return None;
    }
    let mut covariance = sums.covariance()?;
    let least = |k: usize| least_deviation(k, (display, fit.sharpened), at[CURVATURE]);
    (0..UNKNOWNS).for_each(|k| covariance[k][k] += least(k) * least(k));
    let unit = |k: usize| if k == CURVATURE { contrast } else { 1.0 };
    for (k, row) in covariance.iter_mut().enumerate() {
        for (other, value) in row.iter_mut().enumerate() {
            *value = (*value + half[k] * half[other]) / unit(k) / unit(other);
        }
    }
    Some(FilmEstimate {
        constants: FilmConstants {
            curvature: at[CURVATURE] / contrast,
            blur_px: exp(at[BLUR]),
            sharpening: match fit.sharpened {
                true => sharpening(&at),
                false => Sharpening::default(),
            },
            square_px: 1,
        },
        attenuation: core::array::from_fn(|component| exp(at[2 + component])),
        metal: core::array::from_fn(|component| fit.metal(component, &at)),
        covariance,
        display,
        contrast,
        profiles: sums.count,
        residual: sqrt(sums.squares / (sums.count * super::profile::READINGS) as f64),
    })
}

/// What an unknown is uncertain by in any case: what is told of the display, whether edges were enhanced, and a curvature decide.
fn least_deviation(
    k: usize,
    (display, sharpened): (DisplayKnowledge, bool),
    curvature: f64,
) -> f64 {
    match (k, display) {
        (CURVATURE, DisplayKnowledge::Untold) => UNTOLD_DEVIATION,
        (CURVATURE, _) if sharpened => {
            let [least, part] = SHARPENED_DEVIATION;
            least + part * curvature.abs()
        }
        (AMOUNT | RADIUS, _) if !sharpened => 0.0,
        _ => LEAST_DEVIATION[k.min(2)],
    }
}

/// Where grey values were cut off, so that profiles do not tell; `None` where they were not.
#[must_use]
pub fn clipped(profiles: &[FilmProfile]) -> Option<Clipped> {
    Clipped::of(profiles, contrast(profiles)?)
}

/// The mean difference between grey values beside metal and behind it; `None` where metal is not darker.
fn contrast(profiles: &[FilmProfile]) -> Option<f64> {
    let dark = profiles
        .iter()
        .map(FilmProfile::contrast)
        .filter(|&x| x > 0.0);
    let (count, sum) = dark.fold((0, 0.0), |(count, sum), x| (count + 1, sum + f64::from(x)));
    let enough = count >= LEAST_PROFILES && 2 * count > profiles.len();
    enough.then(|| sum / f64::from(count as u32))
}

#[cfg(test)]
mod tests;
