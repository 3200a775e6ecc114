//! The other component of the knee, as the command line names it.

use std::ffi::OsStr;
use std::path::Path;

use anyhow::{Result, bail};
use fluoropose::mesh::OwnedModel;
use fluoropose::pose::Pose;

use crate::choice::Beside;
use crate::files::{Role, States, read_model_of, read_poses};

/// The other component, as files tell it.
pub(super) struct Other {
    role: Role,
    poses: Vec<Option<Pose>>,
    doubtful: Vec<usize>,
    model: Option<OwnedModel>,
}

impl Other {
    /// Beside a component of this role: its poses, as many as there are frames, and its model.
    pub(super) fn read(
        role: Role,
        path: &Path,
        model: Option<&Path>,
        frames: usize,
    ) -> Result<Self> {
        let poses = read_poses(path)?;
        if poses.len() != frames {
            bail!(
                "{} has {} poses but there are {frames} masks; both must be of the same frames",
                path.display(),
                poses.len()
            );
        }
        let doubtful = doubtful_rows(path, &poses)?;
        let model = model.map(|file| read_model_of(file, Some(role.other())));
        Ok(Self {
            role,
            poses,
            doubtful,
            model: model.transpose()?,
        })
    }

    pub(super) fn beside(&self) -> Beside<'_> {
        Beside {
            role: self.role,
            poses: self.poses.clone(),
            doubtful: self.doubtful.clone(),
            model: self.model.as_ref().map(OwnedModel::as_model),
        }
    }
}

/// Rows of a pose file that the table beside it calls doubtful; what a person accepted is not.
fn doubtful_rows(file: &Path, poses: &[Option<Pose>]) -> Result<Vec<usize>> {
    let name = file.file_stem().and_then(OsStr::to_str);
    let (Some(folder), Some(name)) = (file.parent(), name) else {
        return Ok(Vec::new());
    };
    let states = States::beside(folder, &[(name, poses)])?.unwrap_or_default();
    let has_pose = |row: usize| poses.get(row).is_some_and(Option::is_some);
    let all = states.all.iter().filter(|state| has_pose(state.row));
    let doubtful = all.filter(|state| !state.is_good());
    let rows: Vec<usize> = doubtful.map(|state| state.row).collect();
    if !rows.is_empty() {
        let (count, tables) = (
            rows.len(),
            states
                .tables
                .iter()
                .map(|table| table.display().to_string()),
        );
        let tables: Vec<String> = tables.collect();
        println!(
            "{count} of the {} poses in {} rule out nothing: {} does not call them good",
            poses.len(),
            file.display(),
            tables.join(", ")
        );
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::EulerPose;

    #[test]
    fn what_the_table_beside_a_pose_file_calls_doubtful_is_told_by_its_row() {
        let folder = std::env::temp_dir().join(format!("fluoropose-other-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("femur.jts");
        let pose = |x: f64| Some(Pose::from(EulerPose::from([x, 0.0, -900.0, 0.0, 0.0, 0.0])));
        let poses = [pose(1.0), pose(2.0), None];
        assert_eq!(doubtful_rows(&file, &poses).unwrap(), [0usize; 0]);
        let table =
            "frame,verdict,because\n1,good,\"\"\n2,doubtful,\"a rim\"\n3,none,\"no edge\"\n";
        std::fs::write(folder.join("femur.csv"), table).unwrap();
        assert_eq!(doubtful_rows(&file, &poses).unwrap(), [1]);
        assert!(doubtful_rows(&file, &[pose(1.0); 4]).is_err());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
