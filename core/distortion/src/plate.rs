//! The camera from one picture of a flat bead plate of known spacing and the two distances.
//!
//! Source to detector is the principal distance. Source to plate gives the focal length in pixels, and so the pitch.
//! The principal point shows in a single plane only as far as the plate is tilted: it is fitted with a prior at the
//! frame's middle, and its standard deviation says whether the picture or the prior spoke.

use super::correction::Straight;
use super::lattice::{Bead, FEWEST, mean};
use super::polynomial::root_mean_square;
use super::ruler::distances;
use super::{GridError, above_zero};
use fluoropose::math::{
    Matrix3, apply, atan2, degrees, exp, inverse_spd, ln, multiply, rotation_by, sin_cos,
    solve_spd, sqrt,
};

/// What was measured by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    /// Between neighbouring beads, mm.
    pub spacing_mm: f64,
    /// From the X-ray source to the detector, mm.
    pub source_to_detector_mm: f64,
    /// From the X-ray source to the middle of the plate along the axis, mm.
    pub source_to_plate_mm: f64,
}

/// The camera that took a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateCamera {
    /// Between pixels at the detector, mm, and its standard deviation from the beads alone: an error of either distance
    /// comes on top, in proportion.
    pub pitch_mm: f64,
    /// Standard deviation of the pitch, mm.
    pub pitch_deviation_mm: f64,
    /// Principal point from the frame's middle, mm at the detector: x right, y up.
    pub offset_mm: [f64; 2],
    /// Standard deviations of it, mm.
    pub offset_deviation_mm: [f64; 2],
    /// Did the picture tell the principal point, and not the prior?
    pub offset_is_measured: bool,
    /// Between the plate and the detector, degrees.
    pub tilt_deg: f64,
    /// Root mean square distance of the beads from where this camera sees them, px.
    pub residual_px: f64,
    /// Beads that it rests on.
    pub used: usize,
}

/// Standard deviation of the prior at the frame's middle, mm at the detector.
pub const PRIOR_MM: f64 = 10.0;

/// Parameters: logarithm of the focal length, principal point, turn, place across.
const N: usize = 8;
type Vector = [f64; N];
type Matrix = [[f64; N]; N];

/// Fits the camera to numbered beads (straightened ones, where the picture was distorted) in frames of `size` (columns,
/// rows).
///
/// # Errors
/// [`GridError::FewBeads`], [`GridError::Length`], [`GridError::Order`], and [`GridError::Degenerate`] for beads in one
/// line.
pub fn camera(
    beads: &[Bead],
    measured: Distances,
    size: (usize, usize),
) -> Result<PlateCamera, GridError> {
    let spacing = above_zero("spacing of the beads", measured.spacing_mm)?;
    let (detector, object) =
        distances(measured.source_to_detector_mm, measured.source_to_plate_mm)?;
    let used = beads.iter().filter(|bead| bead.index.is_some()).count();
    if used < FEWEST {
        return Err(GridError::FewBeads {
            found: used,
            needed: FEWEST,
        });
    }
    let lattice = Straight::nearest_to(beads);
    let middle = [size.0 as f64 / 2.0, size.1 as f64 / 2.0];
    let focal = lattice.spacing_px() * object / spacing;
    let mut view = View::first(beads, &lattice, spacing, focal, object, middle);
    let prior_px = PRIOR_MM * focal / detector;
    // The noise is not known before the first fit.
    let mut noise = 0.1;
    for _ in 0..ROUNDS {
        view = settle(view, beads, middle, noise / prior_px)?;
        noise = view.residual(beads).max(LEAST_NOISE_PX);
    }
    let (normal, _) = view.equations(beads, middle, noise / prior_px);
    let inverse = inverse_spd(&normal).ok_or(GridError::Degenerate { order: 1 })?;
    let deviation = |k: usize| noise * sqrt(inverse[k][k]);
    let pitch = detector / view.focal();
    let offset_deviation_mm = [deviation(1) * pitch, deviation(2) * pitch];
    let normal_of_plate = [view.turn[0][2], view.turn[1][2], view.turn[2][2]];
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

/// Fits, each with the noise that the one before found.
const ROUNDS: usize = 3;
/// Centroids are no better than this.
const LEAST_NOISE_PX: f64 = 0.005;
/// Steps of a fit.
const STEPS: usize = 40;

/// A camera and a plate before it: y up, looking along -z.
#[derive(Clone, Copy)]
struct View {
    log_focal: f64,
    point: [f64; 2],
    turn: Matrix3,
    place: [f64; 3],
    spacing: f64,
    middle: [f64; 2],
}

impl View {
    /// Parallel to the detector, its middle where the beads' middle is seen.
    fn first(
        beads: &[Bead],
        lattice: &Straight,
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
            turn: [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]],
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

    /// A bead from the plate's middle, turned as the plate is, mm.
    fn arm(&self, index: [i32; 2]) -> [f64; 3] {
        let [i, j] = index.map(f64::from);
        apply(
            &self.turn,
            &[
                self.spacing * (i - self.middle[0]),
                -self.spacing * (j - self.middle[1]),
                0.0,
            ],
        )
    }

    /// Where a bead is seen, and how that changes with the parameters.
    fn project(&self, index: [i32; 2]) -> ([f64; 2], [Vector; 2]) {
        let arm = self.arm(index);
        let [x, y, z] = [
            arm[0] + self.place[0],
            arm[1] + self.place[1],
            arm[2] + self.place[2],
        ];
        let (focal, depth) = (self.focal(), -z);
        let (right, down) = (focal * x / depth, -focal * y / depth);
        // By x, y and z of the bead.
        let slopes = [
            [focal / depth, 0.0, right / depth],
            [0.0, -focal / depth, down / depth],
        ];
        // A turn by w about the plate's middle moves the bead by w x arm.
        let turned = [
            [0.0, -arm[2], arm[1]],
            [arm[2], 0.0, -arm[0]],
            [-arm[1], arm[0], 0.0],
        ];
        let gradient = |axis: usize, image: f64| {
            let slope = slopes[axis];
            let by_turn = |k: usize| {
                slope[0] * turned[k][0] + slope[1] * turned[k][1] + slope[2] * turned[k][2]
            };
            let point = |k: usize| if k == axis { 1.0 } else { 0.0 };
            [
                image,
                point(0),
                point(1),
                by_turn(0),
                by_turn(1),
                by_turn(2),
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

    /// Normal matrix and right side of a step. `weight` is noise over prior.
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
            turn: multiply(&rotation_by(&[a, b, c]), &self.turn),
            place: [self.place[0] + x, self.place[1] + y, self.place[2]],
            ..*self
        }
    }
}

/// Levenberg and Marquardt to rest.
fn settle(mut view: View, beads: &[Bead], prior: [f64; 2], weight: f64) -> Result<View, GridError> {
    let mut damping = 1e-6;
    let mut cost = view.cost(beads, prior, weight);
    for _ in 0..STEPS {
        let (normal, side) = view.equations(beads, prior, weight);
        let mut damped = normal;
        for (k, row) in damped.iter_mut().enumerate() {
            row[k] *= 1.0 + damping;
        }
        let step = solve_spd(damped, side).ok_or(GridError::Degenerate { order: 1 })?;
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
