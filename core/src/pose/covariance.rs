//! Pose uncertainty: the covariance of a pose's six parameters, and of the six numbers in which it is written.

use crate::math::{
    Vector3, add, apply, cross, degrees, deviation, inverse_spd, multiply, multiply_square,
    rotation_vector, scale, sin_cos, solve_spd, subtract, transpose, transpose_square,
};
use crate::pose::{EulerPose, Pose};

/// A 6 x 6 matrix, row by row.
pub type Matrix6 = [[f64; 6]; 6];

/// Least cosine of `x_rot` that is used. Near 90 degrees `z_rot` and `y_rot` rotate about the same line, and each alone is
/// practically unknown.
const LOCK: f64 = 1e-9;

/// Covariance of a pose about its middle.
///
/// The parameters are those of a step of refinement, in this order: a small turn about the middle
/// of the model, as a rotation vector in camera axes (three numbers, radians), and a shift of that
/// middle in camera axes (three numbers, mm). The six numbers of a pose file differ: their
/// translation is that of the model's origin, which may lie far from the part, and their angles
/// are successive; [`Self::numbers`] gives their covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseCovariance {
    /// Turn (radians) before shift (mm); symmetric.
    pub matrix: Matrix6,
}

/// Standard deviations of the numbers of an [`EulerPose`], and of the rotation as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviations {
    /// Of the translation to the right, mm.
    pub x_mm: f64,
    /// Of the translation upwards, mm.
    pub y_mm: f64,
    /// Of the translation along the view, mm.
    pub z_mm: f64,
    /// Of the rotation in the image plane, degrees.
    pub z_rot_deg: f64,
    /// Of the rotation about x, degrees.
    pub x_rot_deg: f64,
    /// Of the rotation about y, degrees.
    pub y_rot_deg: f64,
    /// Root mean square of the angle between the rotation and the true one, degrees.
    pub rotation_deg: f64,
}

impl PoseCovariance {
    /// The inverse of an information matrix in the same parameters: of Fisher's, the bound of
    /// Cramer and Rao. `None` where it is not positive definite: the data do not determine the
    /// pose.
    #[must_use]
    pub fn from_information(information: &Matrix6) -> Option<Self> {
        inverse_spd(information).map(|matrix| Self { matrix })
    }

    /// Covariance of the estimate that solves `normal * step = J' W r`, where `spread` is the
    /// covariance of `J' W r`: `normal^-1 * spread * normal^-1`. Right also where the residuals
    /// are not independent or the weights not the best ones (White, Econometrica 48, 1980).
    ///
    /// `None` where `normal` is not positive definite.
    #[must_use]
    pub fn sandwich(normal: &Matrix6, spread: &Matrix6) -> Option<Self> {
        let bread = inverse_spd(normal)?;
        Some(Self {
            matrix: congruence(&bread, spread),
        })
    }

    /// The reverse of [`Self::numbers`] where nothing but the standard deviations of the six numbers was kept (mm of the
    /// model's origin, then degrees of `z_rot`, `x_rot`, `y_rot`): their errors are taken as independent.
    #[must_use]
    pub fn from_independent(deviations: &[f64; 6], pose: &Pose, middle: &Vector3) -> Self {
        let steps = steps_per_number(pose, middle);
        let spread = core::array::from_fn(|a| {
            core::array::from_fn(|b| {
                let same = f64::from(u8::from(a == b));
                same * deviations[a] * deviations[b]
            })
        });
        Self {
            matrix: congruence(&steps, &spread),
        }
    }

    /// Covariance of `x`, `y`, `z` (mm, of the model's origin), `z_rot`, `x_rot`, `y_rot` (degrees)
    /// of `pose`, to first order. `middle` is the point of the model that the turns leave in
    /// place, model coordinates, mm.
    ///
    /// At an `x_rot` of 90 degrees `z_rot` and `y_rot` have no first order; theirs are
    /// huge there and finite.
    #[must_use]
    pub fn numbers(&self, pose: &Pose, middle: &Vector3) -> Matrix6 {
        congruence(&numbers_per_step(pose, middle), &self.matrix)
    }

    /// Standard deviations of the same six numbers, and of the rotation.
    #[must_use]
    pub fn deviations(&self, pose: &Pose, middle: &Vector3) -> Deviations {
        let numbers = self.numbers(pose, middle);
        let of = |k: usize| deviation(numbers[k][k]);
        Deviations {
            x_mm: of(0),
            y_mm: of(1),
            z_mm: of(2),
            z_rot_deg: of(3),
            x_rot_deg: of(4),
            y_rot_deg: of(5),
            rotation_deg: self.rotation_deg(),
        }
    }

    /// Whether `other` lies within the ellipsoid of this squared radius about `pose`, of which
    /// this is the covariance (12.59 holds 95 % of a normal distribution in six dimensions).
    /// `None` where the covariance has no inverse.
    #[must_use]
    pub fn holds(
        &self,
        pose: &Pose,
        other: &Pose,
        middle: &Vector3,
        squared_radius: f64,
    ) -> Option<bool> {
        let turn = rotation_vector(&multiply(&other.rotation, &transpose(&pose.rotation)));
        let from = pose.transform(middle);
        let shift = subtract(&other.transform(middle), &from);
        let step = joined(&turn, &shift);
        let solved = solve_spd(self.matrix, step)?;
        let squared: f64 = step.iter().zip(&solved).map(|(a, b)| a * b).sum();
        Some(squared <= squared_radius)
    }

    /// Whether another pose is told from this one by what is beyond twice the standard deviations: it is turned by so much, degrees, or its middle
    /// lies so much farther, mm. A pose that is not is no other one, as noise has it.
    #[must_use]
    pub fn tells_apart(&self, turn_deg: f64, farther_mm: f64) -> bool {
        let depth = deviation(self.matrix[5][5]);
        let is_one = turn_deg <= 2.0 * self.rotation_deg() && farther_mm.abs() <= 2.0 * depth;
        !is_one
    }

    /// Root mean square of the angle between the rotation and the true one, degrees: the length
    /// of the rotation vector between them. What is not known (NaN) stays so.
    #[must_use]
    pub fn rotation_deg(&self) -> f64 {
        let trace: f64 = (0..3).map(|k| self.matrix[k][k]).sum();
        degrees(deviation(trace))
    }
}

/// How the six numbers of a pose file (rows: mm, degrees) change with a turn about `middle` and a
/// shift (columns: radians, mm).
///
/// A turn `w` and a shift `s` move the origin by `s - w x (R m)`. Of the angles,
/// `w = z' e_z + x' Rz e_x + y' Rz Rx e_y`; rotated back by `Rz` this is
/// `(x', y' cos x, z' + y' sin x)`.
#[must_use]
pub(crate) fn numbers_per_step(pose: &Pose, middle: &Vector3) -> Matrix6 {
    let euler = EulerPose::from(*pose);
    let (sin_z, cos_z) = sin_cos(crate::math::radians(euler.z_rot_deg));
    let (sin_x, cos_x) = sin_cos(crate::math::radians(euler.x_rot_deg));
    let y_rate = scale(&[-sin_z, cos_z, 0.0], 1.0 / cos_x.max(LOCK));
    let z_rate = add(&[0.0, 0.0, 1.0], &scale(&y_rate, -sin_x));
    let rates = [z_rate, [cos_z, sin_z, 0.0], y_rate];
    let arm = apply(&pose.rotation, middle);
    core::array::from_fn(|row| {
        let mut unit = [0.0; 3];
        if row < 3 {
            unit[row] = 1.0;
            // e . (s - w x arm) = e . s - w . (arm x e)
            let turn = scale(&cross(&arm, &unit), -1.0);
            joined(&turn, &unit)
        } else {
            joined(&rates[row - 3].map(degrees), &[0.0; 3])
        }
    })
}

/// The inverse of [`numbers_per_step`], which exists at any angle: a turn about `middle` and a shift (rows) for each of the six
/// numbers (columns). An angle turns about its own axis and carries the middle around the origin.
fn steps_per_number(pose: &Pose, middle: &Vector3) -> Matrix6 {
    let euler = EulerPose::from(*pose);
    let (sin_z, cos_z) = sin_cos(crate::math::radians(euler.z_rot_deg));
    let (sin_x, cos_x) = sin_cos(crate::math::radians(euler.x_rot_deg));
    let axes = [
        [0.0, 0.0, 1.0],
        [cos_z, sin_z, 0.0],
        [-sin_z * cos_x, cos_z * cos_x, sin_x],
    ];
    let arm = apply(&pose.rotation, middle);
    let columns: Matrix6 = core::array::from_fn(|number| {
        if number < 3 {
            let mut unit = [0.0; 3];
            unit[number] = 1.0;
            joined(&[0.0; 3], &unit)
        } else {
            let turn = axes[number - 3].map(crate::math::radians);
            joined(&turn, &cross(&turn, &arm))
        }
    });
    transpose_square(&columns)
}

fn joined(turn: &Vector3, shift: &Vector3) -> [f64; 6] {
    core::array::from_fn(|k| if k < 3 { turn[k] } else { shift[k - 3] })
}

/// `a * b * c'`.
fn product_with_transpose(a: &Matrix6, b: &Matrix6, c: &Matrix6) -> Matrix6 {
    multiply_square(&multiply_square(a, b), &transpose_square(c))
}

/// `a * b * a'`, made symmetric against rounding.
pub(crate) fn congruence(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    let product = product_with_transpose(a, b, a);
    core::array::from_fn(|row| {
        core::array::from_fn(|column| (product[row][column] + product[column][row]) / 2.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Matrix3, norm, sqrt};
    use crate::pose::{Quaternion, geodesic_deg};
    use proptest::prelude::*;

    /// The pose after a turn about `middle` and a shift, by way of a quaternion.
    fn moved(pose: &Pose, middle: &Vector3, step: &[f64; 6]) -> Pose {
        let [turn, shift] = [[step[0], step[1], step[2]], [step[3], step[4], step[5]]];
        let angle = norm(&turn);
        let (sine, cosine) = sin_cos(angle / 2.0);
        let axis = if angle > 0.0 {
            scale(&turn, sine / angle)
        } else {
            [0.0; 3]
        };
        let rotation = multiply(
            &Matrix3::from(Quaternion {
                w: cosine,
                x: axis[0],
                y: axis[1],
                z: axis[2],
            }),
            &pose.rotation,
        );
        let centre = add(&pose.transform(middle), &shift);
        let translation = subtract(&centre, &apply(&rotation, middle));
        Pose {
            rotation,
            translation,
        }
    }

    fn numbers_of(pose: &Pose) -> [f64; 6] {
        let e = EulerPose::from(*pose);
        [
            e.x_mm,
            e.y_mm,
            e.z_mm,
            e.z_rot_deg,
            e.x_rot_deg,
            e.y_rot_deg,
        ]
    }

    fn pose(z_rot_deg: f64, x_rot_deg: f64, y_rot_deg: f64) -> Pose {
        Pose::from(EulerPose {
            x_mm: 12.0,
            y_mm: -31.0,
            z_mm: -984.0,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
        })
    }

    #[test]
    fn a_rotation_of_which_nothing_is_known_is_not_certain() {
        let with = |variance: f64| {
            let mut matrix = [[0.0; 6]; 6];
            matrix[1][1] = variance;
            PoseCovariance { matrix }.rotation_deg()
        };
        assert!(with(f64::NAN).is_nan() && with(f64::INFINITY) == f64::INFINITY);
        assert_eq!((with(-1e-20), with(0.0)), (0.0, 0.0));
    }

    properties! {
        #[test]
        fn the_numbers_change_as_finite_differences_do(
            z in -170.0..170.0f64, x in -80.0..80.0f64, y in -170.0..170.0f64,
            middle in proptest::array::uniform3(-60.0..60.0f64),
        ) {
            let pose = pose(z, x, y);
            let analytic = numbers_per_step(&pose, &middle);
            for column in 0..6 {
                let mut step = [0.0; 6];
                step[column] = 1e-5;
                let ahead = numbers_of(&moved(&pose, &middle, &step));
                step[column] = -1e-5;
                let behind = numbers_of(&moved(&pose, &middle, &step));
                for row in 0..6 {
                    let slope = (ahead[row] - behind[row]) / 2e-5;
                    let error = (slope - analytic[row][column]).abs();
                    prop_assert!(error < 1e-3 * (1.0 + slope.abs()), "{row} {column}: {slope}");
                }
            }
        }

        #[test]
        fn independent_numbers_have_the_deviations_they_came_from(
            z in -170.0..170.0f64, x in -80.0..80.0f64, y in -170.0..170.0f64,
            middle in proptest::array::uniform3(-60.0..60.0f64),
            deviations in proptest::array::uniform6(0.01..3.0f64),
        ) {
            let pose = pose(z, x, y);
            let covariance = PoseCovariance::from_independent(&deviations, &pose, &middle);
            let numbers = covariance.numbers(&pose, &middle);
            for (a, row) in numbers.iter().enumerate() {
                for (b, found) in row.iter().enumerate() {
                    let wanted = if a == b { deviations[a] * deviations[a] } else { 0.0 };
                    prop_assert!((found - wanted).abs() < 1e-8, "{a} {b}: {found}");
                }
            }
        }

        #[test]
        fn an_information_and_its_covariance_are_inverse(
            entries in proptest::collection::vec(-1.0..1.0f64, 36)
        ) {
            // B B' + 0.1 is positive definite.
            let b: Matrix6 = core::array::from_fn(|r| core::array::from_fn(|c| entries[6 * r + c]));
            let mut information = multiply_square(&b, &transpose_square(&b));
            (0..6).for_each(|k| information[k][k] += 0.1);
            let found = PoseCovariance::from_information(&information).expect("positive definite");
            let one = multiply_square(&found.matrix, &information);
            for (row, values) in one.iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    let wanted = f64::from(u8::from(row == column));
                    prop_assert!((value - wanted).abs() < 1e-8);
                }
            }
            // Where the spread is the information itself, the sandwich is its inverse.
            let same = PoseCovariance::sandwich(&information, &information).expect("the same");
            for (a, b) in same.matrix.iter().flatten().zip(found.matrix.iter().flatten()) {
                prop_assert!((a - b).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn deviations_are_those_of_many_drawn_poses() {
        let (pose, middle) = (pose(40.0, 12.0, -25.0), [20.0, -10.0, 35.0]);
        // Square root of a covariance with correlated turn and shift.
        let mut root = [[0.0; 6]; 6];
        for (k, row) in root.iter_mut().enumerate() {
            row[k] = if k < 3 { 0.002 } else { 0.4 };
        }
        root[3][1] = 0.3;
        root[5][0] = -0.2;
        root[1][0] = 0.001;
        let covariance = PoseCovariance {
            matrix: multiply_square(&root, &transpose_square(&root)),
        };
        let draws = 20_000;
        let mut seed = 1u64;
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let reference = numbers_of(&pose);
        let mut squares = [0.0; 7];
        for _ in 0..draws {
            // Twelve uniform numbers minus six: variance one.
            let white: [f64; 6] = core::array::from_fn(|_| (0..12).map(|_| uniform()).sum());
            let step: [f64; 6] =
                core::array::from_fn(|row| (0..6).map(|k| root[row][k] * (white[k] - 6.0)).sum());
            let drawn = moved(&pose, &middle, &step);
            for (sum, (value, reference)) in squares
                .iter_mut()
                .zip(numbers_of(&drawn).iter().zip(&reference))
            {
                *sum += (value - reference) * (value - reference);
            }
            let angle = geodesic_deg(&drawn.rotation, &pose.rotation);
            squares[6] += angle * angle;
        }
        let d = covariance.deviations(&pose, &middle);
        let expected = [
            d.x_mm,
            d.y_mm,
            d.z_mm,
            d.z_rot_deg,
            d.x_rot_deg,
            d.y_rot_deg,
            d.rotation_deg,
        ];
        for (sum, expected) in squares.iter().zip(expected) {
            let found = sqrt(sum / f64::from(draws));
            assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
        }
    }

    #[test]
    fn what_is_not_determined_has_no_covariance_and_lock_is_finite() {
        let mut information = [[0.0; 6]; 6];
        (0..5).for_each(|k| information[k][k] = 1.0);
        assert_eq!(PoseCovariance::from_information(&information), None);
        information[5][5] = 1.0;
        let covariance = PoseCovariance::from_information(&information).expect("the identity");
        let numbers = covariance.numbers(&pose(10.0, 90.0, 5.0), &[1.0, 2.0, 3.0]);
        assert!(numbers.iter().flatten().all(|value| value.is_finite()));
        assert!(numbers[3][3] > 1e12);
    }
}
