//! The X-ray camera: principal distance, principal point and pixel pitch as one projection.

use thiserror::Error;

use crate::image::contour::Point;
use crate::image::crop::Crop;
use crate::image::mask::MAX_SIDE;
use crate::math::{Decimal, Vector3};

/// Why numbers do not make a camera.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CameraError {
    /// A value is NaN, infinite or out of its range.
    #[error("the calibration's {name} is {}; it must be {rule}", Decimal::brief(*value))]
    Value {
        /// Which value.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        rule: &'static str,
    },
}

/// A pinhole camera at the X-ray focus, looking along -z with y up.
///
/// `column = cx + fx * X / -Z`, `row = cy - fy * Y / -Z`; `fx`, `fy`, `cx`, `cy` in pixels,
/// continuous image coordinates. Built only with values that are finite and possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    /// Distance from focus to detector, mm; infinite where that is not known.
    detector: f64,
}

/// A number's name, least and greatest value, and their rule in words.
type Range = (&'static str, [f64; 2], &'static str);

#[cfg_attr(target_os = "none", inline(never))]
fn check(ranges: &[Range], values: &[f64]) -> Result<(), CameraError> {
    for (&(name, [least, most], rule), &value) in ranges.iter().zip(values) {
        if !(least <= value && value <= most) {
            return Err(CameraError::Value { name, value, rule });
        }
    }
    Ok(())
}

const SIDES: [f64; 2] = [1.0, MAX_SIDE as f64];
const SIDES_RULE: &str = "1 to 16384 pixels";
const FOCALS: [f64; 2] = [1.0, 1e6];
const FOCALS_RULE: &str = "between 1 and 1 000 000 pixels";
const POINTS: [f64; 2] = [-1e5, 1e5];
const POINTS_RULE: &str = "within 100 000 pixels of the frame";

/// What a camera is made of, and its focal lengths' ratio.
const PARTS: [Range; 7] = [
    ("frame width", SIDES, SIDES_RULE),
    ("frame height", SIDES, SIDES_RULE),
    ("horizontal focal length", FOCALS, FOCALS_RULE),
    ("vertical focal length", FOCALS, FOCALS_RULE),
    (
        "ratio of the focal lengths",
        [0.1, 10.0],
        "between 0.1 and 10",
    ),
    ("principal point (column)", POINTS, POINTS_RULE),
    ("principal point (row)", POINTS, POINTS_RULE),
];

const POSITIVE: [f64; 2] = [f64::from_bits(1), 1e5];
const POSITIVE_RULE: &str = "a positive number of mm, at most 100 000";
const ASIDE: [f64; 2] = [-1e5, 1e5];
const ASIDE_RULE: &str = "a number of mm, at most 100 000 either way";

/// The same of one by millimetres.
const PARTS_MM: [Range; 4] = [
    ("principal distance", POSITIVE, POSITIVE_RULE),
    ("pixel pitch", POSITIVE, POSITIVE_RULE),
    ("principal point x", ASIDE, ASIDE_RULE),
    ("principal point y", ASIDE, ASIDE_RULE),
];

impl Camera {
    /// A camera for frames of `width` x `height` pixels, from its focal lengths and principal
    /// point in pixels (continuous coordinates: the first pixel's centre is 0.5).
    ///
    /// # Errors
    /// [`CameraError::Value`] names the value that is not finite or not possible.
    pub fn new(
        width: usize,
        height: usize,
        [fx, fy]: [f64; 2],
        [cx, cy]: [f64; 2],
    ) -> Result<Self, CameraError> {
        let sides = [width as f64, height as f64];
        check(&PARTS, &[sides[0], sides[1], fx, fy, fx / fy, cx, cy])?;
        Ok(Self {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            detector: f64::INFINITY,
        })
    }

    /// A camera from the field's quantities: `distance` from focus to detector, `pitch` between
    /// pixels, and the principal point's `offset` from the frame's centre (x right, y up), all
    /// in mm at the detector.
    ///
    /// # Errors
    /// [`CameraError::Value`] names the value that is not finite or not possible.
    pub fn from_principal_distance(
        width: usize,
        height: usize,
        distance: f64,
        pitch: f64,
        offset: [f64; 2],
    ) -> Result<Self, CameraError> {
        check(&PARTS_MM, &[distance, pitch, offset[0], offset[1]])?;
        let focal = distance / pitch;
        let centre = [
            width as f64 / 2.0 + offset[0] / pitch,
            height as f64 / 2.0 - offset[1] / pitch,
        ];
        let detector = distance;
        let camera = Self::new(width, height, [focal, focal], centre)?;
        Ok(Self { detector, ..camera })
    }

    /// The camera of a part of its frames: it sees there what this one sees, so that poses are the same.
    ///
    /// # Errors
    /// [`CameraError::Value`] where that is no part of this camera's frames, or so far from the principal point as no
    /// frame may be.
    pub fn cropped(&self, crop: &Crop) -> Result<Self, CameraError> {
        let [width, height] = crop.frame().map(|side| [side as f64; 2]);
        let rule = "that of the frame which was cropped";
        let frame = [("frame width", width, rule), ("frame height", height, rule)];
        check(&frame, &[self.width as f64, self.height as f64])?;
        let centre = [
            self.cx - crop.columns().start as f64,
            self.cy - crop.rows().start as f64,
        ];
        let detector = self.detector;
        let camera = Self::new(crop.width(), crop.height(), self.focal(), centre)?;
        Ok(Self { detector, ..camera })
    }

    /// Columns of the frame.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the frame.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Horizontal and vertical focal length, pixels.
    #[must_use]
    pub fn focal(&self) -> [f64; 2] {
        [self.fx, self.fy]
    }

    /// Principal point (column, row), continuous image coordinates in pixels.
    #[must_use]
    pub fn principal_point(&self) -> [f64; 2] {
        [self.cx, self.cy]
    }

    /// How far behind the detector a depth (mm from the focus along the axis) lies, mm; 0 before it, or where its distance is not known,
    /// as of a camera matrix.
    #[must_use]
    pub fn behind_detector(&self, depth: f64) -> f64 {
        (depth - self.detector).max(0.0)
    }

    /// Height of a pixel divided by its width at the object: `fx / fy`.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        self.fx / self.fy
    }

    /// The image of a point in camera coordinates (mm); `None` on or behind the focus.
    #[must_use]
    pub fn project(&self, point: &Vector3) -> Option<Point> {
        let depth = -point[2];
        (depth > 0.0).then(|| Point {
            column: self.cx + self.fx * point[0] / depth,
            row: self.cy - self.fy * point[1] / depth,
        })
    }

    /// The same camera for frames in squares of `side` x `side` pixels ([`crate::image::frame::Frame::reduce`]): poses are the same.
    ///
    /// # Errors
    /// [`CameraError::Value`] when no square fits.
    pub fn reduced(&self, side: usize) -> Result<Self, CameraError> {
        let factor = side.max(1);
        let f = factor as f64;
        let camera = Self::new(
            self.width / factor,
            self.height / factor,
            [self.fx / f, self.fy / f],
            [self.cx / f, self.cy / f],
        )?;
        let detector = self.detector;
        Ok(Self { detector, ..camera })
    }

    /// The same camera for frames sampled `factor` times as finely in both directions.
    ///
    /// # Errors
    /// [`CameraError::Value`] when the frame becomes too large.
    pub fn supersampled(&self, factor: usize) -> Result<Self, CameraError> {
        let f = factor as f64;
        let camera = Self::new(
            self.width.saturating_mul(factor),
            self.height.saturating_mul(factor),
            [self.fx * f, self.fy * f],
            [self.cx * f, self.cy * f],
        )?;
        let detector = self.detector;
        Ok(Self { detector, ..camera })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_optical_axis_meets_a_1024_frame_at_index_511_and_a_half() {
        let camera =
            Camera::from_principal_distance(1024, 1024, 1198.0, 0.373, [0.0, 0.0]).expect("valid");
        let centre = camera.project(&[0.0, 0.0, -900.0]).expect("in front");
        assert_eq!((centre.column - 0.5, centre.row - 0.5), (511.5, 511.5));
    }

    #[test]
    fn a_reduced_frame_shows_the_same_at_the_same_part_of_it() {
        let camera =
            Camera::from_principal_distance(801, 603, 1000.0, 0.5, [10.0, 20.0]).expect("valid");
        let reduced = camera.reduced(2).expect("large enough");
        assert_eq!((reduced.width(), reduced.height()), (400, 301));
        let point = [30.0, 40.0, -500.0];
        let [whole, half] = [camera, reduced].map(|one| one.project(&point).expect("in front"));
        let twice = (2.0 * half.column, 2.0 * half.row);
        assert!((whole.column - twice.0).abs() < 1e-9 && (whole.row - twice.1).abs() < 1e-9);
        assert_eq!(
            reduced.behind_detector(1001.0),
            camera.behind_detector(1001.0)
        );
        assert!(camera.reduced(700).is_err());
    }

    #[test]
    fn x_goes_right_and_y_goes_up_on_the_detector() {
        let camera =
            Camera::from_principal_distance(800, 600, 1000.0, 0.5, [10.0, 20.0]).expect("valid");
        assert_eq!(camera.principal_point(), [420.0, 260.0]);
        // 30 mm right and 40 mm up at half the principal distance are 60 and 80 mm there.
        let image = camera.project(&[30.0, 40.0, -500.0]).expect("in front");
        assert_eq!((image.column, image.row), (420.0 + 120.0, 260.0 - 160.0));
        assert_eq!(camera.project(&[0.0, 0.0, 1.0]), None);
        assert_eq!(camera.project(&[0.0, 0.0, f64::NAN]), None);
    }

    #[test]
    fn impossible_values_are_named() {
        let name = |result: Result<Camera, CameraError>| match result {
            Err(CameraError::Value { name, .. }) => name,
            Ok(_) => "accepted",
        };
        let make =
            |distance, pitch, x| Camera::from_principal_distance(9, 9, distance, pitch, [x, 0.0]);
        assert_eq!(name(make(0.0, 0.3, 0.0)), "principal distance");
        assert_eq!(name(make(f64::NAN, 0.3, 0.0)), "principal distance");
        assert_eq!(name(make(1000.0, -0.3, 0.0)), "pixel pitch");
        assert_eq!(name(make(1000.0, 0.3, f64::INFINITY)), "principal point x");
        assert_eq!(name(Camera::new(0, 9, [1e3; 2], [4.0; 2])), "frame width");
    }
    #[test]
    fn parts_and_finer_frames_of_a_camera_keep_its_detector() {
        let camera = Camera::from_principal_distance(800, 600, 1000.0, 0.5, [0.0; 2]);
        let camera = camera.expect("valid");
        let crop = Crop::around(100..164, 50..114, 0, [800, 600]).expect("valid");
        let part = camera.cropped(&crop).expect("within");
        let finer = camera.supersampled(4).expect("possible");
        for camera in [camera, part, finer] {
            assert_eq!(camera.behind_detector(999.0), 0.0);
            assert_eq!(camera.behind_detector(1200.0), 200.0);
        }
        let matrix = Camera::new(800, 600, camera.focal(), camera.principal_point());
        assert_eq!(matrix.expect("valid").behind_detector(1e9), 0.0);
    }

    /// A point is seen at the same place of the film, in pixels of each.
    #[test]
    fn parts_and_finer_frames_of_a_camera_see_the_same() {
        let camera = Camera::new(800, 600, [2000.0, 1600.0], [390.5, 310.25]).expect("valid");
        assert_eq!(camera.aspect(), 1.25);
        let crop = Crop::around(100..164, 50..114, 0, [800, 600]).expect("valid");
        let part = camera.cropped(&crop).expect("within");
        let finer = camera.supersampled(4).expect("possible");
        assert_eq!([part.width(), part.height()], [64, 64]);
        assert_eq!([finer.width(), finer.height()], [3200, 2400]);
        for point in [[3.0, -8.0, -900.0], [-40.0, 25.0, -1300.0]] {
            let see = |camera: &Camera| camera.project(&point).expect("in front");
            let (whole, part, finer) = (see(&camera), see(&part), see(&finer));
            assert!((part.column + 100.0 - whole.column).abs() < 1e-9);
            assert!((part.row + 50.0 - whole.row).abs() < 1e-9);
            assert!((finer.column - 4.0 * whole.column).abs() < 1e-9);
            assert!((finer.row - 4.0 * whole.row).abs() < 1e-9);
        }
        let other = Crop::around(100..164, 50..114, 0, [800, 601]).expect("valid");
        assert!(matches!(
            camera.cropped(&other),
            Err(CameraError::Value {
                name: "frame height",
                value: 600.0,
                ..
            })
        ));
        assert!(camera.supersampled(21).is_err() && camera.supersampled(0).is_err());
    }

    #[test]
    fn limits_of_a_camera_are_possible_and_what_is_beyond_them_is_not() {
        type Make = fn(f64) -> Result<Camera, CameraError>;
        let makes: [(Make, f64, f64); 5] = [
            (|x| Camera::new(9, 9, [x, x], [4.0; 2]), 1.0, 1e6),
            (
                |x| Camera::new(9, 9, [1000.0 * x, 1000.0], [4.0; 2]),
                0.1,
                10.0,
            ),
            (|x| Camera::new(9, 9, [1e3; 2], [x, 4.0]), -1e5, 1e5),
            (|x| Camera::new(9, 9, [1e3; 2], [4.0, x]), -1e5, 1e5),
            (
                |x| Camera::from_principal_distance(9, 9, 1000.0 * x, x, [0.0; 2]),
                f64::MIN_POSITIVE,
                100.0,
            ),
        ];
        for (number, (make, least, most)) in makes.into_iter().enumerate() {
            assert!(make(least).is_ok() && make(most).is_ok(), "{number}");
            for beyond in [least.next_down().next_down(), most * 1.000_001, f64::NAN] {
                // Below the least positive number there are others that are no distances.
                assert!(
                    make(beyond).is_err() || number == 4 && beyond > 0.0,
                    "{number} {beyond}"
                );
            }
        }
        assert!(Camera::new(16_384, 1, [1e3; 2], [4.0; 2]).is_ok());
        assert!(Camera::new(16_385, 1, [1e3; 2], [4.0; 2]).is_err());
        assert!(Camera::new(1, 16_385, [1e3; 2], [4.0; 2]).is_err());
    }
}
