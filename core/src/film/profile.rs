//! A profile read from a frame across a component's outline, with the paths behind it: what the constants of a film are
//! estimated from.

use super::lines::POINTS;
use super::model::{Drawn, at};

/// Distance between readings, pixels; the first is this far inside the outline.
pub(crate) const READING_STEP: f64 = 0.5;
pub(crate) const FIRST_READING: f64 = -6.0;
/// Readings of a profile: to 5 pixels outside.
pub const READINGS: usize = 23;
/// Readings at each end that tell how bright it is there.
const SIDE: usize = 4;

/// Numbers that a profile is made of, without the names of its component and frame.
pub const PROFILE_NUMBERS: usize = 2 * READINGS + POINTS + 1;

/// A profile across a component's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmProfile {
    /// Number of the component, below [`super::estimate::MOST_COMPONENTS`].
    pub component: u8,
    /// Number of the frame.
    pub frame: u16,
    /// Grey values of a picture that is not inverted, each the mean of the pixels that were read for it, and their variance:
    /// through a display that is not linear the mean of intensities is another.
    pub(crate) mean: [f32; READINGS],
    pub(crate) variance: [f32; READINGS],
    /// Paths through the component along the same line, mm.
    pub(crate) paths: [f32; POINTS],
    /// Where the outline lies on the line, pixels from its origin.
    pub(crate) outline: f32,
    /// How far the film's profile lies beyond the drawn one, pixels, as it was found last.
    pub(crate) shift: f32,
    /// Whether it is believed, as it was decided last.
    pub(crate) used: bool,
}

impl Default for FilmProfile {
    fn default() -> Self {
        Self {
            component: 0,
            frame: 0,
            mean: [0.0; READINGS],
            variance: [0.0; READINGS],
            paths: [0.0; POINTS],
            outline: 0.0,
            shift: 0.0,
            used: true,
        }
    }
}

impl FilmProfile {
    /// What was read, as numbers: for programs that read in one place and estimate in another.
    #[must_use]
    pub fn numbers(&self) -> [f32; PROFILE_NUMBERS] {
        let mut numbers = [self.outline; PROFILE_NUMBERS];
        let (readings, paths) = numbers.split_at_mut(2 * READINGS);
        readings[..READINGS].copy_from_slice(&self.mean);
        readings[READINGS..].copy_from_slice(&self.variance);
        paths[..POINTS].copy_from_slice(&self.paths);
        numbers
    }

    /// The profile of a component and a frame that such numbers make.
    #[must_use]
    pub fn of_numbers((component, frame): (u8, u16), numbers: &[f32; PROFILE_NUMBERS]) -> Self {
        let (readings, paths) = numbers.split_at(2 * READINGS);
        let mut profile = Self {
            component,
            frame,
            outline: numbers[PROFILE_NUMBERS - 1],
            ..Self::default()
        };
        profile.mean.copy_from_slice(&readings[..READINGS]);
        profile.variance.copy_from_slice(&readings[READINGS..]);
        profile.paths.copy_from_slice(&paths[..POINTS]);
        profile
    }

    /// A profile of the readings that `reading` gives: mean and variance of the pixels read at a distance from the line's
    /// origin, `outline` being where the component's outline lies. `None` where one of them is not known.
    pub(crate) fn read(
        paths: &[f32; POINTS],
        outline: f64,
        mut reading: impl FnMut(f64) -> Option<[f64; 2]>,
    ) -> Option<Self> {
        let mut profile = Self {
            paths: *paths,
            outline: outline as f32,
            ..Self::default()
        };
        for k in 0..READINGS {
            let [mean, variance] = reading(outline + Self::along(k))?;
            profile.mean[k] = mean as f32;
            profile.variance[k] = variance as f32;
        }
        Some(profile)
    }

    /// Distance of a reading from the outline, pixels.
    pub(crate) fn along(reading: usize) -> f64 {
        FIRST_READING + READING_STEP * reading as f64
    }

    /// Whether another is of the same frame and component.
    pub(crate) fn is_of_frame(&self, other: &Self) -> bool {
        (self.component, self.frame) == (other.component, other.frame)
    }

    /// How much brighter it is outside than inside, grey values.
    pub(crate) fn contrast(&self) -> f32 {
        let mean = |readings: &[f32]| readings.iter().sum::<f32>() / readings.len() as f32;
        mean(&self.mean[READINGS - SIDE..]) - mean(&self.mean[..SIDE])
    }

    /// The mean of what is drawn of it where that reads inside.
    pub(crate) fn inside(&self, drawn: &Drawn) -> f32 {
        let place = |k: usize| f64::from(self.outline) + Self::along(k);
        (0..SIDE).map(|k| at(drawn, place(k))).sum::<f32>() / SIDE as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::lines::{INNER, STEP};

    #[test]
    fn readings_lie_from_six_pixels_inside_to_five_outside_of_the_outline() {
        let read = FilmProfile::read(&[0.0; POINTS], 0.7, |t| Some([100.0 + t, 2.0 * t]));
        let profile = read.expect("all known");
        for (k, (&mean, &variance)) in profile.mean.iter().zip(&profile.variance).enumerate() {
            let t = 0.7 - 6.0 + 0.5 * k as f32;
            assert!((mean - 100.0 - t).abs() < 1e-4 && (variance - 2.0 * t).abs() < 1e-4);
        }
        // Four of 11 pixels apart, less the half pixels between them.
        assert!((profile.contrast() - 9.5).abs() < 1e-4);
        let missing = |t: f64| (t < 5.0).then_some([0.0; 2]);
        assert!(FilmProfile::read(&[0.0; POINTS], 0.7, missing).is_none());
    }

    #[test]
    fn what_is_drawn_inside_is_read_where_the_profile_is() {
        let drawn = core::array::from_fn(|k| (INNER - STEP * k as f64) as f32);
        let profile = FilmProfile {
            outline: 0.4,
            ..FilmProfile::default()
        };
        // The mean of 6, 5.5, 5 and 4.5 pixels inside the outline.
        assert!(
            (profile.inside(&drawn) - (5.25 - 0.4)).abs() < 1e-4,
            "{}",
            profile.inside(&drawn)
        );
    }
}
