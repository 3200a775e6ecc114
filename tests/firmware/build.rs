//! Finds what goes into flash, a library or an implant, and an outline, and the linker script.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=FLUOROPOSE_FIRMWARE_INPUTS");
    println!("cargo::rerun-if-env-changed=FLUOROPOSE_OUTLINES");
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let inputs = env::var_os("FLUOROPOSE_FIRMWARE_INPUTS")
        .map_or_else(|| usual_inputs(&package), PathBuf::from);
    let for_board = env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none");
    println!("cargo::rustc-check-cfg=cfg(nothing_to_run)");
    for (what, name) in [
        ("LIBRARY", "femur.library"),
        (
            "OUTLINE",
            part("femur.outline", "tibia.outline", "femur.outline"),
        ),
        (
            "IMPLANT",
            part("femur.implant", "tibia.implant", "all_round.implant"),
        ),
    ] {
        let file = inputs.join(name);
        match (file.is_file(), for_board) {
            (true, _) => {}
            (false, true) => println!(
                "cargo::error={name} is missing; `cargo xtask test --firmware` makes it and builds this"
            ),
            // As one of a workspace (`host`) it is also built before.
            (false, false) => println!("cargo::rustc-cfg=nothing_to_run"),
        }
        println!("cargo::rerun-if-changed={}", file.display());
        println!("cargo::rustc-env=FLUOROPOSE_{what}={}", file.display());
    }
    if for_board {
        let is_arm = env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "arm");
        link(&package, is_arm);
    }
}

/// Where the inputs are made: under the root, which is above the package.
fn usual_inputs(package: &Path) -> PathBuf {
    let root = package
        .ancestors()
        .find(|folder| folder.join("xtask").is_dir());
    root.unwrap_or(package).join("target/firmware/inputs")
}

/// Which of three, by the features.
fn part<'n>(usual: &'n str, tibia: &'n str, all_round: &'n str) -> &'n str {
    let is_on = |feature: &str| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some();
    match (is_on("TIBIA"), is_on("ALL_ROUND")) {
        (true, _) => tibia,
        (false, true) => all_round,
        (false, false) => usual,
    }
}

/// Names the linker script of the board; cortex-m-rt's wants the memory alone.
fn link(package: &Path, is_arm: bool) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    let is_small = env::var_os("CARGO_FEATURE_NETDUINOPLUS2").is_some();
    let (own, there, script) = match (is_arm, is_small) {
        (true, false) => ("boards/cortex.x", "memory.x", "link.x"),
        (true, true) => ("boards/netduinoplus2.x", "memory.x", "link.x"),
        (false, _) => ("boards/riscv.ld", "riscv.ld", "riscv.ld"),
    };
    println!("cargo::rerun-if-changed={own}");
    fs::copy(package.join(own), out.join(there)).expect("OUT_DIR can be written");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-T{script}");
    println!("cargo::rustc-link-arg-bins=--nmagic");
    // Functions of the same instructions are kept once.
    println!("cargo::rustc-link-arg-bins=--icf=all");
}
