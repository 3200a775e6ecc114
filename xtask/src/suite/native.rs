//! Layout, formatting, lints and the Rust tests on this machine.

use std::fs;
use std::process::Command;

use anyhow::{Result, ensure};

use super::counts;
use super::report::{Report, Said};
use crate::output::say;
use crate::setup::command;
use crate::setup::components;
use crate::setup::rust_target::own_cargo;
use crate::tidy;
use crate::workspace;

/// Tests use the `release` profile, whose dependencies `cargo xtask` itself has just built, but the core's
/// arithmetic and assertions are checked in them.
pub(crate) const CHECKED: [&str; 5] = [
    "--release",
    "--config",
    "profile.release.package.fluoropose.overflow-checks=true",
    "--config",
    "profile.release.package.fluoropose.debug-assertions=true",
];

/// Programs that check what they print.
const EXAMPLES: [&str; 3] = [
    "joint_kinematics",
    "library_in_static_memory",
    "outline_to_pose",
];

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    report.step("native: layers and cycles", || quiet(&mut tidy::program()));
    report.step("native: formatting", || {
        components::ensure("fmt")?;
        quiet(own_cargo().args(["fmt", "--all", "--check"]))
    });
    report.step("native: lints", || {
        components::ensure("clippy")?;
        let lint = [
            "clippy",
            "--workspace",
            "--all-targets",
            "--release",
            "--",
            "-D",
            "warnings",
        ];
        quiet(own_cargo().args(lint))
    });
    report.step("native: tests", || {
        let everything = [
            "test",
            "--workspace",
            "--exclude",
            "xtask",
            "--no-fail-fast",
        ];
        tests(own_cargo().args(everything).args(CHECKED))
    });
    report.step("native: examples of the core", || {
        EXAMPLES.into_iter().try_for_each(|name| {
            // The tests built them.
            let example = workspace::target_dir().join("release/examples").join(name);
            command::run(&mut Command::new(example))
        })?;
        Ok(Said::default())
    });
    // By itself it shares with the program that runs here all that this was built from.
    report.step("native: tests of this program", || {
        tests(own_cargo().args(["test", "--package", "xtask", "--release"]))
    });
}

fn quiet(command: &mut Command) -> Result<Said> {
    Ok(command::run(command)?.into())
}

/// Runs `cargo test` and counts what it ran, and what of that found nothing to check.
pub(crate) fn tests(cargo: &mut Command) -> Result<Said> {
    let notes = workspace::target_dir().join("skipped-tests");
    // None is left from a run before.
    let _ = fs::remove_file(&notes);
    let (success, output) = command::tee(cargo.env("FLUOROPOSE_SKIPPED", &notes))?;
    ensure!(success, "`cargo test` failed; its output above says where");
    let notes = fs::read_to_string(&notes).unwrap_or_default();
    notes.lines().for_each(say);
    Ok(counts::of_cargo(&output)?.with_notes(&notes).into())
}
