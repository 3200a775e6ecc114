//! Node.js, npm and the packages of a folder with a `package.json`.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::command;
use super::missing::Missing;
use crate::clock::timed;
use crate::workspace::Stamp;

/// The oldest Node.js the page's tools run on (major version).
const OLDEST_NODE: u32 = 20;

/// A Node.js that is new enough.
pub(crate) fn node() -> Result<PathBuf, Missing> {
    let Some(node) = command::find(&["node", "nodejs"]) else {
        return Err(missing("`node` is not on the PATH".into()));
    };
    let version = command::output(Command::new(&node).arg("--version")).unwrap_or_default();
    match major_version(&version) {
        Some(major) if major >= OLDEST_NODE => Ok(node),
        _ => Err(missing(format!("this Node.js is {}", version.trim()))),
    }
}

/// npm, beside a Node.js that is new enough.
pub(crate) fn npm() -> Result<PathBuf, Missing> {
    node()?;
    command::find(&["npm"]).ok_or_else(|| missing("`npm` is not on the PATH".into()))
}

fn missing(why: String) -> Missing {
    Missing {
        what: "Node.js and npm".into(),
        why,
        remedy: format!("install Node.js {OLDEST_NODE} or newer with npm (https://nodejs.org)"),
        tried: false,
    }
}

/// The `20` of `v20.11.1`.
fn major_version(text: &str) -> Option<u32> {
    text.trim()
        .strip_prefix('v')?
        .split('.')
        .next()?
        .parse()
        .ok()
}

/// Installs exactly the packages that a folder's lock file names, if that has not been done for this lock file.
pub(crate) fn install(folder: &Path) -> Result<(), Missing> {
    let npm = npm()?;
    let _turn = super::turns::NPM.turn();
    let name = folder
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let missing = |error: anyhow::Error| Missing {
        what: format!("npm packages of {name}/"),
        why: format!("{error:#}"),
        remedy: format!("run `npm ci` in {name}/ and see what it says"),
        tried: true,
    };
    let made_from = [
        folder.join("package.json"),
        folder.join("package-lock.json"),
    ];
    let stamp = Stamp::new(
        folder.join("node_modules/.fluoropose-installed"),
        &made_from,
    )
    .map_err(missing)?;
    if stamp.is_current() {
        return Ok(());
    }
    let mut ci = Command::new(npm);
    ci.args(["ci", "--no-audit", "--no-fund", "--loglevel=error"])
        .current_dir(folder);
    timed(
        &format!("installing the npm packages of {name}/ (npm ci)"),
        || command::output(&mut ci),
    )
    .map_err(missing)?;
    stamp.write().map_err(missing)
}

/// A command that runs a script of the folder's `package.json`.
pub(crate) fn script(folder: &Path, script: &str) -> Result<Command, Missing> {
    let mut command = Command::new(npm()?);
    command
        .args(["run", "--silent", script])
        .current_dir(folder);
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        assert_eq!(major_version("v20.11.1\n"), Some(20));
        assert_eq!(major_version("20"), None);
        assert_eq!(major_version(""), None);
    }

    #[test]
    fn a_folder_without_a_lock_file_is_told_in_words() {
        let folder = std::env::temp_dir().join("fluoropose-no-such-folder");
        let said = install(&folder).unwrap_err().to_string();
        assert!(said.starts_with("no "), "{said}");
    }
}
