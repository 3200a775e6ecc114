//! How well a pose can be known at all: the bound of Cramer and Rao for a noisy outline.
//!
//! A trace says of each piece `i` of the model's outline how far it is displaced along its normal,
//! `x = J p + e`, with `p` the error of the pose, `J` the outline's Jacobian and `e` the noise of
//! the covariance `C`. For Gaussian noise
//!
//! - **the bound** on the covariance of any unbiased estimator of `p` is the inverse of Fisher's
//!   information `J' C^-1 J` (S. M. Kay, *Fundamentals of Statistical Signal Processing: Estimation
//!   Theory*, 1993, sections 3.7 to 3.9). Only an estimator that knows the noise's spectrum and weighs by it
//!   reaches it (ibid., section 4.5).
//! - **plain least squares**, which weighs by length alone, reaches
//!   `(J' J)^-1 J' C J (J' J)^-1`. What does not know the spectrum cannot be expected to
//!   do better. The two are one where the noise is white.
//!
//! The noise: a mask rounds its outline to whole pixels, an error with the variance of a uniform
//! number, 1/12 square pixel for each pixel of outline, independent from pixel to pixel (W. R.
//! Bennett, Bell Syst. Tech. J. 27, 1948); and a hand's jitter, of the covariance
//! `s^2 exp(-d^2 / (2 l^2))` of the way `d` along the outline.
//!
//! **Rounding alone is no Gaussian noise.** Each pixel of a mask that was drawn from the model
//! rules out every pose that would have drawn it otherwise, so an estimator that makes use of that
//! comes nearer than this bound; for masks without other noise it is a yardstick and no limit.

mod sites;

pub use sites::{Outlines, Site};

use fluoropose::pose::covariance::{Deviations, Matrix6, PoseCovariance};
use nalgebra::{DMatrix, Matrix6xX};
use serde::Serialize;

use super::accuracy::{Errors, rms};
use super::disturb::DisturbanceOptions;
use super::disturb::jitter::Correlation;

/// Variance of a rounded number, square pixels: uniform over one pixel.
const ROUNDED: f64 = 1.0 / 12.0;

/// The noise of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Variance of the white part for one pixel of outline, square pixels.
    pub white_px2: f64,
    /// Standard deviation of the correlated part, pixels.
    pub jitter_px: f64,
    /// Its correlation length, pixels.
    pub correlation_px: f64,
}

impl Noise {
    /// The noise of a mask whose pixels say where the outline is, and nothing else.
    pub const ROUNDING: Self = Self {
        white_px2: ROUNDED,
        jitter_px: 0.0,
        correlation_px: 0.0,
    };

    /// The noise of a mask that was disturbed after it had been drawn `factor` times as finely as
    /// the frame. Jitter takes the outline from one drawing and draws it again: it is
    /// rounded twice, first to `1 / factor` pixel.
    pub fn of(options: &DisturbanceOptions, factor: usize) -> Self {
        if options.jitter == 0.0 {
            return Self::ROUNDING;
        }
        // Variance and length of a fine pixel: 1 / factor^2 and 1 / factor.
        let fine = 1.0 / (factor * factor * factor) as f64;
        Self {
            white_px2: ROUNDED * (1.0 + fine),
            jitter_px: options.jitter,
            correlation_px: options.correlation,
        }
    }
}

/// The two covariances of a pose: see the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The bound of Cramer and Rao.
    pub bound: PoseCovariance,
    /// What plain least squares reaches.
    pub least_squares: PoseCovariance,
}

/// Limits of a pose seen by an outline; `None` where the outline does not determine the pose.
pub fn limits(sites: &[Site], noise: &Noise) -> Option<Limits> {
    if noise.jitter_px == 0.0 {
        let bound = PoseCovariance::from_information(&white_information(sites, noise.white_px2))?;
        return Some(Limits {
            bound,
            least_squares: bound,
        });
    }
    let sites = sites::gathered(sites, noise.correlation_px * GATHERED);
    let covariance = covariance(&sites, noise);
    let jacobian = Matrix6xX::from_iterator(sites.len(), sites.iter().flat_map(|s| s.jacobian));
    // Lengths are the weights: an integral along the outline, whatever the sampling.
    let weighed = Matrix6xX::from_iterator(
        sites.len(),
        sites.iter().flat_map(|s| s.jacobian.map(|j| j * s.length)),
    );
    let normal = &weighed * jacobian.transpose();
    let spread = &weighed * &covariance * weighed.transpose();
    // J' C^-1 J = (L^-1 J)' (L^-1 J) with C = L L'.
    let white = covariance
        .cholesky()?
        .l()
        .solve_lower_triangular(&jacobian.transpose())?;
    let information = white.transpose() * &white;
    let rows = |at: &dyn Fn(usize, usize) -> f64| -> Matrix6 {
        std::array::from_fn(|row| std::array::from_fn(|column| at(row, column)))
    };
    Some(Limits {
        bound: PoseCovariance::from_information(&rows(&|r, c| information[(r, c)]))?,
        least_squares: PoseCovariance::sandwich(
            &rows(&|r, c| normal[(r, c)]),
            &rows(&|r, c| spread[(r, c)]),
        )?,
    })
}

/// Pieces of an outline of this part of the correlation length are taken as one: over it the
/// correlation falls by 1 - exp(-1 / 50), and its spectrum has long ended (exp(-120)).
const GATHERED: f64 = 0.2;

/// Information of an outline under white noise: the sum of `length J' J / variance`.
fn white_information(sites: &[Site], variance: f64) -> Matrix6 {
    let mut information = [[0.0; 6]; 6];
    for site in sites {
        for (row, a) in information.iter_mut().zip(site.jacobian) {
            for (value, b) in row.iter_mut().zip(site.jacobian) {
                *value += site.length * a * b / variance;
            }
        }
    }
    information
}

/// Covariance of the noise of pieces of outline.
fn covariance(sites: &[Site], noise: &Noise) -> DMatrix<f64> {
    let correlation = Correlation {
        length: noise.correlation_px,
    };
    let variance = noise.jitter_px * noise.jitter_px;
    let count = sites.len();
    let mut matrix = DMatrix::zeros(count, count);
    for (row, a) in sites.iter().enumerate() {
        for (column, b) in sites.iter().enumerate().take(row + 1) {
            if a.curve == b.curve {
                let value = variance * correlation.at(a.along - b.along, a.round);
                matrix[(row, column)] = value;
                matrix[(column, row)] = value;
            }
        }
        matrix[(row, row)] += noise.white_px2 / a.length;
    }
    matrix
}

/// Standard deviations, or root mean squares of many, or ratios of such.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// To the right.
    pub x_mm: f64,
    /// Upwards.
    pub y_mm: f64,
    /// Along the view.
    pub z_mm: f64,
    /// Angle of the rotation between estimate and truth.
    pub geodesic_deg: f64,
}

impl From<Deviations> for Limit {
    fn from(d: Deviations) -> Self {
        Self {
            x_mm: d.x_mm,
            y_mm: d.y_mm,
            z_mm: d.z_mm,
            geodesic_deg: d.rotation_deg,
        }
    }
}

impl Limit {
    /// Where the outline does not determine the pose.
    pub const NONE: Self = Self {
        x_mm: f64::INFINITY,
        y_mm: f64::INFINITY,
        z_mm: f64::INFINITY,
        geodesic_deg: f64::INFINITY,
    };

    /// Root mean square of each column.
    pub fn rms(all: &[Self]) -> Self {
        let column = |value: fn(&Self) -> f64| {
            let values: Vec<f64> = all.iter().map(value).collect();
            rms(&values)
        };
        Self {
            x_mm: column(|l| l.x_mm),
            y_mm: column(|l| l.y_mm),
            z_mm: column(|l| l.z_mm),
            geodesic_deg: column(|l| l.geodesic_deg),
        }
    }

    /// Errors divided by this limit, column by column.
    pub fn ratio(&self, rms: &Errors) -> Self {
        Self {
            x_mm: rms.x_mm / self.x_mm,
            y_mm: rms.y_mm / self.y_mm,
            z_mm: rms.z_mm / self.z_mm,
            geodesic_deg: rms.geodesic_deg / self.geodesic_deg,
        }
    }
}

/// The limits of the poses of a table, and the table's errors against them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The noise that the limits are for.
    pub noise: Noise,
    /// Bound of Cramer and Rao, root mean square over the poses.
    pub bound: Limit,
    /// What plain least squares reaches, root mean square over the poses.
    pub least_squares: Limit,
    /// Root mean square error divided by the bound.
    pub ratio_to_bound: Limit,
    /// Root mean square error divided by what plain least squares reaches.
    pub ratio_to_least_squares: Limit,
}

impl Comparison {
    /// Compares the root mean square errors of poses with the limits of each of them.
    pub fn of(noise: Noise, limits: &[PoseLimits], rms: &Errors) -> Self {
        let PoseLimits {
            bound,
            least_squares,
        } = PoseLimits::rms(limits);
        Self {
            noise,
            bound,
            least_squares,
            ratio_to_bound: bound.ratio(rms),
            ratio_to_least_squares: least_squares.ratio(rms),
        }
    }
}

impl Comparison {
    /// Prints errors, limits and ratios, a line each.
    pub fn print(&self, rms: &Errors, median: &Errors) {
        let errors = |e: &Errors| Limit {
            x_mm: e.x_mm,
            y_mm: e.y_mm,
            z_mm: e.z_mm,
            geodesic_deg: e.geodesic_deg,
        };
        let line = |name: &str, l: &Limit| {
            println!(
                "{name:<24} x {:8.4}  y {:8.4}  z {:8.3}  rotation {:8.4}",
                l.x_mm, l.y_mm, l.z_mm, l.geodesic_deg
            );
        };
        line("RMS error (mm, deg)", &errors(rms));
        line("median absolute error", &errors(median));
        line("bound", &self.bound);
        line("RMS error / bound", &self.ratio_to_bound);
        if self.noise.jitter_px > 0.0 {
            line("plain least squares", &self.least_squares);
            line("RMS error / that", &self.ratio_to_least_squares);
        }
    }
}

/// The limits of one pose in the numbers of a table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoseLimits {
    /// Bound of Cramer and Rao.
    pub bound: Limit,
    /// What plain least squares reaches.
    pub least_squares: Limit,
}

impl PoseLimits {
    /// Root mean square of the limits of many poses.
    pub fn rms(all: &[Self]) -> Self {
        let column = |of: fn(&Self) -> Limit| {
            let column: Vec<Limit> = all.iter().map(of).collect();
            Limit::rms(&column)
        };
        Self {
            bound: column(|limits| limits.bound),
            least_squares: column(|limits| limits.least_squares),
        }
    }
}

#[cfg(test)]
mod tests;
