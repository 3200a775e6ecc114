//! The Cortex-M4F application under QEMU, compared with this machine line by line.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use fluoropose::pose::{Pose, geodesic_deg};

use super::report::Report;
use crate::firmware::{Proof, TRUTH, write_inputs};
use crate::setup::rust_target::{self, Toolchain, own_cargo};
use crate::setup::{command, components, programs};
use crate::workspace;

/// Emulating the proof takes a few seconds; far beyond that it hangs.
const QEMU_LIMIT: Duration = Duration::from_secs(120);

/// Runs the suite.
pub fn run(report: &mut Report) {
    let inputs = || write_inputs(&inputs_folder()).map(|()| String::new());
    if !report.step("firmware: library and outline", inputs) {
        report.skip("firmware: the proof", "there is nothing to put into flash");
        return;
    }
    report.step("firmware: formatting and lints", check_source);
    report.step("firmware: board and host agree", || compare(&[]));
    report.step("firmware: board and host agree with micromath", || {
        compare(&["--features", "micromath"])
    });
}

/// Where all that belongs to the firmware goes.
fn folder() -> PathBuf {
    workspace::target_dir().join("firmware")
}

fn inputs_folder() -> PathBuf {
    folder().join("inputs")
}

/// Points a cargo at the firmware's workspace.
fn at_firmware(cargo: &mut Command) -> &mut Command {
    cargo
        .arg("--manifest-path")
        .arg(workspace::root().join("tests/firmware/Cargo.toml"))
        .env("FLUOROPOSE_FIRMWARE_INPUTS", inputs_folder())
}

fn check_source() -> Result<String> {
    components::ensure("fmt")?;
    components::ensure("clippy")?;
    command::run(at_firmware(own_cargo().args(["fmt", "--check"])))?;
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    if matches!(toolchain, Toolchain::Debian { .. }) {
        return Ok("formatting only: Debian's compiler brings no lints".into());
    }
    let mut clippy = toolchain.cargo("clippy", &folder());
    at_firmware(clippy.arg("--release")).args(["--", "-D", "warnings"]);
    command::run(&mut clippy)?;
    Ok(String::new())
}

/// Runs the same proof here and on the board; both must write the same lines, and a pose near the true one.
fn compare(features: &[&str]) -> Result<String> {
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    let qemu = programs::qemu_arm()?;
    let host = on_host(features)?;
    let board = on_board(&toolchain, qemu, features)?;
    for line in board.lines().filter(|line| is_information(line)) {
        println!("{line}");
    }
    let compared: Vec<&str> = board.lines().filter(|line| !is_information(line)).collect();
    let expected: Vec<&str> = host.lines().collect();
    let differing = expected.iter().zip(&compared).find(|(a, b)| a != b);
    if let Some((expected, found)) = differing {
        anyhow::bail!("the host writes `{expected}` where the board writes `{found}`");
    }
    ensure!(
        expected.len() == compared.len(),
        "the host writes {} lines, the board {}",
        expected.len(),
        compared.len()
    );
    check_pose(&host)?;
    Ok(format!("{} lines alike", compared.len()))
}

fn on_host(features: &[&str]) -> Result<String> {
    let mut cargo = own_cargo();
    at_firmware(cargo.args(["run", "--quiet", "--release"])).args(features);
    cargo.arg("--target-dir").arg(folder());
    command::output(&mut cargo)
}

fn on_board(toolchain: &Toolchain, qemu: PathBuf, features: &[&str]) -> Result<String> {
    let mut cargo = toolchain.cargo("build", &folder());
    at_firmware(cargo.arg("--release")).args(features);
    command::run(&mut cargo)?;
    let image = toolchain
        .output_dir("release", &folder())
        .join("fluoropose-firmware");
    let mut board = Command::new(qemu);
    board.args(["-M", "mps2-an386", "-nographic", "-icount", "shift=6"]);
    board
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(image);
    command::output_within(QEMU_LIMIT, &mut board).context("the board did not finish its proof")
}

fn is_information(line: &str) -> bool {
    line.starts_with("info: ")
}

/// That both agree says nothing if both are wrong: the first pose must be near the true one.
fn check_pose(lines: &str) -> Result<()> {
    let proof = Proof::read(lines)?;
    let truth = Pose::from(TRUTH);
    let turned = geodesic_deg(&proof.pose.rotation, &truth.rotation);
    let [x, y, z] = std::array::from_fn(|k| proof.pose.translation[k] - truth.translation[k]);
    println!("off the true pose by {turned:.2} deg, {x:.3}, {y:.3} and {z:.2} mm");
    ensure!(
        turned < 1.0 && x.abs() < 0.5 && y.abs() < 0.5 && z.abs() < 10.0,
        "the pose is {turned:.2} deg and {x:.2}, {y:.2}, {z:.2} mm off the true one"
    );
    Ok(())
}
