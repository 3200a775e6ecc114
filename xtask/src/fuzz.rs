//! Verb `fuzz`: changed files to every reader of frames, masks and models.

use std::io::Write as _;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

use crate::conformance;
use crate::setup::rust_target::own_cargo;
use crate::workspace;

/// Options of `fuzz`.
#[derive(clap::Args)]
#[command(
    after_help = "The files are those of `conformance`, and small models; each is changed at random in one to six places. Arithmetic is checked for \
overflow. What panics, or takes longer than 20 s, is kept below target/fuzz, and the verb fails."
)]
pub(crate) struct Args {
    /// How long
    #[arg(long, value_name = "MINUTES", default_value_t = 1.0)]
    minutes: f64,
    /// Other changes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be installed or built, and where a file ends the program or takes too long.
pub(crate) fn run(args: Args) -> Result<()> {
    let seeds = conformance::seeds()?;
    let mut build = own_cargo();
    build.args(["build", "-p", "fluoropose-decode", "--example", "mutated"]);
    if !build.status()?.success() {
        bail!("the program that reads changed files could not be built");
    }
    let program = format!("mutated{}", std::env::consts::EXE_SUFFIX);
    let mut reading = Command::new(workspace::target_dir().join("debug/examples").join(program))
        .arg(((60.0 * args.minutes).max(1.0) as u64).to_string())
        .arg(args.seed.to_string())
        .arg(workspace::target_dir().join("fuzz"))
        .stdin(Stdio::piped())
        .spawn()?;
    let mut paths = reading.stdin.take().context("the program reads no paths")?;
    paths.write_all(seeds.as_bytes())?;
    drop(paths);
    match reading.wait()?.success() {
        true => Ok(()),
        false => bail!("a file ended the program or took too long"),
    }
}
