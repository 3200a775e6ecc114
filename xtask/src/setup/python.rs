//! Python, and environments with packages of its registry.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::missing::Missing;
use super::{command, debian};
use crate::output::announce;
use crate::workspace;

/// The oldest Python that the package is for.
const OLDEST: (u32, u32) = (3, 10);
/// Names another Python.
const VARIABLE: &str = "FLUOROPOSE_PYTHON";

/// A Python that is new enough, with its module `venv`.
pub(crate) fn python() -> Result<PathBuf, Missing> {
    if let Some(named) = std::env::var_os(VARIABLE) {
        return Ok(PathBuf::from(named));
    }
    if let Some(found) = found() {
        return Ok(found);
    }
    debian::install("Python", &["python3", "python3-venv"])?;
    found().ok_or_else(|| Missing {
        what: format!("Python {}.{}", OLDEST.0, OLDEST.1),
        why: "what was installed is older or lacks its module venv".into(),
        remedy: format!("name one in {VARIABLE}"),
        tried: true,
    })
}

fn found() -> Option<PathBuf> {
    let python = command::find(&["python3", "python"])?;
    let asked = format!(
        "import ensurepip, sys; sys.exit(sys.version_info < ({}, {}))",
        OLDEST.0, OLDEST.1
    );
    let fits = command::output(Command::new(&python).args(["-c", &asked])).is_ok();
    fits.then_some(python)
}

/// The Python of an environment below the target folder that has these packages, made anew where it has others.
pub(crate) fn environment(name: &str, packages: &[&str]) -> Result<PathBuf, Missing> {
    let folder = workspace::target_dir().join("python").join(name);
    let (stamp, wanted) = (folder.join("packages.txt"), packages.join("\n"));
    let own = own_python(&folder);
    if own.is_file() && fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) {
        return Ok(own);
    }
    let python = python()?;
    let missing = |error: anyhow::Error| Missing {
        what: format!("Python packages ({})", packages.join(", ")),
        why: format!("{error:#}"),
        remedy: "look whether pip reaches a registry".into(),
        tried: true,
    };
    announce(&format!(
        "making a Python environment with {} (pip install)",
        packages.join(", ")
    ));
    // None is left of an older one.
    let _ = fs::remove_dir_all(&folder);
    command::output(Command::new(python).args(["-m", "venv"]).arg(&folder)).map_err(missing)?;
    if !packages.is_empty() {
        pip(&own, packages).map_err(missing)?;
    }
    fs::write(&stamp, wanted).map_err(|error| missing(error.into()))?;
    Ok(own)
}

/// Installs packages into the environment of a Python.
pub(crate) fn pip(python: &Path, packages: &[impl AsRef<std::ffi::OsStr>]) -> anyhow::Result<()> {
    let mut pip = Command::new(python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ]);
    command::output(pip.args(packages)).map(drop)
}

fn own_python(folder: &Path) -> PathBuf {
    match cfg!(windows) {
        true => folder.join("Scripts/python.exe"),
        false => folder.join("bin/python"),
    }
}

/// A program of the same environment.
pub(crate) fn beside(python: &Path, name: &str) -> PathBuf {
    python.with_file_name(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_lies_beside_its_python() {
        let python = own_python(Path::new("environment"));
        assert_eq!(beside(&python, "maturin").parent(), python.parent());
    }
}
