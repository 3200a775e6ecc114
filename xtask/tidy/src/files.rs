//! The files of the repository, without what is made from them.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// Folders that hold what was built or downloaded.
const MADE: [&str; 5] = ["target", "node_modules", "dist", "dist-embedded", "pkg"];

/// Every file below the root as a path relative to it, sorted; without dot-folders and what is made.
pub fn list(root: &Path) -> Result<Vec<String>> {
    let mut files = Vec::new();
    visit(root, "", &mut files)?;
    files.sort();
    Ok(files)
}

fn visit(folder: &Path, before: &str, files: &mut Vec<String>) -> Result<()> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') || MADE.contains(&name.as_str()) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            visit(&entry.path(), &format!("{before}{name}/"), files)?;
        } else {
            files.push(format!("{before}{name}"));
        }
    }
    Ok(())
}
