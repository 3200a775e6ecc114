//! `.jts`: the field's text file of poses, one row a frame.
//!
//! Read as well: `.jtak` (as many rows) and `.jtap` (one pose), which differ in their first line alone and leave out a
//! frame that was not solved. What a file is, its first line says.
//!
//! Reading is tolerant (commas, semicolons, spaces and tabs in any mix, trailing commas, a
//! missing last line end, blank lines); writing is exact: each number is the shortest that
//! reads back as the same `f64`.

use core::fmt;

use thiserror::Error;

use crate::pose::EulerPose;

/// First line of a `.jts`, the one that is written: Z-X-Y Euler angles.
pub const JT_EULER_312: &str = "JT_EULER_312";
/// First line of a `.jtak`: the same angles.
pub const JTA_EULER_KINEMATICS: &str = "JTA_EULER_KINEMATICS";
/// First line of a `.jtap`: the same angles.
pub const JTA_EULER_POSE: &str = "JTA_EULER_POSE";

/// Beginning of a row that is no result, whatever follows it.
const NOT_OPTIMIZED: &str = "NOT_OPTIMIZED";

/// Why a text is not a list of poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum JtsError {
    /// The first line is another one.
    #[error(
        "this is not a pose file: its first line is not JT_EULER_312, JTA_EULER_KINEMATICS or JTA_EULER_POSE"
    )]
    Heading,
    /// A row holds neither six finite numbers nor what stands for a frame without a pose.
    #[error(
        "line {line} of the pose file does not hold six numbers (x, y, z in mm, then z, x, y rotation in degrees) with a decimal point; a frame without a pose is six times NaN"
    )]
    Row {
        /// Line, from 1.
        line: usize,
    },
}

/// A row a frame, in order; `None` for a frame without a pose: six times NaN, `NOT_OPTIMIZED`, or six zeros, which are
/// the focus, where nothing can be. Reads as it goes and holds nothing.
///
/// # Errors
/// [`JtsError::Heading`] at once; the iterator gives [`JtsError::Row`] for a faulty row.
pub fn read(
    text: &str,
) -> Result<impl Iterator<Item = Result<Option<EulerPose>, JtsError>>, JtsError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty())
        .peekable();
    match lines.next() {
        Some((_, first)) if is_first_line(first) => {}
        _ => return Err(JtsError::Heading),
    }
    lines.next_if(|(_, line)| names_columns(line));
    Ok(lines.map(|(line, text)| parse_row(text).ok_or(JtsError::Row { line })))
}

fn is_first_line(line: &str) -> bool {
    [JT_EULER_312, JTA_EULER_KINEMATICS, JTA_EULER_POSE]
        .iter()
        .any(|form| line.starts_with(form))
}

fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty())
}

/// `NaN` begins with a letter too, but it is a number.
fn names_columns(line: &str) -> bool {
    let first = fields(line).next().unwrap_or_default();
    first.starts_with(|c: char| c.is_ascii_alphabetic())
        && first.parse::<f64>().is_err()
        && !first.starts_with(NOT_OPTIMIZED)
}

/// `None` for a row at fault, `Some(None)` for a frame without a pose.
fn parse_row(text: &str) -> Option<Option<EulerPose>> {
    if text.starts_with(NOT_OPTIMIZED) {
        return Some(None);
    }
    let mut fields = fields(text);
    let mut numbers = [0.0; 6];
    for number in &mut numbers {
        *number = fields.next()?.parse::<f64>().ok()?;
    }
    if fields.next().is_some() {
        return None;
    }
    let all = |is: fn(&f64) -> bool| numbers.iter().all(is);
    if all(|number| number.is_nan()) || all(|&number| number == 0.0) {
        return Some(None);
    }
    all(|number| number.is_finite()).then(|| Some(EulerPose::from(numbers)))
}

/// Writes the two heading lines.
///
/// # Errors
/// Only those of `out`.
pub fn write_heading(out: &mut impl fmt::Write) -> fmt::Result {
    writeln!(
        out,
        "{JT_EULER_312}\n{:>22},{:>23},{:>23},{:>24},{:>23},{:>23}",
        "x_tran", "y_tran", "z_tran", "z_rot", "x_rot", "y_rot"
    )
}

/// Writes one row; six times NaN for a frame without a pose.
///
/// # Errors
/// Only those of `out`.
pub fn write_row(out: &mut impl fmt::Write, pose: Option<&EulerPose>) -> fmt::Result {
    let none = EulerPose {
        x_mm: f64::NAN,
        y_mm: f64::NAN,
        z_mm: f64::NAN,
        z_rot_deg: f64::NAN,
        x_rot_deg: f64::NAN,
        y_rot_deg: f64::NAN,
    };
    let pose = pose.unwrap_or(&none);
    writeln!(
        out,
        "{:>22},{:>23},{:>23},{:>24},{:>23},{:>23}",
        pose.x_mm, pose.y_mm, pose.z_mm, pose.z_rot_deg, pose.x_rot_deg, pose.y_rot_deg
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_fields_separators_are_understood() {
        let text = "JT_EULER_312\r\n   x_tran,  y_tran, z_tran,  z_rot, x_rot, y_rot\r\n\
            5.1690696,       -18.07639,       -1112.262,\t\t  7.4275697,  8.0422890,  -0.145071,\r\n\
            \r\n1 2\t3;4 , 5 6";
        let mut rows = read(text).expect("heading");
        let first = rows
            .next()
            .expect("a row")
            .expect("six numbers")
            .expect("a pose");
        assert_eq!((first.x_mm, first.y_rot_deg), (5.169_069_6, -0.145_071));
        let second = rows
            .next()
            .expect("a row")
            .expect("six numbers")
            .expect("a pose");
        assert_eq!((second.x_mm, second.y_rot_deg), (1.0, 6.0));
        assert!(rows.next().is_none());
    }

    /// The x of each frame, 0 where there is no pose.
    fn places(text: &str) -> std::vec::Vec<f64> {
        read(text)
            .expect("heading")
            .map(|row| row.expect("six numbers").map_or(0.0, |pose| pose.x_mm))
            .collect()
    }

    #[test]
    fn a_frame_without_a_pose_keeps_its_place() {
        let pose = "7 2 3 4 5 6\n";
        let nothing = [
            "NaN,NaN,NaN,NaN,NaN,NaN\n",
            "nan nan nan nan nan nan\n",
            "-nan,\tNAN,\tnan,\tnan,\tnan,\tnan,\n",
            "0,0,0.0,0,-0,0\n",
            "NOT_OPTIMIZED,\t0,\t0,\t0,\t0,\t0,\n",
            "NOT_OPTIMIZED\n",
        ];
        for heading in ["JT_EULER_312\n", "JT_EULER_312\nx_tran, y_tran, z_tran\n"] {
            for row in nothing {
                let text = [heading, row, pose, row, row, pose].concat();
                assert_eq!(places(&text), [0.0, 7.0, 0.0, 0.0, 7.0], "{text}");
            }
        }
    }

    #[test]
    fn kinematics_and_single_poses_are_read() {
        let columns = "X_TRAN\t\tY_TRAN\t\tZ_TRAN\t\tZ_ROT\t\tX_ROT\t\tY_ROT\r\n";
        let row = "18.52191,\t19.69514,\t-1027.713,\t-26.69708,\t-7.419319,\t-0.2587041,\r\n";
        let pose = EulerPose {
            x_mm: 18.521_91,
            y_mm: 19.695_14,
            z_mm: -1_027.713,
            z_rot_deg: -26.697_08,
            x_rot_deg: -7.419_319,
            y_rot_deg: -0.258_704_1,
        };
        for first in [JTA_EULER_KINEMATICS, JTA_EULER_POSE] {
            let text = [first, "\r\n", columns, row].concat();
            let mut rows = read(&text).expect("heading");
            assert_eq!(rows.next(), Some(Ok(Some(pose))), "{first}");
            assert_eq!(rows.next(), None);
        }
    }

    #[test]
    fn faults_name_their_line() {
        assert_eq!(read("x").map(|_| ()).err(), Some(JtsError::Heading));
        assert_eq!(read("").map(|_| ()).err(), Some(JtsError::Heading));
        let short = ["1,2,3,4,5", "nan,nan", "0,0,0,0,0"];
        let long = ["1,2,3,4,5,6,7", "0 0 0 0 0 0 0"];
        let strange = ["1,2,3,4,5,x", "1,2,nan,4,5,6", "inf,2,3,4,5,6"];
        for row in short.into_iter().chain(long).chain(strange) {
            let text = [JT_EULER_312, "\nx_tran\n1 2 3 4 5 6\n", row].concat();
            let mut rows = read(&text).expect("heading").skip(1);
            assert_eq!(rows.next(), Some(Err(JtsError::Row { line: 4 })), "{row}");
        }
        // Infinity begins with a letter, but names no column.
        let mut rows = read("JT_EULER_312\ninf,2,3,4,5,6").expect("heading");
        assert_eq!(rows.next(), Some(Err(JtsError::Row { line: 2 })));
    }

    properties! {
        #[test]
        fn what_is_written_reads_back_bit_for_bit(values in proptest::array::uniform6(
            proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO
        )) {
            let [x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg] = values;
            let pose = EulerPose { x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg };
            let mut text = std::string::String::new();
            write_heading(&mut text).expect("memory");
            write_row(&mut text, Some(&pose)).expect("memory");
            write_row(&mut text, None).expect("memory");
            let mut rows = read(&text).expect("heading");
            let zeros = pose == EulerPose::default();
            prop_assert_eq!(rows.next().expect("a row"), Ok((!zeros).then_some(pose)));
            prop_assert_eq!(rows.next().expect("a row"), Ok(None));
        }
    }
}
