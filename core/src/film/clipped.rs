//! Grey values that were cut off at the outlines of metal: a display's window from the darkest to the brightest of what it shows.
//!
//! Where metal is as dark as anything can be, or what lies beside it as bright, a profile is flat where the film was not, and its middle lies
//! elsewhere. That looks like another display, and constants that were estimated from it would move edges the wrong way: trays of a clipped film
//! lay 23 mm off with them, and 3 mm without.

use core::fmt;

use super::profile::FilmProfile;
use crate::math::Decimal;

/// Readings that are looked at inside of the outline and outside of it: those within four pixels.
const INSIDE: core::ops::Range<usize> = 4..12;
const OUTSIDE: core::ops::Range<usize> = 13..21;
/// Values are alike that differ by no more than this part of the contrast.
const ALIKE: f32 = 2e-3;
/// Of two films in vivo one in a thousand profiles at most comes to the darkest or brightest of their values, of drawn ones that were clipped 28 in a hundred and
/// more.
const MOST: f64 = 0.1;

/// Where grey values were cut off. Displayed it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clipped {
    /// Part of the outlines inside of which they are, 0 to 1.
    pub inside: f64,
    /// The same beside them.
    pub outside: f64,
}

impl Clipped {
    /// Of profiles whose grey values beside metal and behind it differ by so much; `None` where they were not cut off.
    pub(super) fn of(profiles: &[FilmProfile], contrast: f64) -> Option<Self> {
        let all = || profiles.iter().flat_map(|profile| profile.mean);
        let (low, high) = all().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let alike = ALIKE * contrast as f32;
        let part = |is_at_end: &dyn Fn(&FilmProfile) -> bool| {
            let count = profiles.iter().filter(|profile| is_at_end(profile)).count();
            count as f64 / profiles.len().max(1) as f64
        };
        let clipped = Self {
            inside: match is_last(low) {
                true => part(&|one| one.mean[INSIDE].iter().any(|value| value - low <= alike)),
                false => 0.0,
            },
            outside: match is_last(high) {
                true => part(&|one| one.mean[OUTSIDE].iter().any(|value| high - value <= alike)),
                false => 0.0,
            },
        };
        (clipped.inside > MOST || clipped.outside > MOST).then_some(clipped)
    }
}

/// Whether a grey value is the first or the last of eight bits or more, as windows leave it, be it that these stand at the upper end of a wider number;
/// thick metal without noise is flat at any other. Values of bright metal come with their signs exchanged.
fn is_last(value: f32) -> bool {
    let whole = value.abs() as u32;
    let bits = whole >> whole.trailing_zeros().min(31);
    value == 0.0 || (whole as f32 == value.abs() && bits >= 255 && (bits + 1).is_power_of_two())
}

impl fmt::Display for Clipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (part, what) = match self.inside > self.outside {
            true => (self.inside, "metal"),
            false => (self.outside, "what lies beside metal"),
        };
        write!(
            f,
            "the frames' grey values are cut off: along {} % of the outlines {what} has the last value that there is. Nothing is told of the display then: edges are taken to lie on the outline, and z is uncertain by millimetres. Export the frames with a wider window",
            Decimal::new(100.0 * part, 0)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::format;
    use std::vec::Vec;

    /// Profiles of a soft edge, each a little brighter than the one before and all by so much, with values beyond these cut off.
    fn seen(window: [f32; 2], brighter: f32) -> Vec<FilmProfile> {
        let one = |number: usize| {
            let mut profile = FilmProfile::default();
            for (k, value) in profile.mean.iter_mut().enumerate() {
                let edge = 1.0 / (1.0 + crate::math::exp(-(k as f64 - 11.5) / 1.5)) as f32;
                let grey = brighter + 60.0 + 80.0 * edge + 0.2 * number as f32 + 0.3 * k as f32;
                *value = grey.clamp(window[0], window[1]);
            }
            profile
        };
        (0..60).map(one).collect()
    }

    #[test]
    fn last_values_are_those_of_so_many_bits_wherever_these_stand() {
        let last = [0, 255, 4095, 65535, 65280, 65520, 4080, 16383, 65532];
        assert!(last.map(|value| is_last(value as f32)).iter().all(|&is| is));
        assert!(is_last(-4095.0));
        let other = [1, 127, 254, 256, 4093, 200, 65521];
        assert!(
            !other
                .map(|value| is_last(value as f32))
                .iter()
                .any(|&is| is)
        );
        assert!(!is_last(254.5) && !is_last(f32::NAN) && !is_last(f32::INFINITY));
    }

    #[test]
    fn values_that_are_cut_off_at_either_end_are_told_and_a_whole_film_is_not() {
        assert_eq!(Clipped::of(&seen([0.0, 255.0], 0.0), 80.0), None);
        let dark = Clipped::of(&seen([0.0, 255.0], -75.0), 80.0).expect("cut off");
        assert!(dark.inside > 0.9 && dark.outside < 0.1, "{dark:?}");
        assert!(format!("{dark}").contains("metal has the last value"));
        let bright = Clipped::of(&seen([0.0, 255.0], 115.0), 80.0).expect("cut off");
        assert!(bright.outside > 0.9 && bright.inside < 0.1, "{bright:?}");
        assert!(format!("{bright}").contains("beside metal has the last value"));
        assert_eq!(Clipped::of(&[], 80.0), None);
        // Opaque metal is as flat, and no window ends there.
        assert_eq!(Clipped::of(&seen([75.0, 255.0], 0.0), 80.0), None);
        // Of bright metal.
        let mut negative = seen([0.0, 255.0], -75.0);
        let swapped = negative.iter_mut().flat_map(|profile| &mut profile.mean);
        swapped.for_each(|value| *value -= 255.0);
        assert_eq!(Clipped::of(&negative, 80.0), Some(dark));
    }
}
