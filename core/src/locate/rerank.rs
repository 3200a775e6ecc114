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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::mask::{Mask, words_needed};
    use crate::library::ViewRecord;
    use crate::locate::interpolate::FineView;
    use crate::mesh::edges::fake::add_box;
    use crate::render::scratch_needed;
    use std::vec::Vec as List;

    const SIDE: usize = 96;

    fn located(x_mm: f64, z_mm: f64) -> Located {
        Located {
            pose: Pose {
                translation: [x_mm, 0.0, z_mm],
                ..Pose::IDENTITY
            },
            view: 0,
            fine: FineView {
                record: ViewRecord::default(),
                reversed: false,
                unmatched: 0,
                at_border: false,
            },
            by_pieces: false,
        }
    }

    /// Of how many pixels each pose, by what it lies aside, differs from one that lies where the silhouette does.
    fn reranked<const K: usize>(poses: &[Located]) -> Result<List<(f64, u64)>, RenderError> {
        let (mut vertices, mut triangles) = (List::new(), List::new());
        add_box(
            [-10.0, -5.0, -1.0],
            [10.0, 5.0, 1.0],
            &mut vertices,
            &mut triangles,
        );
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        // At 99 mm from the focus, where its nearer side is, two pixels a mm.
        let camera = Camera::new(SIDE, SIDE, [198.0; 2], [48.0; 2]).expect("valid");
        let mut scratch = std::vec![Projected::default(); scratch_needed(&model)];
        let mut drawn = std::vec![0; words_needed(SIDE, SIDE)];
        let mut drawn = MaskMut::new(&mut drawn, SIDE, SIDE).expect("fits");
        let mut seen = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut seen, SIDE, SIDE).expect("fits");
        (38..58).for_each(|row| mask.fill_span(row, 28, 68));
        let mask: Mask<'_> = mask.into_mask();
        let silhouette = Silhouette::from(&mask);
        let found: Vec<Reranked, K> = rerank(
            poses,
            &model,
            &camera,
            &silhouette,
            &mut scratch,
            &mut drawn,
        )?;
        let told = found
            .iter()
            .map(|one| (one.located.pose.translation[0], one.unmatched));
        Ok(told.collect())
    }

    #[test]
    fn poses_are_put_in_order_by_the_pixels_in_which_they_differ() {
        let poses = [3.0, -1.0, 0.0, 2.0].map(|x| located(x, -100.0));
        // Two pixels a mm, of twenty rows, at either end; of the farther side nothing is seen beside the nearer.
        let all = [(0.0, 0), (-1.0, 80), (2.0, 160), (3.0, 240)];
        assert_eq!(reranked::<4>(&poses), Ok(all.to_vec()));
        // Only the first are drawn.
        assert_eq!(reranked::<2>(&poses), Ok([all[1], all[3]].to_vec()));
        assert_eq!(reranked::<4>(&[]), Ok(List::new()));
    }

    #[test]
    fn a_pose_at_the_focus_is_left_out_and_told_where_there_is_no_other() {
        let (good, bad) = (located(-1.0, -100.0), located(0.0, 0.5));
        assert_eq!(reranked::<4>(&[bad, good]), Ok([(-1.0, 80)].to_vec()));
        assert_eq!(reranked::<4>(&[good, bad]), Ok([(-1.0, 80)].to_vec()));
        let error = reranked::<4>(&[bad, bad]);
        assert!(
            matches!(error, Err(RenderError::BehindCamera(_))),
            "{error:?}"
        );
    }
}
