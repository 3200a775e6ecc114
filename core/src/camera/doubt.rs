//! What is unusual of a camera: numbers that an X-ray set may have, but that most often are a mistake in the calibration.

use core::fmt;

use crate::camera::Camera;
use crate::camera::calibration::Calibration;

/// So far the principal point lies from the middle of frames that were not cut, in their sides: a frame of half or twice the size
/// that was calibrated is farther off.
const OFF_CENTRE: f64 = 0.2;
/// The source stands so many times as far from the detector as the frame's longer side, in frames that were not cut.
const TIMES: core::ops::RangeInclusive<f64> = 1.8..=10.0;
/// Distances from focus to detector, mm: of small arms for hands, and of walls that are looked at from afar.
const DISTANCES: core::ops::RangeInclusive<f64> = 300.0..=5000.0;
/// The longer side of a detector's field, mm: of image intensifiers that are switched to their smallest field, and of the largest flat panels.
const FIELDS: core::ops::RangeInclusive<f64> = 140.0..=450.0;
/// Columns and rows of detectors and of their binned frames are multiples of this; those of a frame that somebody cut are so by chance.
const BINNED: usize = 4;
/// Sides of pixels differ by less.
const UNEQUAL: f64 = 0.05;
/// What a set states of its own geometry is nominal: distances and fields are true to some percent.
const NOMINAL: f64 = 0.05;

/// What is unusual of a camera. A sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraDoubt {
    /// The principal point lies far from the frame's middle.
    PrincipalPoint {
        /// Column and row, pixels; the first pixel's centre is 0.5.
        point: [f64; 2],
        /// Width and height of the frame, pixels.
        frame: [usize; 2],
    },
    /// The focal length is unusual for the frame's size.
    Focal {
        /// The longer one, pixels.
        focal: f64,
        /// In longer sides of the frame.
        times: f64,
    },
    /// The two focal lengths differ.
    Unequal {
        /// Horizontal and vertical, pixels.
        focal: [f64; 2],
    },
    /// The frames' own file states another focal length.
    Stated {
        /// The camera's, pixels.
        focal: f64,
        /// The file's: its distance from source to detector in its pixels there.
        stated: f64,
    },
    /// No X-ray set has its detector at this distance from the focus, mm.
    Distance(f64),
    /// No detector has a field of this size.
    Field {
        /// Width and height of the frame, pixels.
        frame: [usize; 2],
        /// The same on the detector, mm.
        wide: [f64; 2],
    },
    /// The frames look as if they were cut, and the calibration does not say of which frames it is.
    Cut {
        /// Width and height of the frame, pixels.
        frame: [usize; 2],
        /// The same on the detector, mm.
        wide: [f64; 2],
    },
}

impl Calibration {
    /// What is unusual of this calibration and of the `camera` that it gives.
    pub fn doubts(&self, camera: &Camera) -> impl Iterator<Item = CameraDoubt> {
        let frame = [camera.width(), camera.height()];
        let own = match *self {
            Self::CameraMatrix { .. } => [None, None],
            Self::PrincipalDistance {
                distance, pitch, ..
            } => {
                let off =
                    (!DISTANCES.contains(&distance)).then_some(CameraDoubt::Distance(distance));
                let field = field_doubt(frame, frame.map(|side| side as f64 * pitch));
                // What is wrong with the focal length or the distance is wrong with the field too.
                let is_told = off.is_some() || !TIMES.contains(&camera.focal_in_sides());
                let is_new =
                    |doubt: &CameraDoubt| !(is_told && matches!(doubt, CameraDoubt::Field { .. }));
                [off, field.filter(is_new)]
            }
        };
        camera.doubts().chain(own.into_iter().flatten())
    }
}

/// Of a frame that is so wide and high on the detector, mm: one that was cut may be of any size.
fn field_doubt(frame: [usize; 2], wide: [f64; 2]) -> Option<CameraDoubt> {
    if frame.iter().any(|side| side % BINNED != 0) {
        return Some(CameraDoubt::Cut { frame, wide });
    }
    let longer = wide[0].max(wide[1]);
    (!FIELDS.contains(&longer)).then_some(CameraDoubt::Field { frame, wide })
}

impl Camera {
    /// What is unusual of this camera.
    pub fn doubts(&self) -> impl Iterator<Item = CameraDoubt> {
        let (frame, point, focal) = (
            [self.width(), self.height()],
            self.principal_point(),
            self.focal(),
        );
        let off = |k: usize| (point[k] / frame[k] as f64 - 0.5).abs() > OFF_CENTRE;
        let longer = focal[0].max(focal[1]);
        let times = self.focal_in_sides();
        [
            (off(0) || off(1)).then_some(CameraDoubt::PrincipalPoint { point, frame }),
            (!TIMES.contains(&times)).then_some(CameraDoubt::Focal {
                focal: longer,
                times,
            }),
            ((focal[0] / focal[1] - 1.0).abs() > UNEQUAL).then_some(CameraDoubt::Unequal { focal }),
        ]
        .into_iter()
        .flatten()
    }

    /// Whether this camera is another than that which the frames' file states: `distance` mm from source to detector, pixels of `spacing` mm
    /// there, along a row and from row to row. One of both is wrong then, and depths with it, which no outline tells.
    #[must_use]
    pub fn doubt_beside(&self, distance: f64, spacing: [f64; 2]) -> Option<CameraDoubt> {
        let stated = spacing.map(|side| distance / side);
        let pairs = self.focal().into_iter().zip(stated);
        let off = |(focal, stated): (f64, f64)| (focal / stated - 1.0).abs();
        let (focal, stated) = pairs.max_by(|&one, &other| off(one).total_cmp(&off(other)))?;
        (off((focal, stated)) > NOMINAL).then_some(CameraDoubt::Stated { focal, stated })
    }

    /// The longer focal length in longer sides of the frame.
    fn focal_in_sides(&self) -> f64 {
        let [horizontal, vertical] = self.focal();
        horizontal.max(vertical) / self.width().max(self.height()) as f64
    }
}

impl fmt::Display for CameraDoubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PrincipalPoint {
                point: [column, row],
                frame: [width, height],
            } => write!(
                f,
                "the principal point, column {column:.1} and row {row:.1}, lies far from the middle of a frame of {width} x {height} pixels, \
                 as in frames that were cut out of larger ones: if these were not, is it in pixels from the upper left corner, and of frames of this size?"
            ),
            Self::Focal { focal, times } => write!(
                f,
                "the focal length, {focal:.1} pixels, is {times:.2} times the frame's longer side; X-ray sources stand 2 to 6 times as far away: \
                 is it in pixels, not mm, and of frames of this size?"
            ),
            Self::Distance(mm) => write!(
                f,
                "the principal distance is {mm} mm; detectors stand 0.3 to 5 m from the focus: is it in mm, and the pixel pitch too?"
            ),
            Self::Field {
                frame: [width, height],
                wide: [right, down],
            } => write!(
                f,
                "a frame of {width} x {height} pixels would be {right:.0} x {down:.0} mm of the detector, and detectors have fields of 14 to 45 cm: is the \
                 pixel pitch in mm, and that of frames of this size? Where they were made smaller or larger after the calibration, it becomes larger or smaller by as much"
            ),
            Self::Cut {
                frame: [width, height],
                wide: [right, down],
            } => write!(
                f,
                "frames of {width} x {height} pixels look as if they were cut out of larger ones, and the calibration names no frame size: they are taken \
                 for the whole frame, {right:.0} x {down:.0} mm of the detector; if they were cut, its principal point (mm, x right, y up) counts from their own middle"
            ),
            Self::Unequal {
                focal: [horizontal, vertical],
            } => write!(
                f,
                "the focal lengths, {horizontal:.1} and {vertical:.1} pixels, differ as with pixels that are not square: are they so?"
            ),
            Self::Stated { focal, stated } => write!(
                f,
                "the focal length, {focal:.1} pixels, is {:.2} times that which the frames' file states ({stated:.1}, Distance Source to Detector over Imager \
                 Pixel Spacing), and depths are as many times too large if that is right: is the calibration of this set-up and of frames of this size?",
                focal / stated
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    fn told(
        size: (usize, usize),
        focal: [f64; 2],
        point: [f64; 2],
    ) -> std::vec::Vec<std::string::String> {
        let camera = Camera::new(size.0, size.1, focal, point).expect("possible");
        camera.doubts().map(|doubt| doubt.to_string()).collect()
    }

    #[test]
    fn usual_cameras_are_not_doubted() {
        for (size, focal, point) in [
            ((1024, 1024), [3212.0; 2], [512.0; 2]),
            ((1024, 1024), [4489.9, 4492.2], [459.0, 557.8]),
            // A flat panel of 430 mm at 0.9 m, and one of 150 mm on a small arm.
            ((3072, 3072), [6430.0; 2], [1500.0, 1600.0]),
            ((1000, 1000), [3000.0; 2], [430.0, 600.0]),
            ((1280, 720), [3900.0; 2], [640.0, 360.0]),
        ] {
            assert!(told(size, focal, point).is_empty(), "{focal:?}");
        }
    }

    #[test]
    fn what_the_frames_state_otherwise_is_told() {
        let camera = Camera::from_principal_distance(1024, 1024, 1198.0, 0.373, [0.0; 2]);
        let camera = camera.expect("possible");
        let beside = |distance, spacing| camera.doubt_beside(distance, spacing);
        for (distance, spacing) in [
            (1198.0, [0.373; 2]),
            (1198.0, [0.36; 2]),
            (1150.0, [0.373; 2]),
        ] {
            assert_eq!(beside(distance, spacing), None, "{distance} {spacing:?}");
        }
        for (distance, spacing, words) in [
            (
                1198.0,
                [0.1865; 2],
                "is 0.50 times that which the frames' file states (6423.6,",
            ),
            (1000.0, [0.373; 2], "is 1.20 times"),
            (1198.0, [0.373, 0.5], "is 1.34 times"),
        ] {
            let told = beside(distance, spacing).expect(words).to_string();
            assert!(told.contains(words), "{told}");
        }
        // What is no number is no statement.
        assert_eq!(beside(f64::NAN, [0.3; 2]), None);
    }

    #[test]
    fn lengths_in_cm_and_frames_that_were_cut_are_told() {
        let told = |distance: f64, pitch: f64, size: (usize, usize)| {
            let calibration = Calibration::PrincipalDistance {
                distance,
                offset: [0.0; 2],
                pitch,
            };
            let camera = calibration.camera(size.0, size.1).expect("possible");
            let told = calibration.doubts(&camera).map(|doubt| doubt.to_string());
            told.collect::<std::vec::Vec<_>>()
        };
        for size in [(1024, 1024), (880, 880), (1000, 1000), (768, 576)] {
            assert!(told(1198.0, 0.373, size).is_empty(), "{size:?}");
        }
        let [centimetres] = told(119.8, 0.0373, (1024, 1024)).try_into().expect("one");
        assert!(centimetres.contains("is 119.8 mm"), "{centimetres}");
        let [a_mm] = told(1198.0, 2.68, (1024, 1024)).try_into().expect("one");
        assert!(a_mm.contains("0.44 times"), "{a_mm}");
        let [cut] = told(1198.0, 0.373, (650, 430)).try_into().expect("one");
        assert!(
            cut.contains("650 x 430 pixels") && cut.contains("242 x 160 mm"),
            "{cut}"
        );
    }

    /// As by another program's export: a focal length of 4.4 sides in pixels stays one that X-ray sets have, at half and at twice the size.
    #[test]
    fn frames_that_were_resized_after_the_calibration_are_told_where_no_detector_is_of_that_size() {
        let told = |size: (usize, usize)| {
            let calibration = Calibration::PrincipalDistance {
                distance: 1198.0,
                offset: [-14.1, -12.2],
                pitch: 0.2668,
            };
            let camera = calibration.camera(size.0, size.1).expect("possible");
            let told = calibration.doubts(&camera).map(|doubt| doubt.to_string());
            told.collect::<std::vec::Vec<_>>()
        };
        assert!(told((1024, 1024)).is_empty());
        let [half] = told((512, 512)).try_into().expect("one");
        assert!(half.contains("137 x 137 mm of the detector"), "{half}");
        let [twice] = told((2048, 2048)).try_into().expect("one");
        assert!(twice.contains("546 x 546 mm of the detector"), "{twice}");
        // The longer side counts: strips are read out of detectors.
        assert!(told((1024, 256)).is_empty());
    }

    #[test]
    fn usual_mistakes_are_told() {
        let one = |size, focal, point, word: &str| {
            let told = told(size, focal, point);
            assert!(told.len() == 1 && told[0].contains(word), "{told:?}");
        };
        let middle = [512.0; 2];
        // Millimetres from the frame's middle.
        one(
            (1024, 1024),
            [3212.0; 2],
            [0.5, 0.5],
            "principal point, column 0.5",
        );
        // Calibrated at half and at twice the size.
        one((1024, 1024), [3212.0; 2], [256.0; 2], "principal point");
        one((512, 512), [3212.0; 2], [512.0; 2], "principal point");
        // Focal length in millimetres.
        one((1024, 1024), [1198.0; 2], middle, "not mm");
        one((1024, 1024), [3212.0 * 12.0; 2], middle, "37.64 times");
        one((1024, 1024), [3212.0, 2900.0], middle, "not square");
        assert_eq!(told((1024, 1024), [1.2, 1.0], [0.5; 2]).len(), 3);
    }

    /// Limits themselves are usual; numbers beside them are so chosen that quotients are exact.
    #[test]
    fn cameras_are_doubted_beyond_limits_and_not_at_them() {
        let told = |size, focal, point| told(size, focal, point).len();
        let usual = ((1000, 1000), [3000.0; 2], [500.0; 2]);
        assert_eq!(told(usual.0, usual.1, usual.2), 0);
        for (at, doubts) in [(300.0, 0), (299.9, 1), (700.0, 0), (700.1, 1)] {
            assert_eq!(told(usual.0, usual.1, [at, 500.0]), doubts, "{at}");
            assert_eq!(told(usual.0, usual.1, [500.0, at]), doubts, "{at}");
        }
        // Off in both is off once.
        assert_eq!(told(usual.0, usual.1, [200.0, 900.0]), 1);
        for (focal, doubts) in [(1800.0, 0), (1799.9, 1), (10_000.0, 0), (10_000.1, 1)] {
            assert_eq!(told(usual.0, [focal; 2], usual.2), doubts, "{focal}");
            // In sides of the longer one.
            assert_eq!(told((1000, 800), [focal; 2], [500.0, 400.0]), doubts);
            assert_eq!(told((800, 1000), [focal; 2], [400.0, 500.0]), doubts);
        }
        for (other, doubts) in [(2860.0, 0), (2850.0, 1), (3155.0, 0), (3165.0, 1)] {
            assert_eq!(told(usual.0, [3000.0, other], usual.2), doubts, "{other}");
        }
    }
}
