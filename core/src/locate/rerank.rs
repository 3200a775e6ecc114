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
use crate::pace::{Pace, at_once};
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
    let (mut reranked, pace) = (Vec::new(), Pace::new());
    let seen = (camera, silhouette);
    let work = rerank_paced(poses, model, seen, (scratch, drawn), &pace, &mut reranked);
    at_once(&pace, work)?;
    Ok(reranked)
}

/// The same in slices, a drawing each, into a list that was empty.
pub(crate) async fn rerank_paced<const K: usize>(
    poses: &[Located],
    model: &Model<'_>,
    (camera, silhouette): (&Camera, &Silhouette<'_>),
    (scratch, drawn): (&mut [Projected], &mut MaskMut<'_>),
    pace: &Pace,
    reranked: &mut Vec<Reranked, K>,
) -> Result<(), RenderError> {
    let mut undrawable = None;
    for &located in poses.iter().take(K) {
        pace.pause().await;
        match unmatched_at_pose(model, camera, &located.pose, silhouette, scratch, drawn) {
            Ok(unmatched) => {
                let own = Reranked { located, unmatched };
                keep(reranked, own, |other| other.unmatched);
            }
            Err(error @ RenderError::BehindCamera(_)) => undrawable = Some(error),
            Err(error) => return Err(error),
        }
    }
    match undrawable.filter(|_| reranked.is_empty()) {
        Some(error) => Err(error),
        None => Ok(()),
    }
}
