//! From an outline anywhere in the frame to a chosen, judged pose, in memory of a part of the frame.

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Decision, Found, Goal, find_into};
use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::crop::Crop;
use fluoropose::implant::ImplantFile;
use fluoropose::{RefineOptions, Silhouette};

use crate::failure::Failure;
pub(crate) use crate::implanted::opened;
use crate::implanted::{Arena, FRAME_SIDE, calibrated};
use crate::writing::{Write, pose_numbers, whole, words};

/// All that is worked in.
pub struct Memory {
    arena: Arena,
    found: Found,
}

impl Memory {
    /// Empty working memory.
    pub const fn new() -> Self {
        Self {
            arena: Arena::new(),
            found: Found::NOTHING,
        }
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

/// Finds the pose of `outline`, which stays where it is, and writes candidates, choice and verdict to `out`, with every bit,
/// which must agree between targets.
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
    let (pixels, mut finder) = memory.arena.borrow();
    let mask = crop.fill_outline(&outline, pixels)?;
    let silhouette = Silhouette::from(&mask).in_crop(&crop)?;
    stage("silhouette filled");
    let camera = calibrated()?.cropped(&crop)?;
    let component = implant.component();
    let options = RefineOptions::default();
    let found = &mut memory.found;
    find_into(
        &component,
        &camera,
        &silhouette,
        Goal::Outline,
        options,
        &mut finder,
        found,
    )?;
    let decision = found.decide(&ChoiceContext::default());
    let decision = decision.ok_or(Failure::NoPose)?;
    stage("candidates, mirror images, verdict");
    report(out, &crop, found, &decision)
}

#[inline(never)]
fn report(
    out: &mut dyn Write,
    crop: &Crop,
    found: &Found,
    decision: &Decision,
) -> Result<(), Failure> {
    let numbers = [
        (crop.width(), " x "),
        (crop.height(), " pixels, "),
        (found.candidates.len(), " candidates, "),
        (decision.choice.index, " chosen\n"),
    ];
    for (value, what) in numbers {
        whole(out, value as u64)?;
        words(out, &[what])?;
    }
    words(out, &[decision.verdict.word(), "\n"])?;
    let best = found.candidates.get(decision.choice.index);
    let best = best.ok_or(Failure::NoPose)?;
    pose_numbers(out, &best.pose)?;
    let drawings = best.refined.map_or(0, |refined| refined.renders);
    whole(out, drawings as u64)?;
    words(out, &[" drawings led to it\n"])?;
    Ok(())
}
