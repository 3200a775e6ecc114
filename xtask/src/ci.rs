//! Verb `ci`: every suite, and nothing in the working tree changed by it.

use std::process::Command;

use anyhow::{Result, ensure};

use crate::setup::command;
use crate::{test, workspace};

/// Options of `ci`.
///
/// Runs every suite of `test`, then checks that building and testing left the working tree as it was: lock
/// files up to date, generated files ignored.
#[derive(clap::Args)]
pub(crate) struct Args {}

/// Runs the verb.
pub(crate) fn run(_args: Args) -> Result<()> {
    let before = working_tree()?;
    test::run(test::Args::everything())?;
    let after = working_tree()?;
    ensure!(
        before == after,
        "the run changed the working tree, which it must not; before:\n{before}\nafter:\n{after}"
    );
    println!("The working tree is as it was.");
    Ok(())
}

fn working_tree() -> Result<String> {
    let mut git = Command::new("git");
    command::output(
        git.args(["status", "--porcelain"])
            .current_dir(workspace::root()),
    )
}
