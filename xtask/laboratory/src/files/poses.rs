//! Pose files.

use std::ops::RangeInclusive;
use std::path::Path;

use anyhow::{Context, Result, bail};
use fluoropose::math::norm;
use fluoropose::pose::jts;
use fluoropose::pose::{EulerPose, Pose};

use super::text::{read_text, write_text};

/// Reads the poses of a `.jts`, `.jtak` or `.jtap` file, a row a frame; `None` for a frame without one.
///
/// # Errors
/// Names the file and the line.
pub fn read_poses(path: &Path) -> Result<Vec<Option<Pose>>> {
    let text = read_text(path)?;
    let poses: Result<Vec<_>, _> = jts::read(&text).and_then(Iterator::collect);
    let poses = poses.with_context(|| format!("in {}", path.display()))?;
    if poses.is_empty() {
        bail!("{} holds no poses", path.display());
    }
    Ok(poses.into_iter().map(|row| row.map(Pose::from)).collect())
}

/// Knees are seen from no nearer and from no farther, mm.
const DEPTHS: RangeInclusive<f64> = 150.0..=10_000.0;

/// Poses that lie where no knee does, as those in other lengths: a sentence without its full stop.
pub(super) fn doubt_of_lengths(poses: &[Option<Pose>]) -> Option<String> {
    // The origin of a model may lie beside the camera, or behind it.
    let away = poses.iter().flatten().map(|pose| norm(&pose.translation));
    let mut away: Vec<f64> = away.collect();
    away.sort_by(f64::total_cmp);
    let median = *away.get(away.len() / 2)?;
    (!DEPTHS.contains(&median)).then(|| {
        format!(
            "poses lie {median:.1} mm from the focus (median), and no knee is there: lengths of poses are in mm, of which an inch has 25.4 and a centimetre 10"
        )
    })
}

/// Writes poses as `.jts`; the default, six zeros, for a frame without one.
///
/// # Errors
/// Names the file.
pub fn write_poses(path: &Path, poses: &[Option<EulerPose>]) -> Result<()> {
    let mut text = String::new();
    jts::write_heading(&mut text)?;
    for pose in poses {
        jts::write_row(&mut text, pose.as_ref())?;
    }
    write_text(path, &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_in_inches_are_told() {
        let at = |z: f64| {
            let mut pose = Pose::IDENTITY;
            pose.translation[2] = z;
            Some(pose)
        };
        let told = |depths: [f64; 3]| doubt_of_lengths(&depths.map(at));
        let inches = told([-40.2, -42.5, -1080.0]).unwrap();
        assert!(
            inches.starts_with("poses lie 42.5 mm from the focus"),
            "{inches}"
        );
        assert_eq!(told([-1020.0, -1080.0, -40.0]), None);
        assert_eq!(told([1020.0, 1080.0, 990.0]), None);
        let mut beside = Pose::IDENTITY;
        beside.translation = [-1105.0, 491.0, 40.0];
        assert_eq!(doubt_of_lengths(&[Some(beside)]), None);
        assert_eq!(doubt_of_lengths(&[None]), None);
    }
}
