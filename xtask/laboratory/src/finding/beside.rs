//! The joint's other component, where a frame's edges are looked at.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::image::mask::{Mask, MaskMut};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tracing::beside;

use crate::files::MaskBuffer;

/// A component, and where it is in each frame, as far as that is known.
#[derive(Clone, Debug)]
pub struct Beside<'m> {
    /// Its model.
    pub model: Model<'m>,
    /// The frames.
    pub poses: Vec<Option<Pose>>,
}

/// What a component covers at a pose, and what its edges reach beyond that.
///
/// # Errors
/// For a pose that cannot be drawn.
pub fn covered(model: &Model<'_>, camera: &Camera, pose: &Pose) -> Result<MaskBuffer> {
    let mut hidden = MaskBuffer::new(camera.width(), camera.height())?;
    hidden.draw(|hidden| cover(model, camera, pose, hidden))?;
    Ok(hidden)
}

/// What of a frame is not to be looked at: the components beside the one that is, where they are known, and what is `unknown` besides.
/// `None` where that is nothing.
///
/// # Errors
/// For a pose that cannot be drawn.
pub fn hidden(
    beside: &[Beside<'_>],
    camera: &Camera,
    frame: usize,
    unknown: Option<&Mask<'_>>,
) -> Result<Option<MaskBuffer>> {
    let pose = |one: &Beside<'_>| one.poses.get(frame).copied().flatten();
    let known: Vec<(Model<'_>, Pose)> = beside
        .iter()
        .filter_map(|one| Some((one.model, pose(one)?)))
        .collect();
    if known.is_empty() {
        return Ok(unknown.map(MaskBuffer::copy_of));
    }
    let mut hidden = match unknown {
        Some(unknown) => MaskBuffer::copy_of(unknown),
        None => MaskBuffer::new(camera.width(), camera.height())?,
    };
    for (model, pose) in known {
        hidden.draw(|hidden| cover(&model, camera, &pose, hidden))?;
    }
    Ok(Some(hidden))
}

fn cover(model: &Model<'_>, camera: &Camera, pose: &Pose, hidden: &mut MaskMut<'_>) -> Result<()> {
    let mut scratch = vec![Projected::default(); scratch_needed(model)];
    let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
    drawn.draw(|mask| render(model, camera, pose, &mut scratch, mask))?;
    beside::hide(&drawn.mask(), hidden);
    Ok(())
}
