//! Reranking of rival poses: the model is drawn at each and the pixels that differ are counted.
//!
//! The scores of [`crate::search`] are those of whole views; two rivals may differ by less
//! than the poses differ from the nearest view. Drawn at its own pose, each rival is judged by itself.

use heapless::Vec;

use crate::camera::Camera;
use crate::image::mask::MaskMut;
use crate::image::silhouette::Silhouette;
use crate::locate::whole::Located;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::{Projected, RenderError, render};
use crate::shortlist::keep;

/// A located pose and how well the model drawn at it covers the silhouette.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reranked {
    /// The pose and the view that led to it.
    pub located: Located,
    /// Known frame pixels in the silhouette or in the drawing but not in both.
    pub unmatched: u64,
}

/// Known frame pixels that differ between `silhouette` and the model drawn at `pose`. `scratch` and `drawn`
/// are working memory as for [`render`]; `drawn` holds the drawing afterwards.
///
/// # Errors
/// Those of [`render`]; [`RenderError::Size`] also where `silhouette` has another size.
pub fn unmatched_at_pose(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    silhouette: &Silhouette<'_>,
    scratch: &mut [Projected],
    drawn: &mut MaskMut<'_>,
) -> Result<u64, RenderError> {
    drawn.clear();
    render(model, camera, pose, scratch, drawn)?;
    silhouette
        .unmatched(&drawn.as_mask())
        .ok_or(RenderError::Size)
}

/// Draws the model at each pose and puts the poses in order, fewest differing pixels first. Of
/// more than `K` poses only the first `K` are drawn. A pose at which the model reaches the focus explains nothing and is
/// left out.
///
/// # Errors
/// Those of [`unmatched_at_pose`]; that of a pose only where the model can be drawn at none.
pub fn rerank<const K: usize>(
    poses: &[Located],
    model: &Model<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    scratch: &mut [Projected],
    drawn: &mut MaskMut<'_>,
) -> Result<Vec<Reranked, K>, RenderError> {
    let mut reranked = Vec::new();
    let mut undrawable = None;
    for located in poses.iter().take(K) {
        let (seen, memory) = ((camera, silhouette), (&mut *scratch, &mut *drawn));
        let error = add_drawn(located, model, seen, memory, &mut reranked)?;
        undrawable = error.or(undrawable);
    }
    match undrawable.filter(|_| reranked.is_empty()) {
        Some(error) => Err(error),
        None => Ok(reranked),
    }
}

/// The same of one pose; gives the error of one that cannot be drawn.
///
/// # Errors
/// Those for which none can.
pub(crate) fn add_drawn<const K: usize>(
    located: &Located,
    model: &Model<'_>,
    (camera, silhouette): (&Camera, &Silhouette<'_>),
    (scratch, drawn): (&mut [Projected], &mut MaskMut<'_>),
    reranked: &mut Vec<Reranked, K>,
) -> Result<Option<RenderError>, RenderError> {
    let pose = &located.pose;
    match unmatched_at_pose(model, camera, pose, silhouette, scratch, drawn) {
        Ok(unmatched) => {
            let located = *located;
            let own = Reranked { located, unmatched };
            keep(reranked, own, |other| other.unmatched);
            Ok(None)
        }
        Err(error @ RenderError::BehindCamera(_)) => Ok(Some(error)),
        Err(error) => Err(error),
    }
}
