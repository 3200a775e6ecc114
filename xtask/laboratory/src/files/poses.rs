//! Pose files.

use std::path::Path;

use anyhow::{Context, Result, bail};
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
