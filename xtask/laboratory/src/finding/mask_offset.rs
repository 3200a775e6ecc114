//! How far the masks of a source lie off the film's edges everywhere alike, and poses without that.

use fluoropose::finder::onto_target;
use fluoropose::image::silhouette::CommonOffset;
use fluoropose::refine::{CameraView, RefineBuffers, outline_offset};
use fluoropose_report::plus_minus;
use rayon::prelude::*;

use super::film::FrameFound;
use super::filmed::Filmed;

impl Filmed<'_> {
    /// How far the masks lie off the outlines that poses on the frames have. The film tells nothing of it where it is not known.
    pub fn mask_offset(&self) -> Option<CommonOffset> {
        let camera = self.sequence.camera();
        let tell = |buffers: &mut RefineBuffers, (frame, found): (usize, &FrameFound)| {
            let best = found.candidates.first()?;
            let look = self.sequence.look(frame, |seen| {
                let view = CameraView::only(&camera, seen.silhouette);
                let mut memory = buffers.borrow(&self.model, &camera);
                Ok(outline_offset(&self.model, view, &best.pose, &mut memory)?)
            });
            look.ok().flatten()
        };
        let frames = self.found.par_iter().enumerate();
        let single: Vec<_> = frames.map_init(RefineBuffers::default, tell).collect();
        CommonOffset::of(&single.into_iter().flatten().collect::<Vec<f64>>())
    }

    /// Poses that outlines led to, refined on these as they lie without what they have in common.
    pub fn without_offset(&self, outlines: &[FrameFound], common: CommonOffset) -> Vec<FrameFound> {
        let (camera, options) = (self.sequence.camera(), self.options());
        let refine = |buffers: &mut RefineBuffers, (frame, outline): (usize, &FrameFound)| {
            let refined = self.sequence.look(frame, |seen| {
                let silhouette = seen.silhouette.lying_off(common);
                let mut memory = buffers.borrow(&self.model, &camera);
                let (model, from) = (&self.model, &outline.candidates);
                Ok(onto_target(
                    model,
                    &camera,
                    silhouette,
                    from,
                    options,
                    &mut memory,
                )?)
            });
            match (outline.candidates.is_empty(), refined) {
                (false, Ok(candidates)) => FrameFound {
                    candidates: candidates.to_vec(),
                    ..outline.clone()
                },
                _ => outline.clone(),
            }
        };
        let frames = outlines.par_iter().enumerate();
        frames.map_init(RefineBuffers::default, refine).collect()
    }
}

/// As a person would say it.
pub fn offset_words(common: CommonOffset) -> String {
    let side = if common.px < 0.0 { "inside" } else { "outside" };
    let CommonOffset { px, deviation_px } = common;
    format!(
        "masks lie {} px {side} of the outlines that the film shows",
        plus_minus(px.abs(), deviation_px, 2)
    )
}
