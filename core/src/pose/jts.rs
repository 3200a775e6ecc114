//! `.jts`: the field's text file of poses, one row a frame.
//!
//! Reading is tolerant (commas, semicolons, spaces and tabs in any mix, trailing commas, a
//! missing last line end, blank lines); writing is exact: each number is the shortest that
//! reads back as the same `f64`.

use core::fmt;

use thiserror::Error;

use crate::pose::EulerPose;

/// First line of the file: Z-X-Y Euler angles.
pub const JT_EULER_312: &str = "JT_EULER_312";

/// Why a text is not a list of poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum JtsError {
    /// The first line is another one.
    #[error("this is not a pose file: its first line is not JT_EULER_312")]
    Heading,
    /// A row does not hold six finite numbers.
    #[error(
        "line {line} of the pose file does not hold six numbers (x, y, z in mm, then z, x, y rotation in degrees)"
    )]
    Row {
        /// Line, from 1.
        line: usize,
    },
}

/// The poses of a file, in order. Reads as it goes and holds nothing.
///
/// # Errors
/// [`JtsError::Heading`] at once; the iterator gives [`JtsError::Row`] for a faulty row.
pub fn read(text: &str) -> Result<impl Iterator<Item = Result<EulerPose, JtsError>>, JtsError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty())
        .peekable();
    match lines.next() {
        Some((_, first)) if first.starts_with(JT_EULER_312) => {}
        _ => return Err(JtsError::Heading),
    }
    let names_columns = |line: &str| line.starts_with(|c: char| c.is_ascii_alphabetic());
    lines.next_if(|(_, line)| names_columns(line) && !line.starts_with("nan"));
    Ok(lines.map(|(line, text)| parse_row(text).ok_or(JtsError::Row { line })))
}

fn parse_row(text: &str) -> Option<EulerPose> {
    let mut fields = text
        .split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty());
    let mut next = || {
        let value: f64 = fields.next()?.parse().ok()?;
        value.is_finite().then_some(value)
    };
    let pose = EulerPose {
        x_mm: next()?,
        y_mm: next()?,
        z_mm: next()?,
        z_rot_deg: next()?,
        x_rot_deg: next()?,
        y_rot_deg: next()?,
    };
    fields.next().is_none().then_some(pose)
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

/// Writes one row.
///
/// # Errors
/// Only those of `out`.
pub fn write_row(out: &mut impl fmt::Write, pose: &EulerPose) -> fmt::Result {
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
        let first = rows.next().expect("a row").expect("six numbers");
        assert_eq!((first.x_mm, first.y_rot_deg), (5.169_069_6, -0.145_071));
        let second = rows.next().expect("a row").expect("six numbers");
        assert_eq!((second.x_mm, second.y_rot_deg), (1.0, 6.0));
        assert!(rows.next().is_none());
    }

    #[test]
    fn faults_name_their_line() {
        assert_eq!(read("x").map(|_| ()).err(), Some(JtsError::Heading));
        assert_eq!(read("").map(|_| ()).err(), Some(JtsError::Heading));
        for row in ["1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "1,2,nan,4,5,6"] {
            let text = [JT_EULER_312, "\nx_tran\n1 2 3 4 5 6\n", row].concat();
            let mut rows = read(&text).expect("heading").skip(1);
            assert_eq!(rows.next(), Some(Err(JtsError::Row { line: 4 })), "{row}");
        }
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back_bit_for_bit(values in proptest::array::uniform6(
            proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO
        )) {
            let [x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg] = values;
            let pose = EulerPose { x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg };
            let mut text = std::string::String::new();
            write_heading(&mut text).expect("memory");
            write_row(&mut text, &pose).expect("memory");
            let back = read(&text).expect("heading").next().expect("a row");
            prop_assert_eq!(back, Ok(pose));
        }
    }
}
