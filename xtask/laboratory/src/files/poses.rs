//! Pose files.

use std::path::Path;

use anyhow::{Context, Result, bail};
use fluoropose::pose::jts;
use fluoropose::pose::{EulerPose, Pose};

use super::text::{read_text, write_text};

/// Reads the poses of a `.jts` file, a row a frame; [`known_pose`] tells which are none.
///
/// # Errors
/// Names the file and the line.
pub fn read_poses(path: &Path) -> Result<Vec<EulerPose>> {
    let text = read_text(path)?;
    let poses: Result<Vec<_>, _> = jts::read(&text).and_then(Iterator::collect);
    let poses = poses.with_context(|| format!("in {}", path.display()))?;
    if poses.is_empty() {
        bail!("{} holds no poses", path.display());
    }
    Ok(poses)
}

/// The pose of a row of a `.jts` file: six zeros stand for none.
pub fn known_pose(row: &EulerPose) -> Option<Pose> {
    (*row != EulerPose::default()).then(|| Pose::from(*row))
}

/// Writes poses as `.jts`; the default, six zeros, for a frame without one.
///
/// # Errors
/// Names the file.
pub fn write_poses(path: &Path, poses: &[EulerPose]) -> Result<()> {
    let mut text = String::new();
    jts::write_heading(&mut text)?;
    for pose in poses {
        jts::write_row(&mut text, pose)?;
    }
    write_text(path, &text)
}
