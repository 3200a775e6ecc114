//! Where this workspace's files are, and fingerprints of them.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use sha2::{Digest, Sha256};

/// The workspace's top folder: that of the running cargo, else that of the build.
pub(crate) fn root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .filter(|folder| folder.ends_with("xtask"))
        .unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")));
    package.parent().map_or(package.clone(), Path::to_path_buf)
}

/// Where cargo's output goes: `target`, or as the environment says.
pub(crate) fn target_dir() -> PathBuf {
    let chosen = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    root().join(chosen)
}

/// Where cargo keeps what it fetched.
///
/// Errors where the environment does not say.
pub(crate) fn cargo_home() -> Result<PathBuf> {
    let told = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let of_person = || Some(std::env::home_dir()?.join(".cargo"));
    told.or_else(of_person)
        .context("the environment names no folder for cargo")
}

/// SHA-256 (hex) over the names and contents of files and whole folders, independent of the order on disk.
///
/// Errors when one of the paths cannot be read.
pub(crate) fn fingerprint(paths: &[PathBuf]) -> Result<String> {
    let mut hash = Sha256::new();
    for path in paths {
        hash_path(path, &mut hash)?;
    }
    Ok(hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect())
}

fn hash_path(path: &Path, hash: &mut Sha256) -> Result<()> {
    if !path.is_dir() {
        let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        hash.update(path.file_name().unwrap_or_default().as_encoded_bytes());
        hash.update((bytes.len() as u64).to_le_bytes());
        hash.update(&bytes);
        return Ok(());
    }
    let entries = fs::read_dir(path).with_context(|| format!("cannot list {}", path.display()))?;
    let mut entries: Vec<PathBuf> = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_>>()?;
    entries.sort();
    entries.iter().try_for_each(|entry| hash_path(entry, hash))
}

/// A file that remembers what a folder was made from, so that it is made again only when that changes.
pub(crate) struct Stamp {
    file: PathBuf,
    wanted: String,
}

impl Stamp {
    /// The stamp `file` for a folder made from the given files and folders.
    pub(crate) fn new(file: PathBuf, made_from: &[PathBuf]) -> Result<Self> {
        Ok(Self {
            file,
            wanted: fingerprint(made_from)?,
        })
    }

    /// Whether the folder was made from exactly these contents.
    pub(crate) fn is_current(&self) -> bool {
        fs::read_to_string(&self.file).is_ok_and(|found| found == self.wanted)
    }

    /// Remembers that the folder has been made.
    pub(crate) fn write(&self) -> Result<()> {
        fs::write(&self.file, &self.wanted)
            .with_context(|| format!("cannot write {}", self.file.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("fluoropose-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_stamp_is_current_until_its_source_changes() {
        let folder = scratch("stamp");
        let source = folder.join("source");
        fs::write(&source, "one").unwrap();
        let stamp = || Stamp::new(folder.join("stamp"), std::slice::from_ref(&source)).unwrap();
        assert!(!stamp().is_current());
        stamp().write().unwrap();
        assert!(stamp().is_current());
        fs::write(&source, "two").unwrap();
        assert!(!stamp().is_current());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_fingerprint_sees_names_as_well_as_contents() {
        let folder = scratch("fingerprint");
        fs::write(folder.join("a"), "same").unwrap();
        let with_a = fingerprint(std::slice::from_ref(&folder)).unwrap();
        fs::rename(folder.join("a"), folder.join("b")).unwrap();
        assert_ne!(with_a, fingerprint(std::slice::from_ref(&folder)).unwrap());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_root_holds_the_workspace() {
        assert!(root().join("core/Cargo.toml").is_file());
    }
}
