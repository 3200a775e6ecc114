//! Whether constants that are known stand by other profiles of their film.

use super::solver::{ATTENUATIONS, EXPECTED_ATTENUATION, EXPECTED_RADIUS, FEW, Fit, ln_of_blur};
use super::unknowns::{AMOUNT, BLUR, CURVATURE, MOST_COMPONENTS, RADIUS, UNKNOWNS, Vector};
use super::{FilmEstimate, contrast};
use crate::film::given::GivenFilm;
use crate::film::model::FilmModel;
use crate::film::profile::FilmProfile;
use crate::film::sharpening::{RADII, Sharpening};
use crate::math::{ln, sqrt};

/// From so many standard deviations on constants are others, and steps in which that shows.
const FAR_OFF: f64 = 3.0;
const NEAR_STEPS: usize = 8;

/// Whether profiles lead from the constants that are known, of `models` by the numbers of their components, to others that lie more than three
/// standard deviations away. Only minima near these and of other metals are looked for, on some of the profiles: a small part of what an estimate
/// takes.
#[must_use]
pub(in crate::film) fn leads_elsewhere(
    profiles: &mut [FilmProfile],
    models: &[FilmModel],
    given: GivenFilm,
) -> bool {
    let (Some(contrast), Some(first)) = (contrast(profiles), models.first()) else {
        return false;
    };
    profiles.iter_mut().for_each(|profile| profile.used = true);
    let sharpening = first.constants.sharpening;
    let mut fit = Fit {
        every: (profiles.len() / FEW).max(1),
        profiles,
        components: models.len().min(MOST_COMPONENTS),
        contrast,
        only: None,
        hold: false,
        sharpened: sharpening.amount > 0.0,
        given,
    };
    let known = known_of(models, contrast);
    let Some(at) = best_near(&mut fit, &known) else {
        return false;
    };
    let is_far = |unknown: usize, variance: f64| {
        let unit = if unknown == CURVATURE { contrast } else { 1.0 };
        (at[unknown] - known[unknown]).abs() > FAR_OFF * sqrt(variance) * unit
    };
    let of_metal = models.iter().take(MOST_COMPONENTS).enumerate();
    let mut of_metal = of_metal.map(|(number, model)| (2 + number, model.covariance[2][2]));
    let of_film = [CURVATURE, BLUR].map(|unknown| (unknown, first.covariance[unknown][unknown]));
    of_film
        .into_iter()
        .any(|(unknown, variance)| is_far(unknown, variance))
        || of_metal.any(|(unknown, variance)| is_far(unknown, variance))
}

/// So many standard deviations of both lie between an estimate and constants that are known where it is another.
const OTHER: f64 = 2.0;

/// Whether an estimate by all profiles is another than constants that are known, of `models` by the numbers of their components. Some of the profiles
/// by themselves may lead farther than all of them do.
#[must_use]
pub(in crate::film) fn is_other(models: &[FilmModel], found: &FilmEstimate) -> bool {
    models.iter().enumerate().any(|(number, known)| {
        let model = found.model(number);
        let off = [
            known.constants.curvature - model.constants.curvature,
            ln(known.constants.blur_px / model.constants.blur_px),
            ln(known.attenuation / model.attenuation),
        ];
        let enhanced = |model: &FilmModel| model.constants.sharpening.amount > 0.0;
        enhanced(known) != enhanced(&model)
            || off.iter().enumerate().any(|(k, off)| {
                let variance = known.covariance[k][k] + model.covariance[k][k];
                off.abs() > OTHER * sqrt(variance)
            })
    })
}

/// The unknowns as they are known of components by their numbers, on profiles of a contrast.
fn known_of(models: &[FilmModel], contrast: f64) -> Vector {
    let mut at = [EXPECTED_ATTENUATION[0]; UNKNOWNS];
    let Some(FilmModel { constants, .. }) = models.first() else {
        return at;
    };
    let Sharpening { amount, radius_px } = constants.sharpening;
    at[CURVATURE] = constants.curvature * contrast;
    at[BLUR] = ln_of_blur(constants.blur_px);
    (at[AMOUNT], at[RADIUS]) = match amount > 0.0 {
        true => (amount, ln(radius_px.clamp(RADII[0], RADII[1]))),
        false => (0.0, EXPECTED_RADIUS[0]),
    };
    for (value, model) in at[2..AMOUNT].iter_mut().zip(models) {
        *value = ln(model.attenuation);
    }
    at
}

/// The best that constants lead to, and these with one component of another metal.
fn best_near(fit: &mut Fit<'_>, known: &Vector) -> Option<Vector> {
    let components = 2..2 + fit.components;
    let of_other_metal = components.flat_map(|unknown| {
        ATTENUATIONS.map(|attenuation| {
            let mut other = *known;
            other[unknown] = attenuation;
            other
        })
    });
    let starts = core::iter::once(*known).chain(of_other_metal);
    let led_to = starts.filter_map(|mut at| {
        fit.find_shifts(&at);
        let cost = fit.improve(&mut at, NEAR_STEPS)?;
        Some((cost, at))
    });
    let best = led_to.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::FilmConstants;
    use crate::film::estimate::DisplayKnowledge;
    use crate::film::sharpening::MetalContrast;

    /// What is known, the attenuation of the second component's metal so many times as large, and what is found.
    fn pair(times: f64) -> ([FilmModel; 2], FilmEstimate) {
        let mut covariance = [[0.0; UNKNOWNS]; UNKNOWNS];
        (0..UNKNOWNS).for_each(|k| covariance[k][k] = 0.01);
        let found = FilmEstimate {
            constants: FilmConstants::plain(0.006, 1.4),
            attenuation: [1.4; MOST_COMPONENTS],
            metal: [MetalContrast::default(); MOST_COMPONENTS],
            covariance,
            display: DisplayKnowledge::Told,
            contrast: 40.0,
            profiles: 1000,
            residual: 0.5,
        };
        let mut known = [found.model(0), found.model(1)];
        known[1].attenuation *= times;
        (known, found)
    }

    #[test]
    fn an_estimate_is_another_by_the_deviations_of_both() {
        for (times, other) in [
            (1.0, false),
            (1.2, false),
            (0.8, false),
            (1.5, true),
            (0.6, true),
        ] {
            let (known, found) = pair(times);
            assert_eq!(is_other(&known, &found), other, "{times}");
        }
        let (mut known, found) = pair(1.0);
        known[0].constants.sharpening = Sharpening {
            amount: 0.5,
            radius_px: 1.5,
        };
        assert!(is_other(&known, &found));
    }

    #[test]
    fn what_is_known_in_the_solvers_numbers_is_what_is_known() {
        let mut known = pair(1.5).0;
        known[0].constants.sharpening = Sharpening {
            amount: 0.5,
            radius_px: 1.5,
        };
        let at = known_of(&known, 40.0);
        let near =
            |number: usize, wanted: f64| assert!((at[number] - wanted).abs() < 1e-12, "{number}");
        near(CURVATURE, 0.24);
        near(BLUR, libm::log(1.4));
        near(2, libm::log(1.4));
        near(3, libm::log(2.1));
        near(AMOUNT, 0.5);
        near(RADIUS, libm::log(1.5));
        known[0].constants.sharpening = Sharpening::default();
        assert_eq!(known_of(&known, 40.0)[AMOUNT], 0.0);
    }
}
