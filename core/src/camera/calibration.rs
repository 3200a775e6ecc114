//! Calibration files: `JT_INTCALIB`, and camera matrices as MayaCam 2.0 and others write them.

mod error;
mod exported;
mod keyed;
mod lines;
mod matrix;
mod mayacam;
mod meaning;
mod principal;

use core::fmt;

use heapless::Vec;

pub use error::{CalibrationError, JT_INTCALIB, Unread};

use crate::camera::Camera;
use crate::math::Vector3;
use crate::pose::Pose;
use error::OF_TWO;
use lines::lines_of;
use matrix::Intrinsics;

/// The same file as a later program of the field heads it; read, never written.
const JTA_INTCALIB: &str = "JTA_INTCALIB";

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
    /// Reads any kind of file; its first line says which.
    ///
    /// # Errors
    /// [`CalibrationError`] says which line or value is wrong.
    pub fn parse(text: &str) -> Result<Self, CalibrationError> {
        match Self::parse_own(text)? {
            Some(own) => Ok(own),
            None => Ok(Self::of_matrix(exported::read(without_mark(text))?, None)),
        }
    }

    /// Reads the two kinds that [`Display`](fmt::Display) writes, `JT_INTCALIB` and MayaCam 2.0; `None` where a text is of another.
    ///
    /// # Errors
    /// Those of [`Self::parse`].
    pub fn parse_own(text: &str) -> Result<Option<Self>, CalibrationError> {
        let text = without_mark(text);
        let mut lines = lines_of(text);
        let (line, first) = lines.next().ok_or(CalibrationError::UnknownKind)?;
        if first.starts_with(OF_TWO) {
            return Err(CalibrationError::TwoCameras);
        }
        let rest = [JT_INTCALIB, JTA_INTCALIB].into_iter();
        if let Some(rest) = rest
            .filter_map(|heading| first.strip_prefix(heading))
            .next()
        {
            return Self::of_principal(principal::read((line, rest), lines)?).map(Some);
        }
        if !mayacam::is_heading(first, "image size") {
            return Ok(None);
        }
        let (read, laboratory) = mayacam::read(lines)?;
        Ok(Some(Self::of_matrix(read, laboratory)))
    }

    fn of_matrix(read: Intrinsics, laboratory: Option<Pose>) -> Self {
        let Intrinsics {
            size,
            focal,
            centre,
        } = read;
        Self::CameraMatrix {
            size,
            focal,
            centre,
            laboratory,
        }
    }

    fn of_principal([distance, x, y, pitch]: [f64; 4]) -> Result<Self, CalibrationError> {
        // The values are checked now, against a frame of any size, so that a bad file is refused
        // when it is opened and not when the first frame is.
        Camera::from_principal_distance(1024, 1024, distance, pitch, [x, y])?;
        Ok(Self::PrincipalDistance {
            distance,
            offset: [x, y],
            pitch,
        })
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

    /// Whether anything is filmed so far from the focus, mm: nearer than the detector, where the file states how far that is, and farther than a
    /// tube's housing and what is kept between it and the skin, some 200 mm where a metre is usual.
    #[must_use]
    fn may_hold(&self, distance: f64) -> bool {
        const NEAREST: f64 = 0.2;
        let is_before = self.principal_distance().is_none_or(|all| distance < all);
        is_before && distance > NEAREST * self.expected_distance()
    }

    /// Whether a component can be where a pose (`camera_from_model`) has the `middle` of its model's box, mm in its axes: before the detector, and not
    /// within the tube.
    #[must_use]
    pub fn may_be_at(&self, pose: &Pose, middle: &Vector3) -> bool {
        self.may_hold(-pose.transform(middle)[2])
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

fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
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

#[cfg(test)]
mod tests;
