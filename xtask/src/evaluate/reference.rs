//! What a component's poses are compared with.

use anyhow::{Context, Result, bail};
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::Pose;

use super::found::Found;
use super::{Row, StartDifference};
use crate::pipeline::accuracy::{Errors, is_wrong_side, median_absolute, rms};
use crate::pipeline::bound::{Comparison, Noise, Outlines, PoseLimits};
use crate::pipeline::files::{MaskBuffer, known_pose, read_model, read_poses};
use crate::pipeline::study::Component;

/// Reference poses of a component.
pub(super) struct Reference {
    /// Those of each frame, in the frame of the reference's own camera.
    pub(super) poses: Vec<Option<Pose>>,
    /// Planes in which the component is nearly symmetric.
    planes: Vec<SymmetryPlane>,
}

impl Reference {
    pub(super) fn of(component: &Component) -> Result<Option<Self>> {
        let Some(path) = &component.reference else {
            return Ok(None);
        };
        let model = read_model(&component.model)?;
        Ok(Some(Self {
            poses: read_poses(path)?.iter().map(known_pose).collect(),
            planes: symmetry_planes(model.mesh()?.mesh()).to_vec(),
        }))
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
            .filter_map(|(found, reference)| Some(in_frame_of((*found)?, (*reference)?)))
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
            median: Errors::summarise(&errors, median_absolute),
            wrong_side: pairs
                .iter()
                .filter(|(found, known)| is_wrong_side(found, known, &self.planes))
                .count(),
            reasons: None,
            femur: None,
            from_reference: None,
            limits: None,
        })
    }

    /// The limits at the reference poses of frames with a pose, and errors against them.
    pub(super) fn limits(
        &self,
        mesh: Model<'_>,
        found: &Found,
        noise: Noise,
        rms: &Errors,
    ) -> Result<Comparison> {
        let mut outlines = Outlines::new(mesh, found.camera);
        let mut limits: Vec<PoseLimits> = Vec::new();
        let frames = self.poses.iter().zip(&found.hidden).zip(&found.decisions);
        for ((pose, hidden), decision) in frames {
            let (Some(pose), Some(_)) = (pose, decision) else {
                continue;
            };
            let hidden = hidden.as_ref().map(MaskBuffer::mask);
            let found = outlines.pose_limits(&in_front(pose), &noise, hidden.as_ref());
            limits.push(found.with_context(|| format!("at the reference {pose:?}"))?);
        }
        Ok(Comparison::of(noise, &limits, rms))
    }
}

impl StartDifference {
    /// Poses that were chosen against those that refinement found from the reference poses.
    pub(super) fn of(chosen: &[Option<Pose>], from_reference: &[Option<Pose>]) -> Self {
        let both = chosen.iter().zip(from_reference);
        let differences: Vec<Errors> = both
            .filter_map(|(chosen, other)| Some(Errors::of(&(*chosen)?, &(*other)?)))
            .collect();
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        Self {
            frames: differences.len(),
            rms: Errors::summarise(&differences, rms),
            largest: Errors::summarise(&differences, largest),
        }
    }
}

/// A pose in our camera frame, which looks along -z.
pub(super) fn in_front(pose: &Pose) -> Pose {
    if pose.translation[2] > 0.0 {
        pose.flip_camera_axes()
    } else {
        *pose
    }
}

/// Both poses in the reference's own camera frame. A reference in front of a camera that looks
/// along +z (computer vision, as camera-matrix studies may have) has positive z; ours never do.
fn in_frame_of(found: Pose, reference: Pose) -> (Pose, Pose) {
    if reference.translation[2] * found.translation[2] < 0.0 {
        (found.flip_camera_axes(), reference)
    } else {
        (found, reference)
    }
}
