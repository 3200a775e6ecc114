//! Where the edge of a line seems to be on a film: the film's blur and the derivative by which edges are found, as one filter
//! made ready for many lines.

use super::lines::{INNER, POINTS, STEP};
use super::model::{
    Blur, DRAWN_RANGE, Drawn, FilmConstants, FilmModel, MOST_BLUR_REACH, at, transmission,
};
use crate::image::profile::{
    DERIVATIVE, HALF_FILTER, NormalReading, READING_STEP, steepest_rise, strongest,
};
use crate::math::sqrt;

/// Places of a line to a reading of the filter.
const PLACES: usize = (READING_STEP / STEP) as usize;
/// Readings to each side at which slopes are looked at.
const HALF: usize = (DRAWN_RANGE / READING_STEP) as usize;
/// Places at which slopes are taken: each reading lies between two. Some more, so that they are a multiple of four.
const TAKEN: usize = (2 * HALF * PLACES + 2).next_multiple_of(4);
/// Places to each side that a slope may depend on.
const MOST_REACH: usize = MOST_BLUR_REACH + HALF_FILTER * PLACES;
/// Places beyond both ends of a line, where it is continued.
const BEYOND: usize = MOST_REACH + TAKEN;

/// What [`FilmModel`] makes of an edge, ready for many lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFilter {
    attenuation: f64,
    /// Of the places at 1, 2 and so on places after the middle; those before it count as much less. The others are zero.
    weights: [f32; MOST_REACH],
    reach: usize,
    /// The first place of a line that has a part in an edge near its outline.
    first: usize,
    /// Where edges were enhanced no one filter does it.
    enhanced: Option<FilmModel>,
}

impl From<&FilmModel> for EdgeFilter {
    fn from(film: &FilmModel) -> Self {
        let blur = Blur::of(film.constants.blur_px);
        let at = |place: usize| f64::from(blur.weights.get(place).copied().unwrap_or_default());
        let (derivative, norm) = DERIVATIVE;
        let weights = core::array::from_fn(|k| {
            let place = k + 1;
            let each = derivative.iter().enumerate().map(|(reading, weight)| {
                let middle = reading * PLACES;
                weight * (at(place.abs_diff(middle)) - at(place + middle))
            });
            (each.sum::<f64>() / (norm * f64::from(blur.sum))) as f32
        });
        Self {
            attenuation: film.attenuation,
            weights,
            reach: (blur.reach + HALF_FILTER * PLACES).min(MOST_REACH),
            first: first_place(&film.constants),
            enhanced: (film.constants.sharpening.amount > 0.0).then_some(*film),
        }
    }
}

/// Blur and the derivative by which edges are found are together that of a Gaussian: farther off than this many of its widths a step of
/// metal weighs 500 times less than at the edge.
const WIDTHS: f64 = 4.0;
/// How far inside its line's origin an edge may lie, pixels: the outline by half a pixel, the edge inside of it where metal is thin.
const INSIDE: f64 = 2.0;

/// The first place of a line that has a part in edges near its origin: all, where edges were enhanced from afar.
fn first_place(constants: &FilmConstants) -> usize {
    if constants.sharpening.amount > 0.0 {
        return 0;
    }
    let width = sqrt(1.0 + constants.blur_px * constants.blur_px);
    ((INNER - INSIDE - WIDTHS * width).max(0.0) / STEP) as usize
}

impl EdgeFilter {
    /// The first place of a line that an edge within a pixel of its outline depends on.
    pub(crate) fn first(&self) -> usize {
        self.first
    }

    /// Where the edge of a line seems to be on the film, pixels from the line's origin outwards; `expected` is where the
    /// outline itself is, at most [`DRAWN_RANGE`] farther. [`NormalReading::Unknown`] where the surface is not closed.
    pub(crate) fn edge(&self, paths: Option<&[f32; POINTS]>, expected: f64) -> NormalReading {
        let Some(paths) = paths else {
            return NormalReading::Unknown;
        };
        if let Some(film) = &self.enhanced {
            return edge_of(&film.shown(paths), expected);
        }
        let long = continued(&transmission(paths, self.attenuation));
        let first = (expected + INNER) / STEP - (HALF * PLACES) as f64;
        // Nothing changes beyond.
        let first = first.clamp(-(TAKEN as f64), POINTS as f64);
        let low = ((first + BEYOND as f64) as usize).max(MOST_REACH);
        let part = first + BEYOND as f64 - low as f64;
        let between = self.slopes(&long, low);
        let slopes: [f64; 2 * HALF + 1] = core::array::from_fn(|reading| {
            let [a, b] = [0, 1].map(|k| f64::from(between[reading * PLACES + k]));
            a + part * (b - a)
        });
        strongest(&slopes, expected)
    }

    /// Slopes at some places, from one on. Where nothing changes they are zero, to the last bit.
    fn slopes(&self, long: &Continued, from: usize) -> [f32; TAKEN] {
        let mut slopes = [0.0; TAKEN];
        for (k, weight) in self.weights.iter().enumerate().take(self.reach) {
            let before = long.get(from - (k + 1)..).unwrap_or_default();
            let after = long.get(from + (k + 1)..).unwrap_or_default();
            for ((slope, before), after) in slopes.iter_mut().zip(before).zip(after) {
                *slope += weight * (after - before);
            }
        }
        slopes
    }
}

/// The edge of what is drawn of a line.
#[inline(never)]
fn edge_of(drawn: &Drawn, expected: f64) -> NormalReading {
    steepest_rise(expected, DRAWN_RANGE, |middle, profile| {
        for (k, value) in profile.iter_mut().enumerate() {
            let t = expected + READING_STEP * (k as f64 - middle as f64);
            *value = f64::from(at(drawn, t));
        }
        Some(())
    })
}

/// What passes at the places of a line, and beyond both ends as there.
type Continued = [f32; POINTS + 2 * BEYOND];

fn continued(drawn: &[f32; POINTS]) -> Continued {
    let mut long = [drawn[0]; POINTS + 2 * BEYOND];
    long[BEYOND..BEYOND + POINTS].copy_from_slice(drawn);
    long[BEYOND + POINTS..].fill(drawn[POINTS - 1]);
    long
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::FilmConstants;
    use proptest::prelude::*;

    /// Oracle: blurred, read and differentiated one after the other.
    fn one_by_one(film: &FilmModel, paths: &[f32; POINTS], expected: f64) -> NormalReading {
        edge_of(&film.shown(paths), expected)
    }

    properties! {
        #[test]
        fn one_filter_finds_what_blur_and_derivative_find(
            steps in proptest::collection::vec((0..55usize, 0.05..20.0f32), 1..6),
            blur_px in 0.3..3.0f64,
            attenuation in 0.05..1.0f64,
            expected in -2.0..1.5f64,
        ) {
            let mut paths = [0.0; POINTS];
            for (to, more) in steps {
                paths[..to].iter_mut().for_each(|path| *path += more);
            }
            let film = FilmModel::certain(FilmConstants::plain(0.0, blur_px), attenuation);
            let (quick, slow) = (
                EdgeFilter::from(&film).edge(Some(&paths), expected),
                one_by_one(&film, &paths, expected),
            );
            match (quick, slow) {
                // Where the profile is nearly straight rounding decides where it is steepest.
                (NormalReading::At(a), NormalReading::At(b)) => {
                    prop_assert!((a - b).abs() < 2e-3, "{} {}", a, b);
                }
                (a, b) => prop_assert_eq!(a, b),
            }
        }
    }

    properties! {
        /// A rim that grows to its thickness, and metal up to nine times as thick farther in than the filter looks.
        #[test]
        fn what_lies_far_inside_moves_no_edge(
            thickness in 0.2..10.0f32, rounded in 0.5..2.0f32, off in -1.0..0.5f64, farther in 0.0..8.0f32,
            blur_px in 0.3..1.6f64, attenuation in 0.05..1.0f64,
        ) {
            let film = FilmModel::certain(FilmConstants::plain(0.0, blur_px), attenuation);
            let filter = EdgeFilter::from(&film);
            let inside = |k: usize| (off + INNER - STEP * k as f64) as f32;
            let rim = |k: usize| thickness * (inside(k) / rounded).clamp(0.0, 1.0);
            let cut: [f32; POINTS] = core::array::from_fn(|k| rim(k.max(filter.first())));
            let mut whole: [f32; POINTS] = core::array::from_fn(rim);
            whole[..filter.first()].iter_mut().for_each(|path| *path += farther * thickness);
            prop_assert!(filter.first() > 0);
            match [&whole, &cut].map(|paths| filter.edge(Some(paths), off)) {
                [NormalReading::At(a), NormalReading::At(b)] => prop_assert!((a - b).abs() < 0.02, "{} {}", a, b),
                other => prop_assert_eq!(other[0], other[1]),
            }
        }
    }

    #[test]
    fn a_line_without_metal_or_far_from_it_has_no_edge() {
        let filter = EdgeFilter::from(&FilmModel::certain(FilmConstants::plain(0.0, 1.0), 0.3));
        let mut paths = [0.0; POINTS];
        assert_eq!(filter.edge(Some(&paths), 0.4), NormalReading::Nothing);
        paths[..10].fill(9.0);
        assert_eq!(filter.edge(Some(&paths), 7.0), NormalReading::Nothing);
        for far in [-1e9, 1e9, f64::NAN] {
            assert_eq!(filter.edge(Some(&paths), far), NormalReading::Nothing);
        }
        assert_eq!(filter.edge(None, 0.0), NormalReading::Unknown);
    }
}
