//! MayaCam 2.0: an image's size, a camera matrix, rotation and translation, each below its heading.

use super::error::CalibrationError;
use super::lines::{next_numbers, numbers};
use super::matrix::Intrinsics;
use crate::math::Matrix3;
use crate::pose::Pose;

/// Reads what follows the line "image size": the camera's numbers, and where it stands, where the file says it.
pub(super) fn read<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<(Intrinsics, Option<Pose>), CalibrationError> {
    let size = next_size(&mut lines)?;
    heading(&mut lines, "camera matrix")?;
    let k = next_matrix(&mut lines, "camera matrix")?;
    let read = Intrinsics::of(&k, size)?;
    let mut laboratory = None;
    let mut lines = lines.peekable();
    // A file of another form would lose where the camera stands, or its distortion, without a word.
    if lines.peek().is_some() {
        heading(&mut lines, "rotation")?;
        let mut pose = Pose::IDENTITY;
        pose.rotation = next_matrix(&mut lines, "rotation")?;
        if !pose.is_rigid(1e-3) {
            return Err(CalibrationError::Rotation);
        }
        heading(&mut lines, "translation")?;
        pose.translation = next_translation(&mut lines)?;
        laboratory = Some(pose);
    }
    Ok((read, laboratory))
}

/// Width and height, which are whole numbers.
fn next_size<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<(usize, usize), CalibrationError> {
    let name = "image size";
    let (line, text) = lines.next().ok_or(CalibrationError::Missing(name))?;
    let size: [f64; 2] = numbers((line, text), name)?;
    let [width, height] = size.map(|side| side as usize);
    if [width, height].map(|side| side as f64) != size {
        return Err(CalibrationError::Number { line, name });
    }
    Ok((width, height))
}

fn heading<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    name: &'static str,
) -> Result<(), CalibrationError> {
    match lines.next() {
        Some((_, text)) if is_heading(text, name) => Ok(()),
        Some((line, _)) => Err(CalibrationError::Heading { line, name }),
        None => Err(CalibrationError::Missing(name)),
    }
}

/// Some write it with a colon, or say what it is.
pub(super) fn is_heading(text: &str, name: &str) -> bool {
    let text = text.trim_end_matches(':').trim_end();
    let (Some(begin), Some(rest)) = (text.get(..name.len()), text.get(name.len()..)) else {
        return false;
    };
    let is_rest = |known: &str| rest.trim_start().eq_ignore_ascii_case(known);
    begin.eq_ignore_ascii_case(name) && ["", "matrix", "vector"].into_iter().any(is_rest)
}

fn next_matrix<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    name: &'static str,
) -> Result<Matrix3, CalibrationError> {
    Ok([
        next_numbers(lines, name)?,
        next_numbers(lines, name)?,
        next_numbers(lines, name)?,
    ])
}

/// Three numbers, which files have on one line or on a line each.
fn next_translation<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<[f64; 3], CalibrationError> {
    let name = "translation";
    let first = lines.next().ok_or(CalibrationError::Missing(name))?;
    if let Ok(all) = numbers::<3>(first, name) {
        return Ok(all);
    }
    let [x] = numbers(first, name)?;
    let [y] = next_numbers(lines, name)?;
    let [z] = next_numbers(lines, name)?;
    Ok([x, y, z])
}
