//! Words and numbers without the language's own writing of them, which takes 4 KB of a board's flash: only a proof shows any.

use core::fmt::{Error, Result};

use fluoropose::pose::{EulerPose, Pose};

/// Where lines go. In place of the language's trait, whose table of functions has its formatting linked whether anybody calls it or not.
pub trait Write {
    /// Adds words to the line.
    ///
    /// # Errors
    /// Where there is no room for them.
    fn write_str(&mut self, words: &str) -> Result;
}

impl<const N: usize> Write for heapless::String<N> {
    fn write_str(&mut self, words: &str) -> Result {
        self.push_str(words).map_err(|_| Error)
    }
}

/// Pieces of a line.
pub fn words(out: &mut dyn Write, pieces: &[&str]) -> Result {
    pieces.iter().try_for_each(|piece| out.write_str(piece))
}

/// A whole number.
pub fn whole(out: &mut dyn Write, number: u64) -> Result {
    digits(out, number, 10, 1)
}

/// A line with a number below 2^32 twice: for people, to a millionth, and with every bit.
pub fn number(out: &mut dyn Write, name: &str, value: f64) -> Result {
    let size = value.abs();
    let mut whole_part = size as u32;
    // The fraction is exact; its millionths are rounded once more, which only a tie would show.
    let mut millionths = ((size - f64::from(whole_part)) * 1e6 + 0.5) as u32;
    if millionths == 1_000_000 {
        (whole_part, millionths) = (whole_part + 1, 0);
    }
    let sign = if value.is_sign_negative() {
        ": -"
    } else {
        ": "
    };
    words(out, &[name, sign])?;
    whole(out, whole_part.into())?;
    words(out, &["."])?;
    digits(out, millionths.into(), 10, 6)?;
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
pub fn digits(out: &mut dyn Write, number: u64, base: u32, least: u32) -> Result {
    let (rest, digit) = divided(number, base);
    if least > 1 || rest > 0 {
        digits(out, rest, base, least.saturating_sub(1))?;
    }
    words(out, &[DIGITS.get(digit as usize).unwrap_or(&"?")])
}

const DIGITS: [&str; 16] = [
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "a", "b", "c", "d", "e", "f",
];

/// Quotient and remainder by a number of 16 bits, as by hand: no microcontroller divides 64 bits.
pub fn divided(number: u64, by: u32) -> (u64, u32) {
    let (mut quotient, mut rest) = (0, 0);
    for place in [48, 32, 16, 0] {
        let part = rest << 16 | (number >> place) as u32 & 0xffff;
        quotient = quotient << 16 | u64::from(part / by.max(1));
        rest = part % by.max(1);
    }
    (quotient, rest)
}
