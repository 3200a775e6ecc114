//! Files of the field, read. `.jts`, `.jtak` and `.jtap` are read by `fluoropose::pose::jts`.

use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::shared::ERRORS;
use fluoropose::joint::{COLUMNS, JointFrame};
use fluoropose::{Pose, Side};
use thiserror::Error;

use crate::cell::{in_heading, plain};
use crate::film::{JointFilm, JointRow, NO_VERDICTS};

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ReadError {
    /// A row of another length, or with words.
    #[error("line {line} of the file does not hold {expected} numbers")]
    Row {
        /// Line, from 1.
        line: usize,
        /// Numbers that it should hold.
        expected: usize,
    },
    /// Another kind of file.
    #[error("this is no {0} file")]
    Kind(&'static str),
    /// Bodies of a `.tra` have 16 numbers each.
    #[error(
        "a row of this .tra file holds {0} numbers, which is no multiple of 16: files of x, y, z, yaw, pitch and roll do not say about which axes, so only matrices are read"
    )]
    Bodies(usize),
    /// Numbers that are no pose.
    #[error("line {0} of the .tra file holds a matrix that is no rotation and translation")]
    Matrix(usize),
}

/// Columns of numbers with their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Row by row.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// A column by its name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.names.iter().position(|other| other == name)?;
        self.rows.iter().map(|row| row.get(at).copied()).collect()
    }
}

/// The poses of each body of a `.tra`: matrices by rows or by columns, whichever has 0, 0, 0, 1 where that belongs.
///
/// # Errors
/// [`ReadError`] names the line.
pub fn tra(text: &str) -> Result<Vec<Vec<Option<Pose>>>, ReadError> {
    let mut bodies: Vec<Vec<Option<Pose>>> = Vec::new();
    let lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    for (index, line) in lines {
        let fields = line
            .split([',', '\t', ' ', ';'])
            .filter(|field| !field.is_empty());
        let numbers: Option<Vec<f64>> = fields.map(|field| field.parse().ok()).collect();
        let expected = 16 * bodies.len().max(1);
        let row = ReadError::Row {
            line: index + 1,
            expected,
        };
        let numbers = numbers.ok_or_else(|| row.clone())?;
        let (matrices, rest) = numbers.as_chunks::<16>();
        if !rest.is_empty() || matrices.is_empty() {
            return Err(ReadError::Bodies(numbers.len()));
        }
        if bodies.is_empty() {
            bodies.resize(matrices.len(), Vec::new());
        }
        if bodies.len() != matrices.len() {
            return Err(row);
        }
        for (body, matrix) in bodies.iter_mut().zip(matrices) {
            body.push(pose(matrix).ok_or(ReadError::Matrix(index + 1))?);
        }
    }
    Ok(bodies)
}

/// `None` for numbers that are no pose, `Some(None)` for a frame without one.
fn pose(matrix: &[f64; 16]) -> Option<Option<Pose>> {
    if matrix.iter().all(|number| number.is_nan()) {
        return Some(None);
    }
    let by_rows = matrix[12..] == [0.0, 0.0, 0.0, 1.0];
    let at = |row: usize, column: usize| match by_rows {
        true => matrix[4 * row + column],
        false => matrix[4 * column + row],
    };
    let last: [f64; 4] = core::array::from_fn(|column| at(3, column));
    let pose = Pose {
        rotation: core::array::from_fn(|row| core::array::from_fn(|column| at(row, column))),
        translation: core::array::from_fn(|row| at(row, 3)),
    };
    (last == [0.0, 0.0, 0.0, 1.0] && pose.is_rigid(1e-3)).then_some(Some(pose))
}

/// OpenSim's `.mot` and `.sto`.
///
/// # Errors
/// [`ReadError`] names the line.
pub fn mot(text: &str) -> Result<Table, ReadError> {
    let mut lines = text.lines().enumerate();
    let end = lines.find(|(_, line)| line.trim() == "endheader");
    let names = end
        .and_then(|_| lines.next())
        .ok_or(ReadError::Kind(".mot"))?;
    rows(names.1, lines, &['\t', ' '])
}

/// A table of joint numbers, the columns that hold numbers.
///
/// # Errors
/// [`ReadError`] names the line.
pub fn table(text: &str) -> Result<Table, ReadError> {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.starts_with('#'));
    let names = lines.next().ok_or(ReadError::Kind("table"))?;
    let names = names
        .1
        .strip_suffix(",doubt")
        .ok_or(ReadError::Kind("joint table"))?;
    // The doubts, in quotes, stand at the end.
    let numbers = lines.map(|(index, line)| {
        (
            index,
            line.split_once(",\"").map_or(line, |(numbers, _)| numbers),
        )
    });
    rows(names, numbers, &[','])
}

/// The film of a joint table: what [`crate::write::table`] wrote of it, without the tray's outline and what errors are shared. What a person accepted
/// is among its remarks.
///
/// # Errors
/// [`ReadError`] names the line, or says what is missing.
pub fn film(text: &str) -> Result<JointFilm, ReadError> {
    let table = table(text)?;
    let mut film = JointFilm {
        name: study_and_knee(text)
            .map(|(study, _)| study)
            .ok_or(ReadError::Kind("joint table"))?
            .to_owned(),
        side: match study_and_knee(text).and_then(|(_, knee)| knee.split(';').next()) {
            Some("left") => Side::Left,
            Some("right") => Side::Right,
            _ => return Err(ReadError::Kind("joint table")),
        },
        plate_depth_mm: millimetres(text, "tray: ", " mm deep"),
        plate_width_mm: millimetres(text, " mm deep, ", " mm wide"),
        plate_outline: Vec::new(),
        frames_per_s: None,
        cutoff_hz: None,
        remarks: Vec::new(),
        has_verdicts: !text.contains(&in_heading(NO_VERDICTS)),
        rows: Vec::new(),
    };
    let column = |name: &str| table.column(name).ok_or(ReadError::Kind("joint table"));
    let (numbers, checked) = (column("frame")?, column("checked")?);
    let all: Result<Vec<_>, _> = COLUMNS.iter().map(|one| column(one.name)).collect();
    let deviations: Result<Vec<_>, _> = COLUMNS
        .iter()
        .map(|one| column(&format!("sd_{}", one.name)))
        .collect();
    let (all, deviations) = (all?, deviations?);
    let body = text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    for (at, doubt) in body.skip(1).map(doubt_of).enumerate() {
        let take = |columns: &[Vec<f64>]| core::array::from_fn(|k| columns[k][at]);
        let joint = JointFrame {
            numbers: take(&all),
            deviations: Some(take(&deviations)).filter(|all: &[f64; NUMBERS]| all[0].is_finite()),
            shared: [[0.0; NUMBERS]; ERRORS],
        };
        let is_there = joint.numbers[place::FLEXION].is_finite();
        film.rows.push(JointRow {
            number: numbers[at] as usize,
            joint: is_there.then_some(joint),
            filtered: None,
            checked: checked[at] > 0.0,
            doubt: (!doubt.is_empty()).then_some(doubt),
            accepted: None,
            beside: None,
        });
    }
    film.remarks = remarks(text, &film.told());
    Ok(film)
}

/// What a heading says of a film behind the lines that each has, but for what its numbers say themselves.
fn remarks(text: &str, known: &[String]) -> Vec<String> {
    let heading = text.lines().map_while(|line| line.strip_prefix("# "));
    let behind = heading
        .skip_while(|line| !line.starts_with("filter: "))
        .skip(1);
    let is_known = |line: &str| known.iter().any(|known| in_heading(known) == line);
    behind
        .filter(|line| !is_known(line))
        .map(str::to_owned)
        .collect()
}

/// The text at the end of a row.
fn doubt_of(line: &str) -> String {
    let doubt = line
        .split_once(",\"")
        .map_or("", |(_, doubt)| doubt)
        .trim_end();
    let doubt = doubt
        .strip_suffix('"')
        .unwrap_or(doubt)
        .replace("\"\"", "\"");
    plain(&doubt).to_owned()
}

/// What a heading says between two words.
fn stated<'t>(text: &'t str, before: &str, after: &str) -> Option<&'t str> {
    let heading = text.lines().take_while(|line| line.starts_with('#'));
    let mut rests = heading.filter_map(|line| Some(line.split_once(before)?.1));
    rests.next()?.split_once(after).map(|(stated, _)| stated)
}

/// What the heading says of the study, and from the knee on. A study may have any name.
fn study_and_knee(text: &str) -> Option<(&str, &str)> {
    let heading = text.lines().take_while(|line| line.starts_with('#'));
    let mut rests = heading.filter_map(|line| line.strip_prefix("# study: "));
    rests.next()?.rsplit_once("; knee: ")
}

fn millimetres(text: &str, before: &str, after: &str) -> f64 {
    stated(text, before, after)
        .and_then(|stated| stated.parse().ok())
        .unwrap_or(0.0)
}

fn rows<'t>(
    names: &str,
    lines: impl Iterator<Item = (usize, &'t str)>,
    separators: &[char],
) -> Result<Table, ReadError> {
    let fields = |line: &str| -> Vec<String> {
        let fields = line.split(separators).filter(|field| !field.is_empty());
        fields.map(|field| field.trim().to_owned()).collect()
    };
    let names = fields(names);
    let mut table = Table {
        names,
        rows: Vec::new(),
    };
    for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let numbers: Option<Vec<f64>> = fields(line)
            .iter()
            .map(|field| field.parse().ok())
            .collect();
        let whole = numbers.filter(|numbers| numbers.len() == table.names.len());
        table.rows.push(whole.ok_or(ReadError::Row {
            line: index + 1,
            expected: table.names.len(),
        })?);
    }
    Ok(table)
}
