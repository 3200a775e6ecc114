//! The laboratory's verbs, which a program of its own has: it is compiled when one of them is wanted.

use std::ffi::OsString;
use std::ops::Deref;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result};

use crate::setup::command as commands;
use crate::setup::rust_target::own_cargo;
use crate::workspace;

/// Whatever follows the verb; the laboratory reads it.
#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub(crate) struct Words {
    #[arg(
        trailing_var_arg = true,
        allow_hyphen_values = true,
        value_name = "OPTIONS"
    )]
    words: Vec<OsString>,
}

impl Deref for Words {
    type Target = [OsString];

    fn deref(&self) -> &[OsString] {
        &self.words
    }
}

/// Goes over into the laboratory's program that runs `verb`, so that its exit code and what ends it are this one's.
///
/// # Errors
/// Where cargo cannot be started. Nothing returns from here otherwise.
pub(crate) fn run(verb: &str, words: &[OsString]) -> Result<()> {
    let mut cargo = command(verb, words)?;
    #[cfg(unix)]
    let failed = std::os::unix::process::CommandExt::exec(&mut cargo);
    #[cfg(not(unix))]
    let failed = match cargo.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(1)),
        Err(error) => error,
    };
    Err(failed).context("cannot start cargo")
}

/// The program, compiled if need be.
///
/// # Errors
/// Where it does not compile.
pub(crate) fn program() -> Result<PathBuf> {
    commands::run(own_cargo().args(["build", "--release", "--package", "fluoropose-laboratory"]))?;
    let name = format!("release/fluoropose{}", std::env::consts::EXE_SUFFIX);
    Ok(workspace::target_dir().join(name))
}

fn command(verb: &str, words: &[OsString]) -> Result<Command> {
    let mut cargo = own_cargo();
    // Paths among the words are meant from where the person is.
    cargo.current_dir(std::env::current_dir()?);
    cargo
        .args(["run", "--release", "--manifest-path"])
        .arg(workspace::root().join("xtask/laboratory/Cargo.toml"))
        .args(["--", verb])
        .args(words)
        // As its examples name it.
        .env("FLUOROPOSE_COMMAND", "cargo xtask");
    Ok(cargo)
}
