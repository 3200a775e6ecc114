//! Verb `mutants`: changes of the sources, one at a time, that the tests have to notice.
//!
//! The program that makes them is compiled when it is wanted, as that of `tidy`, and works on a copy.

use std::fs;

use anyhow::{Context, Result};

use crate::setup::command;
use crate::setup::rust_target::own_cargo;
use crate::{sources, workspace};

/// Options of `mutants`.
#[derive(clap::Args)]
#[command(
    disable_help_flag = true,
    after_help = "`cargo xtask mutants --help` tells them."
)]
pub(crate) struct Args {
    /// Options of the program
    #[arg(
        allow_hyphen_values = true,
        trailing_var_arg = true,
        value_name = "OPTIONS"
    )]
    options: Vec<String>,
}

/// Runs the verb.
///
/// # Errors
/// Where there is nothing to copy, and where tests fail without a change. A change that is missed is no error: it is listed.
pub(crate) fn run(args: Args) -> Result<()> {
    let copy = workspace::target_dir().join("mutants/sources");
    let asks = |option: &String| matches!(option.as_str(), "--help" | "-h");
    // Another run may have woven its changes into the copy.
    if !args.options.iter().any(asks) {
        fs::create_dir_all(&copy).with_context(|| format!("cannot make {}", copy.display()))?;
        sources::copy(&copy)?;
    }
    let mut program = own_cargo();
    program.args([
        "run",
        "--release",
        "--quiet",
        "--package",
        "fluoropose-mutants",
        "--",
    ]);
    command::run(program.arg("--root").arg(&copy).args(args.options))
}
