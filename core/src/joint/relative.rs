//! The femoral component as the tibial one sees it, and how certain that is.

use crate::joint::shared::{self, ERRORS, KnownTo, Step};
use crate::math::{
    Matrix3, Vector3, add, apply, cross, deviation, multiply, rotation_by, subtract, transpose,
};
use crate::pose::Pose;
use crate::pose::covariance::{Matrix6, PoseCovariance, congruence};

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
    /// What of the covariance is the film's ([`crate::refine::Assessment::film_steps`]), and so the other component's too.
    pub film_steps: [Step; 2],
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
            film_steps: [[0.0; 6]; 2],
        }
    }

    /// The same with the film's part of its covariance.
    #[must_use]
    pub fn on_film(self, film_steps: [Step; 2]) -> Self {
        Self { film_steps, ..self }
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
    /// What of it is wrong with the whole film alike: how the pose moves with one standard deviation of each error, in tibial axes.
    pub shared: [Step; ERRORS],
}

/// What numbers of a relative pose are not known to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried<const N: usize> {
    /// One standard deviation of each.
    pub deviations: [f64; N],
    /// How each moves with one standard deviation of each error that the whole film has alike ([`super::shared`]); the deviations hold
    /// it.
    pub shared: [[f64; N]; ERRORS],
}

impl Relative {
    /// Of both components in one frame: what the film's constants, the principal distance and the sizes of the models do to both
    /// poses alike is carried as such. What is in both covariances and is not among the film's steps counts twice: the joint's depth
    /// then looks less certain than it is, never more.
    #[must_use]
    pub fn new(femur: &Placed, tibia: &Placed, known: KnownTo) -> Self {
        let to_joint = Steps::new(femur, tibia);
        let parts = [femur, tibia];
        let middles = parts.map(|part| part.pose.transform(&part.middle));
        let errors = shared::steps(middles, parts.map(|part| part.film_steps), known);
        let both = femur.covariance.zip(tibia.covariance);
        Self {
            tibia_from_femur: tibia.pose.inverse().compose(&femur.pose),
            middle: femur.middle,
            covariance: both.map(|both| to_joint.carry(both, &errors)),
            shared: errors.map(|[femur, tibia]| to_joint.step(&femur, &tibia)),
        }
    }

    /// The tibial component in the femoral one's axes: what [`super::kinematics::joint_angles`] takes.
    #[must_use]
    pub fn femur_from_tibia(&self) -> Pose {
        self.tibia_from_femur.inverse()
    }

    /// What any numbers of the relative pose are not known to, to first order, by central differences. `None` without a covariance of
    /// the pose.
    pub fn carry<const N: usize>(
        &self,
        numbers: impl FnMut(&Pose) -> [f64; N],
    ) -> Option<Carried<N>> {
        let covariance = self.covariance?.matrix;
        let slopes = self.slopes(numbers);
        let along = |step: &Step, n: usize| (0..6).map(|k| slopes[k][n] * step[k]).sum::<f64>();
        let variance = |n: usize| -> f64 {
            let slope = core::array::from_fn(|k| slopes[k][n]);
            (0..6)
                .map(|row| slope[row] * dot(&covariance[row], &slope))
                .sum()
        };
        Some(Carried {
            deviations: core::array::from_fn(|n| deviation(variance(n))),
            shared: self
                .shared
                .map(|step| core::array::from_fn(|n| along(&step, n))),
        })
    }

    fn slopes<const N: usize>(&self, mut numbers: impl FnMut(&Pose) -> [f64; N]) -> [[f64; N]; 6] {
        core::array::from_fn(|k| {
            let size = if k < 3 { TURN_STEP } else { SHIFT_STEP };
            let mut at = |size: f64| {
                let mut step = [0.0; 6];
                step[k] = size;
                numbers(&self.stepped(&step))
            };
            let (up, down) = (at(size), at(-size));
            core::array::from_fn(|n| (up[n] - down[n]) / (2.0 * size))
        })
    }

    /// One standard deviation of each of any numbers; see [`Self::carry`].
    pub fn deviations<const N: usize>(
        &self,
        numbers: impl FnMut(&Pose) -> [f64; N],
    ) -> Option<[f64; N]> {
        Some(self.carry(numbers)?.deviations)
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
        both: (PoseCovariance, PoseCovariance),
        errors: &[[Step; 2]; ERRORS],
    ) -> PoseCovariance {
        let femur = shared::widened(&both.0, errors, 0);
        let tibia = shared::widened(&both.1, errors, 1);
        let own = congruence(&self.femur, &femur.matrix);
        let other = congruence(&self.tibia, &tibia.matrix);
        let mut matrix =
            core::array::from_fn(|a| core::array::from_fn(|b| own[a][b] + other[a][b]));
        for [femur, tibia] in errors {
            let (femur, tibia) = (times(&self.femur, femur), times(&self.tibia, tibia));
            shared::add_product(&mut matrix, &femur, &tibia);
            shared::add_product(&mut matrix, &tibia, &femur);
        }
        PoseCovariance { matrix }
    }

    /// How the relative pose moves where both do.
    fn step(&self, femur: &Step, tibia: &Step) -> Step {
        let (femur, tibia) = (times(&self.femur, femur), times(&self.tibia, tibia));
        core::array::from_fn(|k| femur[k] + tibia[k])
    }
}

fn dot(a: &Step, b: &Step) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times(matrix: &Matrix6, step: &Step) -> Step {
    matrix.map(|row| dot(&row, step))
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
