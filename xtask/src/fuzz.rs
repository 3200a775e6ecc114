//! Verb `fuzz`: changed bytes to every reader, and to the way from an outline to a pose.

use std::io::Write as _;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

use crate::conformance;
use crate::output::announce;
use crate::setup::rust_target::own_cargo;
use crate::setup::{command, node};
use crate::workspace;

/// Options of `fuzz`.
#[derive(clap::Args)]
#[command(
    after_help = "Targets, by turns: frames (images, DICOM, models: the files of `conformance`), libraries and implants in one file with right checksums, pose files \
beside a second reader, calibrations, outlines to poses, and sessions. What is kept in tests/corpus, golden files and more are changed at random in one to six places. \
Arithmetic is checked for overflow. What panics, or takes longer than 20 s, is kept below target/fuzz, and the verb fails; it prints how often each target ran since its last crash."
)]
pub(crate) struct Args {
    /// How long
    #[arg(long, value_name = "MINUTES", default_value_t = 1.0)]
    minutes: f64,
    /// Instead: flip every single bit of libraries, a firmware image, a session, and small frames and models, some minutes
    #[arg(long, conflicts_with = "minutes")]
    flips: bool,
    /// Other changes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be installed or built, and where a file ends the program or takes too long.
pub(crate) fn run(args: Args) -> Result<()> {
    if args.flips {
        return flips();
    }
    // Without the other readers there is the corpus alone.
    let seeds = conformance::seeds().unwrap_or_else(|error| {
        announce(&format!(
            "the files of other readers are left out: {error:#}"
        ));
        String::new()
    });
    let mut build = own_cargo();
    build.args(["build", "-p", "fluoropose-tests", "--example", "fuzz"]);
    if !build.status()?.success() {
        bail!("the program that changes bytes could not be built");
    }
    let program = format!("fuzz{}", std::env::consts::EXE_SUFFIX);
    // The others and sessions have the same time each.
    let seconds = (60.0 * args.minutes).max(1.0);
    let mut reading = Command::new(workspace::target_dir().join("debug/examples").join(program))
        .arg((seconds * 6.0 / 7.0).ceil().to_string())
        .arg(args.seed.to_string())
        .arg(workspace::target_dir().join("fuzz"))
        .stdin(Stdio::piped())
        .spawn()?;
    let mut paths = reading.stdin.take().context("the program reads no paths")?;
    paths.write_all(seeds.as_bytes())?;
    drop(paths);
    if !reading.wait()?.success() {
        bail!("bytes ended the program or took too long");
    }
    sessions(seconds / 7.0, args.seed)
}

/// Session files, which the page reads: changed for so long, and then each single bit flipped.
fn sessions(seconds: f64, seed: u64) -> Result<()> {
    let web = workspace::root().join("web");
    node::install(&web)?;
    let mut tests = node::script(&web, "test")?;
    tests
        .args(["--", "tests/document/changed_sessions.test.ts"])
        .env("FLUOROPOSE_FUZZ_SECONDS", seconds.to_string())
        .env("FLUOROPOSE_FUZZ_SEED", seed.to_string());
    command::run(&mut tests)
}

fn flips() -> Result<()> {
    let mut tests = own_cargo();
    tests
        .args(["test", "-p", "fluoropose-tests", "--test", "all", "flips::"])
        .args(["--", "--nocapture"])
        .env("FLUOROPOSE_EVERY_BIT", "1");
    command::run(&mut tests)?;
    let mut files = own_cargo();
    files
        .args(["test", "-p", "fluoropose-decode", "--test", "decode"])
        .args(["--", "any_", "small_files_take"])
        .env("FLUOROPOSE_EVERY_BIT", "1");
    command::run(&mut files)?;
    sessions(1.0, 1)
}
