//! Files that are whole or absent, whenever the program ends and however full the disk is.

mod left;

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Context, Result};

/// Writes a file beside the wanted one and gives it its name when all of it is on the disk: until then there is what was there
/// before. What a program that was killed left beside it is swept. What a link names is written, not the link; what is no file (a pipe, a terminal) is written as it is.
///
/// # Errors
/// Names the file.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<()> {
    let cannot = || format!("cannot write {}", path.display());
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::symlink_metadata(&place) {
        // Also a link that leads nowhere yet, or in a circle: the system follows it, or says why not.
        Ok(there) if !there.is_file() => fs::write(&place, bytes).with_context(cannot),
        there => {
            let permissions = there.ok().map(|there| there.permissions());
            if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
                // A new name would go past the wish that it stays as it is.
                return Err(io::Error::from(io::ErrorKind::PermissionDenied)).with_context(cannot);
            }
            put(&place, bytes.as_ref(), permissions).with_context(cannot)
        }
    }
}

/// Whether [`write()`] could do so now: who works for hours before it asks first. Nothing is left there.
///
/// # Errors
/// Those of [`write()`], as far as there is room.
pub fn check(path: &Path) -> Result<()> {
    let cannot = || format!("cannot write {}", path.display());
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let refused = |kind: io::ErrorKind| Err(io::Error::from(kind)).with_context(cannot);
    match fs::symlink_metadata(&place) {
        Ok(there) if there.is_dir() => refused(io::ErrorKind::IsADirectory),
        Ok(there) if there.is_file() && there.permissions().readonly() => {
            refused(io::ErrorKind::PermissionDenied)
        }
        // A pipe or a terminal; a link that leads nowhere yet, of which the system tells then.
        Ok(there) if !there.is_file() => Ok(()),
        _ => {
            let beside = Beside::of(&place);
            File::create_new(&beside.0).map(drop).with_context(cannot)
        }
    }
}

fn put(place: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let beside = Beside::of(place);
    let mut file = File::create_new(&beside.0)?;
    // As long as this program lives, none sweeps it. Where there are no locks, nothing is swept.
    let _ = file.try_lock();
    left::sweep(&beside.0, &file);
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    // Some systems tell only now that there is no room.
    file.sync_all()?;
    fs::rename(&beside.0, place)
}

/// The file while it is written; nothing is left of it where that fails.
struct Beside(PathBuf);

impl Beside {
    /// With a point before its name, so that a folder of frames is not one longer by it.
    fn of(place: &Path) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        Self(place.with_file_name(left::name(std::process::id(), count)))
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        // It has its name by now, or was never there.
        let _ = fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, SystemTime};

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let name = format!("fluoropose-whole-{name}-{}", std::process::id());
            let folder = std::env::temp_dir().join(name);
            fs::create_dir_all(&folder).unwrap();
            Self(folder)
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).unwrap();
            let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
            let mut names: Vec<String> = entries
                .map(|entry| name(entry).to_string_lossy().into_owned())
                .collect();
            names.sort();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_is_written_and_written_over() {
        let folder = Folder::new("over");
        let path = folder.0.join("a");
        write(&path, "first").unwrap();
        write(&path, "second").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
        assert_eq!(folder.names(), ["a"]);
    }

    #[test]
    fn what_a_killed_program_left_is_swept_and_nothing_else() {
        let folder = Folder::new("swept");
        let old = SystemTime::now() - Duration::from_secs(3600);
        let left = |name: &str, modified: SystemTime| {
            let file = File::create_new(folder.0.join(name)).unwrap();
            file.set_modified(modified).unwrap();
            file
        };
        drop(left(".fluoropose-1-0.part", old));
        drop(left(".fluoropose-4294967295-17.part", old));
        // One that is about to be locked.
        drop(left(".fluoropose-2-0.part", SystemTime::now()));
        // Names that are not ours.
        drop(left(".fluoropose-1-.part", old));
        drop(left(".fluoropose-1-x.part", old));
        drop(left(".fluoropose-1-0.part.txt", old));
        drop(left("fluoropose-1-0.part", old));
        fs::create_dir(folder.0.join(".fluoropose-3-0.part")).unwrap();
        // One that is written for a long time.
        let living = left(".fluoropose-1-1.part", old);
        living.lock().unwrap();

        write(&folder.0.join("a"), "text").unwrap();
        let mut stay = vec![
            ".fluoropose-1-.part",
            ".fluoropose-1-0.part.txt",
            ".fluoropose-1-1.part",
            ".fluoropose-1-x.part",
            ".fluoropose-2-0.part",
            ".fluoropose-3-0.part",
            "a",
            "fluoropose-1-0.part",
        ];
        assert_eq!(folder.names(), stay);
        // A folder is looked through once by a program, lest ten thousand files take a hundred million looks.
        drop(living);
        write(&folder.0.join("b"), "text").unwrap();
        stay.insert(7, "b");
        assert_eq!(folder.names(), stay);
    }

    #[test]
    fn where_it_cannot_be_written_nothing_is_left_and_the_old_one_stays() {
        let folder = Folder::new("cannot");
        let error = write(&folder.0.join("no/a"), "x").unwrap_err();
        assert!(format!("{error:#}").contains("no"), "{error:#}");
        let path = folder.0.join("kept");
        fs::write(&path, "old").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        assert!(write(&path, "new").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(folder.names(), ["kept"]);
    }

    #[test]
    fn what_could_not_be_written_is_told_before_and_nothing_is_left() {
        let folder = Folder::new("before");
        let path = folder.0.join("a");
        check(&path).unwrap();
        fs::write(&path, "old").unwrap();
        check(&path).unwrap();
        assert!(check(&folder.0.join("no/a")).is_err());
        assert!(check(&path.join("b")).is_err());
        assert!(check(&folder.0).is_err());
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        assert!(check(&path).is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(folder.names(), ["a"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_modes_stay_as_they_were() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = Folder::new("links");
        let (file, link) = (folder.0.join("file"), folder.0.join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("file", &link).unwrap();
        write(&link, "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let mode = fs::metadata(&file).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode, 0o640);
        write(Path::new("/dev/null"), "nothing").unwrap();
        let circle = folder.0.join("circle");
        symlink("circle", &circle).unwrap();
        assert!(write(&circle, "x").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_nowhere_yet_is_followed() {
        use std::os::unix::fs::symlink;
        let folder = Folder::new("dangling");
        symlink("later", folder.0.join("link")).unwrap();
        write(&folder.0.join("link"), "text").unwrap();
        assert_eq!(fs::read_to_string(folder.0.join("later")).unwrap(), "text");
    }
}
