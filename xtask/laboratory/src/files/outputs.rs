//! Files that a verb is going to write: asked about before the work, which may take hours.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use fluoropose_phantom::whole;

/// Refuses files that cannot be written, one that is named for two things, and one that is read as well. Each output comes with the option that
/// names it.
///
/// # Errors
/// Names the option and the file.
pub fn check_outputs<'p>(
    outputs: &[(&str, Option<&'p Path>)],
    inputs: impl IntoIterator<Item = Option<&'p Path>>,
) -> Result<()> {
    let inputs: Vec<PathBuf> = inputs.into_iter().flatten().map(place_of).collect();
    let mut known: Vec<(&str, PathBuf)> = Vec::new();
    for &(option, path) in outputs {
        let Some(path) = path else { continue };
        let place = place_of(path);
        if let Some((other, _)) = known.iter().find(|(_, other)| *other == place) {
            bail!(
                "{other} and {option} both name {}: one would be written over the other",
                path.display()
            );
        }
        if inputs.contains(&place) {
            bail!(
                "{option} names {}, which is read too and would be written over",
                path.display()
            );
        }
        whole::check(path)?;
        known.push((option, place));
    }
    Ok(())
}

/// Where a file lies or is going to lie, by whatever way it is named.
fn place_of(path: &Path) -> PathBuf {
    let whole = || path.canonicalize().ok();
    let in_folder = || {
        let folder = std::path::absolute(path)
            .ok()?
            .parent()?
            .canonicalize()
            .ok()?;
        Some(folder.join(path.file_name()?))
    };
    whole()
        .or_else(in_folder)
        .unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_written_once_and_none_that_is_read() {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-outputs-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("in")).unwrap();
        let model = folder.join("model.stl");
        std::fs::write(&model, "solid").unwrap();
        let told = |outputs: &[(&str, PathBuf)]| {
            let outputs: Vec<_> = outputs
                .iter()
                .map(|(name, path)| (*name, Some(&**path)))
                .collect();
            let checked = check_outputs(&outputs, [Some(&*model), None]);
            checked.map_or_else(|error| error.to_string(), |()| String::new())
        };
        let (a, same) = (folder.join("a.csv"), folder.join("in/../a.csv"));
        assert_eq!(
            told(&[("--out", a.clone()), ("--report", folder.join("b.csv"))]),
            ""
        );
        let twice = told(&[("--out", a.clone()), ("--report", same)]);
        assert!(twice.starts_with("--out and --report both name"), "{twice}");
        let read = told(&[("--out", folder.join("in/../model.stl"))]);
        assert!(read.contains("is read too"), "{read}");
        let nowhere = told(&[("--out", folder.join("no/a.csv"))]);
        assert!(nowhere.starts_with("cannot write"), "{nowhere}");
        assert!(!a.exists() && std::fs::read(&model).unwrap() == b"solid");
        std::fs::remove_dir_all(folder).unwrap();
    }
}
