//! The camera from one frame of a flat bead plate of known spacing and two distances.
//!
//! The distance from source to detector is the principal distance. That from source to plate gives the focal length in
//! pixels and with it the pixel pitch. A single plane shows the principal point only as far as it is tilted: the point is
//! fitted with a prior at the middle of the frame, and its standard deviation tells whether it comes from the frame or from
//! the prior.

use crate::correction::UndistortedLattice;
use crate::error::{DistortionError, above_zero};
use crate::lattice::{Bead, FEWEST, mean};
use crate::polynomial::root_mean_square;
use crate::ruler::distances;
use fluoropose::math::{
    Matrix3, apply, atan2, degrees, exp, inverse_spd, ln, multiply, rotation_by, sin_cos,
    solve_spd, sqrt,
};

/// Lengths that were measured by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    /// Distance between neighbouring beads, mm.
    pub spacing_mm: f64,
    /// Distance from the X-ray source to the detector, mm.
    pub source_to_detector_mm: f64,
    /// Distance from the X-ray source to the middle of the plate along the axis, mm.
    pub source_to_plate_mm: f64,
}

/// The camera that took a frame of a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateCamera {
    /// Distance between pixels at the detector, mm.
    pub pitch_mm: f64,
    /// Standard deviation of the pitch from the beads alone, mm. The relative error of either distance comes on top.
    pub pitch_deviation_mm: f64,
    /// Principal point from the middle of the frame, mm at the detector: x to the right, y up.
    pub offset_mm: [f64; 2],
    /// Its standard deviations, mm.
    pub offset_deviation_mm: [f64; 2],
    /// Whether the principal point comes from the frame and not from the prior.
    pub offset_is_measured: bool,
    /// Angle between the plate and the detector, degrees.
    pub tilt_deg: f64,
    /// Root mean square distance of the beads from their places by this camera, px.
    pub residual_px: f64,
    /// Number of beads that it was fitted to.
    pub used: usize,
}

/// Centres of beads are better than this, pixels: what is more is distortion.
const DISTORTED_PX: f64 = 0.3;

/// Above this a plate is tilted, degrees: its tilt then costs more than a thousandth of the pitch. Distortion looks like some tilt too, a pincushion of
/// 25 pixels at a frame's corner like 1.4 degrees, with beads in half of the frame alone like 4.6 (the tests of this file).
const TILTED_DEG: f64 = 4.0;

impl PlateCamera {
    /// Whether the plate, as it was taken, is tilted too far for a correction of distortion, which takes its perspective for distortion: the
    /// pitch is then off by 0.14 percent at 4 degrees, 0.8 at 10 and 4.9 at 25.
    #[must_use]
    pub fn is_tilted(&self) -> bool {
        self.tilt_deg > TILTED_DEG
    }

    /// Whether the picture is distorted, so that the pitch is that of its middle at best: its correction comes first.
    #[must_use]
    pub fn is_distorted(&self) -> bool {
        self.residual_px > DISTORTED_PX
    }
}

/// Standard deviation of the prior at the frame's middle, mm at the detector.
pub const PRIOR_MM: f64 = 10.0;

/// Parameters: logarithm of the focal length, principal point (2), rotation (3), place across the axis (2).
const N: usize = 8;
type Vector = [f64; N];
type Matrix = [[f64; N]; N];

/// Fits the camera to numbered beads in a frame of `size` (columns, rows). Where the frame was distorted, the beads are the
/// undistorted ones.
///
/// # Errors
/// [`DistortionError::FewBeads`], [`DistortionError::Length`], [`DistortionError::Order`], and [`DistortionError::Degenerate`] for beads in one
/// line.
pub fn camera(
    beads: &[Bead],
    measured: Distances,
    size: (usize, usize),
) -> Result<PlateCamera, DistortionError> {
    let spacing = above_zero("spacing of the beads", measured.spacing_mm)?;
    let (detector, object) =
        distances(measured.source_to_detector_mm, measured.source_to_plate_mm)?;
    let used = beads.iter().filter(|bead| bead.index.is_some()).count();
    if used < FEWEST {
        return Err(DistortionError::FewBeads {
            found: used,
            needed: FEWEST,
        });
    }
    let lattice = UndistortedLattice::nearest_to(beads);
    let middle = [size.0 as f64 / 2.0, size.1 as f64 / 2.0];
    let focal = lattice.spacing_px() * object / spacing;
    let mut view = View::first(beads, &lattice, spacing, focal, object, middle);
    let prior_px = PRIOR_MM * focal / detector;
    // The noise, that of a column or a row, is not known before the first fit.
    let mut noise = 0.1;
    let numbers = (2 * used) as f64;
    for _ in 0..FITS {
        view = settle(view, beads, middle, noise / prior_px)?;
        let squares = used as f64 * view.residual(beads) * view.residual(beads);
        noise = sqrt(squares / (numbers - N as f64)).max(LEAST_NOISE_PX);
    }
    let (normal, _) = view.equations(beads, middle, noise / prior_px);
    let inverse = inverse_spd(&normal).ok_or(DistortionError::Degenerate { order: 1 })?;
    let deviation = |k: usize| noise * sqrt(inverse[k][k]);
    let pitch = detector / view.focal();
    let offset_deviation_mm = [deviation(1) * pitch, deviation(2) * pitch];
    let normal_of_plate = [
        view.rotation[0][2],
        view.rotation[1][2],
        view.rotation[2][2],
    ];
    let across =
        sqrt(normal_of_plate[0] * normal_of_plate[0] + normal_of_plate[1] * normal_of_plate[1]);
    Ok(PlateCamera {
        pitch_mm: pitch,
        pitch_deviation_mm: pitch * deviation(0),
        offset_mm: [
            (view.point[0] - middle[0]) * pitch,
            (middle[1] - view.point[1]) * pitch,
        ],
        offset_deviation_mm,
        offset_is_measured: offset_deviation_mm.iter().all(|&mm| mm < PRIOR_MM / 2.0),
        tilt_deg: degrees(atan2(across, normal_of_plate[2].abs())),
        residual_px: view.residual(beads),
        used,
    })
}

/// Number of fits, each with the noise that the fit before it found.
const FITS: usize = 3;
/// No centroid is more accurate than this.
const LEAST_NOISE_PX: f64 = 0.005;
/// The greatest number of steps of a fit.
const STEPS: usize = 40;

/// A camera that looks along -z with y up, and a plate in front of it.
#[derive(Clone, Copy)]
struct View {
    log_focal: f64,
    point: [f64; 2],
    rotation: Matrix3,
    place: [f64; 3],
    spacing: f64,
    middle: [f64; 2],
}

impl View {
    /// The first guess: parallel to the detector, its middle where the middle of the beads is seen.
    fn first(
        beads: &[Bead],
        lattice: &UndistortedLattice,
        spacing: f64,
        focal: f64,
        object: f64,
        point: [f64; 2],
    ) -> Self {
        let numbered = || {
            beads
                .iter()
                .filter_map(|bead| Some((bead.index?.map(f64::from), bead.at)))
        };
        let middle = mean(numbered().map(|(index, _)| index));
        let seen = mean(numbered().map(|(_, at)| at));
        let (a, b) = (lattice.place([0, 0]), lattice.place([1, 0]));
        // Rows go down on the frame and y goes up.
        let (sine, cosine) = sin_cos(-atan2(b[1] - a[1], b[0] - a[0]));
        Self {
            log_focal: ln(focal),
            point,
            rotation: [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]],
            place: [
                (seen[0] - point[0]) * object / focal,
                (point[1] - seen[1]) * object / focal,
                -object,
            ],
            spacing,
            middle,
        }
    }

    fn focal(&self) -> f64 {
        exp(self.log_focal)
    }

    /// Vector from the middle of the plate to a bead, mm.
    fn arm(&self, index: [i32; 2]) -> [f64; 3] {
        let [i, j] = index.map(f64::from);
        apply(
            &self.rotation,
            &[
                self.spacing * (i - self.middle[0]),
                -self.spacing * (j - self.middle[1]),
                0.0,
            ],
        )
    }

    /// The place where a bead is seen, px, and its derivatives by the parameters.
    fn project(&self, index: [i32; 2]) -> ([f64; 2], [Vector; 2]) {
        let arm = self.arm(index);
        let [x, y, z] = [
            arm[0] + self.place[0],
            arm[1] + self.place[1],
            arm[2] + self.place[2],
        ];
        let (focal, depth) = (self.focal(), -z);
        let (right, down) = (focal * x / depth, -focal * y / depth);
        // Derivatives by x, y and z of the bead.
        let slopes = [
            [focal / depth, 0.0, right / depth],
            [0.0, -focal / depth, down / depth],
        ];
        // A rotation by w about the middle of the plate moves the bead by w x arm.
        let moved = [
            [0.0, -arm[2], arm[1]],
            [arm[2], 0.0, -arm[0]],
            [-arm[1], arm[0], 0.0],
        ];
        let gradient = |axis: usize, image: f64| {
            let slope = slopes[axis];
            let by_rotation =
                |k: usize| slope[0] * moved[k][0] + slope[1] * moved[k][1] + slope[2] * moved[k][2];
            let point = |k: usize| if k == axis { 1.0 } else { 0.0 };
            [
                image,
                point(0),
                point(1),
                by_rotation(0),
                by_rotation(1),
                by_rotation(2),
                slope[0],
                slope[1],
            ]
        };
        (
            [self.point[0] + right, self.point[1] + down],
            [gradient(0, right), gradient(1, down)],
        )
    }

    fn residual(&self, beads: &[Bead]) -> f64 {
        root_mean_square(beads.iter().filter_map(|bead| {
            let ([column, row], _) = self.project(bead.index?);
            let (right, down) = (bead.at[0] - column, bead.at[1] - row);
            Some(right * right + down * down)
        }))
    }

    /// Normal matrix and right side of a step. `weight` is the noise divided by the standard deviation of the prior.
    fn equations(&self, beads: &[Bead], prior: [f64; 2], weight: f64) -> (Matrix, Vector) {
        let (mut normal, mut side) = ([[0.0; N]; N], [0.0; N]);
        for bead in beads {
            let Some(index) = bead.index else { continue };
            let (seen, gradients) = self.project(index);
            for (axis, gradient) in gradients.iter().enumerate() {
                let miss = bead.at[axis] - seen[axis];
                for (row, a) in gradient.iter().enumerate() {
                    side[row] += a * miss;
                    for (column, b) in gradient.iter().enumerate() {
                        normal[row][column] += a * b;
                    }
                }
            }
        }
        for axis in 0..2 {
            normal[1 + axis][1 + axis] += weight * weight;
            side[1 + axis] += weight * weight * (prior[axis] - self.point[axis]);
        }
        (normal, side)
    }

    fn cost(&self, beads: &[Bead], prior: [f64; 2], weight: f64) -> f64 {
        let count = beads.iter().filter(|bead| bead.index.is_some()).count() as f64;
        let residual = self.residual(beads);
        let away: f64 = (0..2)
            .map(|axis| (self.point[axis] - prior[axis]) * (self.point[axis] - prior[axis]))
            .sum();
        count * residual * residual + weight * weight * away
    }

    fn moved(&self, step: &Vector) -> Self {
        let [log_focal, column, row, a, b, c, x, y] = *step;
        Self {
            log_focal: self.log_focal + log_focal,
            point: [self.point[0] + column, self.point[1] + row],
            rotation: multiply(&rotation_by(&[a, b, c]), &self.rotation),
            place: [self.place[0] + x, self.place[1] + y, self.place[2]],
            ..*self
        }
    }
}

/// The method of Levenberg and Marquardt, until the cost no longer falls.
fn settle(
    mut view: View,
    beads: &[Bead],
    prior: [f64; 2],
    weight: f64,
) -> Result<View, DistortionError> {
    let mut damping = 1e-6;
    let mut cost = view.cost(beads, prior, weight);
    for _ in 0..STEPS {
        let (normal, side) = view.equations(beads, prior, weight);
        let mut damped = normal;
        for (k, row) in damped.iter_mut().enumerate() {
            row[k] *= 1.0 + damping;
        }
        let step = solve_spd(damped, side).ok_or(DistortionError::Degenerate { order: 1 })?;
        let next = view.moved(&step);
        let lower = next.cost(beads, prior, weight);
        // A NaN is no improvement.
        if lower <= cost {
            let gained = cost - lower;
            (view, cost, damping) = (next, lower, (damping / 10.0).max(1e-12));
            if gained <= 1e-12 * cost {
                break;
            }
        } else if damping > 1e6 {
            break;
        } else {
            damping *= 10.0;
        }
    }
    Ok(view)
}

#[cfg(test)]
mod tests;
