//! The Cortex-M4F application under QEMU, compared with this machine line by line.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use fluoropose::pose::{Pose, geodesic_deg};

use super::report::{Report, Said};
use crate::firmware::{Proof, TRUTH, write_inputs};
use crate::output::say;
use crate::setup::rust_target::{self, Toolchain, own_cargo};
use crate::setup::{command, components, programs};
use crate::workspace;

/// Emulating the proof takes a few seconds; far beyond that it hangs.
const QEMU_LIMIT: Duration = Duration::from_secs(120);

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    let inputs = || write_inputs(&inputs_folder()).map(Said::from);
    if !report.step("firmware: library and outline", inputs) {
        report.skip("firmware: the proof", "there is nothing to put into flash");
        return;
    }
    report.step("firmware: formatting", check_formatting);
    report.step("firmware: linted; board and host agree", || compare(&[]));
    report.step(
        "firmware: linted; board and host agree with micromath",
        || compare(&["--features", "micromath"]),
    );
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

fn check_formatting() -> Result<Said> {
    components::ensure("fmt")?;
    command::run(at_firmware(own_cargo().args(["fmt", "--check"])))?;
    Ok(().into())
}

/// Runs the same proof here and on the board; both must write the same lines, and a pose near the true one.
fn compare(features: &[&str]) -> Result<Said> {
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    let qemu = programs::qemu_arm()?;
    let host = on_host(features)?;
    let board = on_board(&toolchain, qemu, features)?;
    for line in board.lines().filter(|line| is_information(line)) {
        say(line);
    }
    let count = ensure_alike(&host, &board)?;
    check_pose(&host)?;
    Ok(format!("{count} lines alike").into())
}

/// The number of lines, which must be the same but for the board's own information.
fn ensure_alike(host: &str, board: &str) -> Result<usize> {
    let expected: Vec<&str> = host.lines().collect();
    let found: Vec<&str> = board.lines().filter(|line| !is_information(line)).collect();
    for (expected, found) in expected.iter().zip(&found) {
        ensure!(
            expected == found,
            "the host writes `{expected}` where the board writes `{found}`"
        );
    }
    let (here, there) = (expected.len(), found.len());
    ensure!(
        here == there,
        "the host writes {here} lines, the board {there}"
    );
    Ok(here)
}

/// The image for the board is optimised as one piece of code; here that would only be waited for, and how it is compiled
/// must not matter.
const HOST: [&str; 8] = [
    "--config",
    "profile.release.opt-level=0",
    "--config",
    "profile.release.debug=false",
    "--config",
    "profile.release.lto='off'",
    "--config",
    "profile.release.codegen-units=16",
];

fn on_host(features: &[&str]) -> Result<String> {
    let mut cargo = own_cargo();
    at_firmware(cargo.args(["run", "--quiet", "--release"]).args(HOST)).args(features);
    cargo.arg("--target-dir").arg(folder());
    components::lint(&mut cargo)?;
    command::output(&mut cargo)
}

fn on_board(toolchain: &Toolchain, qemu: PathBuf, features: &[&str]) -> Result<String> {
    let mut cargo = toolchain.cargo("build", &folder());
    at_firmware(cargo.arg("--release")).args(features);
    // Debian's compiler brings no lints.
    if let Toolchain::Own { .. } = toolchain {
        components::lint(&mut cargo)?;
    }
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
    say(&format!(
        "off the true pose by {turned:.2} deg, {x:.3}, {y:.3} and {z:.2} mm"
    ));
    ensure!(
        turned < 0.5 && x.abs() < 0.3 && y.abs() < 0.3 && z.abs() < 6.0,
        "the pose is {turned:.2} deg and {x:.2}, {y:.2}, {z:.2} mm off the true one"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_information_may_differ() {
        assert_eq!(
            ensure_alike("a\nb\n", "a\ninfo: 5 instructions\nb\n").unwrap(),
            2
        );
        assert!(ensure_alike("a\nb\n", "a\nc\n").is_err());
        assert!(ensure_alike("a\nb\n", "a\n").is_err());
        assert!(ensure_alike("a\n", "a\nb\n").is_err());
    }

    #[test]
    fn a_pose_off_the_true_one_is_told() {
        let lines = |x_mm: f64| {
            let truth = TRUTH;
            [
                ("x mm", x_mm),
                ("y mm", truth.y_mm),
                ("z mm", truth.z_mm),
                ("z_rot deg", truth.z_rot_deg),
                ("x_rot deg", truth.x_rot_deg),
                ("y_rot deg", truth.y_rot_deg),
            ]
            .map(|(name, value)| format!("{name}: {value} ({:016x})\n", value.to_bits()))
            .concat()
        };
        check_pose(&lines(TRUTH.x_mm + 0.1)).unwrap();
        assert!(check_pose(&lines(TRUTH.x_mm + 0.4)).is_err());
    }
}
