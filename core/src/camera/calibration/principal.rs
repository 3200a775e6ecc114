//! `JT_INTCALIB`: four numbers in mm, on a line each or all on one.

use super::error::CalibrationError;
use super::lines::{next_numbers, numbers};

/// What each number is.
const NAMES: [&str; 4] = [
    "principal distance",
    "principal point x",
    "principal point y",
    "pixel pitch",
];

/// Reads what follows the heading: `first` is the rest of its line. Principal distance, principal point x and y, pixel pitch.
pub(super) fn read<'a>(
    first: (usize, &'a str),
    lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<[f64; 4], CalibrationError> {
    // Words behind the heading are a note.
    let (line, rest) = first;
    let rest = rest.trim_start_matches([':', '=', ',', ';', ' ', '\t']);
    let begins = is_number_begun(rest).then_some((line, rest));
    let mut lines = begins.into_iter().chain(lines).peekable();
    let read = match lines.next_if(|&(_, line)| fields(line).count() == NAMES.len()) {
        Some(line) => all_on(line)?,
        None => {
            let mut read = [0.0; 4];
            for (value, name) in read.iter_mut().zip(NAMES) {
                if let Some(&line) = lines.peek() {
                    without_decimal_comma(line)?;
                }
                [*value] = next_numbers(&mut lines, name)?;
            }
            read
        }
    };
    // Notes stand there too, and three vectors of where the camera is in a laboratory, on which no pose in the camera's axes depends.
    for line in lines {
        if numbers::<1>(line, "").is_ok() {
            return Err(CalibrationError::OneMore { line: line.0 });
        }
    }
    Ok(read)
}

fn all_on(line: (usize, &str)) -> Result<[f64; 4], CalibrationError> {
    without_decimal_comma(line)?;
    let mut read = [0.0; 4];
    let of = read.iter_mut().zip(NAMES);
    for ((value, name), field) in of.zip(fields(line.1)) {
        [*value] = numbers((line.0, field), name)?;
    }
    Ok(read)
}

/// A comma between digits parts numbers only where all of the line is parted so, which is of four numbers then.
fn without_decimal_comma((line, text): (usize, &str)) -> Result<(), CalibrationError> {
    let within = |field: &str| field.trim_matches(',').contains(',');
    let is_list = parted(text).count() == 1 && fields(text).count() == NAMES.len();
    match !is_list && is_number_begun(text) && parted(text).any(within) {
        true => Err(CalibrationError::DecimalComma { line }),
        false => Ok(()),
    }
}

fn parted(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| letter == ';' || letter.is_whitespace())
        .filter(|field| !field.is_empty())
}

fn fields(text: &str) -> impl Iterator<Item = &str> {
    parted(text)
        .flat_map(|field| field.split(','))
        .filter(|field| !field.is_empty())
}

fn is_number_begun(text: &str) -> bool {
    let first = fields(text).next();
    first.is_some_and(|field| field.parse::<f64>().is_ok())
}
