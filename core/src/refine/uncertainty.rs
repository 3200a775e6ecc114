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
use super::common_distance::Errors;
use super::correlation::{BLOCK, Correlation};
use super::edge_bias::EdgeBias;
use super::error::RefineError;
use super::fit::{Fit, FitSums};
use super::jacobians::Jacobians;
use super::loss::Loss;
use super::memory::RefineMemory;
use super::motion::Motion;
use super::problem::Problem;
use super::result::Refined;
use super::stages::{Pass, STAGES, Stage};
use super::view::CameraView;
use crate::film::PathLine;
use crate::math::inverse_spd;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance};
use crate::render::Projected;

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
/// None errs less than this part of what it would if the outline erred in independent stretches: a quarter of the standard deviation. A judgement, not a fit.
const LEAST_SPREAD: f64 = 1.0 / 16.0;
/// Mixtures with what were so all along the outline, one after the other, until it is so.
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
    /// ([`super::ImageTarget::film`]), of masks how far they may be too wide everywhere ([`crate::image::silhouette::CommonOffset`]) or on one side.
    /// What else shifts the whole outline alike (more of that, a wrong calibration) leaves no residual and is not in it. Of a model that is known to be round the turn about its axis has the deviation of an angle of
    /// which nothing is known.
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
    // One by one: of both at once there would be copies on the stack.
    let mut sums = Sums::default();
    let mut bias = EdgeBias::default();
    let fit = observe(model, views, refined, memory, |seen| {
        let motion = &seen.motion;
        let jacobian = |sample: &BorderPixel| motion.jacobian(sample);
        let jacobians = Jacobians::new(seen.border, jacobian, seen.scratch);
        sums.add(&jacobians, seen.stage.loss, 6.0 / views.len() as f32);
        bias.add((seen.view, motion), &seen.stage, seen.border, seen.lines);
    })?;
    let covariance = sums.covariance();
    Ok(Assessment {
        covariance: covariance.map(|covariance| {
            let widened = bias.widen(covariance, sums.errors());
            let round = model.revolution();
            round.map_or(widened, |round| {
                round.widen(widened, &refined.pose, &model.centre())
            })
        }),
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
    observe(model, views, &unrefined, memory, |_| ())
}

/// What was seen in a view.
pub(super) struct Observed<'o> {
    view: &'o CameraView<'o>,
    motion: Motion,
    stage: Stage,
    pub(super) border: &'o [BorderPixel],
    lines: &'o [PathLine],
    /// What the model was drawn in, not needed any more.
    scratch: &'o mut [Projected],
}

/// Looks at the outline at a pose as the last stage of refinement does; `each` gets the samples of every view.
pub(super) fn observe(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    memory: &mut RefineMemory<'_>,
    mut each: impl FnMut(Observed<'_>),
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
        let seen = view.placement.compose(&refined.pose);
        let count = problem.observe_view(view, &seen, refined.offset_px, &stage, memory)?;
        let border = memory.border.get(..count).unwrap_or_default();
        each(Observed {
            view,
            motion: problem.motion(view, &seen),
            stage,
            border,
            lines: memory.film.lines.get(..count).unwrap_or_default(),
            scratch: memory.projected,
        });
        sums.add_samples(border, stage.range);
        let offset_px = refined.offset_px + view.target.offset_px();
        sums.add_areas(&view.target, offset_px, memory.drawn)?;
        sums.add_place(model, view, &seen);
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

/// Adds a symmetric matrix of which the lower triangle alone was summed.
fn add_lower(to: &mut Matrix6, more: &[[f32; 6]; 6]) {
    let mut add = |row: usize, column: usize, sum: f32| {
        let entry = to.get_mut(row).and_then(|row| row.get_mut(column));
        if let Some(entry) = entry {
            *entry += f64::from(sum);
        }
    };
    for (row, sums) in more.iter().enumerate() {
        for (column, &sum) in sums.iter().enumerate().take(row + 1) {
            add(row, column, sum);
            if column < row {
                add(column, row, sum);
            }
        }
    }
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
    /// `sum(l v)` with what a pixel of length errs where stretches do so independently: the variance of `psi`, and their length.
    noise: f64,
}

impl Sums {
    /// `fitted` parameters were taken from this view's residuals.
    fn add<F: Fn(&BorderPixel) -> [f32; 6]>(
        &mut self,
        jacobians: &Jacobians<'_, F>,
        loss: Loss,
        fitted: f32,
    ) {
        let border = jacobians.border;
        let covariance = Correlation::of(border, loss, fitted);
        let mut length = 0.0;
        for (few, samples) in border.chunks(BLOCK).enumerate() {
            let mut sums = Block::default();
            for (place, sample) in samples.iter().enumerate() {
                let index = few * BLOCK + place;
                let Some(residual) = sample.residual_px() else {
                    continue;
                };
                let own = jacobians.of(index);
                // Half of the sample's own part: every pair is met once and counts both ways.
                let mut sum = own.map(|value| value * sample.weight * covariance.bins[0] / 2.0);
                for (number, other, alike) in covariance.after(border, index) {
                    let weight = other.weight * alike;
                    for (sum, value) in sum.iter_mut().zip(&jacobians.of(number)) {
                        *sum += weight * value;
                    }
                }
                sums.add(sample.weight, loss.curvature(residual), &own, &sum);
            }
            length += f64::from(sums.length);
            self.add_block(&sums);
        }
        let stretch = f64::from(covariance.stretch_px());
        self.stretches += length / stretch;
        self.noise += length * stretch * f64::from(covariance.bins[0]);
    }

    fn add_block(&mut self, block: &Block) {
        self.curvature += f64::from(block.curvature);
        self.length += f64::from(block.length);
        add_lower(&mut self.spread, &block.spread);
        add_lower(&mut self.information, &block.information);
        add_lower(&mut self.holding, &block.holding);
    }

    /// `H`, with as much of what it were with the mean of `psi'` everywhere as it needs: where residuals are large `psi'` is
    /// negative, and a part of the outline that lies on something else would hold a number the wrong way.
    fn bread(&self) -> Matrix6 {
        self.mixed(self.mean_curvature(), &self.holding, LEAST_HOLD)
    }

    /// `M`, with as much of what it were if the outline erred in independent stretches as it needs: a covariance that is cut where it first fails
    /// to be positive is none of a wave that is as long, and would give it a variance below zero.
    fn meat(&self) -> Matrix6 {
        let noise = self.noise / self.length.max(1.0);
        self.mixed(noise, &self.spread, LEAST_SPREAD)
    }

    /// How residuals err, with rounding.
    fn errors(&self) -> Errors {
        Errors {
            noise: self.noise / self.length.max(1.0) + GRAIN,
            curvature: self.mean_curvature(),
        }
    }

    /// The mean of `psi'`.
    fn mean_curvature(&self) -> f64 {
        (self.curvature / self.length.max(1.0)).max(LEAST_CURVATURE)
    }

    /// A sum over the outline, mixed with as much of what it were if every pixel of length had the part `even` in it as leaves no combination of the six
    /// parameters less than the part `least` of that.
    fn mixed(&self, even: f64, own: &Matrix6, least: f64) -> Matrix6 {
        let sum = |evenly: f64, by_itself: f64| -> Matrix6 {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    evenly * even * self.information[row][column] + by_itself * own[row][column]
                })
            })
        };
        let is_enough = |part: &f64| inverse_spd(&sum(part - least, 1.0 - part)).is_some();
        let mixtures = (0..=MIXTURES).map(|k| f64::from(k) / f64::from(MIXTURES));
        let part = mixtures.into_iter().find(is_enough).unwrap_or(1.0);
        sum(part, 1.0 - part)
    }

    fn covariance(&self) -> Option<PoseCovariance> {
        let bread = self.bread();
        let freedom = (self.stretches - 6.0).max(LEAST_FREEDOM);
        // 6 F(6, n) / chi^2(6) at 95 %, within 1 % for n of 10 and more (Abramowitz and Stegun,
        // table 26.9).
        let few = 1.0 + 4.4 / freedom + 9.0 / (freedom * freedom);
        let meat = self.meat();
        let spread: Matrix6 = core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                meat[row][column] * few + self.information[row][column] * GRAIN
            })
        });
        PoseCovariance::sandwich(&bread, &spread)
    }
}

/// [`Sums`] over a few samples, lower triangles alone.
#[derive(Default)]
struct Block {
    information: [[f32; 6]; 6],
    holding: [[f32; 6]; 6],
    spread: [[f32; 6]; 6],
    curvature: f32,
    length: f32,
}

impl Block {
    /// Adds a sample with its Jacobian, and with the sum of those near it.
    fn add(&mut self, length: f32, curvature: f32, own: &[f32; 6], sum: &[f32; 6]) {
        self.length += length;
        self.curvature += length * curvature;
        let rows = self.spread.iter_mut().zip(&mut self.information);
        let rows = rows.zip(&mut self.holding).zip(own.iter().zip(sum));
        for (row, (((spread, information), holding), (&own_of, &sum_of))) in rows.enumerate() {
            let (own_row, sum_row) = (length * own_of, length * sum_of);
            let held = curvature * own_row;
            let columns = spread.iter_mut().zip(information).zip(holding);
            let columns = columns.zip(own.iter().zip(sum)).take(row + 1);
            for (((spread, information), holding), (&own, &sum)) in columns {
                *spread += own_row * sum + sum_row * own;
                *information += own_row * own;
                *holding += held * own;
            }
        }
    }
}

#[cfg(test)]
mod tests;
