//! The femoral component as the tibial one sees it, and how certain that is.

use crate::math::{
    Matrix3, Vector3, add, apply, cross, multiply, rotation_by, sqrt, subtract, transpose,
};
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance, congruence, product_with_transpose};

/// Steps of the numerical derivatives: of turns in radians, of shifts in mm. The tops of condyles bend over some tens of mm, so
/// a tenth of a degree is a small step, and rounding is a millionth of one.
const TURN_STEP: f64 = 2e-3;
const SHIFT_STEP: f64 = 0.02;

/// A component in a frame, in the axes in which its joint is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// `camera_from_component`: the pose of its file composed with its joint axes.
    pub pose: Pose,
    /// Middle of its model in joint axes, mm: what the turns of its covariance leave in place.
    pub middle: Vector3,
    /// Covariance of the pose; `None` where it is not known.
    pub covariance: Option<PoseCovariance>,
}

impl Placed {
    /// From the pose of a file (`camera_from_model`), the joint's axes in it (`model_from_joint`,
    /// [`super::kinematics::joint_axes`]) and the middle of the model ([`crate::Model::centre`]).
    #[must_use]
    pub fn new(
        pose: &Pose,
        axes: &Pose,
        centre: &Vector3,
        covariance: Option<PoseCovariance>,
    ) -> Self {
        Self {
            pose: pose.compose(axes),
            middle: axes.inverse().transform(centre),
            covariance,
        }
    }
}

/// The femoral component in the tibial one's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// `inverse(camera_from_tibia) * camera_from_femur`, in joint axes.
    pub tibia_from_femur: Pose,
    /// What the turns of the covariance leave in place: the middle of the femoral model, in its joint axes, mm.
    pub middle: Vector3,
    /// Covariance of this pose, in tibial axes. `None` where that of a component is not known.
    pub covariance: Option<PoseCovariance>,
}

/// No error is known that moves both poses.
pub const NOTHING_COMMON: Matrix6 = [[0.0; 6]; 6];

/// Covariance between the two poses of what moves both: each entry is an error by one standard deviation, as the step (turn in
/// radians, shift in mm, camera axes) that it makes in the femoral and in the tibial pose.
///
/// One film has one display and one blur, and one calibration one principal distance: what is wrong with these moves both
/// components along the view alike, and little of it is left in the joint. [`crate::refine::Assessment::film_steps`] has the
/// steps of the film's constants.
#[must_use]
pub fn common(errors: &[([f64; 6], [f64; 6])]) -> Matrix6 {
    let mut sum = NOTHING_COMMON;
    for (femur, tibia) in errors {
        for (row, a) in sum.iter_mut().zip(femur) {
            for (value, b) in row.iter_mut().zip(tibia) {
                *value += a * b;
            }
        }
    }
    sum
}

impl Relative {
    /// Of both components in one frame. `common` is the covariance between the steps of the femoral pose (rows) and of the
    /// tibial one (columns): [`common`], or [`NOTHING_COMMON`] where it is not known. What is in both covariances
    /// and is not said to be common counts twice, so the joint's depth then looks less certain than it is, never more.
    #[must_use]
    pub fn new(femur: &Placed, tibia: &Placed, common: &Matrix6) -> Self {
        let steps = Steps::new(femur, tibia);
        let both = femur.covariance.zip(tibia.covariance);
        Self {
            tibia_from_femur: tibia.pose.inverse().compose(&femur.pose),
            middle: femur.middle,
            covariance: both.map(|(femur, tibia)| steps.carry(&femur, &tibia, common)),
        }
    }

    /// The tibial component in the femoral one's axes: what [`super::kinematics::joint_angles`] takes.
    #[must_use]
    pub fn femur_from_tibia(&self) -> Pose {
        self.tibia_from_femur.inverse()
    }

    /// Covariance of any numbers of the relative pose, to first order, by central differences. `None` without a covariance of
    /// the pose.
    pub fn carry<const N: usize>(
        &self,
        mut numbers: impl FnMut(&Pose) -> [f64; N],
    ) -> Option<[[f64; N]; N]> {
        let covariance = self.covariance?.matrix;
        let slopes: [[f64; N]; 6] = core::array::from_fn(|k| {
            let size = if k < 3 { TURN_STEP } else { SHIFT_STEP };
            let mut at = |size: f64| {
                let mut step = [0.0; 6];
                step[k] = size;
                numbers(&self.stepped(&step))
            };
            let (up, down) = (at(size), at(-size));
            core::array::from_fn(|n| (up[n] - down[n]) / (2.0 * size))
        });
        let product = |a: usize, b: usize| -> f64 {
            let row = |i: usize| (0..6).map(|j| covariance[i][j] * slopes[j][b]).sum::<f64>();
            (0..6).map(|i| slopes[i][a] * row(i)).sum()
        };
        Some(core::array::from_fn(|a| {
            core::array::from_fn(|b| product(a, b))
        }))
    }

    /// One standard deviation of each of any numbers; see [`Self::carry`].
    pub fn deviations<const N: usize>(
        &self,
        numbers: impl FnMut(&Pose) -> [f64; N],
    ) -> Option<[f64; N]> {
        let covariance = self.carry(numbers)?;
        Some(core::array::from_fn(|n| sqrt(covariance[n][n].max(0.0))))
    }

    /// The pose after a turn about the middle and a shift, in tibial axes.
    #[must_use]
    pub fn stepped(&self, step: &[f64; 6]) -> Pose {
        let [a, b, c, shift @ ..] = *step;
        let pose = &self.tibia_from_femur;
        let rotation = multiply(&rotation_by(&[a, b, c]), &pose.rotation);
        let place = add(&pose.transform(&self.middle), &shift);
        Pose {
            rotation,
            translation: subtract(&place, &apply(&rotation, &self.middle)),
        }
    }
}

/// How steps of either pose in camera axes move the relative one in tibial axes, to first order.
///
/// With the middles `f` and `t` in camera axes, turns `w` and shifts `s`: the relative turn is `R_t' (w_f - w_t)`, and the
/// femoral middle moves by `R_t' (s_f - s_t - w_t x (f - t))`.
struct Steps {
    femur: Matrix6,
    tibia: Matrix6,
}

impl Steps {
    fn new(femur: &Placed, tibia: &Placed) -> Self {
        let to_tibia = transpose(&tibia.pose.rotation);
        let apart = subtract(
            &femur.pose.transform(&femur.middle),
            &tibia.pose.transform(&tibia.middle),
        );
        let none = [[0.0; 3]; 3];
        let back = to_tibia.map(|row| row.map(|value| -value));
        // Row r of R' [d]x is r x d, because r . (d x w) = (r x d) . w.
        let arm = to_tibia.map(|row| cross(&row, &apart));
        Self {
            femur: blocks(&to_tibia, &none, &to_tibia),
            tibia: blocks(&back, &arm, &back),
        }
    }

    fn carry(
        &self,
        femur: &PoseCovariance,
        tibia: &PoseCovariance,
        common: &Matrix6,
    ) -> PoseCovariance {
        let own = congruence(&self.femur, &femur.matrix);
        let other = congruence(&self.tibia, &tibia.matrix);
        let between = product_with_transpose(&self.femur, common, &self.tibia);
        PoseCovariance {
            matrix: core::array::from_fn(|a| {
                core::array::from_fn(|b| own[a][b] + other[a][b] + between[a][b] + between[b][a])
            }),
        }
    }
}

/// Turns to turns, turns to shifts, shifts to shifts.
fn blocks(turn: &Matrix3, arm: &Matrix3, shift: &Matrix3) -> Matrix6 {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| match (row < 3, column < 3) {
            (true, true) => turn[row][column],
            (true, false) => 0.0,
            (false, true) => arm[row - 3][column],
            (false, false) => shift[row - 3][column - 3],
        })
    })
}

#[cfg(test)]
mod tests;
