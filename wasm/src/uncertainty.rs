//! How uncertain a pose is, as it leaves and comes back.

use fluoropose::math::Vector3;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::pose::{Pose, geodesic_deg};

/// How uncertain a pose is, as it leaves: the standard deviations of its six numbers, in their order and units, and then the
/// covariance that they come from, [`PoseCovariance::matrix`] from its diagonal on, row by row; then what of it is the film's
/// (`film_steps` of the core), zero where nothing is known of that.
pub(crate) type Uncertainty = [f64; 6 + UPPER + FILM];
/// Numbers of the upper half of a covariance.
pub(crate) const UPPER: usize = 21;
/// Numbers of the film's part of it.
pub(crate) const FILM: usize = 12;

pub(crate) fn uncertainty(
    covariance: &PoseCovariance,
    film_steps: &[[f64; 6]; 2],
    pose: &Pose,
    middle: &Vector3,
) -> Uncertainty {
    let deviations = covariance.deviations(pose, middle);
    let six = [
        deviations.x_mm,
        deviations.y_mm,
        deviations.z_mm,
        deviations.z_rot_deg,
        deviations.x_rot_deg,
        deviations.y_rot_deg,
    ];
    let upper = (0..6).flat_map(|row| covariance.matrix[row][row..].iter().copied());
    let mut all = [0.0; 6 + UPPER + FILM];
    let film = film_steps.as_flattened().iter().copied();
    for (place, number) in all.iter_mut().zip(six.into_iter().chain(upper).chain(film)) {
        *place = number;
    }
    all
}

/// The covariance of which this is the upper half.
pub(crate) fn covariance_of(upper: &[f64; UPPER]) -> PoseCovariance {
    let mut matrix = [[0.0; 6]; 6];
    let places = (0..6).flat_map(|row| (row..6).map(move |column| (row, column)));
    for ((row, column), &number) in places.zip(upper) {
        matrix[row][column] = number;
        matrix[column][row] = number;
    }
    PoseCovariance { matrix }
}

/// Whether two poses are two, by the covariance of the first.
pub(crate) fn tells_apart(
    covariance: &PoseCovariance,
    [own, other]: [&Pose; 2],
    middle: &Vector3,
) -> bool {
    let [depth, others] = [own, other].map(|pose| pose.transform(middle)[2]);
    covariance.tells_apart(geodesic_deg(&own.rotation, &other.rotation), others - depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_covariance_comes_back_whole() {
        let matrix = core::array::from_fn(|a| {
            core::array::from_fn(|b| if a == b { 9.0 } else { (a + b) as f64 / 10.0 })
        });
        let numbers = uncertainty(
            &PoseCovariance { matrix },
            &[[7.0; 6], [8.0; 6]],
            &Pose::IDENTITY,
            &[0.0; 3],
        );
        // Without a middle apart from the origin, its shift is that of the numbers.
        assert_eq!(numbers[..3], [3.0; 3]);
        assert_eq!(numbers[27..], [[7.0; 6], [8.0; 6]].concat());
        let upper = numbers[6..27].try_into().unwrap();
        assert_eq!(covariance_of(upper), PoseCovariance { matrix });
    }
}
