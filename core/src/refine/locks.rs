//! Numbers of a pose that refinement leaves as they are.

use super::step::Step;
use crate::math::Vector3;
use crate::pose::covariance::numbers_per_step;
use crate::pose::{EulerPose, Pose};

/// Which of a pose's numbers are locked, as the field writes them: nothing is by default.
///
/// Of several cameras the numbers are those of `world_from_model`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Locks {
    /// [`EulerPose::x_mm`], [`EulerPose::y_mm`] and [`EulerPose::z_mm`].
    pub translation: [bool; 3],
    /// [`EulerPose::z_rot_deg`].
    pub z_rot: bool,
    /// [`EulerPose::x_rot_deg`].
    pub x_rot: bool,
    /// [`EulerPose::y_rot_deg`].
    pub y_rot: bool,
}

impl Locks {
    /// Whether nothing is locked.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// How fast the locked numbers change with a step about `middle`.
    pub(super) fn rows(&self, pose: &Pose, middle: &Vector3) -> impl Iterator<Item = [f64; 6]> {
        let [x, y, z] = self.translation;
        let locked = [x, y, z, self.z_rot, self.x_rot, self.y_rot];
        let rows = numbers_per_step(pose, middle).into_iter().zip(locked);
        rows.filter_map(|(row, locked)| locked.then_some(row))
    }

    /// `pose` with the locked numbers of `start`. A step holds them to first order only.
    pub(super) fn restore(&self, pose: &Pose, start: &EulerPose) -> Pose {
        if self.is_empty() {
            return *pose;
        }
        let mut euler = EulerPose::from(*pose);
        let [x, y, z] = self.translation;
        let numbers = [
            (x, &mut euler.x_mm, start.x_mm),
            (y, &mut euler.y_mm, start.y_mm),
            (z, &mut euler.z_mm, start.z_mm),
            (self.z_rot, &mut euler.z_rot_deg, start.z_rot_deg),
            (self.x_rot, &mut euler.x_rot_deg, start.x_rot_deg),
            (self.y_rot, &mut euler.y_rot_deg, start.y_rot_deg),
        ];
        for (locked, number, wanted) in numbers {
            if locked {
                *number = wanted;
            }
        }
        euler.into()
    }
}

/// Locks with the numbers that they hold.
#[derive(Clone, Copy)]
pub(super) struct Hold {
    pub(super) locks: Locks,
    pub(super) start: EulerPose,
}

impl Hold {
    /// The pose after a step, the locked numbers exactly as they were.
    pub(super) fn apply(&self, step: &Step, pose: &Pose, middle: &Vector3) -> Pose {
        self.locks.restore(&step.apply(pose, middle), &self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn what_is_locked_is_restored_and_nothing_else(z in -170.0..170.0f64, x in -70.0..70.0f64) {
            let start = EulerPose { x_mm: 1.0, y_mm: 2.0, z_mm: -800.0,
                z_rot_deg: 10.0, x_rot_deg: 20.0, y_rot_deg: 30.0 };
            let other = EulerPose { x_mm: 4.0, y_mm: 5.0, z_mm: -700.0,
                z_rot_deg: z, x_rot_deg: x, y_rot_deg: -12.0 };
            let locks = Locks { translation: [false, false, true], y_rot: true, ..Locks::default() };
            let got = EulerPose::from(locks.restore(&Pose::from(other), &start));
            prop_assert!((got.z_mm + 800.0).abs() < 1e-9 && (got.y_rot_deg - 30.0).abs() < 1e-9);
            prop_assert!((got.x_mm - 4.0).abs() < 1e-9 && (got.y_mm - 5.0).abs() < 1e-9);
            prop_assert!((got.z_rot_deg - z).abs() < 1e-7 && (got.x_rot_deg - x).abs() < 1e-7);
        }
    }

    #[test]
    fn a_row_for_each_number_that_is_locked() {
        let rows = |locks: Locks| locks.rows(&Pose::IDENTITY, &[1.0, 2.0, 3.0]).count();
        assert!(Locks::default().is_empty());
        assert_eq!(rows(Locks::default()), 0);
        let two = Locks {
            translation: [true, false, false],
            y_rot: true,
            ..Locks::default()
        };
        assert_eq!(rows(two), 2);
    }
}
