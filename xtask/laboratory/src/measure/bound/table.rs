//! Limits as tables show them, and errors against them.

use fluoropose::pose::covariance::Deviations;
use serde::Serialize;

use crate::measure::accuracy::{Errors, rms};
use crate::noise::Noise;

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
