//! Constants of a film, and the edge that they make of paths through metal.

use core::fmt;

pub(crate) use super::drawn::Drawn;
use super::drawn::Gaussian;
use super::lines::{INNER, POINTS, STEP};
use super::sharpening::{MetalContrast, Sharpening};
use crate::image::display::DisplayCurve;
use crate::image::profile::FILTER_REACH;
use crate::math::exp;

/// What is the same for all frames of a study and all components in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmConstants {
    /// Of the display, one divided by grey values; see [`DisplayCurve`].
    pub curvature: f64,
    /// Standard deviation of everything that blurs: focal spot, detector, pixels, motion. Pixels.
    pub blur_px: f64,
    /// How edges were enhanced.
    pub sharpening: Sharpening,
    /// Side of the squares that frames are read in, pixels of the file ([`super::SquareChoice`]). What is said here in pixels is in such sides,
    /// and so are the frames and cameras that it is used with.
    pub square_px: usize,
}

impl FilmConstants {
    /// Those of a film whose edges nobody enhanced.
    #[must_use]
    pub fn plain(curvature: f64, blur_px: f64) -> Self {
        Self {
            curvature,
            blur_px,
            sharpening: Sharpening::default(),
            square_px: 1,
        }
    }

    /// The same film read in squares with sides of so many of the pixels that this is of.
    #[must_use]
    pub fn in_squares(self, side: usize) -> Self {
        let Sharpening { amount, radius_px } = self.sharpening;
        let pixels = side.max(1) as f64;
        Self {
            blur_px: self.blur_px / pixels,
            sharpening: Sharpening {
                amount,
                radius_px: radius_px / pixels,
            },
            square_px: self.square_px * side.max(1),
            ..self
        }
    }
}

/// As a person who stated them would say it.
impl fmt::Display for FilmConstants {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            curvature, blur_px, ..
        } = self;
        match *curvature > 0.0 {
            true => write!(
                f,
                "film as stated, {:.0} grey values for a factor of e",
                1.0 / curvature
            )?,
            false => f.write_str("linear film, as stated")?,
        }
        write!(f, ", blur {blur_px:.1} px")
    }
}

/// Numbers of a [`FilmModel`] that have an uncertainty: curvature, blur, attenuation.
pub const CONSTANTS: usize = 3;

/// What a film makes of one component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmModel {
    /// Those of the film.
    pub constants: FilmConstants,
    /// Attenuation of the component's metal for thin layers, per mm.
    pub attenuation: f64,
    /// What its profiles show: behind a curved display it tells how edges were enhanced.
    pub contrast: MetalContrast,
    /// Covariance of curvature, the logarithm of the blur and that of the attenuation.
    pub covariance: [[f64; CONSTANTS]; CONSTANTS],
}

impl FilmModel {
    /// Constants that are taken as they are.
    #[must_use]
    pub fn certain(constants: FilmConstants, attenuation: f64) -> Self {
        Self {
            constants,
            attenuation,
            contrast: MetalContrast::default(),
            covariance: [[0.0; CONSTANTS]; CONSTANTS],
        }
    }

    /// The curve by which frames are read; `inverted` where metal is bright.
    #[must_use]
    pub fn curve(&self, inverted: bool) -> DisplayCurve {
        DisplayCurve::new(self.constants.curvature, inverted)
    }

    /// One of the numbers that have an uncertainty changed by a little, in the units of [`Self::covariance`].
    pub(crate) fn changed(mut self, number: usize, by: f64) -> Self {
        match number {
            0 => self.constants.curvature += by,
            1 => self.constants.blur_px *= exp(by),
            _ => self.attenuation *= exp(by),
        }
        self
    }

    /// What a line looks like, read through the display's curve.
    pub(crate) fn shown(&self, paths: &[f32; POINTS]) -> Drawn {
        let FilmConstants {
            curvature,
            blur_px,
            sharpening,
            ..
        } = self.constants;
        let drawn = LineBlur::of(blur_px).blurred(&transmission(paths, self.attenuation));
        sharpening.of(&drawn, self.contrast.over_veil(curvature))
    }
}

/// How far from an outline its edge may seem to be, pixels.
pub const DRAWN_RANGE: f64 = 3.0;

// What the filter reads of a line lies on it, or beyond its ends where nothing changes.
const _: () = assert!(DRAWN_RANGE + FILTER_REACH < INNER);

/// Beam hardening: metal takes the soft part of the beam first, so that thicker layers attenuate less for each mm,
/// `(1 + v mu L)^(-1 / v)` with this `v`; 0 would be one energy alone, `exp(-mu L)`.
const HARDENING: f32 = 0.25;

/// What passes through metal of this attenuation, per mm.
pub(crate) fn transmission(paths: &[f32; POINTS], attenuation: f64) -> Drawn {
    paths.map(|path| {
        let thin = 1.0 + HARDENING * attenuation as f32 * path;
        1.0 / (thin * thin * thin * thin)
    })
}

/// Blur is taken to be within these, pixels: a pixel's own width is 0.3.
pub(crate) const LEAST_BLUR: f64 = 0.3;
pub(crate) const MOST_BLUR: f64 = 3.0;

/// Places to each side that blur reaches at most.
pub(crate) const MOST_BLUR_REACH: usize = 40;

/// Weights of a Gaussian.
pub(crate) struct Blur {
    /// At the places of a line from the middle to one side.
    pub(crate) weights: [f32; MOST_BLUR_REACH + 1],
    /// Places to each side that have any.
    pub(crate) reach: usize,
    /// Of those of both sides.
    pub(crate) sum: f32,
}

impl Blur {
    /// Of this width, pixels.
    pub(crate) fn of(blur_px: f64) -> Self {
        let (width, reach) = blur_places(blur_px);
        let mut blur = Self {
            weights: [0.0; MOST_BLUR_REACH + 1],
            reach,
            sum: 0.0,
        };
        for (k, weight) in blur.weights.iter_mut().take(blur.reach + 1).enumerate() {
            let part = k as f32 / width;
            *weight = exp(f64::from(-0.5 * part * part)) as f32;
            blur.sum += if k == 0 { *weight } else { 2.0 * *weight };
        }
        blur
    }
}

/// Standard deviation of a blur, and how far to each side it reaches, places.
fn blur_places(blur_px: f64) -> (f32, usize) {
    let width = (blur_px.clamp(LEAST_BLUR, MOST_BLUR) / STEP) as f32;
    (width, ((3.2 * width) as usize + 1).min(MOST_BLUR_REACH))
}

/// A blur made ready for many lines.
pub(super) struct LineBlur(Gaussian<MOST_BLUR_REACH>);

impl LineBlur {
    /// Of this width, pixels.
    pub(super) fn of(blur_px: f64) -> Self {
        let (width, reach) = blur_places(blur_px);
        Self(Gaussian::of(width, reach))
    }

    /// A line with this blur; both ends are continued.
    pub(super) fn blurred(&self, drawn: &Drawn) -> Drawn {
        let mut blurred = self.0.convolved(drawn);
        keep_level(drawn, self.0.reach(), &mut blurred);
        blurred
    }
}

/// Where nothing changes within a reach nothing is changed: outside of the part everything passes.
fn keep_level(drawn: &Drawn, reach: usize, blurred: &mut Drawn) {
    let mut start = 0;
    for stretch in drawn.chunk_by(|a, b| a == b) {
        let end = start + stretch.len();
        let from = if start == 0 { 0 } else { start + reach };
        let to = if end == POINTS {
            end
        } else {
            end.saturating_sub(reach)
        };
        if from < to {
            blurred[from..to].copy_from_slice(&drawn[from..to]);
        }
        start = end;
    }
}

/// Between places of a line, linear; beyond its ends as there.
pub(crate) fn at(drawn: &Drawn, along: f64) -> f32 {
    let place = ((along + INNER) / STEP).clamp(0.0, (POINTS - 1) as f64) as f32;
    let low = (place as usize).min(POINTS - 2);
    let part = place - low as f32;
    drawn[low] + part * (drawn[low + 1] - drawn[low])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::edge::EdgeFilter;
    use crate::image::profile::NormalReading;
    use proptest::prelude::*;

    /// A half space of this depth, from the origin inwards.
    fn slab(depth: f32) -> [f32; POINTS] {
        core::array::from_fn(|k| {
            if (k as f64) * STEP < INNER {
                depth
            } else {
                0.0
            }
        })
    }

    /// The end of a rounded rim of this radius, pixels, in mm a third of that each; the rim ends this far outside.
    fn rim(radius: f64, end: f64) -> [f32; POINTS] {
        core::array::from_fn(|k| {
            let inside = end + INNER - STEP * k as f64;
            let off = (radius - inside).clamp(0.0, radius);
            (2.0 * libm::sqrt(radius * radius - off * off) / 3.0) as f32
        })
    }

    fn edge(paths: &[f32; POINTS], blur_px: f64, attenuation: f64) -> f64 {
        let model = FilmModel::certain(FilmConstants::plain(0.0, blur_px), attenuation);
        match EdgeFilter::from(&model).edge(Some(paths), 0.0) {
            NormalReading::At(edge) => edge,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_edge_of_a_slab_is_its_edge_whatever_the_blur() {
        for blur_px in [0.4, 0.7, 1.3, 2.0] {
            // Between the last place inside and the first outside.
            let found = edge(&slab(8.0), blur_px, 0.4) + STEP / 2.0;
            assert!(found.abs() < 0.02, "{found} {blur_px}");
        }
    }

    #[test]
    fn the_edge_of_a_rounded_rim_lies_inside_and_more_so_of_thin_metal() {
        // A rim may end anywhere between two places of a line.
        let ends = [0.0, 0.05, 0.1, 0.15, 0.2].map(|end| end - 0.1);
        let [thin, thick] = [0.1, 1.5].map(|attenuation| {
            let found = ends.map(|end| edge(&rim(9.0, end), 0.8, attenuation) - end);
            found.iter().sum::<f64>() / 5.0
        });
        assert!(thin < thick && thick < -0.1, "{thin} {thick}");
        for (found, attenuation) in [(thin, 0.1), (thick, 1.5)] {
            let wanted = steepest(9.0, 0.8, attenuation);
            assert!((found - wanted).abs() < 0.02, "{found} {wanted}");
        }
    }

    /// Oracle: the steepest place of a rim's profile, a hundred places to the pixel, blurred by film and filter at once.
    fn steepest(radius: f64, blur_px: f64, attenuation: f64) -> f64 {
        let passed = |along: f64| {
            let off = (radius + along).clamp(0.0, radius);
            let path = 2.0 * libm::sqrt(radius * radius - off * off) / 3.0;
            libm::pow(1.0 + 0.25 * attenuation * path, -4.0)
        };
        let variance = blur_px * blur_px + 1.0;
        let slope = |at: f64| -> f64 {
            let kernel = |off: f64| off * libm::exp(-off * off / (2.0 * variance));
            (-600..=600)
                .map(|k| f64::from(k) / 100.0)
                .map(|off| kernel(off) * passed(at + off))
                .sum()
        };
        let places = (-300..=100).map(|k| f64::from(k) / 100.0);
        places
            .max_by(|a, b| slope(*a).total_cmp(&slope(*b)))
            .expect("some")
    }

    /// Oracle: a place at a time.
    fn blurred_one_by_one(drawn: &Drawn, blur_px: f64) -> Drawn {
        let width = (blur_px / STEP) as f32;
        let reach = (3.2 * width) as i32 + 1;
        let weight = |j: i32| libm::expf(-0.5 * (j as f32 / width) * (j as f32 / width));
        let there = |k: i32| drawn[k.clamp(0, POINTS as i32 - 1) as usize];
        let sum: f32 = (-reach..=reach).map(weight).sum();
        core::array::from_fn(|k| {
            let near = (-reach..=reach).map(|j| weight(j) * there(k as i32 + j));
            near.sum::<f32>() / sum
        })
    }

    properties! {
        #[test]
        fn blur_is_the_mean_of_what_is_near(
            steps in proptest::collection::vec((0..POINTS, 0.0..1.0f32), 0..6),
            blur_px in 0.3..3.0f64,
        ) {
            let mut drawn = [1.0; POINTS];
            for (from, value) in steps {
                drawn[from..].fill(value);
            }
            let quick = LineBlur::of(blur_px).blurred(&drawn);
            let naive = blurred_one_by_one(&drawn, blur_px);
            for (k, (a, b)) in quick.iter().zip(&naive).enumerate() {
                prop_assert!((a - b).abs() < 1e-5, "{} {} {}", k, a, b);
            }
            let first = drawn.iter().position(|&x| x != drawn[0]).unwrap_or(POINTS);
            let reach = (3.2 * blur_px / STEP) as usize + 1;
            prop_assert!(quick[..first.saturating_sub(reach)].iter().all(|&x| x == drawn[0]));
        }
    }

    #[test]
    fn blur_keeps_the_sum_and_has_the_width_asked_for() {
        let mut drawn = [1.0; POINTS];
        drawn[40] = 2.0;
        let blurred = LineBlur::of(1.3).blurred(&drawn);
        let (mut sum, mut spread) = (0.0, 0.0);
        for (k, &x) in blurred.iter().enumerate() {
            let off = STEP * (k as f64 - 40.0);
            sum += f64::from(x - 1.0);
            spread += f64::from(x - 1.0) * off * off;
        }
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
        assert!((spread / sum - 1.69).abs() < 0.05, "{spread}");
    }
}
