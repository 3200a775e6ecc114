//! The Python package: what fits into every run, and the whole of it, as a wheel in an environment of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Implants, Options};

use super::checked_profile::{self, CHECKED};
use super::counts;
use super::report::{Report, Said};
use crate::setup::rust_target::own_cargo;
use crate::setup::{command, components, python, telling};
use crate::{wheel, workspace};

/// The extension's crate.
pub(super) const PACKAGE: &str = "fluoropose-python";
/// What the extension is called in cargo's output, and in the package.
const BUILT: [(&str, &str); 3] = [
    ("libfluoropose_python.so", "_native.abi3.so"),
    ("libfluoropose_python.dylib", "_native.abi3.so"),
    ("fluoropose_python.dll", "_native.pyd"),
];
/// What the whole suite reads the package's files with.
const READERS: [&str; 8] = [
    "numpy>=1.23",
    "mypy",
    "pandas",
    "pandas-stubs",
    "spm1d",
    "matplotlib",
    "nbclient",
    "ipykernel",
];

/// The quick tests, without a wheel: they find the package where it lies, with the extension that the native suite built.
pub(crate) fn quick(report: &mut Report) {
    report.step("python: tests", || {
        let folder = workspace::target_dir().join("python/package");
        assemble(&folder)?;
        let python = with_numpy()?;
        tests(&python, "test_quick_*.py", Some(&folder))
    });
}

/// The extension with its lints, by itself, and the quick tests.
pub(super) fn alone(report: &mut Report) {
    let built = report.step("python: extension with lints", || {
        let mut cargo = own_cargo();
        cargo.args(["build", "--package", PACKAGE]).args(CHECKED);
        components::lint(&mut cargo)?;
        Ok(command::run(&mut cargo)?.into())
    });
    if built {
        quick(report);
    }
}

/// The wheel in a clean environment: types, all tests, the notebook.
pub(crate) fn run(report: &mut Report) {
    let mut installed = None;
    report.step("python: wheel in a clean environment", || {
        let wheel = wheel::make(&workspace::target_dir().join("python/wheel"))?;
        // Made anew each time: nothing of an older wheel is left.
        let _ = fs::remove_dir_all(workspace::target_dir().join("python/clean"));
        let python = python::environment("clean", &[])?;
        python::pip(&python, &[wheel])?;
        let said = command::output(
            Command::new(&python).args(["-m", "pip", "list", "--format", "freeze"]),
        )?;
        let others = said.lines().filter(|line| {
            !["pip=", "setuptools=", "wheel="]
                .iter()
                .any(|own| line.starts_with(own))
        });
        let others: Vec<&str> = others.collect();
        ensure!(
            others.len() == 2 && others[1].starts_with("numpy="),
            "numpy alone is to come with fluoropose, not {others:?}"
        );
        installed = Some(python);
        Ok(others.join(", ").into())
    });
    let Some(python) = installed else {
        for name in [QUICK, TYPES, WHOLE] {
            report.skip(name, "there is no wheel");
        }
        return;
    };
    report.step(QUICK, || tests(&python, "test_quick_*.py", None));
    report.step(TYPES, || {
        python::pip(&python, &READERS)?;
        let package = workspace::root().join("core/python");
        let mut mypy = Command::new(&python);
        mypy.args([
            "-m",
            "mypy",
            "--strict",
            "python/fluoropose",
            "tests/example_types.py",
        ]);
        command::run(mypy.current_dir(package))?;
        Ok(Said::default())
    });
    report.step(WHOLE, || tests(&python, "test_*.py", None));
    report.step("the command by cargo install", || {
        installed_command(&python)
    });
}

/// The command alone, without Python: its libraries are those of the wheel's command, byte for byte.
fn installed_command(python: &Path) -> Result<Said> {
    let root = workspace::target_dir().join("python/installed");
    let mut cargo = own_cargo();
    cargo.args(["install", "--locked", "--force", "--quiet", "--path"]);
    cargo.arg(workspace::root().join("xtask/laboratory"));
    cargo.arg("--root").arg(&root);
    cargo.arg("--target-dir").arg(workspace::target_dir());
    command::run(&mut cargo)?;
    let alone = root
        .join("bin")
        .join(format!("fluoropose{}", std::env::consts::EXE_SUFFIX));
    let study = workspace::target_dir().join("python/study");
    let library = |program: &Path| -> Result<Vec<u8>> {
        let out = root.join("femur.library");
        let mut verb = Command::new(program);
        verb.arg("library")
            .arg("--model")
            .arg(study.join("femur.stl"));
        verb.arg("--calibration").arg(study.join("calibration.txt"));
        command::output(verb.arg("--out").arg(&out))?;
        Ok(fs::read(&out)?)
    };
    let of_wheel = python::beside(python, "fluoropose");
    ensure!(
        library(&alone)? == library(&of_wheel)?,
        "the installed command makes another library than the wheel's"
    );
    Ok(Said::default())
}

const QUICK: &str = "python: tests with numpy alone";
const TYPES: &str = "python: types";
const WHOLE: &str = "python: tests with the files' readers";

/// Puts the package together.
fn assemble(folder: &Path) -> Result<()> {
    let package = folder.join("fluoropose");
    let _ = fs::remove_dir_all(&package);
    fs::create_dir_all(&package)?;
    let release = workspace::target_dir().join("release");
    let built = BUILT.iter().find(|(name, _)| release.join(name).is_file());
    let (name, to) = built.context("cargo left no extension")?;
    fs::copy(release.join(name), package.join(to))?;
    for entry in fs::read_dir(workspace::root().join("core/python/python/fluoropose"))? {
        let path = entry?.path();
        if path.is_file() {
            fs::copy(&path, package.join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}

/// The Python at hand where it has numpy, else an environment that has.
fn with_numpy() -> Result<PathBuf> {
    let python = python::python()?;
    if command::output(Command::new(&python).args(["-c", "import numpy"])).is_ok() {
        return Ok(python);
    }
    Ok(python::environment("numpy", &["numpy>=1.23"])?)
}

/// Runs the package's tests on a synthetic study.
fn tests(python: &Path, pattern: &str, package: Option<&Path>) -> Result<Said> {
    let study = workspace::target_dir().join("python/study");
    let options = Options {
        frames: 2,
        seed: 3,
        // As `study.py` knows: numbers are as much the same in small frames, and of models with fewer triangles.
        pixels: 512,
        implants: Some(Implants::built_in(Side::Left, 0.5)?),
        ..Options::default()
    };
    sequence::write(&options, &study)?;
    let notes = workspace::target_dir().join("python/skipped");
    let _ = fs::remove_file(&notes);
    let mut tests = Command::new(python);
    tests
        .args([
            "-m",
            "unittest",
            "discover",
            "--verbose",
            "--start-directory",
            "tests",
            "--pattern",
            pattern,
        ])
        .current_dir(workspace::root().join("core/python"))
        .env("FLUOROPOSE_DEMO", &study)
        .env("FLUOROPOSE_SKIPPED", &notes)
        .env("PYTHONDONTWRITEBYTECODE", "1");
    if let Some(package) = package {
        tests
            .env("PYTHONPATH", package)
            .envs(checked_profile::surroundings());
    }
    let told = command::tee_all(&mut tests)?;
    told.or_failed("a test of the Python package", telling::of_unittest)?;
    Ok(counts::of_unittest(&told.all())?.into())
}
