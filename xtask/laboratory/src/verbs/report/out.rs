//! Where files go.

use std::path::Path;

use anyhow::{Context, Result};
use fluoropose::joint::COLUMNS;
use fluoropose_report::{JointFilm, write};

use crate::files::write_text;

/// A file of each number, a row a film.
pub(super) fn write_cycles(out: &Path, films: &[&JointFilm]) -> Result<()> {
    let cycle = out.join("cycle");
    make_folder(&cycle)?;
    for (number, column) in COLUMNS.iter().enumerate() {
        let name = cycle.join(format!("{}.csv", column.name));
        write_text(&name, &write::matrix(films, number))?;
    }
    Ok(())
}

pub(super) fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", folder.display()))
}
