//! Why a text is not a calibration, in words that say what to do.

use core::fmt;

use thiserror::Error;

use crate::camera::CameraError;

/// First line of a `JT_INTCALIB` file.
pub const JT_INTCALIB: &str = "JT_INTCALIB";
/// Heading of files of two cameras by a later program of the field.
pub(super) const OF_TWO: &str = "JTA_INTCALIB_BIPLANE";

/// Why a text is not a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CalibrationError {
    /// Neither heading was found.
    #[error(
        "this is not a calibration: it begins neither with JT_INTCALIB nor with the line 'image size' of a camera-matrix file, and holds no camera_matrix as OpenCV, ROS or MATLAB write it; five lines would do: JT_INTCALIB, and then in mm the distance from focus to detector, x (right) and y (up) of the principal point from the frame's middle, and the pixel pitch"
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
    /// More than one number stands where one is due, parted by a comma.
    #[error(
        "line {line} of the calibration holds a comma between digits, where one number is due: write a decimal comma as a point, 0.373"
    )]
    DecimalComma {
        /// Line, from 1.
        line: usize,
    },
    /// A camera matrix as others write it, for a reason that is theirs.
    #[error(transparent)]
    Exported(#[from] Unread),
    /// The camera matrix is written by columns.
    #[error(
        "the camera matrix is transposed, its principal point {},{} stands in the last row: write it by rows, fx,0,cx / 0,fy,cy / 0,0,1, and where it is MATLAB's take 1 from cx and cy, which it counts from 1",
        .0[0], .0[1]
    )]
    Transposed([f64; 2]),
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
        "the calibration is for frames of {} x {} pixels, but these have {} x {}: {}",
        calibration.0, calibration.1, frame.0, frame.1, sides(*calibration, *frame)
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

/// Why a camera matrix of others is not read, and what to do: words before and after a number, where one tells more. They stand where they are given, so that
/// who reads the two forms of the field alone does not carry them.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub struct Unread {
    before: &'static str,
    number: Option<f64>,
    after: &'static str,
}

impl Unread {
    pub(super) const fn new(sentence: &'static str) -> Self {
        Self {
            before: sentence,
            number: None,
            after: "",
        }
    }

    pub(super) const fn with(before: &'static str, number: f64, after: &'static str) -> Self {
        Self {
            before,
            number: Some(number),
            after,
        }
    }
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.before)?;
        self.number.map_or(Ok(()), |number| number.fmt(f))?;
        f.write_str(self.after)
    }
}

/// What to do about frames of another size.
fn sides((width, height): (usize, usize), frame: (usize, usize)) -> &'static str {
    match (height, width) == frame {
        true => {
            "these are its sides the other way round; if it has its height first, write width first, and if the frames were turned, give them as they were taken"
        }
        false => "it is of frames as they were taken, neither scaled nor cut",
    }
}
