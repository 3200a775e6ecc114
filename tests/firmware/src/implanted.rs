//! The implant in flash, the camera that sees it, and the memory that both take: what finding a pose and refining one share.

use fluoropose::Camera;
use fluoropose::camera::CameraError;
use fluoropose::implant::{Aligned, ArenaNeeds, ImplantFile};

use crate::failure::Failure;

/// Columns and rows of the frame, pixels.
pub(crate) const FRAME_SIDE: usize = 512;

/// The implant: surface, edges, planes of symmetry and library.
pub(crate) static IMPLANT: Aligned<[u8; include_bytes!(env!("FLUOROPOSE_IMPLANT")).len()]> =
    Aligned(*include_bytes!(env!("FLUOROPOSE_IMPLANT")));

/// Columns and rows of the largest silhouette with its margin, pixels.
const COLUMNS: usize = 224;
const ROWS: usize = 288;
/// Pixels of the longest outline.
const BORDER: usize = 900;

fluoropose::finder_arena!(pub Arena, &IMPLANT.0, columns: COLUMNS, rows: ROWS, border: BORDER);
const _: () = assert!(
    size_of::<Arena>() == ArenaNeeds::of(&IMPLANT.0, COLUMNS, ROWS).bytes_for(BORDER),
    "what is told of an arena is what it takes"
);

/// The device's camera: a detector of 512 x 512 pixels of 0.4 mm, 1000 mm from the focus. It sees what the library's camera does, and
/// knows besides where its detector is, behind which nothing lies.
pub(crate) fn calibrated() -> Result<Camera, CameraError> {
    Camera::from_principal_distance(FRAME_SIDE, FRAME_SIDE, 1000.0, 0.4, [0.0; 2])
}

/// The implant, checked in all, by its checksums, and then trusted.
pub(crate) fn opened(stage: &mut dyn FnMut(&str)) -> Result<ImplantFile<'static>, Failure> {
    check()?;
    stage("implant opened, checked");
    sum()?;
    stage("implant opened, its checksums asked");
    let implant = ImplantFile::trusted(&IMPLANT.0)?;
    stage("implant opened, trusted");
    Ok(implant)
}

/// Checks every byte of the implant. By itself, because of what it leaves on the stack nothing is needed.
#[inline(never)]
fn check() -> Result<(), Failure> {
    ImplantFile::open(&IMPLANT.0)?;
    Ok(())
}

/// Checks that no byte has changed since.
#[inline(never)]
fn sum() -> Result<(), Failure> {
    ImplantFile::intact(&IMPLANT.0)?;
    Ok(())
}
