//! What `test --miri` runs: tests in an interpreter that tells undefined behaviour, and on a machine whose bytes stand in the other
//! order. Miri comes with nightly compilers alone, so no other suite has it.

use anyhow::Result;

use super::native;
use super::report::{Report, Said};
use crate::setup::miri;

/// Its square roots are no assembler in `libm`, which Miri does not read; for all targets it needs nothing but its compiler.
const LITTLE_ENDIAN: &str = "riscv64gc-unknown-linux-gnu";
const BIG_ENDIAN: &str = "s390x-unknown-linux-gnu";

/// Rules for pointers. The core has no `unsafe`; that of `bitvec`, which its tests read masks by, is right by the newer rules alone.
const USUAL_RULES: &str = "";
const NEWER_RULES: &str = "-Zmiri-tree-borrows";

/// Vectors that Miri knows. Kernels for more are compared with the portable ones where the native tests find a machine for them.
const VECTORS: &str = "-Ctarget-feature=+popcnt,+avx2,+bmi1,+bmi2";

/// Random cases of each property: an interpreter takes some hundred times as long.
const CASES: &str = "2";

/// What reads files of others, and what it relies on, as far as it ends in minutes. What fills, draws, refines or draws many random numbers
/// takes an interpreter hours.
const READERS: [&str; 7] = [
    "camera::",
    "image::shuttered::",
    "library::runs::",
    "memory::",
    "pose::jts::",
    "pose::rigid::",
    "shortlist::",
];

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    let kernels = ["--package", "fluoropose-kernels"];
    if cfg!(target_arch = "x86_64") {
        report.step("miri: kernels with vectors", || {
            tests(&kernels, &[], USUAL_RULES, Some(VECTORS))
        });
    }
    for (target, order) in [(LITTLE_ENDIAN, "little-endian"), (BIG_ENDIAN, "big-endian")] {
        let with = |which: &[&'static str]| [which, &["--target", target]].concat();
        report.step(&format!("miri: kernels, {order}"), || {
            tests(&with(&kernels), &[], USUAL_RULES, None)
        });
        report.step(&format!("miri: the core's readers, {order}"), || {
            let core = ["--package", "fluoropose", "--lib", "--features", "alloc"];
            tests(&with(&core), &READERS, NEWER_RULES, None)
        });
    }
}

fn tests(which: &[&str], names: &[&str], rules: &str, flags: Option<&str>) -> Result<Said> {
    let mut cargo = miri::cargo()?;
    cargo
        .args(["miri", "test"])
        .args(which)
        .arg("--")
        .args(names);
    // Properties read where their failures would be kept.
    cargo
        .env("MIRIFLAGS", format!("-Zmiri-disable-isolation {rules}"))
        .env("PROPTEST_CASES", CASES);
    if let Some(flags) = flags {
        cargo.env("RUSTFLAGS", flags);
    }
    native::tests(&mut cargo, "miri")
}
