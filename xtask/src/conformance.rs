//! Verb `conformance`: the reader of frames beside those of the Python world, on the files that they ship.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Result, bail};

use crate::setup::rust_target::own_cargo;
use crate::setup::{command, python};
use crate::workspace;

/// The readers that ours is held against, and what they decode with.
const PACKAGES: [&str; 10] = [
    "numpy",
    "pydicom",
    "pylibjpeg",
    "pylibjpeg-libjpeg",
    "pylibjpeg-openjpeg",
    "pylibjpeg-rle",
    "pyjpegls",
    "pillow",
    "tifffile[all]",
    "scikit-image",
];

/// Where the programs in Python are.
const PROGRAMS: &str = "xtask/src/conformance";

/// Options of `conformance`.
#[derive(clap::Args)]
#[command(
    after_help = "pydicom, tifffile, Pillow, imagecodecs and scikit-image are installed with pip into a folder of their own under target/. Every \
image file that they ship for their tests, and some hundred that their encoders make, are read by them and by fluoropose. Each is the same, \
within the tolerance of a lossy coding, refused with the reason, or WRONG, at which the verb fails."
)]
pub(crate) struct Args {
    /// Only files with one of these in their names
    names: Vec<String>,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be installed or built, and where a file is read wrong.
pub(crate) fn run(args: Args) -> Result<()> {
    let python = environment()?;
    let mut build = own_cargo();
    build.args(["build", "--release", "-p", "fluoropose-decode"]);
    if !build.args(["--example", "decoded"]).status()?.success() {
        bail!("the program that decodes could not be built");
    }
    let program = format!("decoded{}", std::env::consts::EXE_SUFFIX);
    let compared = Command::new(python)
        .arg(workspace::root().join(PROGRAMS).join("conformance.py"))
        .arg(
            workspace::target_dir()
                .join("release/examples")
                .join(program),
        )
        .arg(folder()?)
        .args(args.names)
        .status()?;
    match compared.success() {
        true => Ok(()),
        false => bail!("files are read wrong, or could not be compared"),
    }
}

/// Paths of the files, a line each: those that are compared, and small models.
///
/// # Errors
/// For what cannot be installed or made.
pub(crate) fn seeds() -> Result<String> {
    let mut listing = Command::new(environment()?);
    listing
        .arg(workspace::root().join(PROGRAMS).join("seeds.py"))
        .arg(folder()?);
    command::output(&mut listing)
}

fn environment() -> Result<PathBuf> {
    Ok(python::environment("conformance", &PACKAGES)?)
}

/// Where made files are.
fn folder() -> Result<PathBuf> {
    let folder = workspace::target_dir().join("conformance");
    std::fs::create_dir_all(&folder)?;
    Ok(folder)
}
