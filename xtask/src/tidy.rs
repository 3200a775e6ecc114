//! Verb `tidy`: the layout of the sources, checked by a program of its own.
//!
//! It is compiled when it is wanted: it parses Rust, and who only serves the page need not wait for that.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Result;

use crate::setup::command;
use crate::setup::rust_target::own_cargo;
use crate::workspace;

/// Options of `tidy`.
///
/// No file may use another in a circle, and no room of a `layers.txt` one above it. Nothing may stand at the top of
/// the repository that has no place there, no test may be switched off, no work be left to come, and no word return
/// that `xtask/tidy/words.txt` has replaced.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Print which file uses which in a crate, in `web`, or in a folder of their sources, room by room
    #[arg(long, value_name = "FOLDER")]
    graph: Option<PathBuf>,
    /// List files over 500 lines and functions over 60, and count them as errors
    #[arg(long)]
    long: bool,
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let mut check = program();
    if args.long {
        check.arg("--long");
    }
    if let Some(folder) = args.graph {
        check.arg("--graph").arg(folder);
    }
    command::run(&mut check)
}

/// The program that checks this workspace.
fn program() -> Command {
    let mut cargo = own_cargo();
    cargo
        .args([
            "run",
            "--release",
            "--quiet",
            "--package",
            "fluoropose-tidy",
            "--",
        ])
        .arg("--root")
        .arg(workspace::root());
    cargo
}
