//! What C sees of numbers, field by field as in `include/fluoropose.h`.

use fluoropose::Camera;
use fluoropose::camera::CameraError;
use fluoropose::finder::{Candidate, Decision, Verdict};
use fluoropose::image::crop::Crop;
use fluoropose::pose::{EulerPose, Pose};

pub use fluoropose::Point as PointNumbers;

/// `fluoropose_room`: how much there is to be memory for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Room {
    /// Columns of the largest part of a frame: a silhouette and 24 pixels around it.
    pub columns: u32,
    /// Its rows.
    pub rows: u32,
    /// Pixels of the longest outline.
    pub border: u32,
    /// Runs of pixels, of silhouettes that come row by row; 0 where they come as outlines.
    pub runs: u32,
}

/// `fluoropose_camera`: pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CameraNumbers {
    /// Columns of the frame.
    pub width: u32,
    /// Rows of the frame.
    pub height: u32,
    /// Focal length along rows.
    pub fx: f64,
    /// Focal length along columns.
    pub fy: f64,
    /// Column of the principal point.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
}

impl From<Camera> for CameraNumbers {
    fn from(camera: Camera) -> Self {
        let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
        Self {
            width: camera.width() as u32,
            height: camera.height() as u32,
            fx,
            fy,
            cx,
            cy,
        }
    }
}

impl CameraNumbers {
    /// # Errors
    /// [`CameraError`] for numbers of no camera.
    pub(crate) fn camera(&self) -> Result<Camera, CameraError> {
        let (width, height) = (self.width as usize, self.height as usize);
        Camera::new(width, height, [self.fx, self.fy], [self.cx, self.cy])
    }
}

/// `fluoropose_calibration`: a camera by the field's quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CalibrationNumbers {
    /// Columns of the frame.
    pub width: u32,
    /// Rows of the frame.
    pub height: u32,
    /// From the focus to the detector, mm.
    pub distance_mm: f64,
    /// Between pixels, at the detector, mm.
    pub pitch_mm: f64,
    /// The principal point, to the right of the frame's middle, mm at the detector.
    pub right_mm: f64,
    /// The same, up.
    pub up_mm: f64,
}

impl CalibrationNumbers {
    /// # Errors
    /// [`CameraError`] for numbers of no camera.
    pub(crate) fn camera(&self) -> Result<Camera, CameraError> {
        let (width, height) = (self.width as usize, self.height as usize);
        let middle = [self.right_mm, self.up_mm];
        Camera::from_principal_distance(width, height, self.distance_mm, self.pitch_mm, middle)
    }
}

/// `fluoropose_found`: what was found, and how far it is to be trusted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FoundNumbers {
    /// 1 good, 2 doubtful, 3 none; 0, of memory that nothing was written to, is no verdict.
    pub verdict: u32,
    /// Poses that explain the silhouette.
    pub candidates: u32,
    /// Which of them was chosen, from 0.
    pub chosen: u32,
    /// Left column, upper row, columns and rows of the part of the frame that was looked at.
    pub part: [u32; 4],
}

impl FoundNumbers {
    pub(crate) fn of(candidates: usize, decision: &Decision, crop: &Crop) -> Self {
        let (columns, rows) = (crop.columns(), crop.rows());
        Self {
            verdict: match decision.verdict {
                Verdict::Good => 1,
                Verdict::Doubtful(_) => 2,
                Verdict::NoFit(_) => 3,
            },
            candidates: candidates as u32,
            chosen: decision.choice.index as u32,
            part: [columns.start, rows.start, columns.len(), rows.len()].map(|side| side as u32),
        }
    }
}

/// `fluoropose_candidate`: a pose and how well it fits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CandidateNumbers {
    /// `camera_from_model`, row by row.
    pub rotation: [[f64; 3]; 3],
    /// The same, mm.
    pub translation_mm: [f64; 3],
    /// Rotations about z, x and y of the same pose, degrees.
    pub rotations_deg: [f64; 3],
    /// Of a small turn about the model's middle (radians, camera axes) and a shift of it (mm); zeros where it is not known.
    pub covariance: [[f64; 6]; 6],
    /// Root of twice the robust loss, pixels.
    pub misfit_px: f64,
    /// Part of the model's outline that the silhouette's meets.
    pub met: f64,
    /// Times the model was drawn on the way from its start.
    pub drawings: u32,
    /// Whether `covariance` is known.
    pub has_covariance: u32,
}

impl CandidateNumbers {
    /// The pose by its matrix.
    pub(crate) fn pose(&self) -> Pose {
        Pose {
            rotation: self.rotation,
            translation: self.translation_mm,
        }
    }
}

impl From<&Candidate> for CandidateNumbers {
    fn from(candidate: &Candidate) -> Self {
        let euler = EulerPose::from(candidate.pose);
        let covariance = candidate.covariance.map(|covariance| covariance.matrix);
        Self {
            rotation: candidate.pose.rotation,
            translation_mm: candidate.pose.translation,
            rotations_deg: [euler.z_rot_deg, euler.x_rot_deg, euler.y_rot_deg],
            covariance: covariance.unwrap_or_default(),
            misfit_px: candidate.misfit(),
            met: candidate.fit.met,
            drawings: candidate
                .refined
                .map_or(0, |refined| refined.renders as u32),
            has_covariance: u32::from(covariance.is_some()),
        }
    }
}
