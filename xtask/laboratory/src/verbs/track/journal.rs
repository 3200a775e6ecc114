//! What was done so far, written after every step: a run that was stopped goes on from there.
//!
//! A line a step: its key, and what came of it as the bits of numbers. A key names all that a step depends on, so that a
//! step is done again only where that has changed, and the order of lines does not matter.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, bail};

use super::record::Record;
use crate::progress::Stop;

/// First word of the file, with the version of what steps do: another version's steps are of no use.
const HEADING: &str = "fluoropose-track-11";

/// What was done so far.
pub(super) struct Journal {
    done: HashMap<String, Vec<f64>>,
    file: Mutex<File>,
    stop: Stop,
}

impl Journal {
    /// Opens the journal of a folder, or begins one. `inputs` is the digest of frames, models and calibration.
    ///
    /// # Errors
    /// Where the file cannot be read or written, or is of other inputs.
    pub(super) fn open(path: &Path, inputs: &str, anew: bool, stop: Stop) -> Result<Self> {
        let heading = format!("{HEADING} {inputs}\n");
        let named = || format!("cannot write {}", path.display());
        let bytes = match std::fs::read(path) {
            _ if anew => Vec::new(),
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            Err(error) => {
                return Err(error).with_context(|| format!("cannot read {}", path.display()));
            }
        };
        // What was cut off while it was written is done again, and so is a step whose line is damaged.
        let end = bytes.iter().rposition(|&byte| byte == b'\n');
        let whole = end.map_or(0, |end| end + 1);
        let text = String::from_utf8_lossy(&bytes[..whole]);
        let is_cut = whole == 0 && heading.as_bytes().starts_with(&bytes);
        if !is_cut && !text.starts_with(&heading) {
            bail!(
                "{} is of other frames, models or settings: choose another folder, or begin anew with --anew",
                path.display()
            );
        }
        let done = text.lines().skip(1).filter_map(parse).collect();
        let mut file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(path)
            .with_context(named)?;
        file.set_len(whole as u64).with_context(named)?;
        std::io::Seek::seek(&mut file, std::io::SeekFrom::End(0)).with_context(named)?;
        if text.is_empty() {
            file.write_all(heading.as_bytes()).with_context(named)?;
        }
        Ok(Self {
            done,
            file: Mutex::new(file),
            stop,
        })
    }

    /// What came of a step: as it was written down, or by doing it now.
    ///
    /// # Errors
    /// Those of the step, where the file cannot be written, and where the run is to stop.
    pub(super) fn step<R: Record>(&self, key: &str, work: impl FnOnce() -> Result<R>) -> Result<R> {
        if let Some(found) = self.done.get(key).and_then(|done| R::from_numbers(done)) {
            return Ok(found);
        }
        self.stop.check()?;
        let found = work()?;
        let mut line = String::from(key);
        for number in found.numbers() {
            write!(line, " {:x}", number.to_bits())?;
        }
        line.push('\n');
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(line.as_bytes())
            .context("cannot write the journal")?;
        Ok(found)
    }
}

fn parse(line: &str) -> Option<(String, Vec<f64>)> {
    let mut words = line.split(' ');
    let key = words.next()?;
    let number = |word: &str| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
    let numbers: Option<Vec<f64>> = words.map(number).collect();
    Some((key.to_owned(), numbers?))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    /// Of a file with these bytes; the file's path.
    fn opened(name: &str, bytes: &[u8]) -> (Result<Journal>, PathBuf) {
        let name = format!("fluoropose-journal-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, bytes).unwrap();
        (Journal::open(&path, "inputs", false, Stop::default()), path)
    }

    #[test]
    fn what_is_no_journal_is_refused_and_stays() {
        for notes in [
            &b"My notes"[..],
            b"My notes of M\xfcller\n",
            b"fluoropose-track-1 inputs\n",
        ] {
            let (journal, path) = opened("notes", notes);
            assert!(journal.is_err());
            assert_eq!(std::fs::read(&path).unwrap(), notes);
        }
    }

    #[test]
    fn a_damaged_line_costs_its_own_step_alone() {
        let heading = format!("{HEADING} inputs\n");
        // Cut off within its first line it begins anew.
        let (_, path) = opened("cut", &heading.as_bytes()[..9]);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), heading);
        let mut bytes = format!("{heading}a 0\nb 0\n").into_bytes();
        bytes[heading.len() + 2] = 0xfc;
        let (journal, _) = opened("damaged", &bytes);
        let done = journal.unwrap().done;
        assert!(!done.contains_key("a") && done.contains_key("b"));
    }
}
