//! Miri, an interpreter that tells undefined behaviour: a component of nightly compilers.

use std::process::Command;

use super::command;
use super::missing::Missing;
use super::rust_target::COMPILER_OF_MEMBERS;
use crate::output::announce;
use crate::workspace;

/// A nightly `cargo` with Miri, got where it is not there.
pub(crate) fn cargo() -> Result<Command, Missing> {
    let missing = |why: String, tried: bool| Missing {
        what: "Miri".into(),
        why,
        remedy:
            "run `rustup toolchain install nightly --profile minimal --component miri,rust-src`"
                .into(),
        tried,
    };
    let rustup = command::find(&["rustup"])
        .ok_or_else(|| missing("there is no rustup to get it with".into(), false))?;
    let nightly = || {
        let mut cargo = Command::new(&rustup);
        // What the outer cargo set for itself would lead to its own compiler.
        for name in [
            "RUSTUP_TOOLCHAIN",
            "CARGO",
            "RUSTC",
            "RUSTC_WRAPPER",
            COMPILER_OF_MEMBERS,
            "RUSTFLAGS",
        ] {
            cargo.env_remove(name);
        }
        cargo.current_dir(workspace::root());
        cargo.args(["run", "nightly", "cargo"]);
        cargo
    };
    let has_miri = || command::output(nightly().args(["miri", "--version"])).is_ok();
    let _turn = super::turns::RUSTUP.turn();
    if !has_miri() {
        announce("getting a nightly compiler with Miri (rustup toolchain install)");
        let mut install = Command::new(&rustup);
        install.args(["toolchain", "install", "nightly", "--profile", "minimal"]);
        install.args(["--component", "miri,rust-src"]);
        command::output(&mut install).map_err(|error| missing(format!("{error:#}"), true))?;
    }
    Ok(nightly())
}
