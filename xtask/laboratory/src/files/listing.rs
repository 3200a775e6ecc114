//! The files of a folder of frames or masks.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose_decode::{gaps_among, name_order};

use super::text::name_of;

/// What systems put into folders by themselves, in small letters; so are names that begin with a point.
const OF_SYSTEMS: [&str; 4] = ["thumbs.db", "ehthumbs.db", "desktop.ini", "icon\r"];

/// The files of a folder in the order of their names ([`name_order`]): the order of the frames. Files that systems put there are passed over.
/// A file in place of a folder is all there is: DICOM and TIFF hold whole films.
///
/// # Errors
/// When the folder cannot be listed or holds no file.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    if folder.is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files: Vec<(String, PathBuf)> = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .map(|path| path.map(|path| (name_of(&path), path)))
        .collect::<Result<_, _>>()
        .with_context(|| format!("cannot list {}", folder.display()))?;
    files.retain(|(name, _)| !is_of_system(name));
    // A frame that is kept elsewhere and was not fetched: without it all rows behind it would be other frames'.
    if let Some((_, lost)) = files
        .iter()
        .find(|(_, path)| path.is_symlink() && !path.exists())
    {
        bail!("{} is a link to a file that is not there", lost.display());
    }
    files.retain(|(_, path)| path.is_file());
    files.sort_by(|(a, _), (b, _)| name_order(a, b));
    if files.is_empty() {
        bail!("{} holds no files", folder.display());
    }
    Ok(files.into_iter().map(|(_, path)| path).collect())
}

/// Whether a file has a name that systems give: it is no frame.
pub fn is_of_system(name: &str) -> bool {
    name.starts_with('.') || OF_SYSTEMS.contains(&name.to_lowercase().as_str())
}

/// What is missing among numbered files ([`gaps_among`]). `files` are in their order.
pub fn gaps_in(files: &[PathBuf]) -> Option<String> {
    gaps_among(&files.iter().map(|path| name_of(path)).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_stand_by_their_numbers_and_what_systems_left_is_none() {
        let folder = std::env::temp_dir().join(format!("fluoropose-listed-{}", std::process::id()));
        fs::create_dir_all(folder.join("f3.png")).unwrap();
        for name in [
            "f10.png",
            "f2.png",
            "f1.png",
            "Thumbs.db",
            ".DS_Store",
            "desktop.ini",
        ] {
            fs::write(folder.join(name), name).unwrap();
        }
        let files = files_in(&folder).unwrap();
        let only = folder.join("f2.png");
        assert_eq!(files_in(&only).unwrap(), [only]);
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("nowhere", folder.join("f4.png")).unwrap();
            let lost = files_in(&folder).unwrap_err().to_string();
            assert!(
                lost.ends_with("f4.png is a link to a file that is not there"),
                "{lost}"
            );
        }
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
        assert_eq!(names, ["f1.png", "f2.png", "f10.png"]);
    }
}
