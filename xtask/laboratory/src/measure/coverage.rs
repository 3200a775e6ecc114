//! Whether poses are as sure as they are said to be: how often the truth lies within what was said.

use std::array;

use fluoropose::pose::covariance::Deviations;
use serde::Serialize;

use super::accuracy::Errors;
use crate::choice::report::Numbers;

/// Standard deviations to either side that hold 68.3 and 95 % of a normally distributed number.
const REGIONS: [f64; 2] = [1.0, 1.96];

/// The parts of poses whose regions of 68 and 95 % hold the truth, number by number.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Coverage {
    /// 68.3 %.
    pub narrow: Numbers,
    /// 95 %.
    pub wide: Numbers,
}

impl Coverage {
    /// Of poses as they are off, and the deviations that were told of them; what nothing was told of holds nothing.
    pub fn of<'p>(poses: impl Iterator<Item = (&'p Errors, Option<&'p Deviations>)>) -> Self {
        let (mut held, mut count) = ([[0.0; 6]; 2], 0.0);
        for (errors, told) in poses {
            count += 1.0;
            let Some(told) = told else { continue };
            for (held, reach) in held.iter_mut().zip(REGIONS) {
                for (held, [error, deviation]) in held.iter_mut().zip(pairs(errors, told)) {
                    *held += f64::from(u8::from(error.abs() <= reach * deviation));
                }
            }
        }
        let [narrow, wide] = held.map(|held| Numbers::from(held.map(|held| held / count)));
        Self { narrow, wide }
    }

    /// As it is printed: percent of each region, number by number.
    pub fn words(&self) -> [String; 2] {
        [self.narrow, self.wide].map(|numbers| {
            let cells = numbers.all().map(|part| format!("{:>4.0}", 100.0 * part));
            cells.concat()
        })
    }
}

/// How far each number is off and its standard deviation, in the order of a pose file.
fn pairs(errors: &Errors, told: &Deviations) -> [[f64; 2]; 6] {
    let errors = [
        errors.x_mm,
        errors.y_mm,
        errors.z_mm,
        errors.z_rot_deg,
        errors.x_rot_deg,
        errors.y_rot_deg,
    ];
    let told = [
        told.x_mm,
        told.y_mm,
        told.z_mm,
        told.z_rot_deg,
        told.x_rot_deg,
        told.y_rot_deg,
    ];
    array::from_fn(|k| [errors[k], told[k]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_counts_where_its_error_is_within_what_was_told() {
        let errors = [0.5, 1.5, -3.0].map(|z_mm| Errors {
            z_mm,
            x_rot_deg: 0.1,
            ..Errors::default()
        });
        let told = Deviations {
            x_mm: 1.0,
            y_mm: 1.0,
            z_mm: 1.0,
            z_rot_deg: 1.0,
            x_rot_deg: 0.04,
            y_rot_deg: 1.0,
            rotation_deg: 1.0,
        };
        let of = |told| Coverage::of(errors.iter().map(|errors| (errors, told)));
        let found = of(Some(&told));
        assert_eq!([found.narrow.z_mm, found.wide.z_mm], [1.0 / 3.0, 2.0 / 3.0]);
        assert_eq!([found.narrow.x_rot_deg, found.wide.y_mm], [0.0, 1.0]);
        assert_eq!(of(None).wide.z_mm, 0.0);
    }
}
