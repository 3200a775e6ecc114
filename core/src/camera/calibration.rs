//! Calibration files: `JT_INTCALIB` and the camera matrix of MayaCam 2.0.

use core::fmt;

use heapless::Vec;
use thiserror::Error;

use crate::camera::{Camera, CameraError};
use crate::math::Matrix3;
use crate::pose::Pose;

/// First line of a `JT_INTCALIB` file.
pub const JT_INTCALIB: &str = "JT_INTCALIB";
/// The same file as a later program of the field heads it; read, never written.
const JTA_INTCALIB: &str = "JTA_INTCALIB";

/// Heading of files of two cameras by the same program.
const OF_TWO: &str = "JTA_INTCALIB_BIPLANE";

/// Why a text is not a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CalibrationError {
    /// Neither heading was found.
    #[error(
        "this is not a calibration: it begins neither with JT_INTCALIB nor with the line 'image size' of a camera-matrix file; five lines would do: JT_INTCALIB, and then in mm the distance from focus to detector, x (right) and y (up) of the principal point from the frame's middle, and the pixel pitch"
    )]
    UnknownKind,
    /// A file of two cameras.
    #[error(
        "the calibration is of two cameras ({OF_TWO}): give each a file of its own, {JT_INTCALIB} and four numbers"
    )]
    TwoCameras,
    /// A line is missing.
    #[error("the calibration ends before its {0}")]
    Missing(&'static str),
    /// A number cannot be read.
    #[error("line {line} of the calibration, the {name}, does not hold the numbers expected there")]
    Number {
        /// Line, from 1.
        line: usize,
        /// What was expected.
        name: &'static str,
    },
    /// A line is not the heading that is expected there.
    #[error(
        "line {line} of the calibration is not the heading '{name}': a camera-matrix file has image size, camera matrix, and rotation and translation or nothing more"
    )]
    Heading {
        /// Line, from 1.
        line: usize,
        /// What was expected.
        name: &'static str,
    },
    /// The camera matrix has a skew.
    #[error(
        "the camera matrix is not of the form fx,0,cx / 0,fy,cy / 0,0,1; skewed pixels are not supported"
    )]
    Matrix,
    /// The last row of the camera matrix is not 0, 0, 1.
    #[error(
        "the last row of the camera matrix is {},{},{}, but the matrix is of the form fx,0,cx / 0,fy,cy / 0,0,1: divide all of it by its last number, and write it by rows",
        .0[0], .0[1], .0[2]
    )]
    LastRow([f64; 3]),
    /// One more number stands below the pixel pitch.
    #[error(
        "line {line} of the calibration holds one more number below the pixel pitch, and nothing says what it is: one camera has JT_INTCALIB and four numbers; give each camera a file of its own, and leave other numbers out"
    )]
    OneMore {
        /// Line, from 1.
        line: usize,
    },
    /// A focal length of the camera matrix is negative.
    #[error(
        "the camera matrix has a negative focal length, {focal}: it is of a camera whose {axis} runs the other way; write it without the minus, and turn the signs of the {row} row of the rotation and the {row} number of the translation, where the file has them"
    )]
    Negative {
        /// The focal length, pixels.
        focal: f64,
        /// The camera's axis that it belongs to.
        axis: &'static str,
        /// That axis' place in rotation and translation.
        row: &'static str,
    },
    /// The rotation is not one.
    #[error("the calibration's rotation is not a rotation matrix")]
    Rotation,
    /// The frame has another size than the calibration names.
    #[error(
        "the calibration is for frames of {} x {} pixels, but these have {} x {}: it is of frames as they were taken, neither scaled nor cut",
        calibration.0, calibration.1, frame.0, frame.1
    )]
    FrameSize {
        /// Width and height in the file.
        calibration: (usize, usize),
        /// Width and height of the frame.
        frame: (usize, usize),
    },
    /// A value is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// A camera's calibration as its file describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Calibration {
    /// `JT_INTCALIB`: lengths in mm at the detector. It names no frame size.
    PrincipalDistance {
        /// Distance from focus to detector, mm.
        distance: f64,
        /// Principal point from the frame's centre, mm: x right, y up.
        offset: [f64; 2],
        /// Distance between pixels, mm.
        pitch: f64,
    },
    /// A camera matrix in the computer-vision convention, for one frame size.
    CameraMatrix {
        /// Width and height, pixels.
        size: (usize, usize),
        /// Focal lengths, pixels.
        focal: [f64; 2],
        /// Principal point: pixel indices, whole numbers at pixel centres.
        centre: [f64; 2],
        /// From laboratory to camera coordinates, in the file's own convention (camera along
        /// +z, y down), where the file says it.
        laboratory: Option<Pose>,
    },
}

impl Calibration {
    /// Reads either kind of file; its first line says which.
    ///
    /// # Errors
    /// [`CalibrationError`] says which line or value is wrong.
    pub fn parse(text: &str) -> Result<Self, CalibrationError> {
        let text = text.trim_start_matches('\u{feff}');
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty());
        match lines.next() {
            Some((_, first)) if first.starts_with(OF_TWO) => Err(CalibrationError::TwoCameras),
            Some((_, first))
                if first.starts_with(JT_INTCALIB) || first.starts_with(JTA_INTCALIB) =>
            {
                parse_principal(lines)
            }
            Some((_, first)) if first.eq_ignore_ascii_case("image size") => parse_matrix(lines),
            _ => Err(CalibrationError::UnknownKind),
        }
    }

    /// The camera for frames of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`CalibrationError::FrameSize`] when the file is for another size, or
    /// [`CalibrationError::Camera`] for an impossible value.
    pub fn camera(&self, width: usize, height: usize) -> Result<Camera, CalibrationError> {
        match *self {
            Self::PrincipalDistance {
                distance,
                offset,
                pitch,
            } => Ok(Camera::from_principal_distance(
                width, height, distance, pitch, offset,
            )?),
            Self::CameraMatrix {
                size,
                focal,
                centre,
                ..
            } => {
                if size != (width, height) {
                    return Err(CalibrationError::FrameSize {
                        calibration: size,
                        frame: (width, height),
                    });
                }
                Ok(Camera::new(width, height, focal, centre.map(|c| c + 0.5))?)
            }
        }
    }

    /// Where a knee is expected when nothing says so, mm from the focus: 0.9 of the principal distance, as knees stand
    /// before a detector close behind them; 1000 where the file does not state that. It sets the perspective of a library's
    /// views, which changes slowly with it, and a first pose a little; a refined pose does not depend on it.
    #[must_use]
    pub fn expected_distance(&self) -> f64 {
        const PART: f64 = 0.9;
        self.principal_distance()
            .map_or(1000.0, |distance| PART * distance)
    }

    /// Distances in mm of the libraries that a part is looked for with where nobody points at it, in the order in which they are tried: one
    /// where that was `told` or the file states the principal distance, else two, each of which serves parts from three quarters of it to a
    /// third more; of these the one alone that serves a part at `depth`, mm, where that is about known.
    #[must_use]
    pub fn search_distances(&self, told: Option<f64>, depth: Option<f64>) -> Vec<f64, 2> {
        const FARTHER: f64 = 1.3;
        const NEARER: f64 = 0.75;
        let usual = self.expected_distance();
        let both = [FARTHER * usual, NEARER * usual];
        let one = match (told, self.principal_distance(), depth) {
            (Some(told), _, _) => told,
            (None, Some(_), _) => usual,
            (None, None, None) => return Vec::from(both),
            (None, None, Some(depth)) => {
                let off = |distance: f64| libm::fabs(libm::log(distance / depth));
                both[usize::from(off(both[1]) < off(both[0]))]
            }
        };
        Vec::from([one])
    }

    /// Distance from focus to detector in mm, where the file states it.
    #[must_use]
    pub fn principal_distance(&self) -> Option<f64> {
        match *self {
            Self::PrincipalDistance { distance, .. } => Some(distance),
            Self::CameraMatrix { .. } => None,
        }
    }
}

/// Writes the file back: every number comes out as it went in.
impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PrincipalDistance {
                distance,
                offset: [x, y],
                pitch,
            } => write!(f, "{JT_INTCALIB}\n{distance}\n{x}\n{y}\n{pitch}\n"),
            Self::CameraMatrix {
                size: (width, height),
                focal: [fx, fy],
                centre: [cx, cy],
                laboratory,
            } => {
                writeln!(f, "image size\n{width},{height}\n")?;
                writeln!(f, "camera matrix\n{fx},0,{cx}\n0,{fy},{cy}\n0,0,1\n")?;
                let Some(laboratory) = laboratory else {
                    return Ok(());
                };
                writeln!(f, "rotation")?;
                for [a, b, c] in laboratory.rotation {
                    writeln!(f, "{a},{b},{c}")?;
                }
                writeln!(f, "\ntranslation")?;
                laboratory
                    .translation
                    .iter()
                    .try_for_each(|value| writeln!(f, "{value}"))
            }
        }
    }
}

fn numbers<const N: usize>(
    (line, text): (usize, &str),
    name: &'static str,
) -> Result<[f64; N], CalibrationError> {
    let mut values = [0.0; N];
    let mut fields = text
        .split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty());
    for value in &mut values {
        *value = fields
            .next()
            .and_then(|field| field.parse().ok())
            .filter(|value: &f64| value.is_finite())
            .ok_or(CalibrationError::Number { line, name })?;
    }
    match fields.next() {
        Some(_) => Err(CalibrationError::Number { line, name }),
        None => Ok(values),
    }
}

fn next_numbers<'a, const N: usize>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    name: &'static str,
) -> Result<[f64; N], CalibrationError> {
    numbers(lines.next().ok_or(CalibrationError::Missing(name))?, name)
}

fn parse_principal<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<Calibration, CalibrationError> {
    let [distance] = next_numbers(&mut lines, "principal distance")?;
    let [x] = next_numbers(&mut lines, "principal point x")?;
    let [y] = next_numbers(&mut lines, "principal point y")?;
    let [pitch] = next_numbers(&mut lines, "pixel pitch")?;
    // Notes stand there too, and three vectors of where the camera is in a laboratory, on which no pose in the camera's axes depends.
    for line in lines {
        if numbers::<1>(line, "").is_ok() {
            return Err(CalibrationError::OneMore { line: line.0 });
        }
    }
    // The values are checked now, against a frame of any size, so that a bad file is refused
    // when it is opened and not when the first frame is.
    Camera::from_principal_distance(1024, 1024, distance, pitch, [x, y])?;
    Ok(Calibration::PrincipalDistance {
        distance,
        offset: [x, y],
        pitch,
    })
}

fn parse_matrix<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<Calibration, CalibrationError> {
    let size = next_size(&mut lines)?;
    heading(&mut lines, "camera matrix")?;
    let k = next_matrix(&mut lines, "camera matrix")?;
    if k[2] != [0.0, 0.0, 1.0] {
        return Err(CalibrationError::LastRow(k[2]));
    }
    if k[0][1] != 0.0 || k[1][0] != 0.0 {
        return Err(CalibrationError::Matrix);
    }
    for (focal, axis, row) in [(k[0][0], "x", "first"), (k[1][1], "y", "second")] {
        if focal < 0.0 {
            return Err(CalibrationError::Negative { focal, axis, row });
        }
    }
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
    let calibration = Calibration::CameraMatrix {
        size,
        focal: [k[0][0], k[1][1]],
        centre: [k[0][2], k[1][2]],
        laboratory,
    };
    let camera = calibration.camera(size.0, size.1)?;
    in_pixels(&camera)?;
    Ok(calibration)
}

/// Refuses a matrix that is not in pixels but in parts of the frame, or in metres: no source shines on all that is before it.
fn in_pixels(camera: &Camera) -> Result<(), CameraError> {
    const LEAST: f64 = 0.1;
    let ([fx, fy], [width, height]) = (camera.focal(), [camera.width(), camera.height()]);
    for (name, value, side) in [
        ("horizontal focal length", fx, width),
        ("vertical focal length", fy, height),
    ] {
        if value < LEAST * side as f64 {
            let rule = "at least a tenth of the frame's side, in pixels";
            return Err(CameraError::Value { name, value, rule });
        }
    }
    Ok(())
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
fn is_heading(text: &str, name: &str) -> bool {
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

#[cfg(test)]
mod tests;
