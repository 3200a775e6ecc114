//! Camera matrices as OpenCV, ROS and MATLAB write them.

mod unread;

use super::error::CalibrationError;
use super::keyed::{Token, Tokens};
use super::lines::{lines_of, numbers};
use super::matrix::{Intrinsics, is_transposed};
use super::meaning::{Meaning, is_of_matlab, meaning};
use crate::math::Matrix3;

/// So many numbers of a value are kept; the others are counted.
const KEPT: usize = 9;

/// The numbers that follow a key.
#[derive(Clone, Copy)]
struct Value {
    meaning: Meaning,
    numbers: [f64; KEPT],
    count: usize,
    /// The largest of them all.
    largest: f64,
    is_open: bool,
}

impl Value {
    fn of(meaning: Meaning) -> Self {
        Self {
            meaning,
            numbers: [0.0; KEPT],
            count: 0,
            largest: 0.0,
            is_open: true,
        }
    }

    fn push(&mut self, number: f64) {
        if !self.is_open {
            return;
        }
        if let Some(place) = self.numbers.get_mut(self.count) {
            *place = number;
        }
        self.count += 1;
        // What is no number stays the largest.
        if number.is_nan() || number.abs() > self.largest.abs() {
            self.largest = number;
        }
    }

    fn pair(&self) -> Option<[f64; 2]> {
        (self.count == 2).then(|| [self.numbers[0], self.numbers[1]])
    }
}

/// What was found of one camera.
#[derive(Default)]
struct Found {
    matrix: Option<Matrix3>,
    focal: Option<[f64; 2]>,
    point: Option<[f64; 2]>,
    both: Option<[f64; 2]>,
    width: Option<f64>,
    height: Option<f64>,
    skew: f64,
    distortion: f64,
    region: f64,
    /// Pixels count from 1, and the height stands first.
    is_matlab: bool,
}

/// Reads a camera matrix that is none of this field's files.
///
/// # Errors
/// Says what the file was taken for, and what to do.
pub(super) fn read(text: &str) -> Result<Intrinsics, CalibrationError> {
    bare_numbers(text)?;
    let mut found = Found::default();
    let mut value = Value::of(Meaning::Other);
    for token in Tokens::of(text) {
        match token {
            Token::Number(number) => value.push(number),
            Token::Word => {}
            Token::Key(key) => match meaning(key) {
                Meaning::Form => {}
                Meaning::Sides => value.is_open = false,
                Meaning::Data => value = Value::of(value.meaning),
                meaning => {
                    found.take(&value)?;
                    value = Value::of(meaning);
                    found.is_matlab |= is_of_matlab(key);
                }
            },
        }
    }
    found.take(&value)?;
    found.intrinsics()
}

/// Refuses lines of three numbers and nothing else, which do not say enough.
fn bare_numbers(text: &str) -> Result<(), CalibrationError> {
    let is_bare = lines_of(text).all(|line| numbers::<3>(line, "").is_ok());
    match lines_of(text).count() {
        3 if is_bare => Err(unread::NINE_NUMBERS.into()),
        5 if is_bare => Err(unread::MAYACAM_1.into()),
        _ => Ok(()),
    }
}

impl Found {
    fn take(&mut self, value: &Value) -> Result<(), CalibrationError> {
        let [first, ..] = value.numbers;
        if value.count == 0 {
            return Ok(());
        }
        match value.meaning {
            // Coefficients of a distortion have these names too.
            Meaning::Matrix { .. } if value.count == 1 => self.add_distortion(value),
            Meaning::Matrix { is_matlab } => self.add_matrix(value, is_matlab)?,
            Meaning::Focal => self.focal = value.pair(),
            Meaning::Point => self.point = value.pair(),
            Meaning::Size => self.both = value.pair(),
            Meaning::Width => only(&mut self.width, value)?,
            Meaning::Height => only(&mut self.height, value)?,
            Meaning::Distortion => self.add_distortion(value),
            Meaning::Region if first != 0.0 => self.region = first,
            Meaning::Binning if first != 0.0 && first != 1.0 => self.region = first,
            Meaning::Skew if value.largest != 0.0 => self.skew = value.largest,
            _ => {}
        }
        Ok(())
    }

    fn add_distortion(&mut self, value: &Value) {
        if value.largest != 0.0 {
            self.distortion = value.largest;
        }
    }

    fn add_matrix(&mut self, value: &Value, is_matlab: bool) -> Result<(), CalibrationError> {
        if value.count != KEPT {
            return Err(unread::count(value.count).into());
        }
        let at = |row: usize, column: usize| value.numbers[3 * row + column];
        let k = core::array::from_fn(|row| core::array::from_fn(|column| at(row, column)));
        let k = match is_matlab {
            true if is_transposed(&k) => {
                core::array::from_fn(|row| core::array::from_fn(|column| at(column, row)))
            }
            true => return Err(unread::BY_ROWS.into()),
            false => k,
        };
        match self.matrix.replace(k) {
            Some(other) if other != k => Err(unread::SEVERAL.into()),
            _ => Ok(()),
        }
    }

    fn intrinsics(&self) -> Result<Intrinsics, CalibrationError> {
        let k = match (self.matrix, self.focal, self.point) {
            (Some(k), ..) => k,
            (None, Some([fx, fy]), Some([cx, cy])) => {
                [[fx, self.skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]
            }
            _ => return Err(CalibrationError::UnknownKind),
        };
        // Of a matrix that is no matrix other faults say nothing.
        let size = self.size()?;
        let mut read = Intrinsics::of(&k, size)?;
        if self.skew != 0.0 {
            return Err(CalibrationError::Matrix);
        }
        if self.distortion != 0.0 {
            return Err(unread::distorted(self.distortion).into());
        }
        if self.region != 0.0 {
            return Err(unread::region(self.region).into());
        }
        if self.is_matlab {
            read.centre = read.centre.map(|place| place - 1.0);
        }
        Ok(read)
    }

    fn size(&self) -> Result<(usize, usize), CalibrationError> {
        let [width, height] = match (self.both, self.width, self.height) {
            (_, Some(width), Some(height)) => [width, height],
            (Some([height, width]), ..) if self.is_matlab => [width, height],
            (Some(both), ..) => both,
            _ => return Err(unread::NO_SIZE.into()),
        };
        let sides = [width, height].map(|side| side as usize);
        match sides.map(|side| side as f64) == [width, height] {
            true => Ok((sides[0], sides[1])),
            false => Err(unread::SIZE.into()),
        }
    }
}

/// A side that is stated once, or several times alike: that of a region is 0 where all is meant.
fn only(side: &mut Option<f64>, value: &Value) -> Result<(), CalibrationError> {
    let [stated, ..] = value.numbers;
    if stated == 0.0 {
        return Ok(());
    }
    if value.count != 1 || side.is_some_and(|known| known != stated) {
        return Err(unread::SIZE.into());
    }
    *side = Some(stated);
    Ok(())
}

#[cfg(test)]
mod tests;
