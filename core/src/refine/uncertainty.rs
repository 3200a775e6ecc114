//! Uncertainty of a refined pose, from what its outline leaves unexplained.
//!
//! Residuals along an outline are not independent: a hand, a network and a grey edge err over
//! many pixels alike. The covariance is that of an M-estimate (Huber, *Robust Statistics*, 6.3)
//! whose influences are correlated along the outline (Conley, J. Econometrics 92, 1999, for
//! errors correlated in space): `H^-1 M H^-1` with `H = sum(l psi' J J')` and
//! `M = sum(l_i l_j g(d_ij) J_i J_j')`, where `psi` is the derivative of the loss, `l` arc
//! length, and `g` the covariance of `psi` over the distance `d` between samples, estimated from
//! the residuals themselves. `psi'` stands within the sum: where a stretch of outline fits badly it
//! holds the pose less than the rest, and often it is the one stretch that holds a number.

use super::border::BorderPixel;
use super::edge_bias::EdgeBias;
use super::equations::Equations;
use super::error::RefineError;
use super::fit::{Fit, FitSums};
use super::loss::Loss;
use super::memory::RefineMemory;
use super::problem::Problem;
use super::result::Refined;
use super::stages::{Pass, STAGES, Stage};
use super::view::CameraView;
use crate::film::PathLine;
use crate::math::inverse_spd;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance};

/// Width of a bin of distance, pixels, and number of bins.
const BIN: f64 = 2.0;
const BINS: usize = 24;
/// Samples belong together when the cosine between their normals is at least this: the two
/// sides of a thin plate err apart.
const ALIKE: f32 = 0.5;
/// Variance of an outline that is known to whole pixels only, square pixels for each pixel of its
/// length: residuals are differences of two drawings in the same pixels and do not show it. A
/// quarter of that of rounding, as measured by `cargo xtask synthetic --method refined`: errors of
/// noise-free outlines are 0.3 to 0.6 of what rounding as independent noise would give.
const GRAIN: f64 = 0.25 / 12.0;
/// Least mean of `psi'`, which may be small where the loss was cut close.
const LEAST_CURVATURE: f64 = 0.2;
/// No combination of the six parameters is held less than this part of what it were with the mean of `psi'` everywhere:
/// four standard deviations instead of one.
const LEAST_HOLD: f64 = 0.25;
/// Mixtures with that mean, one after the other, until it is so.
const MIXTURES: u32 = 8;
/// Independent stretches beyond the six parameters that are supposed at least.
const LEAST_FREEDOM: f64 = 4.0;

/// What the outline says of a pose: how sure it is, and how well it fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessment {
    /// Covariance of the pose, so wide that the ellipsoid of 95 % of a normal distribution in
    /// six dimensions (squared radius 12.59) holds the truth in 95 % of cases: the few independent
    /// stretches of an outline determine their own variance poorly, which the width allows for.
    ///
    /// It knows of random errors that vary along the outline and, on grey frames, of what is not known of the film
    /// ([`super::ImageTarget::film`]). What else shifts the whole outline alike (a trace that is everywhere too wide, a wrong
    /// calibration) leaves no residual and is not in it.
    /// `None` where the outline does not determine the pose.
    pub covariance: Option<PoseCovariance>,
    /// How the pose would move (turn in radians, shift in mm, camera axes) with one standard deviation of each of two
    /// independent errors of what components of one film share: its display, with what blur and attenuation are then, and its
    /// blur beyond that. Both are in the covariance already; [`crate::joint::shared`] takes them of both
    /// components. Zero where no film is known. The distance between edges and outline that physics leaves out is in the
    /// covariance and not here: nobody knows how much of it is common.
    pub film_steps: [[f64; 6]; 2],
    /// How well the model's outline is met by what was seen.
    pub fit: Fit,
}

/// How sure a refined pose is and how well it fits, from one more drawing in each view.
///
/// # Errors
/// [`RefineError`] as of [`super::refine`].
pub fn assess(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    memory: &mut RefineMemory<'_>,
) -> Result<Assessment, RefineError> {
    let (mut sums, mut bias) = (Sums::default(), EdgeBias::default());
    let fit = observe(
        model,
        views,
        refined,
        memory,
        |view, stage, border, lines| {
            sums.add(border, stage.loss, 6.0 / views.len() as f64);
            bias.add(view, stage, border, lines);
        },
    )?;
    let covariance = sums.covariance();
    Ok(Assessment {
        covariance: covariance.map(|covariance| bias.widen(covariance)),
        film_steps: bias.film_steps(),
        fit,
    })
}

/// How well a pose fits, from one drawing in each view. The pose need not be a refined one.
///
/// # Errors
/// [`RefineError`] as of [`super::refine`].
pub fn fit_at(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Fit, RefineError> {
    let unrefined = Refined::at(*pose);
    observe(model, views, &unrefined, memory, |_, _, _, _| ())
}

/// Looks at the outline at a pose as the last stage of refinement does; `each` gets the samples of every view.
pub(super) fn observe(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    memory: &mut RefineMemory<'_>,
    mut each: impl FnMut(&CameraView<'_>, &Stage, &[BorderPixel], &[PathLine]),
) -> Result<Fit, RefineError> {
    let problem = Problem::new(model, views, memory)?;
    let pass = Pass {
        index: STAGES - 1,
        sigma_px: refined.robust_sigma_px,
        drawn: true,
        ..Pass::default()
    };
    let mut sums = FitSums::default();
    for view in views {
        let stage = pass.stage(&view.target);
        let (pose, offset) = (&refined.pose, refined.offset_px);
        let mut equations = Equations::new();
        let count = problem.observe_view(view, pose, offset, &stage, memory, &mut equations)?;
        let border = memory.border.get(..count).unwrap_or_default();
        let lines = memory.film.lines.get(..count).unwrap_or_default();
        each(view, &stage, border, lines);
        sums.add_samples(border, stage.range);
        sums.add_areas(&view.target, memory.drawn)?;
        let seen = view.placement.compose(pose);
        sums.add_place(view.camera, &seen.transform(&model.bounds().centre));
    }
    Ok(sums.fit())
}

/// Covariance of a refined pose; see [`Assessment::covariance`].
///
/// # Errors
/// [`RefineError`] as of [`super::refine`].
pub fn uncertainty(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    memory: &mut RefineMemory<'_>,
) -> Result<Option<PoseCovariance>, RefineError> {
    Ok(assess(model, views, refined, memory)?.covariance)
}

/// Sums over the samples of all views.
#[derive(Default)]
struct Sums {
    /// `sum(l J J')`
    information: Matrix6,
    /// `sum(l psi' J J')`
    holding: Matrix6,
    /// `sum(l_i l_j g(d_ij) J_i J_j')`
    spread: Matrix6,
    /// `sum(l psi')`
    curvature: f64,
    length: f64,
    /// Number of stretches that err independently.
    stretches: f64,
}

impl Sums {
    /// `fitted` parameters were taken from this view's residuals.
    fn add(&mut self, border: &[BorderPixel], loss: Loss, fitted: f64) {
        let covariance = Correlation::of(border, loss, fitted);
        let reach = covariance.reach();
        let mut length = 0.0;
        for (index, sample, residual) in found(border) {
            let l = f64::from(sample.weight);
            length += l;
            let curvature = loss.curvature(residual);
            self.curvature += l * curvature;
            let jacobian = sample.jacobian.map(f64::from);
            // Half of the sample's own part: every pair is met once and counts both ways.
            let mut sum = jacobian.map(|value| value * l * covariance.bins[0] / 2.0);
            for (_, other, bin) in after(border, index, reach) {
                let weight = f64::from(other.weight) * covariance.bins[bin];
                for (sum, &value) in sum.iter_mut().zip(&other.jacobian) {
                    *sum += weight * f64::from(value);
                }
            }
            for row in 0..6 {
                for column in 0..6 {
                    let both = jacobian[row] * sum[column] + sum[row] * jacobian[column];
                    self.spread[row][column] += l * both;
                    let own = l * jacobian[row] * jacobian[column];
                    self.information[row][column] += own;
                    self.holding[row][column] += curvature * own;
                }
            }
        }
        self.length += length;
        self.stretches += length / covariance.stretch_px();
    }

    /// `H`, with as much of what it were with the mean of `psi'` everywhere as it needs: where residuals are large `psi'` is
    /// negative, and a part of the outline that lies on something else would hold a number the wrong way.
    fn bread(&self) -> Matrix6 {
        let curvature = (self.curvature / self.length.max(1.0)).max(LEAST_CURVATURE);
        let sum = |even: f64, own: f64| -> Matrix6 {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    even * curvature * self.information[row][column]
                        + own * self.holding[row][column]
                })
            })
        };
        let holds = |even: &f64| inverse_spd(&sum(even - LEAST_HOLD, 1.0 - even)).is_some();
        let mixtures = (0..=MIXTURES).map(|k| f64::from(k) / f64::from(MIXTURES));
        let even = mixtures.into_iter().find(holds).unwrap_or(1.0);
        sum(even, 1.0 - even)
    }

    fn covariance(&self) -> Option<PoseCovariance> {
        let bread = self.bread();
        let freedom = (self.stretches - 6.0).max(LEAST_FREEDOM);
        // 6 F(6, n) / chi^2(6) at 95 %, within 1 % for n of 10 and more (Abramowitz and Stegun,
        // table 26.9).
        let few = 1.0 + 4.4 / freedom + 9.0 / (freedom * freedom);
        let spread: Matrix6 = core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                self.spread[row][column] * few + self.information[row][column] * GRAIN
            })
        });
        PoseCovariance::sandwich(&bread, &spread)
    }
}

/// Samples that have a residual, with their places in the list and the residual, pixels.
fn found(border: &[BorderPixel]) -> impl Iterator<Item = (usize, &BorderPixel, f64)> {
    let samples = border.iter().enumerate();
    samples.filter_map(|(index, sample)| Some((index, sample, sample.residual_px()?)))
}

/// Samples this far apart, pixels, are not compared.
const REACH: i32 = (BIN * BINS as f64) as i32;

/// The bin of a distance, from 1, by its square in pixels.
const BIN_OF: [u8; (REACH * REACH) as usize] = {
    let mut bins = [0; (REACH * REACH) as usize];
    let (mut square, mut bin) = (0, 1);
    while square < bins.len() {
        let end = BIN * bin as f64;
        if square as f64 >= end * end {
            bin += 1;
        }
        bins[square] = bin;
        square += 1;
    }
    bins
};

/// The samples listed after one that are less than `reach` pixels from it and on the same side of the part, with their
/// places in the list and the bin of their distance.
fn after(
    border: &[BorderPixel],
    index: usize,
    reach: i32,
) -> impl Iterator<Item = (usize, &BorderPixel, usize)> {
    let sample = border[index];
    let offset = |a: u16, b: u16| i32::from(a) - i32::from(b);
    // They are listed row by row.
    let close = move |other: &&BorderPixel| offset(other.row, sample.row) < reach;
    let rest = border.get(index + 1..).unwrap_or_default();
    let rest = (index + 1..).zip(rest.iter().take_while(close));
    rest.filter_map(move |(number, other)| {
        let right = offset(other.column, sample.column);
        if right.abs() >= reach {
            return None;
        }
        let down = offset(other.row, sample.row);
        let bin = *BIN_OF.get((right * right + down * down) as usize)?;
        let [a, b] = [sample.normal, other.normal];
        let alike = a[0] * b[0] + a[1] * b[1] >= ALIKE;
        other.residual_px().filter(|_| alike)?;
        Some((number, other, usize::from(bin)))
    })
}

/// Samples within reach, mostly: an outline has some four in a row.
const KEPT: usize = 256;

/// Derivatives of the loss at samples, each reckoned once: a sample has some hundred others near it.
struct Pulls<'b> {
    border: &'b [BorderPixel],
    loss: Loss,
    /// Of the last samples before [`Self::known`], by the remainder of their number.
    last: [f64; KEPT],
    known: usize,
}

impl<'b> Pulls<'b> {
    fn new(border: &'b [BorderPixel], loss: Loss) -> Self {
        Self {
            border,
            loss,
            last: [0.0; KEPT],
            known: 0,
        }
    }

    /// That of a sample which does not come before `least`, which rises from call to call.
    fn of(&mut self, number: usize, least: usize) -> f64 {
        if number - least >= KEPT {
            return self.reckoned(number);
        }
        while self.known <= number {
            self.last[self.known % KEPT] = self.reckoned(self.known);
            self.known += 1;
        }
        self.last[number % KEPT]
    }

    fn reckoned(&self, number: usize) -> f64 {
        let residual = self.border.get(number).and_then(BorderPixel::residual_px);
        residual.map_or(0.0, |residual| self.loss.pull(residual))
    }
}

/// Covariance of `psi` over distance.
struct Correlation {
    /// At distance zero, then in bins of [`BIN`] pixels; zero from where it first fails to be
    /// positive.
    bins: [f64; BINS + 1],
}

impl Correlation {
    /// Rounds in which the correlation and what the fit took of it are brought to agree.
    const ROUNDS: usize = 8;
    /// More than this part of the variance is not supposed to have been taken. What is supposed lengthens the stretches that err alike,
    /// and those what is supposed: without a narrow bound two poses 0.03 degrees apart may be told with a deviation that is four times
    /// as large for one as for the other.
    const MOST_TAKEN: f64 = 0.25;

    /// `fitted` parameters took the longest waves out of the residuals, as much as they explain
    /// of the independent stretches. The covariance of what remains is too small by the same amount at every
    /// distance, and this amount is added again.
    fn of(border: &[BorderPixel], loss: Loss, fitted: f64) -> Self {
        let (raw, length) = Self::raw(border, loss);
        let mut taken = 0.0;
        let mut correlation = Self::cut(&raw, taken);
        for _ in 0..Self::ROUNDS {
            let fraction =
                (fitted * correlation.stretch_px() / length.max(1.0)).min(Self::MOST_TAKEN);
            taken = raw[0] * fraction / (1.0 - fraction);
            correlation = Self::cut(&raw, taken);
        }
        correlation
    }

    /// `taken` more at every distance, up to where it first fails to be positive.
    fn cut(raw: &[f64; BINS + 1], taken: f64) -> Self {
        let mut bins = raw.map(|value| value + taken);
        let end = bins.iter().position(|&value| value <= 0.0);
        bins[end.unwrap_or(BINS + 1)..].fill(0.0);
        Self { bins }
    }

    /// The mean product of `psi` in every bin, and the length of the outline.
    fn raw(border: &[BorderPixel], loss: Loss) -> ([f64; BINS + 1], f64) {
        let (mut sums, mut weights) = ([0.0; BINS + 1], [0.0; BINS + 1]);
        let mut pulls = Pulls::new(border, loss);
        for (index, sample, _) in found(border) {
            let (l, own) = (f64::from(sample.weight), pulls.of(index, index));
            sums[0] += l * own * own;
            weights[0] += l;
            for (number, other, bin) in after(border, index, REACH) {
                let weight = l * f64::from(other.weight);
                sums[bin] += weight * own * pulls.of(number, index);
                weights[bin] += weight;
            }
        }
        let mean = |bin: usize| {
            if weights[bin] > 0.0 {
                sums[bin] / weights[bin]
            } else {
                0.0
            }
        };
        (core::array::from_fn(mean), weights[0])
    }

    /// Distance from which on samples err apart, pixels.
    fn reach(&self) -> i32 {
        let first = self.bins.iter().position(|&value| value == 0.0);
        BIN as i32 * first.map_or(BINS, |bin| bin.saturating_sub(1)) as i32
    }

    /// Length of outline that errs alike, pixels: the integral of the correlation to both sides,
    /// at least one pixel.
    fn stretch_px(&self) -> f64 {
        let [own, rest @ ..] = &self.bins;
        if *own <= 0.0 {
            return 1.0;
        }
        (2.0 * BIN * rest.iter().sum::<f64>() / own).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::border::Residual;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Of six stretches each holds one number by itself; the first is met badly.
    fn stretches(badly_px: f32) -> Vec<BorderPixel> {
        let sample = |number: u16| {
            let (held, swing) = (usize::from(number / 100), f32::from(number % 2) - 0.5);
            let mut jacobian = [0.0; 6];
            jacobian[held] = 1.0;
            BorderPixel {
                // Far from each other, so that none errs like another.
                column: 60 * (number % 100),
                row: 60 * (number / 100),
                normal: [1.0, 0.0],
                weight: 1.0,
                residual: Residual::Px(swing * if held == 0 { badly_px } else { 0.2 }),
                jacobian,
                ..BorderPixel::EMPTY
            }
        };
        (0..600).map(sample).collect()
    }

    #[test]
    fn a_stretch_that_is_met_badly_holds_its_number_less() {
        let deviations = |badly_px: f32| -> [f64; 6] {
            let mut sums = Sums::default();
            sums.add(&stretches(badly_px), Loss::Tukey(2.5), 0.0);
            let matrix = sums.covariance().expect("determined").matrix;
            core::array::from_fn(|k| matrix[k][k].sqrt())
        };
        let (alike, badly) = (deviations(0.2), deviations(2.0));
        assert!((alike[0] / alike[1] - 1.0).abs() < 1e-9);
        // psi' at 1 px of 2.5 is 0.17, where it is 0.99 elsewhere.
        assert!((badly[0] / badly[1] - 0.99 / 0.25).abs() < 0.3, "{badly:?}");
        // Where psi' is negative it must not hold the wrong way.
        let off = deviations(3.4);
        assert!(off.iter().all(|x| x.is_finite() && *x > 0.0), "{off:?}");
        assert!(off[0] / off[1] < 4.0 * (0.99 / 0.85), "{off:?}");
    }

    /// A wave as long as the outline looks like few stretches that err alike, and less than nothing taken or nearly all of it explain it.
    #[test]
    fn a_fit_takes_no_more_than_a_quarter_of_the_variance() {
        let sample = |k: u16| BorderPixel {
            column: 8 + k,
            row: 9,
            normal: [0.0, 1.0],
            weight: 1.0,
            residual: Residual::Px(0.5 * libm::sinf(f32::from(k) / 9.0)),
            ..BorderPixel::EMPTY
        };
        let border: Vec<BorderPixel> = (0..300).map(sample).collect();
        let loss = Loss::Tukey(2.5);
        let (raw, _) = Correlation::raw(&border, loss);
        let taken = Correlation::of(&border, loss, 6.0).bins[0] / raw[0] - 1.0;
        assert!((taken - 1.0 / 3.0).abs() < 1e-9, "{taken}");
    }

    proptest! {
        #[test]
        fn derivatives_that_are_kept_are_those_that_are_reckoned(
            residuals in proptest::collection::vec(proptest::option::weighted(0.8, -9.0f32..9.0), 1..900),
            every in 1usize..9, reach in 1usize..600,
        ) {
            let sample = |residual: &Option<f32>| BorderPixel {
                residual: residual.map_or(Residual::Missing, Residual::Px),
                ..BorderPixel::EMPTY
            };
            let border: Vec<BorderPixel> = residuals.iter().map(sample).collect();
            let loss = Loss::Cauchy(1.5);
            let mut pulls = Pulls::new(&border, loss);
            for least in (0..residuals.len()).step_by(every) {
                let near = residuals.iter().enumerate().skip(least).take(reach);
                for (number, residual) in near {
                    let own = residual.map_or(0.0, |px| loss.pull(f64::from(px)));
                    prop_assert_eq!(pulls.of(number, least), own);
                }
            }
        }
    }
}
