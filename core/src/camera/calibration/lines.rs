//! Lines of a calibration and the numbers in them.

use super::error::CalibrationError;

/// Lines that say something, from 1, without the notes at their ends.
pub(super) fn lines_of(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(index, line)| (index + 1, without_note(line).trim()))
        .filter(|(_, line)| !line.is_empty())
}

/// Notes begin as in most programs' files.
fn without_note(line: &str) -> &str {
    let line = line.split(['#', '%']).next().unwrap_or(line);
    let slashes = line.as_bytes().windows(2).position(|pair| pair == b"//");
    slashes.and_then(|end| line.get(..end)).unwrap_or(line)
}

pub(super) fn numbers<const N: usize>(
    (line, text): (usize, &str),
    name: &'static str,
) -> Result<[f64; N], CalibrationError> {
    let mut values = [0.0; N];
    let mut fields = text
        .split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty());
    for value in &mut values {
        *value = fields
            .next()
            .and_then(|field| field.parse().ok())
            .filter(|value: &f64| value.is_finite())
            .ok_or(CalibrationError::Number { line, name })?;
    }
    match fields.next() {
        Some(_) => Err(CalibrationError::Number { line, name }),
        None => Ok(values),
    }
}

pub(super) fn next_numbers<'a, const N: usize>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    name: &'static str,
) -> Result<[f64; N], CalibrationError> {
    numbers(lines.next().ok_or(CalibrationError::Missing(name))?, name)
}
