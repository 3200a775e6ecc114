//! The same sources packaged in two folders: what comes out must be alike to the last bit.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::output::announce;
use crate::setup::command;
use crate::{sources, workspace};

/// Packages a copy of the sources in another folder, with nothing that was compiled before, and compares it with the package in
/// `first`. The copy stays where something differs.
///
/// # Errors
/// Names the files that differ.
pub(super) fn compare(first: &Path) -> Result<()> {
    let folder = workspace::target_dir().join("packaged-a-second-time");
    let (sources, second) = (folder.join("sources"), folder.join("package"));
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    sources::copy(&sources)?;
    announce("packaging a copy of the sources in another folder, some minutes");
    // This very program: it takes the folder that cargo names for the workspace's.
    let mut again = Command::new(std::env::current_exe()?);
    again
        .current_dir(&sources)
        .env("CARGO_TARGET_DIR", sources.join("target"))
        .env("CARGO_MANIFEST_DIR", sources.join("xtask"))
        .args(["package", "--out"])
        .arg(&second);
    command::run(&mut again)?;
    let (ours, theirs) = (packaged(first)?, packaged(&second)?);
    let differing = differing(&ours, &theirs);
    ensure!(
        differing.is_empty(),
        "{} of {} files differ between {} and {}: {}",
        differing.len(),
        ours.len(),
        first.display(),
        second.display(),
        differing.join("; ")
    );
    let bytes: usize = ours.values().map(Vec::len).sum();
    println!(
        "Built twice:       {} files, {:.1} MB, alike to the last bit",
        ours.len(),
        bytes as f64 / 1e6
    );
    fs::remove_dir_all(&folder).with_context(|| format!("cannot remove {}", folder.display()))
}

/// The files of a package; a folder may hold others beside them.
fn packaged(folder: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>> {
    let mut found = files(folder)?;
    let parts = ["site", "npm", "fluoropose.html"];
    found.retain(|name, _| parts.iter().any(|part| name.starts_with(part)));
    Ok(found)
}

/// All files below a folder, by their names from there.
fn files(folder: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in
            fs::read_dir(&next).with_context(|| format!("cannot list {}", next.display()))?
        {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let bytes =
                fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            found.insert(path.strip_prefix(folder)?.to_owned(), bytes);
        }
    }
    Ok(found)
}

/// A few words on each file that only one of two has, or that differs.
fn differing(
    ours: &BTreeMap<PathBuf, Vec<u8>>,
    theirs: &BTreeMap<PathBuf, Vec<u8>>,
) -> Vec<String> {
    let mut names: Vec<&PathBuf> = ours.keys().chain(theirs.keys()).collect();
    names.sort();
    names.dedup();
    let told = |name: &PathBuf| {
        let words = match (ours.get(name), theirs.get(name)) {
            (Some(a), Some(b)) if a == b => return None,
            (Some(a), Some(b)) => {
                let alike = a.iter().zip(b).take_while(|(a, b)| a == b).count();
                format!("from byte {alike} on, of {} and {}", a.len(), b.len())
            }
            (Some(_), None) => "only in the first".to_owned(),
            (None, _) => "only in the second".to_owned(),
        };
        Some(format!("{} ({words})", name.display()))
    };
    names.into_iter().filter_map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_differ_are_named_with_the_place() {
        let scratch = std::env::temp_dir().join(format!("fluoropose-twice-{}", std::process::id()));
        let folder = |name: &str, own: &[(&str, &str)]| {
            for (file, text) in own {
                let path = scratch.join(name).join(file);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, text).unwrap();
            }
            files(&scratch.join(name)).unwrap()
        };
        let first = folder("a", &[("same", "x"), ("deep/other", "abc"), ("gone", "")]);
        let second = folder("b", &[("same", "x"), ("deep/other", "abd"), ("new", "")]);
        let told = differing(&first, &second);
        assert_eq!(
            told,
            [
                "deep/other (from byte 2 on, of 3 and 3)",
                "gone (only in the first)",
                "new (only in the second)"
            ]
        );
        assert!(differing(&first, &first).is_empty());
        fs::remove_dir_all(scratch).unwrap();
    }
}
