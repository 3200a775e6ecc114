//! The folder that a film is written to is its own: no other study's files are written over, and none of another film's frames stay among its own.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

/// How the sentences end: what to do.
const CHOOSE: &str = "choose another folder";

/// Refuses the folder of the study that a film is made from: its files would be written over while they are read.
///
/// # Errors
/// Names the folder.
pub fn check_source(study: &Path, out: &Path) -> Result<()> {
    let folder = match study.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let places = [folder, out].map(fs::canonicalize);
    if let [Ok(folder), Ok(out)] = &places {
        ensure!(
            folder != out,
            "{} is the folder of the study itself, whose files would be written over: {CHOOSE}",
            out.display()
        );
    }
    Ok(())
}

/// Refuses a folder that holds a study which `is_own`, asked of its text, does not know.
///
/// # Errors
/// Names the study.
pub fn check_study(out: &Path, is_own: impl Fn(&str) -> bool) -> Result<()> {
    let file = out.join("study.toml");
    if let Ok(bytes) = fs::read(&file) {
        ensure!(
            is_own(&String::from_utf8_lossy(&bytes)),
            "{} is a study that others made, and would be written over: {CHOOSE}",
            file.display()
        );
    }
    Ok(())
}

/// Refuses a folder of frames or masks with files, as `belongs` knows them by their names, that would be taken for frames of the film though
/// it writes none of that name.
///
/// # Errors
/// Names the first.
pub fn check_files(folder: &Path, belongs: impl Fn(&str) -> bool) -> Result<()> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Ok(());
    };
    let mut strangers = Vec::new();
    for entry in entries {
        let entry = entry.with_context(|| format!("cannot list {}", folder.display()))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_file() && !belongs(&name) {
            strangers.push(name);
        }
    }
    match strangers.iter().min() {
        Some(first) => bail!(
            "{} holds {first}, which would stay among the new film's frames: empty it, or {CHOOSE}",
            folder.display()
        ),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_of_others_is_refused_and_named() {
        let name = format!("fluoropose-own-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let absent = folder.join("absent");
        fs::create_dir_all(folder.join("frames")).unwrap();
        fs::write(folder.join("study.toml"), "name = \"theirs\"").unwrap();
        fs::write(folder.join("frames/2.png"), "").unwrap();
        let study = folder.join("study.toml");
        let own = check_source(&study, &folder.join("frames/..")).unwrap_err();
        assert!(own.to_string().contains("the study itself"), "{own}");
        check_source(&study, &absent).unwrap();
        let theirs = check_study(&folder, |text| text.starts_with('#')).unwrap_err();
        assert!(theirs.to_string().contains("others made"), "{theirs}");
        check_study(&folder, |text| text.contains("theirs")).unwrap();
        check_study(&absent, |_| false).unwrap();
        let frames = folder.join("frames");
        let stays = check_files(&frames, |name| name == "1.png").unwrap_err();
        assert!(stays.to_string().contains("holds 2.png"), "{stays}");
        check_files(&frames, |name| name == "2.png").unwrap();
        check_files(&absent, |_| false).unwrap();
        fs::remove_dir_all(folder).unwrap();
    }
}
