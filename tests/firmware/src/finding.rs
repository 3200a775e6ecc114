//! From an outline anywhere in the frame to a chosen, judged pose, in memory of a part of the frame.

use core::fmt::{self, Write};

use fluoropose::camera::CameraError;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Decision, FindError, Found, Goal, find_into};
use fluoropose::image::contour::{Outline, OutlineError, Point};
use fluoropose::image::crop::Crop;
use fluoropose::image::mask::MaskError;
use fluoropose::implant::{Aligned, ImplantError, ImplantFile};
use fluoropose::math::Decimal;
use fluoropose::pose::EulerPose;
use fluoropose::{Camera, RefineOptions, Silhouette};

use crate::memory::FRAME_SIDE;

/// The implant: surface, edges, planes of symmetry and library.
pub(crate) static IMPLANT: Aligned<
    [u8; include_bytes!(concat!(
        env!("FLUOROPOSE_FIRMWARE_INPUTS"),
        "/femur.implant"
    ))
    .len()],
> = Aligned(*include_bytes!(concat!(
    env!("FLUOROPOSE_FIRMWARE_INPUTS"),
    "/femur.implant"
)));

/// Columns and rows of the largest silhouette with its margin, pixels.
const COLUMNS: usize = 224;
const ROWS: usize = 288;
/// Pixels of the longest outline.
const BORDER: usize = 900;

fluoropose::finder_arena!(pub Arena, &IMPLANT.0, columns: COLUMNS, rows: ROWS, border: BORDER);

/// All that is worked in.
pub struct FindingMemory {
    arena: Arena,
    found: Found,
}

impl FindingMemory {
    /// Empty working memory.
    pub const fn new() -> Self {
        Self {
            arena: Arena::new(),
            found: Found::NOTHING,
        }
    }
}

impl Default for FindingMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// Why there is no pose.
#[derive(Debug)]
pub enum FindingFailure {
    /// The bytes in flash are no implant.
    Implant(ImplantError),
    /// The points in flash are no outline.
    Outline(OutlineError),
    /// Nothing was found.
    NoPose,
    /// The calibration is none, or that of other frames.
    Camera(CameraError),
    /// The mask of it is none.
    Mask(MaskError),
    /// No pose explains it.
    Find(FindError),
    /// A line could not be written.
    Write,
}

impl fmt::Display for FindingFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Implant(error) => write!(f, "{error}"),
            Self::Camera(error) => write!(f, "{error}"),
            Self::Outline(error) => write!(f, "{error}"),
            Self::NoPose => write!(f, "no pose explains the outline"),
            Self::Mask(error) => write!(f, "{error}"),
            Self::Find(error) => write!(f, "{error}"),
            Self::Write => write!(f, "a line could not be written"),
        }
    }
}

impl From<fmt::Error> for FindingFailure {
    fn from(_: fmt::Error) -> Self {
        Self::Write
    }
}

impl From<MaskError> for FindingFailure {
    fn from(error: MaskError) -> Self {
        Self::Mask(error)
    }
}

/// The device's camera: a detector of 512 x 512 pixels of 0.4 mm, 1000 mm from the focus. It sees what the library's camera does, and
/// knows besides where its detector is, behind which nothing lies.
fn calibrated() -> Result<Camera, CameraError> {
    Camera::from_principal_distance(FRAME_SIDE, FRAME_SIDE, 1000.0, 0.4, [0.0; 2])
}

/// Finds the pose of `outline`, which stays where it is, and writes candidates, choice and verdict to `out`, with every bit,
/// which must agree between targets.
///
/// `stage` is called with a stage's name after it.
///
/// # Errors
/// A [`FindingFailure`], in words through `Display`.
pub fn find_pose(
    outline: &[Point],
    memory: &mut FindingMemory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), FindingFailure> {
    check()?;
    stage("implant opened, checked");
    let implant = ImplantFile::trusted(&IMPLANT.0).map_err(FindingFailure::Implant)?;
    stage("implant opened, trusted");
    let outline = Outline::new(outline, FRAME_SIDE, FRAME_SIDE).map_err(FindingFailure::Outline)?;
    stage("outline checked");
    let crop = Crop::around_outline(&outline, Crop::MARGIN, [FRAME_SIDE; 2])?;
    let (words, mut finder) = memory.arena.borrow();
    let mask = crop.fill_outline(&outline, words)?;
    let silhouette = Silhouette::from(&mask).in_crop(&crop)?;
    stage("silhouette filled");
    let camera = calibrated().map_err(FindingFailure::Camera)?;
    let camera = camera.cropped(&crop).map_err(FindingFailure::Camera)?;
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
    )
    .map_err(FindingFailure::Find)?;
    let decision = found
        .decide(&ChoiceContext::default())
        .ok_or(FindingFailure::NoPose)?;
    stage("candidates, mirror images, verdict");
    report(out, &crop, found, &decision)
}

/// Checks every byte of the implant. By itself, because of what it leaves on the stack nothing is needed.
#[inline(never)]
fn check() -> Result<(), FindingFailure> {
    let checked = ImplantFile::open(&IMPLANT.0).map_err(FindingFailure::Implant);
    checked.map(drop)
}

#[inline(never)]
fn report(
    out: &mut dyn Write,
    crop: &Crop,
    found: &Found,
    decision: &Decision,
) -> Result<(), FindingFailure> {
    writeln!(
        out,
        "{} x {} pixels, {} candidates, {} chosen",
        crop.width(),
        crop.height(),
        found.candidates.len(),
        decision.choice.index
    )?;
    writeln!(out, "{}: {}", decision.verdict.word(), decision.verdict)?;
    let Some(best) = found.candidates.get(decision.choice.index) else {
        return Err(FindingFailure::NoPose);
    };
    let euler = EulerPose::from(best.pose);
    let numbers = [
        ("x mm", euler.x_mm),
        ("y mm", euler.y_mm),
        ("z mm", euler.z_mm),
        ("z_rot deg", euler.z_rot_deg),
        ("x_rot deg", euler.x_rot_deg),
        ("y_rot deg", euler.y_rot_deg),
    ];
    for (name, value) in numbers {
        writeln!(
            out,
            "  {name}: {} ({:016x})",
            Decimal::new(value, 6),
            value.to_bits()
        )?;
    }
    let drawings = best.refined.map_or(0, |refined| refined.renders);
    writeln!(out, "{drawings} drawings led to it")?;
    Ok(())
}
