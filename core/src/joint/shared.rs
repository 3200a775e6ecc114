//! What is wrong with a whole film alike, and so with both poses of a frame and with every frame.
//!
//! Such an error is not seen in how numbers scatter from frame to frame, and no mean over frames takes it away. Where it moves both
//! components along the view alike, little of it is left in the joint.

use crate::math::{Vector3, scale};
use crate::pose::covariance::PoseCovariance;

/// Errors of a film: two of its constants ([`crate::refine::Assessment::film_steps`]), the principal distance, the size of the femoral
/// model and that of the tibial one.
pub const ERRORS: usize = 5;

/// How a pose moves with one standard deviation of an error: turn in radians, shift of the middle in mm, camera axes.
pub type Step = [f64; 6];

/// What frames do not tell of camera and models: one standard deviation each, as a part of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownTo {
    /// Of the principal distance.
    pub distance: f64,
    /// Of the size of each model.
    pub size: f64,
}

impl KnownTo {
    /// Nothing is wrong with either.
    pub const EXACTLY: Self = Self {
        distance: 0.0,
        size: 0.0,
    };
    /// Where nobody says better. Judgements, not measurements: 5 mm of a principal distance of a metre, and 0.07 mm of an implant of
    /// 70 mm, which is how well such parts are ground and scanned.
    pub const USUALLY: Self = Self {
        distance: 0.005,
        size: 0.001,
    };
}

/// The steps that the errors make in the femoral and in the tibial pose, whose middles lie there in camera axes, mm.
/// `film_steps`: of the film's constants, for either pose.
pub(super) fn steps(
    middles: [Vector3; 2],
    film_steps: [[Step; 2]; 2],
    known: KnownTo,
) -> [[Step; 2]; ERRORS] {
    let shift = |[x, y, z]: [f64; 3]| [0.0, 0.0, 0.0, x, y, z];
    // With a wrong distance an outline is as large and lies where it lies at another depth alone; a model of a wrong size slides
    // along the ray through it.
    let deeper = middles.map(|[.., z]| shift([0.0, 0.0, known.distance * z]));
    let [femur_size, tibia_size] = middles.map(|middle| shift(scale(&middle, known.size)));
    let constant = |k: usize| film_steps.map(|steps| steps[k]);
    [
        constant(0),
        constant(1),
        deeper,
        [femur_size, [0.0; 6]],
        [[0.0; 6], tibia_size],
    ]
}

/// A covariance with errors that it does not know of; it has the film's constants already.
pub(super) fn widened(
    covariance: &PoseCovariance,
    steps: &[[Step; 2]; ERRORS],
    part: usize,
) -> PoseCovariance {
    let mut matrix = covariance.matrix;
    for step in steps.iter().skip(2).map(|step| &step[part]) {
        add_product(&mut matrix, step, step);
    }
    PoseCovariance { matrix }
}

/// Adds `a b'`.
pub(super) fn add_product(matrix: &mut [[f64; 6]; 6], a: &Step, b: &Step) {
    for (row, a) in matrix.iter_mut().zip(a) {
        for (value, b) in row.iter_mut().zip(b) {
            *value += a * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_distance_moves_along_the_view_and_a_wrong_size_along_the_ray() {
        let known = KnownTo {
            distance: 0.01,
            size: 0.002,
        };
        let film = [[[1.0; 6], [2.0; 6]], [[3.0; 6], [4.0; 6]]];
        let middles = [[10.0, -20.0, -1000.0], [5.0, 0.0, -500.0]];
        let none = [0.0; 6];
        let found = steps(middles, film, known);
        let wanted = [
            [[1.0; 6], [3.0; 6]],
            [[2.0; 6], [4.0; 6]],
            [
                [0.0, 0.0, 0.0, 0.0, 0.0, -10.0],
                [0.0, 0.0, 0.0, 0.0, 0.0, -5.0],
            ],
            [[0.0, 0.0, 0.0, 0.02, -0.04, -2.0], none],
            [none, [0.0, 0.0, 0.0, 0.01, 0.0, -1.0]],
        ];
        assert_eq!(found, wanted);
        // The film's constants are in a covariance already; what is not is added.
        let covariance = PoseCovariance {
            matrix: [[0.0; 6]; 6],
        };
        let femur = widened(&covariance, &found, 0).matrix;
        assert!((femur[5][5] - 104.0).abs() < 1e-12 && (femur[3][4] + 0.0008).abs() < 1e-12);
        assert_eq!(femur[0], none);
        let tibia = widened(&covariance, &found, 1).matrix;
        assert!((tibia[5][5] - 26.0).abs() < 1e-12 && (tibia[5][3] + 0.01).abs() < 1e-12);
    }
}
