//! What an image for the board takes, as rows: compared with what was committed, and written as JSON.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde::Serialize;

use crate::workspace;

/// One figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    pub board: &'static str,
    pub work: String,
    pub value: u64,
    pub unit: String,
}

/// A figure may differ from the committed one by one part in this many: more is a change that somebody wants to know of.
const TOLERANCE: u64 = 20;
/// And by so much, whatever it is: one more call in a hundred.
const SMALL: u64 = 100;

/// The row in `info: WORK: VALUE UNIT`, of a program of this name on a board.
pub(crate) fn read(board: &'static str, program: &str, line: &str) -> Option<Row> {
    let (work, figure) = line.strip_prefix("info: ")?.rsplit_once(": ")?;
    let (value, unit) = figure.split_once(' ')?;
    Some(Row {
        board,
        work: format!("{program}: {work}"),
        value: value.parse().ok()?,
        unit: unit.into(),
    })
}

/// Where the figures are that were committed.
fn committed() -> PathBuf {
    workspace::root().join("tests/snapshots/firmware.txt")
}

/// Compares the figures of a program with those that were committed; `FLUOROPOSE_REGENERATE=1` commits them instead.
///
/// Errors with the lines to change where one differs by more than a twentieth.
pub(crate) fn compare(program: &str, rows: &[Row]) -> Result<()> {
    let text = fs::read_to_string(committed()).unwrap_or_default();
    let prefix = format!("{program}: ");
    let (own, others): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| line.starts_with(&prefix));
    let lines: Vec<String> = rows.iter().map(line).collect();
    if std::env::var_os("FLUOROPOSE_REGENERATE").is_some_and(|value| value == "1") {
        let mut all: Vec<String> = others.into_iter().map(String::from).collect();
        all.extend(lines);
        all.sort();
        return fs::write(committed(), all.join("\n") + "\n")
            .context("the snapshot cannot be written");
    }
    let patch = patch(&own, &lines);
    ensure!(
        patch.is_empty(),
        "tests/snapshots/firmware.txt is {program}'s no more; if that should be, run again with FLUOROPOSE_REGENERATE=1\n{}",
        patch.join("\n")
    );
    Ok(())
}

fn line(row: &Row) -> String {
    format!("{}: {} {}", row.work, row.value, row.unit)
}

/// What would have to change, as lines of a patch.
fn patch(old: &[&str], new: &[String]) -> Vec<String> {
    let parts = |line: &str| {
        let (work, figure) = line.rsplit_once(": ").unwrap_or((line, ""));
        let value = figure
            .split(' ')
            .next()
            .and_then(|value| value.parse::<u64>().ok());
        (work.to_string(), value.unwrap_or_default())
    };
    let alike = |a: &str, b: &str| {
        let ((a, x), (b, y)) = (parts(a), parts(b));
        // None is none: of calls that end in a panic.
        a == b && (x == 0) == (y == 0) && x.abs_diff(y) <= (x / TOLERANCE).max(SMALL)
    };
    let gone = old
        .iter()
        .filter(|old| !new.iter().any(|new| alike(old, new)));
    let come = new
        .iter()
        .filter(|new| !old.iter().any(|old| alike(old, new)));
    let gone = gone.map(|line| format!("-{line}"));
    gone.chain(come.map(|line| format!("+{line}"))).collect()
}

/// Writes rows as `{"rows": [{"board", "work", "value", "unit"}]}`.
///
/// Errors where the file cannot be written.
pub(crate) fn write_json(rows: &[Row], file: &Path) -> Result<()> {
    #[derive(Serialize)]
    struct Rows<'r> {
        rows: &'r [Row],
    }
    let text = serde_json::to_string_pretty(&Rows { rows })?;
    fs::write(file, text + "\n").with_context(|| format!("cannot write {}", file.display()))
}

/// Adds rows to those of a file that [`write_json`] wrote.
///
/// Errors where it is none, or cannot be written.
pub(crate) fn add_json(rows: &[Row], file: &Path) -> Result<()> {
    let text = fs::read_to_string(file).context("no figures were written")?;
    let mut all: serde_json::Value = serde_json::from_str(&text)?;
    let list = all
        .get_mut("rows")
        .and_then(serde_json::Value::as_array_mut);
    let list = list.context("the figures have no rows")?;
    for row in rows {
        list.push(serde_json::to_value(row)?);
    }
    let text = serde_json::to_string_pretty(&all)?;
    fs::write(file, text + "\n").with_context(|| format!("cannot write {}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_from_what_the_board_says() {
        let row = read(
            "Cortex-M4F",
            "finder",
            "info: implant opened, checked: 4000123 instructions",
        )
        .unwrap();
        assert_eq!(row.work, "finder: implant opened, checked");
        assert_eq!((row.value, row.unit.as_str()), (4_000_123, "instructions"));
        assert_eq!(read("Cortex-M4F", "finder", "x mm: 3.0"), None);
    }

    #[test]
    fn what_changes_by_more_than_a_twentieth_is_a_patch() {
        let old = ["a: 1000000 bytes", "b: 10 calls", "c: 7 bytes"];
        let new = |a: u64, b: u64| {
            vec![
                format!("a: {a} bytes"),
                format!("b: {b} calls"),
                "c: 7 bytes".into(),
            ]
        };
        assert!(patch(&old, &new(1_049_000, 12)).is_empty());
        assert_eq!(
            patch(&old, &new(1_051_000, 10)),
            ["-a: 1000000 bytes", "+a: 1051000 bytes"]
        );
        assert_eq!(patch(&old, &new(940_000, 10)).len(), 2);
        assert_eq!(patch(&old, &new(1_000_000, 10)[..2]), ["-c: 7 bytes"]);
        let none = ["d: 0 calls"];
        assert!(patch(&none, &["d: 0 calls".into()]).is_empty());
        assert_eq!(patch(&none, &["d: 1 calls".into()]).len(), 2);
    }
}
