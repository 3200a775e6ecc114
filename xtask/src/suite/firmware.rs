//! The Cortex-M4F application under QEMU, compared with this machine line by line. Other boards: `boards.rs`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use fluoropose::pose::{Pose, geodesic_deg};

use super::board_rows::{self, Row, write_json};
use super::calls;
use super::checked_profile;
use super::report::{Report, Said};
use crate::firmware::{Proof, TRUTH, write_inputs};
use crate::output::say;
use crate::setup::rust_target::{self, Toolchain, own_cargo};
use crate::setup::{command, components, programs};
use crate::workspace;

/// Emulating the proof takes a few seconds, beside browsers and compilers a minute; far beyond that it hangs.
const QEMU_LIMIT: Duration = Duration::from_secs(600);

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    let inputs = || write_inputs(&inputs_folder()).map(Said::from);
    if !report.step("firmware: library and outline", inputs) {
        report.skip("firmware: the proof", "there is nothing to put into flash");
        return;
    }
    report.step("firmware: formatting", check_formatting);
    let mut rows = Vec::new();
    report.step("firmware: linted; board and host agree", || {
        compare(&LIBRARY, &mut rows)
    });
    report.step("firmware: linted; the finder on board and host", || {
        compare(&FINDER, &mut rows)
    });
    report.step("firmware: figures", || {
        write_json(&rows, &figures()).map(Said::from)
    });
}

/// Compares both with the fast approximations as well.
pub(super) fn run_with_micromath(report: &mut Report) {
    report.step(
        "firmware: linted; board and host agree with micromath",
        || compare(&MICROMATH, &mut Vec::new()),
    );
}

/// Where the figures of the last run are, as JSON.
pub(crate) fn figures() -> PathBuf {
    folder().join("figures.json")
}

/// One program for the board, and how near to the true pose it comes.
pub(super) struct Program {
    pub(super) name: &'static str,
    pub(super) features: &'static str,
    pub(super) within: Option<Within>,
}

pub(super) struct Within {
    turn_deg: f64,
    aside_mm: f64,
    depth_mm: f64,
}

/// Views a degree apart, interpolated.
const OF_A_VIEW: Within = Within {
    turn_deg: 0.5,
    aside_mm: 0.3,
    depth_mm: 6.0,
};

pub(super) const LIBRARY: Program = Program {
    name: "library",
    features: "",
    within: Some(OF_A_VIEW),
};

const MICROMATH: Program = Program {
    name: "micromath",
    features: "micromath",
    within: Some(OF_A_VIEW),
};

/// Its surface is coarser than the one that was seen.
const OF_A_COARSE_SURFACE: Within = Within {
    turn_deg: 0.5,
    aside_mm: 0.15,
    depth_mm: 1.0,
};

pub(super) const FINDER: Program = Program {
    name: "finder",
    features: "finder",
    within: Some(OF_A_COARSE_SURFACE),
};

/// From the pose of the frame before.
pub(super) const REFINE: Program = Program {
    name: "refinement",
    features: "refine",
    ..FINDER
};

/// A library's poses of random outlines, one after another: no panic, the host's answers, the stack of the worst.
pub(super) const OUTLINES: Program = Program {
    name: "outlines",
    features: "outlines",
    within: None,
};

/// The finder of the tibial component.
pub(super) const TIBIA: Program = Program {
    name: "tibia",
    features: "tibia",
    ..FINDER
};

/// The finder where nothing is known of the view.
pub(super) const ALL_ROUND: Program = Program {
    name: "all round",
    features: "all_round",
    ..FINDER
};

/// The same, linked for a Netduino Plus 2.
pub(super) const SMALL_FINDER: Program = Program {
    features: "finder,netduinoplus2",
    ..FINDER
};

/// Where all that belongs to the firmware goes.
pub(super) fn folder() -> PathBuf {
    workspace::target_dir().join("firmware")
}

pub(super) fn inputs_folder() -> PathBuf {
    folder().join("inputs")
}

/// Points a cargo at the firmware's workspace.
fn at_firmware(cargo: &mut Command) -> &mut Command {
    cargo
        .arg("--manifest-path")
        .arg(workspace::root().join("tests/firmware/Cargo.toml"))
        .env("FLUOROPOSE_FIRMWARE_INPUTS", inputs_folder())
}

/// Whether the build script finds what belongs into flash without being told: what the native suite has built need not be built again then.
fn inputs_are_where_usual() -> bool {
    inputs_folder() == workspace::root().join("target/firmware/inputs")
}

fn check_formatting() -> Result<Said> {
    components::ensure("fmt")?;
    command::run(at_firmware(own_cargo().args(["fmt", "--check"])))?;
    Ok(().into())
}

/// Runs the same program here and on the board; both must write the same lines, and a pose near the true one. Adds its
/// figures.
fn compare(program: &Program, rows: &mut Vec<Row>) -> Result<Said> {
    let features = program.features;
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    let qemu = programs::qemu_arm()?;
    let image = build(&toolchain, features)?;
    let board = on_board(&qemu, M4F, &image)?;
    // After that: it may wait for what the native suite compiles.
    let host = on_host(features)?;
    if program.name == FINDER.name {
        // The same image; another core, another board.
        let other = on_board(&qemu, M7, &image)?;
        ensure_alike(&host, &other).context("on a Cortex-M7")?;
    }
    let calls = calls::count(&std::fs::read(&image)?)?;
    let own = [
        format!(
            "info: calls of the core that end in a panic: {} calls",
            calls.panics
        ),
        format!(
            "info: calls of 64-bit floating point: {} calls",
            calls.doubles
        ),
        format!(
            "info: of the code, the language's writing of words and numbers: {} bytes",
            calls.writing
        ),
    ];
    let information = board.lines().filter(|line| is_information(line));
    let mut found = Vec::new();
    for line in information.chain(own.iter().map(String::as_str)) {
        say(line);
        found.extend(board_rows::read("Cortex-M4F", program.name, line));
    }
    let count = ensure_alike(&host, &board)?;
    check_pose(&host, program)?;
    // Another compiler makes another image.
    if let (Toolchain::Own { .. }, "library" | "finder") = (&toolchain, program.name) {
        board_rows::compare(program.name, &found)?;
    }
    rows.extend(found);
    Ok(format!("{count} lines alike").into())
}

/// The number of lines, which must be the same but for the board's own information.
pub(super) fn ensure_alike(host: &str, board: &str) -> Result<usize> {
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

/// The package that is the same program here.
const HOST: &str = "fluoropose-firmware-host";

/// Compiled here as all that tests run: the core is that of the native suite, with checked arithmetic and all of its features. How it is compiled must not matter.
///
/// What is compiled on the way lies beside the native suite's, the program by itself, as that suite builds one of the same name.
pub(super) fn on_host(features: &str) -> Result<String> {
    let folder = folder().join("host");
    let mut cargo = checked_profile::cargo("build", &["--quiet", "--bin", HOST])?;
    let of_host = features
        .split_terminator(',')
        .map(|name| format!("{HOST}/{name}"));
    cargo.args(of_host.flat_map(|name| ["--features".to_owned(), name]));
    cargo.env("CARGO_BUILD_BUILD_DIR", workspace::target_dir());
    if !inputs_are_where_usual() {
        cargo.env("FLUOROPOSE_FIRMWARE_INPUTS", inputs_folder());
    }
    command::run(cargo.arg("--target-dir").arg(&folder))?;
    let program = format!("release/{HOST}{}", std::env::consts::EXE_SUFFIX);
    command::output(&mut command::of_lane(folder.join(program)))
}

pub(super) fn build(toolchain: &Toolchain, features: &str) -> Result<PathBuf> {
    let mut cargo = toolchain.cargo("build", &folder());
    at_firmware(cargo.args(["--release", "--features", features]));
    // Debian's compiler brings no lints.
    if let Toolchain::Own { .. } = toolchain {
        components::lint(&mut cargo)?;
    }
    command::run(&mut cargo)?;
    Ok(toolchain
        .output_dir("release", &folder())
        .join("fluoropose-firmware"))
}

/// Boards as QEMU calls them: a Cortex-M4F, a Cortex-M7.
pub(super) const M4F: &str = "mps2-an386";
const M7: &str = "mps2-an500";

/// What an image for a board of the Cortex-M family writes.
pub(super) fn on_board(qemu: &Path, machine: &str, image: &Path) -> Result<String> {
    let mut board = Command::new(qemu);
    board.args(["-M", machine, "-icount", "shift=6"]);
    board.args(["-semihosting-config", "enable=on,target=native"]);
    emulated(&mut board, image)
}

/// What an image writes.
pub(super) fn emulated(board: &mut Command, image: &Path) -> Result<String> {
    board.args(["-nographic", "-kernel"]).arg(image);
    command::output_within(QEMU_LIMIT, board).context("the board did not finish its proof")
}

pub(super) fn is_information(line: &str) -> bool {
    line.starts_with("info: ")
}

/// That both agree says nothing if both are wrong: the first pose must be near the true one.
pub(super) fn check_pose(lines: &str, program: &Program) -> Result<()> {
    let Some(within) = &program.within else {
        return Ok(());
    };
    let proof = Proof::read(lines)?;
    let truth = Pose::from(TRUTH);
    let turned = geodesic_deg(&proof.pose.rotation, &truth.rotation);
    let [x, y, z] = std::array::from_fn(|k| proof.pose.translation[k] - truth.translation[k]);
    say(&format!(
        "off the true pose by {turned:.2} deg, {x:.3}, {y:.3} and {z:.2} mm"
    ));
    ensure!(
        turned < within.turn_deg
            && x.abs() < within.aside_mm
            && y.abs() < within.aside_mm
            && z.abs() < within.depth_mm,
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
            .map(|(name, value)| format!("{name}: {value:.6} ({:016x})\n", value.to_bits()))
            .concat()
        };
        check_pose(&lines(TRUTH.x_mm + 0.1), &LIBRARY).unwrap();
        assert!(check_pose(&lines(TRUTH.x_mm + 0.4), &LIBRARY).is_err());
        assert!(check_pose(&lines(TRUTH.x_mm + 0.2), &FINDER).is_err());
    }
}
