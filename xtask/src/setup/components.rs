//! Components of the Rust toolchain that only the tests want: the formatter and the linter.

use std::process::Command;

use anyhow::{Context, Result};

use super::command;
use super::missing::Missing;
use super::rust_target::{COMPILER_OF_MEMBERS, own_cargo};
use crate::output::announce;

/// Makes sure of `cargo fmt` and `cargo clippy` (`subcommand` is `fmt` or `clippy`).
pub(crate) fn ensure(subcommand: &str) -> std::result::Result<(), Missing> {
    let _turn = super::turns::RUSTUP.turn();
    if works(subcommand) {
        return Ok(());
    }
    let component = if subcommand == "fmt" {
        "rustfmt"
    } else {
        subcommand
    };
    let missing = |why: String, tried: bool| Missing {
        what: format!("cargo {subcommand}"),
        why,
        remedy: format!("run `rustup component add {component}`"),
        tried,
    };
    let rustup = command::find(&["rustup"])
        .ok_or_else(|| missing("there is no rustup to add it with".into(), false))?;
    announce(&format!(
        "adding the Rust component {component} (rustup component add)"
    ));
    command::output(Command::new(rustup).args(["component", "add", component]))
        .map_err(|error| missing(format!("{error:#}"), true))?;
    Ok(())
}

/// Lets the linter compile the members of a workspace: it is the compiler with more warnings, so that nothing has to be
/// compiled a second time for them. All warnings are errors.
pub(crate) fn lint(cargo: &mut Command) -> Result<()> {
    ensure("clippy")?;
    let linter = command::find(&["clippy-driver"]);
    let linter = linter.context("no clippy-driver on the PATH: it comes with `cargo clippy`")?;
    cargo.env(COMPILER_OF_MEMBERS, linter);
    // As `cargo clippy -- -D warnings` hands it on, and `.ci/run`.
    cargo.env(
        "CLIPPY_ARGS",
        ["-D", "warnings", ""].join("__CLIPPY_HACKERY__"),
    );
    Ok(())
}

fn works(subcommand: &str) -> bool {
    command::output(own_cargo().args([subcommand, "--version"])).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_subcommand_does_not_work() {
        assert!(!works("no-such-subcommand"));
    }
}
