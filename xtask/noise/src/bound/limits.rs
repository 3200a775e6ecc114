//! Both limits from the pieces of an outline and the covariance of their noise.

use fluoropose::pose::covariance::{Matrix6, PoseCovariance};

use super::cholesky::{Cholesky, Lower};
use super::sites::{self, Site};
use crate::Noise;
use crate::jitter::Correlation;

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
    let jacobian: Vec<[f64; 6]> = sites.iter().map(|site| site.jacobian).collect();
    // Lengths are the weights: an integral along the outline, whatever the sampling.
    let weighed: Vec<[f64; 6]> = sites
        .iter()
        .map(|site| site.jacobian.map(|j| j * site.length))
        .collect();
    let normal = product(&weighed, &jacobian);
    let spread = product(&weighed, &times(&covariance, &weighed));
    // J' C^-1 J = (L^-1 J)' (L^-1 J) with C = L L'.
    let white = Cholesky::of(covariance)?.whitened(&jacobian);
    Some(Limits {
        bound: PoseCovariance::from_information(&product(&white, &white))?,
        least_squares: PoseCovariance::sandwich(&normal, &spread)?,
    })
}

/// `A' B`.
fn product(a: &[[f64; 6]], b: &[[f64; 6]]) -> Matrix6 {
    let mut sum = [[0.0; 6]; 6];
    for (a, b) in a.iter().zip(b) {
        for (out, a) in sum.iter_mut().zip(a) {
            for (out, b) in out.iter_mut().zip(b) {
                *out += a * b;
            }
        }
    }
    sum
}

/// `C B` for a symmetric `C`.
fn times(matrix: &Lower, b: &[[f64; 6]]) -> Vec<[f64; 6]> {
    let mut out = vec![[0.0; 6]; b.len()];
    for (row, values) in matrix.iter().enumerate() {
        for (column, &value) in values.iter().enumerate() {
            for k in 0..6 {
                out[row][k] += value * b[column][k];
                if column < row {
                    out[column][k] += value * b[row][k];
                }
            }
        }
    }
    out
}

/// Pieces of an outline of this part of the correlation length are taken as one: over it the
/// correlation falls by 1 - exp(-1 / 50), and its spectrum has long ended (exp(-120)).
const GATHERED: f64 = 0.2;

/// Information of an outline under white noise: the sum of `length J' J / variance`.
pub(super) fn white_information(sites: &[Site], variance: f64) -> Matrix6 {
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
pub(super) fn covariance(sites: &[Site], noise: &Noise) -> Lower {
    let correlation = Correlation {
        length: noise.correlation_px,
    };
    let variance = noise.jitter_px * noise.jitter_px;
    let value = |a: &Site, b: &Site| {
        if a.curve == b.curve {
            variance * correlation.at(a.along - b.along, a.round)
        } else {
            0.0
        }
    };
    let row = |(row, a): (usize, &Site)| {
        let mut values: Vec<f64> = sites[..=row].iter().map(|b| value(a, b)).collect();
        values[row] += noise.white_px2 / a.length;
        values
    };
    sites.iter().enumerate().map(row).collect()
}
