//! Words and numbers without the language's own writing of them, which takes 4 KB of a board's flash: only a proof shows any.

use core::fmt::{Result, Write};

use fluoropose::pose::{EulerPose, Pose};

/// Pieces of a line.
pub fn words(out: &mut dyn Write, pieces: &[&str]) -> Result {
    pieces.iter().try_for_each(|piece| out.write_str(piece))
}

/// A whole number.
pub fn whole(out: &mut dyn Write, number: u64) -> Result {
    digits(out, number, 10, 1)
}

/// A line with a number twice: for people, to a millionth, and with every bit.
pub fn number(out: &mut dyn Write, name: &str, value: f64) -> Result {
    let size = value.abs();
    let mut whole_part = size as u64;
    // The fraction is exact; its millionths are rounded once more, which only a tie would show.
    let mut millionths = ((size - whole_part as f64) * 1e6 + 0.5) as u64;
    if millionths == 1_000_000 {
        (whole_part, millionths) = (whole_part + 1, 0);
    }
    let sign = if value.is_sign_negative() {
        ": -"
    } else {
        ": "
    };
    words(out, &[name, sign])?;
    whole(out, whole_part)?;
    words(out, &["."])?;
    digits(out, millionths, 10, 6)?;
    words(out, &[" ("])?;
    digits(out, value.to_bits(), 16, 16)?;
    words(out, &[")\n"])
}

/// The six numbers of a pose, each a line.
pub fn pose_numbers(out: &mut dyn Write, pose: &Pose) -> Result {
    let euler = EulerPose::from(*pose);
    let numbers = [
        ("  x mm", euler.x_mm),
        ("  y mm", euler.y_mm),
        ("  z mm", euler.z_mm),
        ("  z_rot deg", euler.z_rot_deg),
        ("  x_rot deg", euler.x_rot_deg),
        ("  y_rot deg", euler.y_rot_deg),
    ];
    numbers
        .into_iter()
        .try_for_each(|(name, value)| number(out, name, value))
}

/// At least so many digits, in a base up to 16.
pub fn digits(out: &mut dyn Write, number: u64, base: u64, least: u32) -> Result {
    let rest = number / base;
    if least > 1 || rest > 0 {
        digits(out, rest, base, least.saturating_sub(1))?;
    }
    let digit = (number % base) as u8;
    let digit = digit + if digit < 10 { b'0' } else { b'a' - 10 };
    out.write_char(char::from(digit))
}
