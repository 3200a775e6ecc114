//! What programs that were killed left of files that they were writing.

use std::collections::HashSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

const BEFORE: &str = ".fluoropose-";
const BEHIND: &str = ".part";

/// A file is locked as soon as it is there; who has not done so for this long will not.
const LOCKED_BY_THEN: Duration = Duration::from_secs(60);

/// The name of a file while a process writes it.
pub(super) fn name(process: u32, count: u32) -> String {
    format!("{BEFORE}{process}-{count}{BEHIND}")
}

/// Removes such files that no living process has locked, from the folder of a file that has just been made: its time is that of the
/// folder's own clock. A process of another machine is asked by its lock too, where its number would say nothing. Each folder is looked
/// through once; what cannot be looked at stays.
pub(super) fn sweep(made: &Path, file: &File) {
    static SWEPT: Mutex<Option<HashSet<PathBuf>>> = Mutex::new(None);
    let Some(folder) = made.parent() else { return };
    let is_new = {
        let mut swept = SWEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let swept = swept.get_or_insert_default();
        swept.insert(folder.to_owned())
    };
    let Ok(now) = file.metadata().and_then(|made| made.modified()) else {
        return;
    };
    // The system's own names for the folder in which it stands are empty.
    let listed = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let Some(entries) = is_new.then(|| fs::read_dir(listed).ok()).flatten() else {
        return;
    };
    for entry in entries.flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_file || !is_name(&entry.file_name().to_string_lossy()) {
            continue;
        }
        let modified = entry.metadata().and_then(|other| other.modified());
        let age = modified.map(|modified| now.duration_since(modified).unwrap_or_default());
        if age.is_ok_and(|age| age >= LOCKED_BY_THEN) {
            remove_if_left(&entry.path());
        }
    }
}

fn remove_if_left(path: &Path) {
    let Ok(file) = File::options().write(true).open(path) else {
        return;
    };
    if file.try_lock().is_ok() {
        // Another program may have swept it meanwhile.
        let _ = fs::remove_file(path);
    }
}

/// Whether a file has a name that [`name`] gives.
fn is_name(text: &str) -> bool {
    let numbers = text
        .strip_prefix(BEFORE)
        .and_then(|text| text.strip_suffix(BEHIND))
        .and_then(|text| text.split_once('-'));
    numbers.is_some_and(|(process, count)| {
        [process, count].into_iter().all(|number| {
            let digits = number.bytes().all(|byte| byte.is_ascii_digit());
            digits && number.parse::<u32>().is_ok()
        })
    })
}
