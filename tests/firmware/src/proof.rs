//! Outline to mask to canonical form to views to pose, with every number written out.

use core::fmt::{self, Write};

use fluoropose::image::contour::{Contour, Outline, OutlineError, Point};
use fluoropose::image::mask::{MaskError, MaskMut};
use fluoropose::library::{Library, LibraryError};
use fluoropose::locate::{LocateError, Located, LocatedPoses, Workspace, locate};
use fluoropose::math::Decimal;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::search::kernels::Kernels;

use crate::memory::{FRAME_SIDE, MAX_POINTS, Memory};

/// Rival poses to report.
const RIVALS: usize = 3;

/// Why there is no proof.
#[derive(Debug)]
pub enum Failure {
    /// The bytes in flash are no library.
    Library(LibraryError),
    /// The bytes in flash are not whole vertices, or more than there is room for.
    OutlineBytes(usize),
    /// The vertices are no outline.
    Outline(OutlineError),
    /// The working memory holds no mask of the frame.
    Mask(MaskError),
    /// No pose was found.
    Locate(LocateError),
    /// The score surface has no minimum.
    NoPose,
    /// A line could not be written.
    Write,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(error) => write!(f, "{error}"),
            Self::OutlineBytes(bytes) => write!(
                f,
                "the outline has {bytes} bytes; it needs 16 a vertex, for at most {MAX_POINTS}"
            ),
            Self::Outline(error) => write!(f, "{error}"),
            Self::Mask(error) => write!(f, "{error}"),
            Self::Locate(error) => write!(f, "{error}"),
            Self::NoPose => write!(f, "no view of the library fits better than its neighbours"),
            Self::Write => write!(f, "a line could not be written"),
        }
    }
}

impl From<fmt::Error> for Failure {
    fn from(_: fmt::Error) -> Self {
        Self::Write
    }
}

/// Goes from `outline` (as in [`crate::OUTLINE`]) to the poses that explain it and writes each result to `out`.
///
/// `stage` is called with a stage's name after it: a place to look at a clock.
///
/// # Errors
/// A [`Failure`], in words through `Display`.
pub fn prove(
    library: &[u8],
    outline: &[u8],
    memory: &mut Memory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let library = Library::open(library).map_err(Failure::Library)?;
    stage("library opened and checked");
    let info = library.info();
    let [a, b, c, d, ..] = info.model;
    writeln!(
        out,
        "library: {} views, model {:08x}",
        library.views(),
        u32::from_be_bytes([a, b, c, d])
    )?;

    read_outline(outline, &mut memory.points)?;
    let outline = Outline::new(&memory.points, FRAME_SIDE, FRAME_SIDE).map_err(Failure::Outline)?;
    stage("outline checked");
    writeln!(out, "outline: {} points", outline.points().len())?;
    number(out, "outline area px", outline.area())?;

    let mut mask = MaskMut::new(&mut memory.mask, FRAME_SIDE, FRAME_SIDE).map_err(Failure::Mask)?;
    mask.fill_outline(&outline);
    let mask = mask.into_mask();
    stage("mask filled");
    writeln!(out, "mask: {} px", mask.area())?;

    let work = Workspace {
        canonical: &mut memory.canonical,
        rotated: &mut memory.turned,
        scores: &mut memory.scores,
        bytes: &mut memory.bytes,
        kernels: Kernels::PORTABLE,
    };
    let found: LocatedPoses<RIVALS> =
        locate(&mask, &info.camera, &library, work).map_err(Failure::Locate)?;
    stage("canonical form, match, pose");
    report(out, &found)
}

pub(crate) fn read_outline(bytes: &[u8], points: &mut Contour<MAX_POINTS>) -> Result<(), Failure> {
    points.clear();
    let (vertices, rest) = bytes.as_chunks::<16>();
    if !rest.is_empty() {
        return Err(Failure::OutlineBytes(bytes.len()));
    }
    for vertex in vertices {
        let (halves, _) = vertex.as_chunks::<8>();
        let &[column, row] = halves else {
            return Err(Failure::OutlineBytes(bytes.len()));
        };
        let point = Point {
            column: f64::from_le_bytes(column),
            row: f64::from_le_bytes(row),
        };
        points
            .push(point)
            .map_err(|_| Failure::OutlineBytes(bytes.len()))?;
    }
    Ok(())
}

fn report(out: &mut dyn Write, found: &LocatedPoses<RIVALS>) -> Result<(), Failure> {
    number(out, "centroid column", found.form.centroid.column)?;
    number(out, "centroid row", found.form.centroid.row)?;
    number(out, "axis angle rad", found.form.angle)?;
    number(out, "canonical scale", found.form.scale)?;
    for located in &found.poses {
        let Located {
            pose, view, fine, ..
        } = located;
        writeln!(
            out,
            "view {view}: reversed {}, unmatched {} px, at border {}",
            fine.reversed, fine.unmatched, fine.at_border
        )?;
        report_pose(out, pose)?;
    }
    match found.poses.is_empty() {
        true => Err(Failure::NoPose),
        false => Ok(()),
    }
}

fn report_pose(out: &mut dyn Write, pose: &Pose) -> Result<(), Failure> {
    let euler = EulerPose::from(*pose);
    number(out, "  x mm", euler.x_mm)?;
    number(out, "  y mm", euler.y_mm)?;
    number(out, "  z mm", euler.z_mm)?;
    number(out, "  z_rot deg", euler.z_rot_deg)?;
    number(out, "  x_rot deg", euler.x_rot_deg)?;
    number(out, "  y_rot deg", euler.y_rot_deg)?;
    for row in pose.rotation {
        for value in row {
            number(out, "  rotation", value)?;
        }
    }
    Ok(())
}

/// A number twice: for people, and with every bit.
fn number(out: &mut dyn Write, name: &str, value: f64) -> Result<(), Failure> {
    Ok(writeln!(
        out,
        "{name}: {} ({:016x})",
        Decimal::new(value, 6),
        value.to_bits()
    )?)
}
