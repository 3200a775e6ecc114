//! The Python package as a wheel.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::output::announce;
use crate::setup::{command, python};
use crate::supply::{self, notices};
use crate::workspace;

/// What builds it.
const MATURIN: [&str; 1] = ["maturin>=1.9,<2"];

/// Builds the wheel into a folder; its path.
///
/// Errors where Python, its packages or a compiler cannot be had.
pub(crate) fn make(out: &Path) -> Result<PathBuf> {
    let tools = python::environment("tools", &MATURIN)?;
    fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    // What an older version left is no answer.
    for old in wheels(out)? {
        fs::remove_file(&old).with_context(|| format!("cannot remove {}", old.display()))?;
    }
    let folder = workspace::root().join("core/python");
    notices::write(
        &folder,
        "the Python package fluoropose",
        &supply::of_wheel()?,
    )?;
    announce("building the Python package (maturin build)");
    let mut maturin = command::of_lane(python::beside(&tools, "maturin"));
    maturin
        .args(["build", "--release", "--manifest-path"])
        .arg(folder.join("Cargo.toml"))
        .arg("--sbom-include")
        .arg(folder.join(notices::SBOM))
        .arg("--out")
        .arg(out);
    command::run(&mut maturin)?;
    wheels(out)?.pop().context("maturin left no wheel")
}

fn wheels(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let ours = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("fluoropose-") && name.ends_with(".whl")
    };
    Ok(paths.filter(ours).collect())
}
