//! The laboratory's verbs, which a program of its own has: it is compiled when one of them is wanted.

use std::ffi::OsString;
use std::ops::Deref;
use std::process::ExitStatus;

use anyhow::{Context, Result};

use crate::setup::rust_target::own_cargo;

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

/// Ends this program as the laboratory's ends when it runs `verb`.
///
/// # Errors
/// Where cargo cannot be started. Otherwise the laboratory has said what was wrong, and nothing returns from here
/// unless it succeeded.
pub(crate) fn run(verb: &str, words: &[OsString]) -> Result<()> {
    let status = start(verb, words)?;
    if status.success() {
        return Ok(());
    }
    std::process::exit(status.code().unwrap_or(1))
}

fn start(verb: &str, words: &[OsString]) -> Result<ExitStatus> {
    let mut cargo = own_cargo();
    // Paths among the words are meant from where the person is.
    cargo.current_dir(std::env::current_dir()?);
    cargo
        .args(["run", "--release", "--manifest-path"])
        .arg(crate::workspace::root().join("xtask/laboratory/Cargo.toml"))
        .args(["--", verb])
        .args(words)
        // As its examples name it.
        .env("FLUOROPOSE_COMMAND", "cargo xtask");
    cargo.status().context("cannot start cargo")
}
