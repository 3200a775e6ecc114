//! Errors of poses against known ones, and their statistics.

use fluoropose::math::{Vector3, wrap};
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::SymmetryPlane;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use serde::Serialize;

/// Signed differences of one pose from a reference; the geodesic one is not signed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// To the right, mm.
    pub x_mm: f64,
    /// Upwards, mm.
    pub y_mm: f64,
    /// Along the view, mm.
    pub z_mm: f64,
    /// In the image plane, degrees.
    pub z_rot_deg: f64,
    /// About x, degrees.
    pub x_rot_deg: f64,
    /// About y, degrees.
    pub y_rot_deg: f64,
    /// Angle of the rotation between the two, degrees.
    pub geodesic_deg: f64,
}

/// A pose in our camera frame, which looks along -z, of a model whose `middle` lies before the camera: its origin may lie behind it.
pub fn in_front(pose: &Pose, middle: &Vector3) -> Pose {
    if pose.transform(middle)[2] > 0.0 {
        pose.flip_camera_axes()
    } else {
        *pose
    }
}

impl Errors {
    /// `found` minus `reference`; angles are taken the short way round.
    pub fn of(found: &Pose, reference: &Pose) -> Self {
        let (a, b) = (EulerPose::from(*found), EulerPose::from(*reference));
        Self {
            x_mm: a.x_mm - b.x_mm,
            y_mm: a.y_mm - b.y_mm,
            z_mm: a.z_mm - b.z_mm,
            z_rot_deg: wrap(a.z_rot_deg - b.z_rot_deg, 360.0),
            x_rot_deg: wrap(a.x_rot_deg - b.x_rot_deg, 360.0),
            y_rot_deg: wrap(a.y_rot_deg - b.y_rot_deg, 360.0),
            geodesic_deg: geodesic_deg(&found.rotation, &reference.rotation),
        }
    }

    /// One statistic of each column; NaN for no errors at all.
    pub fn summarise(all: &[Self], statistic: impl Fn(&[f64]) -> f64) -> Self {
        let column = |value: fn(&Self) -> f64| {
            let values: Vec<f64> = all.iter().map(value).collect();
            statistic(&values)
        };
        Self {
            x_mm: column(|e| e.x_mm),
            y_mm: column(|e| e.y_mm),
            z_mm: column(|e| e.z_mm),
            z_rot_deg: column(|e| e.z_rot_deg),
            x_rot_deg: column(|e| e.x_rot_deg),
            y_rot_deg: column(|e| e.y_rot_deg),
            geodesic_deg: column(|e| e.geodesic_deg),
        }
    }
}

/// Root of the mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Mean of the values, with their signs.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean of the absolute values.
pub fn mean_absolute(values: &[f64]) -> f64 {
    values.iter().map(|v| v.abs()).sum::<f64>() / values.len() as f64
}

/// Median of the absolute values; the mean of the two middle ones for an even number.
pub fn median_absolute(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match (sorted.get(middle), sorted.len() % 2) {
        (None, _) => f64::NAN,
        (Some(value), 1) => *value,
        (Some(value), _) => (sorted[middle - 1] + value) / 2.0,
    }
}

/// Whether `found` lies on the wrong side of the mirror trap: nearer to a mirror image of the
/// reference than to the reference itself.
///
/// `planes` are those in which the part is nearly symmetric ([`fluoropose::mesh::symmetry`]); a part
/// without any has no side to be wrong about. Where image and reference are less than 2 degrees
/// apart there is none either.
pub fn is_wrong_side(found: &Pose, reference: &Pose, planes: &[SymmetryPlane]) -> bool {
    let own = geodesic_deg(&found.rotation, &reference.rotation);
    planes
        .iter()
        .map(|plane| mirror_pose(reference, plane).rotation)
        .filter(|image| geodesic_deg(image, &reference.rotation) > 2.0)
        .any(|image| geodesic_deg(&found.rotation, &image) < own)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(z_rot_deg: f64, x_rot_deg: f64, y_rot_deg: f64) -> Pose {
        Pose::from(EulerPose {
            z_mm: -1000.0,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
            ..EulerPose::default()
        })
    }

    #[test]
    fn statistics_of_known_lists() {
        assert_eq!(rms(&[3.0, -4.0]), 12.5f64.sqrt());
        assert_eq!(mean_absolute(&[3.0, -4.0]), 3.5);
        assert_eq!(median_absolute(&[5.0, -1.0, 2.0]), 2.0);
        assert_eq!(median_absolute(&[5.0, -1.0]), 3.0);
        assert!(median_absolute(&[]).is_nan());
    }

    /// Models as scanners have them lie metres from their origin.
    #[test]
    fn what_lies_before_the_camera_is_told_by_the_model_and_not_by_its_origin() {
        let mut behind = pose(0.0, 0.0, 0.0);
        behind.translation = [0.0, 0.0, 1480.0];
        assert_eq!(in_front(&behind, &[0.0, 0.0, -2700.0]), behind);
        assert_eq!(in_front(&behind, &[0.0; 3]), behind.flip_camera_axes());
    }

    #[test]
    fn errors_go_the_short_way_round() {
        let errors = Errors::of(&pose(179.5, 1.0, 0.0), &pose(-179.5, 0.0, 0.0));
        assert!((errors.z_rot_deg + 1.0).abs() < 1e-9);
        assert!((errors.x_rot_deg - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_mirror_image_on_the_axis_negates_both_out_of_plane_rotations() {
        let reference = pose(-84.0, 0.6, -9.0);
        let mediolateral = [SymmetryPlane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            deviation_mm: 0.0,
        }];
        let wrong = |found: Pose| is_wrong_side(&found, &reference, &mediolateral);
        assert!(wrong(pose(-84.0, -0.5, 8.8)));
        assert!(!wrong(pose(-83.0, 1.0, -7.0)));
        assert!(!wrong(reference));
        assert!(!is_wrong_side(&pose(-84.0, -0.5, 8.8), &reference, &[]));
    }
}
