//! From the pose of the frame before to that of this one, without a library: what following an implant takes.

use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::crop::Crop;
use fluoropose::implant::ImplantFile;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{CameraView, Refined, refine};
use fluoropose::{RefineOptions, Silhouette};

use crate::failure::Failure;
pub use crate::implanted::Arena as Memory;
pub(crate) use crate::implanted::opened;
use crate::implanted::{FRAME_SIDE, calibrated};
use crate::writing::{Write, number, pose_numbers, whole, words};

/// Where the implant was on the frame before: some 4 degrees, 3 mm in the plane and 15 mm of depth away.
const START: EulerPose = EulerPose {
    x_mm: 9.5,
    y_mm: -7.5,
    z_mm: -885.0,
    z_rot_deg: 27.0,
    x_rot_deg: 6.0,
    y_rot_deg: -1.8,
};

/// Refines [`START`] onto `outline` and writes the pose to `out`, with every bit, which must agree between targets.
///
/// `stage` is called with a stage's name after it.
///
/// # Errors
/// A [`Failure`].
pub(crate) fn pose_of(
    implant: &ImplantFile<'_>,
    outline: &[Point],
    memory: &mut Memory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let outline = Outline::new(outline, FRAME_SIDE, FRAME_SIDE)?;
    stage("outline checked");
    let crop = Crop::around_outline(&outline, Crop::MARGIN, [FRAME_SIDE; 2])?;
    let (pixels, mut finder) = memory.borrow();
    let mask = crop.fill_outline(&outline, pixels)?;
    let silhouette = Silhouette::from(&mask).in_crop(&crop)?;
    stage("silhouette filled");
    let camera = calibrated()?.cropped(&crop)?;
    let model = implant.component().model;
    let views = [CameraView::only(&camera, silhouette)];
    let options = RefineOptions::default();
    let start = Pose::from(START);
    let refined = refine(model, &views, &start, options, &mut finder.refine)?;
    stage("refined from one start");
    report(out, &refined)
}

#[inline(never)]
fn report(out: &mut dyn Write, refined: &Refined) -> Result<(), Failure> {
    pose_numbers(out, &refined.pose)?;
    number(out, "residual px", refined.residual_px)?;
    whole(out, refined.renders as u64)?;
    words(out, &[" drawings led to it\n"])?;
    Ok(())
}
