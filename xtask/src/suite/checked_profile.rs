//! How tests are compiled.

use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use anyhow::Result;

use crate::setup::rust_target::own_cargo;
use crate::setup::{command, components};
use crate::workspace;

/// The `release` profile as tests use it; the file says what is otherwise, and why. Every cargo of ours begins at the root, where it is found.
pub(crate) const CHECKED: [&str; 3] = ["--release", "--config", ".cargo/checked.toml"];

/// What the file puts into the surroundings of programs: cargo does it for those that it starts.
pub(super) fn surroundings() -> impl Iterator<Item = (&'static str, &'static str)> {
    let file = include_str!("../../../.cargo/checked.toml");
    let lines = file.lines().skip_while(|line| *line != "[env]").skip(1);
    let lines = lines.take_while(|line| !line.starts_with('['));
    let entries = lines.filter_map(|line| line.split_once(" = "));
    entries.map(|(name, value)| (name, value.trim_matches('"')))
}

/// Cargo on the whole workspace, compiled by the linter: what one command has built the next finds.
///
/// # Errors
/// Where there is no linter.
pub(crate) fn cargo(what: &str, options: &[&str]) -> Result<Command> {
    let mut cargo = own_cargo();
    cargo.arg(what).args(CHECKED);
    cargo.arg("--workspace").args(options);
    components::lint(&mut cargo)?;
    Ok(cargo)
}

/// The laboratory's program as tests compile it. Who asks while it is being built waits for that, and for nothing else that is built with
/// it. Compiled in another way it would overwrite what modules of the page leave without a number in their files' names, and the tests
/// would be built anew.
///
/// # Errors
/// Where it does not compile.
pub(crate) fn laboratory() -> Result<PathBuf> {
    static BUILT: Mutex<Option<PathBuf>> = Mutex::new(None);
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(program) = &*built {
        return Ok(program.clone());
    }
    command::run(&mut cargo("build", &["--bin", "fluoropose"])?)?;
    let name = format!("release/fluoropose{}", std::env::consts::EXE_SUFFIX);
    let program = workspace::target_dir().join(name);
    *built = Some(program.clone());
    Ok(program)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_of_tests_have_the_stack_that_the_file_gives_them() {
        let found: Vec<_> = surroundings().collect();
        assert_eq!(found, [("RUST_MIN_STACK", "8388608")]);
    }
}
