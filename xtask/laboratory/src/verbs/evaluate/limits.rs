//! The limits at the reference poses.

use anyhow::{Context, Result};
use fluoropose::mesh::Model;

use super::found::Found;
use super::reference::Reference;
use crate::files::MaskBuffer;
use crate::measure::accuracy::{Errors, in_front};
use crate::measure::bound::{Comparison, Outlines, PoseLimits};
use crate::noise::Noise;

/// The limits at the reference poses of frames with a pose, and errors against them.
pub(super) fn against(
    reference: &Reference,
    mesh: Model<'_>,
    found: &Found,
    noise: Noise,
    rms: &Errors,
) -> Result<Comparison> {
    let middle = mesh.bounds().centre;
    let mut outlines = Outlines::new(mesh, found.camera);
    let mut limits: Vec<PoseLimits> = Vec::new();
    let frames = reference
        .poses
        .iter()
        .zip(&found.hidden)
        .zip(&found.decisions);
    for ((pose, hidden), decision) in frames {
        let (Some(pose), Some(_)) = (pose, decision) else {
            continue;
        };
        let hidden = hidden.as_ref().map(MaskBuffer::mask);
        let found = outlines.pose_limits(&in_front(pose, &middle), &noise, hidden.as_ref());
        limits.push(found.with_context(|| format!("at the reference {pose:?}"))?);
    }
    Ok(Comparison::of(noise, &limits, rms))
}
