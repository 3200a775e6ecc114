//! What some constants make of profiles, ready for many of them.

use super::unknowns::{AMOUNT, BLUR, CURVATURE, MOST_COMPONENTS, RADIUS, Vector};
use crate::film::model::{Drawn, LineBlur, transmission};
use crate::film::profile::FilmProfile;
use crate::film::sharpening::{MetalContrast, Sharpening, UnsharpMask};
use crate::math::exp;

/// How edges are enhanced.
pub(super) fn sharpening(at: &Vector) -> Sharpening {
    Sharpening {
        amount: at[AMOUNT],
        radius_px: exp(at[RADIUS]),
    }
}

/// Constants, and the filters that they are.
pub(super) struct Drawing {
    /// Of the display, one divided by grey values.
    pub(super) curvature: f64,
    attenuation: [f64; MOST_COMPONENTS],
    blur: LineBlur,
    mask: Option<UnsharpMask>,
}

impl Drawing {
    /// Of profiles of this contrast.
    pub(super) fn of(at: &Vector, contrast: f64, sharpened: bool) -> Self {
        let sharpening = sharpened.then(|| sharpening(at));
        Self {
            curvature: at[CURVATURE] / contrast,
            attenuation: core::array::from_fn(|component| exp(at[2 + component])),
            blur: LineBlur::of(exp(at[BLUR])),
            mask: sharpening.and_then(|sharpening| UnsharpMask::of(&sharpening)),
        }
    }

    /// What a profile is drawn as.
    pub(super) fn of_profile(&self, profile: &FilmProfile) -> Drawn {
        self.enhanced(profile, self.before_sharpening(profile))
    }

    /// The same, but for enhanced edges: curvature and these have no part in it.
    pub(super) fn before_sharpening(&self, profile: &FilmProfile) -> Drawn {
        let attenuation = self.attenuation[usize::from(profile.component)];
        self.blur
            .blurred(&transmission(&profile.paths, attenuation))
    }

    /// What a profile is drawn as, made of what it is before its edges are enhanced.
    pub(super) fn enhanced(&self, profile: &FilmProfile, drawn: Drawn) -> Drawn {
        let Some(mask) = &self.mask else {
            return drawn;
        };
        let contrast = MetalContrast {
            grey: f64::from(profile.contrast()),
            passed: f64::from(profile.inside(&drawn)),
        };
        mask.on(&drawn, contrast.over_veil(self.curvature))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::estimate::unknowns::UNKNOWNS;
    use crate::film::lines::POINTS;
    use crate::film::{FilmConstants, FilmModel};
    use proptest::prelude::*;

    properties! {
        /// Oracle: the model of a film, which makes its filters anew for each line.
        #[test]
        fn ready_filters_draw_what_the_film_shows_to_the_last_bit(
            steps in proptest::collection::vec((0..POINTS, 0.05..9.0f32), 1..6),
            [curvature, blur, attenuation, radius] in [-0.5..3.0f64, -1.2..1.1, -2.0..0.5, -0.3..2.0],
            amount in prop_oneof![Just(0.0), 0.1..2.0f64], bright in 1.0..90.0f32,
        ) {
            let mut profile = FilmProfile::default();
            for (to, more) in steps {
                profile.paths[..to].iter_mut().for_each(|path| *path += more);
            }
            let half = profile.mean.len() / 2;
            profile.mean[half..].fill(bright);
            let mut at = [attenuation; UNKNOWNS];
            (at[CURVATURE], at[BLUR], at[AMOUNT], at[RADIUS]) = (curvature, blur, amount, radius);
            let drawing = Drawing::of(&at, 40.0, true);
            let film = FilmModel::certain(FilmConstants::plain(curvature / 40.0, exp(blur)), exp(attenuation));
            let blurred = film.shown(&profile.paths);
            prop_assert_eq!(drawing.before_sharpening(&profile), blurred);
            let contrast = MetalContrast {
                grey: f64::from(profile.contrast()),
                passed: f64::from(profile.inside(&blurred)),
            };
            let shown = sharpening(&at).of(&blurred, contrast.over_veil(curvature / 40.0));
            prop_assert_eq!(drawing.of_profile(&profile), shown);
        }
    }
}
