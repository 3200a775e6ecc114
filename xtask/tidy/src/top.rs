//! What stands at the top of the repository.

use std::path::Path;

use anyhow::{Context, Result};

/// All that a visitor meets first, dot-folders aside.
const PLACED: [&str; 13] = [
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "DESIGN.md",
    "LICENSE",
    "README.md",
    "SECURITY.md",
    "core",
    "tests",
    "wasm",
    "web",
    "xtask",
];

/// An error for each file or folder that has no place at the top and is not ignored by git.
pub fn errors(root: &Path) -> Result<Vec<String>> {
    let ignored = std::fs::read_to_string(root.join(".gitignore")).unwrap_or_default();
    let is_ignored = |name: &str| ignored.lines().any(|line| line.trim_matches('/') == name);
    let mut errors = Vec::new();
    let entries = root
        .read_dir()
        .with_context(|| format!("cannot list {}", root.display()))?;
    for entry in entries {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let placed = name.starts_with('.') || PLACED.contains(&name.as_str());
        if !placed && !is_ignored(&name) {
            errors.push(format!("{name} has no place at the top of the repository"));
        }
    }
    errors.sort();
    Ok(errors)
}
