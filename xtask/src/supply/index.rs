//! Which crates were taken back (yanked), as cargo's own copy of the registry's index says.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use super::parts::Part;
use crate::setup::command;
use crate::setup::rust_target::own_cargo;
use crate::workspace;

/// Has cargo ask the registry for what is new; it changes no lock file.
///
/// Errors where the registry does not answer.
pub(crate) fn refresh() -> Result<()> {
    let mut update = own_cargo();
    update.args(["update", "--dry-run", "--manifest-path"]);
    command::output(update.arg(workspace::root().join("Cargo.toml")))?;
    Ok(())
}

/// What was taken back of these, and how many the index does not name.
///
/// Errors where there is no index.
pub(crate) fn yanked(parts: &[Part]) -> Result<(Vec<&Part>, usize)> {
    let indexes = indexes()?;
    let (mut yanked, mut unknown) = (Vec::new(), 0);
    for part in parts {
        let files = indexes
            .iter()
            .filter_map(|at| fs::read(at.join(place(&part.name))).ok());
        let told: Vec<bool> = files
            .filter_map(|file| state(&file, &part.version))
            .collect();
        if told.is_empty() {
            unknown += 1;
        }
        if told.contains(&true) {
            yanked.push(part);
        }
    }
    Ok((yanked, unknown))
}

fn indexes() -> Result<Vec<PathBuf>> {
    let folder = workspace::cargo_home()?.join("registry/index");
    let entries = fs::read_dir(&folder).context("cargo has no copy of the registry's index")?;
    let caches = entries.flatten().map(|entry| entry.path().join(".cache"));
    let caches: Vec<PathBuf> = caches.filter(|cache| cache.is_dir()).collect();
    ensure!(
        !caches.is_empty(),
        "cargo has no copy of the registry's index"
    );
    Ok(caches)
}

/// Where a crate stands in an index.
fn place(name: &str) -> PathBuf {
    let name = name.to_lowercase();
    let part = |from: usize, to: usize| name.get(from..to).unwrap_or_default().to_owned();
    let folder = match name.len() {
        1 | 2 => name.len().to_string(),
        3 => format!("3/{}", part(0, 1)),
        _ => format!("{}/{}", part(0, 2), part(2, 4)),
    };
    Path::new(&folder).join(&name)
}

/// Whether a version was taken back; `None` where the file does not name it. Versions and their entries stand between zeros.
fn state(file: &[u8], version: &str) -> Option<bool> {
    let entries = file
        .split(|&byte| byte == 0)
        .filter(|entry| entry.starts_with(b"{"));
    let mut entries = entries.filter_map(|entry| serde_json::from_slice::<Value>(entry).ok());
    let own = entries.find(|entry| entry["vers"] == version)?;
    own["yanked"].as_bool()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_of_the_index_is_found_and_read() {
        assert_eq!(place("Serde"), Path::new("se/rd/serde"));
        assert_eq!(place("png"), Path::new("3/p/png"));
        assert_eq!(place("cc"), Path::new("2/cc"));
        let file = b"\x03\x02\0\0\0etag: x\x001.0.0\0{\"vers\": \"1.0.0\", \"yanked\": true}\x001.0.1\0{\"vers\":\"1.0.1\",\"yanked\":false}\0";
        assert_eq!(state(file, "1.0.0"), Some(true));
        assert_eq!(state(file, "1.0.1"), Some(false));
        assert_eq!(state(file, "1.0.2"), None);
    }
}
