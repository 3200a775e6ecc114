//! A model's silhouette in the memory of a click.

use fluoropose::camera::Camera;
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::RefineMemory;
use fluoropose::render::render;

/// The model's silhouette at a pose; `None` where it cannot be drawn.
pub(super) fn drawn_at<'m>(
    pose: &Pose,
    model: &Model<'_>,
    camera: &Camera,
    memory: &'m mut RefineMemory<'_>,
) -> Option<Mask<'m>> {
    let (width, height) = (camera.width(), camera.height());
    let words = memory.drawn.get_mut(..words_needed(width, height))?;
    let mut drawn = MaskMut::new(words, width, height).ok()?;
    render(model, camera, pose, memory.projected, &mut drawn).ok()?;
    Some(drawn.into_mask())
}
