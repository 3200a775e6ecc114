//! Copies of the repository, to be built or changed elsewhere.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::setup::command;
use crate::workspace;

/// Copies what belongs to the repository, as it is now; files that are there already and alike keep their times.
///
/// Errors where git does not tell what that is.
pub(crate) fn copy(to: &Path) -> Result<()> {
    let root = workspace::root();
    let mut git = Command::new("git");
    git.current_dir(&root);
    git.args([
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ]);
    let listed = command::output(&mut git).context("git tells which files are sources")?;
    for name in listed.split('\0').filter(|name| !name.is_empty()) {
        let (source, target) = (root.join(name), to.join(name));
        // One that was removed and is still listed.
        if !source.is_file() {
            continue;
        }
        let bytes = fs::read(&source).with_context(|| format!("cannot read {name}"))?;
        if fs::read(&target).is_ok_and(|there| there == bytes) {
            continue;
        }
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&target, bytes).with_context(|| format!("cannot copy {name}"))?;
    }
    Ok(())
}
