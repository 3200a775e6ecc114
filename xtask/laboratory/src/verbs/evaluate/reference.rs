//! What a component's poses are compared with.

use std::path::Path;

use anyhow::{Result, bail};
use fluoropose::math::Vector3;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::Pose;

use super::table::Row;
use crate::files::{Component, read_poses_of};
use crate::measure::accuracy::{Errors, is_wrong_side, mean, median_absolute, rms};

/// Reference poses of a component.
pub(super) struct Reference {
    /// Those of each frame, in the frame of the reference's own camera.
    pub(super) poses: Vec<Option<Pose>>,
    /// Planes in which the component is nearly symmetric.
    planes: Vec<SymmetryPlane>,
    /// Of the model's box.
    middle: Vector3,
}

impl Reference {
    pub(super) fn of(component: &Component, frames: Option<&Path>) -> Result<Option<Self>> {
        let Some(path) = &component.reference else {
            return Ok(None);
        };
        let model = component.read_model()?;
        Ok(Some(Self {
            poses: read_poses_of(path, frames)?,
            planes: symmetry_planes(model.as_model().mesh()).to_vec(),
            middle: model.as_model().bounds().centre,
        }))
    }

    /// Both poses in the reference's own camera frame. A model in front of a camera that looks along +z (computer vision, as camera-matrix
    /// studies may have) has positive z; ours never do, but for an origin that lies behind the camera.
    fn in_frame_of(&self, found: Pose, reference: Pose) -> (Pose, Pose) {
        let [z, known] = [found, reference].map(|pose| pose.transform(&self.middle)[2]);
        match z * known < 0.0 {
            true => (found.flip_camera_axes(), reference),
            false => (found, reference),
        }
    }

    /// The row of poses that are named by component, source and method.
    pub(super) fn row(
        &self,
        [component, source, method]: [&str; 3],
        found: &[Option<Pose>],
    ) -> Result<Row> {
        if found.len() != self.poses.len() {
            bail!(
                "{component} {source}: {} poses but {} reference poses; both must be of the same frames",
                found.len(),
                self.poses.len()
            );
        }
        let both = found.iter().zip(&self.poses);
        let pairs: Vec<(Pose, Pose)> = both
            .filter_map(|(found, reference)| Some(self.in_frame_of((*found)?, (*reference)?)))
            .collect();
        let errors: Vec<Errors> = pairs.iter().map(|(a, b)| Errors::of(a, b)).collect();
        let none = |poses: &[Option<Pose>]| poses.iter().filter(|pose| pose.is_none()).count();
        Ok(Row {
            component: component.to_owned(),
            source: source.to_owned(),
            method: method.to_owned(),
            frames: found.len(),
            not_found: none(found),
            no_reference: none(&self.poses),
            rms: Errors::summarise(&errors, rms),
            bias: Errors::summarise(&errors, mean),
            median: Errors::summarise(&errors, median_absolute),
            wrong_side: pairs
                .iter()
                .filter(|(found, known)| is_wrong_side(found, known, &self.planes))
                .count(),
            inside: None,
            verdicts: None,
            reasons: None,
            femur: None,
            film: None,
            from_reference: None,
            limits: None,
        })
    }
}
