//! Layout, formatting, lints and the Rust tests on this machine.

use std::fs;
use std::process::Command;

use anyhow::Result;

use super::checked_profile;
use super::counts;
use super::python;
use super::report::{Report, Said};
use super::test_programs;
use crate::output::{self, Lane, say};
use crate::setup::command;
use crate::setup::components;
use crate::setup::rust_target::own_cargo;
use crate::setup::telling;
use crate::workspace;

/// Programs that check what they print.
const EXAMPLES: [&str; 3] = [
    "joint_kinematics",
    "library_in_static_memory",
    "outline_to_pose",
];

/// Packages that have no tests in their sources: asked for by their kind, tests of theirs would be compiled none the less.
const WITHOUT_TESTS: [&str; 2] = ["fluoropose-embedded", "fluoropose-firmware-host"];

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    report.step("native: formatting", || {
        components::ensure("fmt")?;
        quiet(own_cargo().args(["fmt", "--all", "--check"]))
    });
    let mut programs = Vec::new();
    report.step("native: compiled, with lints", || {
        // First what tests in a browser wait for.
        checked_profile::laboratory()?;
        // Not `--benches`, to which tests in the sources belong: compiling those takes a third of the time, and other tests run meanwhile.
        let all_else = [
            "--lib",
            "--bins",
            "--examples",
            "--bench",
            "*",
            "--test",
            "*",
        ];
        command::run(&mut checked_profile::cargo("build", &all_else)?)?;
        // Now, as nobody else holds cargo's lock.
        programs = test_programs::built()?;
        Ok(Said::default())
    });
    report.step("native: layers and cycles", || {
        // It was built with everything else.
        let name = format!("release/tidy{}", std::env::consts::EXE_SUFFIX);
        let program = workspace::target_dir().join(name);
        quiet(Command::new(program).arg("--root").arg(workspace::root()))
    });
    // While tests in the sources are compiled, for which cargo locks what is built, the others need no cargo.
    let gives_way = output::lane().map_or(0, |lane| lane.gives_way);
    let lane = |name, gives_way| Lane { name, gives_way };
    report.side_by_side(&[
        (lane("sources", gives_way), &in_the_sources),
        // The last to be waited for compiles, and then runs, tests in the sources; and those in browsers have clocks.
        (lane("files", gives_way + 5), &|report| {
            report.step("native: tests in files of their own", || {
                test_programs::run(&programs)
            });
        }),
        (lane("beside", gives_way), &beside_the_tests),
    ]);
}

/// Tests inside the sources that they test.
fn in_the_sources(report: &mut Report) {
    // Asked for by its kind, even the extension's library would become a program, which it cannot be everywhere. It has no tests.
    let of_sources = |more: &[&str]| -> Result<Command> {
        let mut cargo = with_tests()?;
        cargo.args(["--exclude", python::PACKAGE]);
        cargo.args(["--lib", "--bins"]).args(more);
        Ok(cargo)
    };
    report.step("native: unit tests compiled, with lints", || {
        quiet(&mut of_sources(&["--no-run"])?)
    });
    report.step("native: tests in the sources", || {
        tests(&mut of_sources(&[])?, "sources")
    });
}

/// All that has tests in its sources.
fn with_tests() -> Result<Command> {
    let without = WITHOUT_TESTS.iter().flat_map(|name| ["--exclude", name]);
    let mut cargo = checked_profile::cargo("test", &["--no-fail-fast"])?;
    cargo.args(without);
    Ok(cargo)
}

/// Steps that read what is built, and change nothing of it.
fn beside_the_tests(report: &mut Report) {
    python::quick(report);
    report.step("native: examples of the core", || {
        EXAMPLES.into_iter().try_for_each(|name| {
            // The tests built them.
            let example = workspace::target_dir().join("release/examples").join(name);
            command::run(&mut Command::new(example))
        })?;
        Ok(Said::default())
    });
    // These wait for cargo's lock.
    report.step("native: examples in the documentation", || {
        tests(with_tests()?.arg("--doc"), "documentation")
    });
    report.step("native: pages of the crates", pages_of_the_crates);
}

fn pages_of_the_crates() -> Result<Said> {
    let crates = [
        "fluoropose",
        "fluoropose-tracing",
        "fluoropose-distortion",
        "fluoropose-kernels",
        "fluoropose-embedded",
    ];
    let packages = crates.iter().flat_map(|name| ["--package", name]);
    // What they stand on is compiled for the tests; lints were asked then.
    let mut cargo = own_cargo();
    cargo.arg("doc").args(checked_profile::CHECKED);
    cargo.args(["--no-deps", "--features", "fluoropose/alloc"]);
    // It has no page: with it macros have the features with which they are compiled.
    cargo.args(["--package", "xtask"]);
    quiet(cargo.args(packages).env("RUSTDOCFLAGS", "-D warnings"))
}

fn quiet(command: &mut Command) -> Result<Said> {
    Ok(command::run(command)?.into())
}

/// Runs `cargo test` and counts what it ran, and what of that found nothing to check; `which` names the tests, of those that run at one time.
pub(crate) fn tests(cargo: &mut Command, which: &str) -> Result<Said> {
    let notes = workspace::target_dir().join(format!("skipped-tests-{which}"));
    // None is left from a run before.
    let _ = fs::remove_file(&notes);
    let told = command::tee(cargo.env("FLUOROPOSE_SKIPPED", &notes))?;
    told.or_failed("`cargo test`", telling::of_cargo)?;
    let notes = fs::read_to_string(&notes).unwrap_or_default();
    notes.lines().for_each(say);
    Ok(counts::of_cargo(&told.output)?.with_notes(&notes).into())
}
