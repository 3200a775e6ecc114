//! From an outline anywhere in the frame to a library's poses, with every number written out.

use fluoropose::image::contour::{Outline, Point};
use fluoropose::image::crop::Crop;
use fluoropose::library::Library;
use fluoropose::locate::{Located, LocatedPoses, canonical_form, locate_form};
use fluoropose_kernels::fastest;

use crate::failure::Failure;
use crate::inputs::LIBRARY;
use crate::writing::{Write, number, pose_numbers, whole, words};

/// Rival poses to report.
const RIVALS: usize = 3;
/// Columns and rows of the largest silhouette, pixels. Nothing is drawn around it, so it needs no margin.
const COLUMNS: usize = 224;
const ROWS: usize = 288;

fluoropose::locate_arena!(pub Memory, LIBRARY, columns: COLUMNS, rows: ROWS);

/// The library, checked in all, by its checksums, and then trusted.
pub(crate) fn opened(stage: &mut dyn FnMut(&str)) -> Result<Library<'static>, Failure> {
    check()?;
    stage("library opened, checked");
    sum()?;
    stage("library opened, its checksums asked");
    let library = Library::trusted(LIBRARY)?;
    stage("library opened, trusted");
    Ok(library)
}

/// Checks every byte of the library. By itself, because of what it leaves on the stack nothing is needed.
#[inline(never)]
fn check() -> Result<(), Failure> {
    Library::open(LIBRARY)?;
    Ok(())
}

/// Checks that no byte has changed since.
#[inline(never)]
fn sum() -> Result<(), Failure> {
    Library::intact(LIBRARY)?;
    Ok(())
}

/// Goes from `outline` to the poses that explain it and writes each result to `out`.
///
/// `stage` is called with a stage's name after it: a place to look at a clock.
///
/// # Errors
/// A [`Failure`].
pub(crate) fn pose_of(
    library: &Library<'_>,
    outline: &[Point],
    memory: &mut Memory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let camera = library.info().camera;
    let frame = [camera.width(), camera.height()];
    let outline = Outline::new(outline, frame[0], frame[1])?;
    stage("outline checked");
    let crop = Crop::around_outline(&outline, 0, frame)?;
    let camera = camera.cropped(&crop)?;
    let (pixels, mut work) = memory.borrow();
    work.kernels = fastest();
    let mask = crop.fill_outline(&outline, pixels)?;
    stage("silhouette filled");

    let form = canonical_form(&mask, &camera, library, &mut work)?;
    // The mask is needed no more.
    let work = work.with_words(pixels);
    let found = locate_form(&form, &camera, library, work);
    stage("canonical form, match, pose");
    // Not moved: it is long.
    match &found {
        Ok(found) => report(out, library, &crop, found),
        Err(error) => Err((*error).into()),
    }
}

#[inline(never)]
fn report(
    out: &mut dyn Write,
    library: &Library<'_>,
    crop: &Crop,
    found: &LocatedPoses<RIVALS>,
) -> Result<(), Failure> {
    whole(out, library.views() as u64)?;
    words(out, &[" views\n"])?;
    whole(out, found.form.area_px)?;
    words(out, &[" px\n"])?;
    let (columns, rows) = (crop.columns(), crop.rows());
    let centroid = found.form.centroid;
    number(
        out,
        "centroid column",
        columns.start as f64 + centroid.column,
    )?;
    number(out, "centroid row", rows.start as f64 + centroid.row)?;
    number(out, "axis angle rad", found.form.angle)?;
    number(out, "canonical scale", found.form.scale)?;
    for located in &found.poses {
        let Located {
            pose, view, fine, ..
        } = located;
        words(out, &["view "])?;
        whole(out, *view as u64)?;
        words(out, &[": "])?;
        whole(out, fine.unmatched.into())?;
        words(out, &[" px unmatched"])?;
        let (rotated, at_border) = (fine.reversed, fine.at_border);
        words(out, &[if rotated { ", rotated" } else { "" }])?;
        words(out, &[if at_border { ", at the border\n" } else { "\n" }])?;
        pose_numbers(out, pose)?;
        for value in pose.rotation.into_iter().flatten() {
            number(out, "  rotation", value)?;
        }
    }
    match found.poses.is_empty() {
        true => Err(Failure::NoPose),
        false => Ok(()),
    }
}
