//! Where a batch keeps what: results by the names of studies, and what is not finished in folders that begin with a point.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::manifest::{Inputs, Manifest};
use crate::files::{read_text, write_json};

/// The folder of a batch.
#[derive(Clone, Debug)]
pub(super) struct Folders(PathBuf);

/// Why a study has no results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Failure {
    /// Whose fault it is.
    pub(super) kind: FailureKind,
    /// What is wrong, in a sentence.
    pub(super) because: String,
}

/// Whose fault a failure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum FailureKind {
    /// The study's: what it names is missing, cannot be read or does not belong together.
    Input,
    /// The program's or the machine's.
    Crash,
}

impl Folders {
    /// Those of a batch that was begun.
    #[must_use]
    pub(super) fn at(out: &Path) -> Self {
        Self(out.to_owned())
    }

    /// Makes what is missing.
    ///
    /// # Errors
    /// Names the folder.
    pub(super) fn make(out: &Path) -> Result<Self> {
        let folders = Self::at(out);
        for folder in [
            folders.claims(),
            folders.0.join(".aside"),
            folders.0.join(".failed"),
        ] {
            fs::create_dir_all(&folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        Ok(folders)
    }

    /// Results of a study.
    #[must_use]
    pub(super) fn results(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Where a study is worked on.
    #[must_use]
    pub(super) fn aside(&self, name: &str) -> PathBuf {
        self.0.join(".aside").join(name)
    }

    /// Claims.
    #[must_use]
    pub(super) fn claims(&self) -> PathBuf {
        self.0.join(".claims")
    }

    fn failed(&self, name: &str) -> PathBuf {
        self.0.join(".failed").join(format!("{name}.json"))
    }

    /// Why a study failed, if it did.
    #[must_use]
    pub(super) fn failure(&self, name: &str) -> Option<Failure> {
        serde_json::from_str(&read_text(&self.failed(name)).ok()?).ok()
    }

    /// Notes that a study failed, or that it did not.
    ///
    /// # Errors
    /// Names the file.
    pub(super) fn note(&self, name: &str, failure: Option<&Failure>) -> Result<()> {
        let path = self.failed(name);
        match failure {
            Some(failure) => write_json(Some(&path), failure),
            // There may have been none.
            None => {
                let _ = fs::remove_file(&path);
                Ok(())
            }
        }
    }

    /// An aside folder that belongs to these inputs: that of an earlier life of the task, or an empty one.
    ///
    /// # Errors
    /// Names the folder.
    pub(super) fn begin(&self, name: &str, inputs: &Inputs) -> Result<PathBuf> {
        let aside = self.aside(name);
        let note = self.0.join(".aside").join(format!("{name}.json"));
        let before: Option<Inputs> = read_text(&note)
            .ok()
            .and_then(|text| serde_json::from_str(&text).ok());
        if before.as_ref() != Some(inputs) {
            if aside.exists() {
                fs::remove_dir_all(&aside)
                    .with_context(|| format!("cannot empty {}", aside.display()))?;
            }
            write_json(Some(&note), inputs)?;
        }
        fs::create_dir_all(&aside)
            .with_context(|| format!("cannot make the folder {}", aside.display()))?;
        Ok(aside)
    }

    /// Puts finished results in their place; what was there before goes.
    ///
    /// # Errors
    /// Names the folder.
    pub(super) fn publish(&self, name: &str, manifest: Manifest) -> Result<Manifest> {
        let (aside, results) = (self.aside(name), self.results(name));
        let manifest = manifest.write(&aside)?;
        let old = self.0.join(".aside").join(format!("{name}.old"));
        if results.exists() {
            let _ = fs::remove_dir_all(&old);
            fs::rename(&results, &old)
                .with_context(|| format!("cannot replace {}", results.display()))?;
        }
        fs::rename(&aside, &results)
            .with_context(|| format!("cannot write {}", results.display()))?;
        // What cannot be removed is in nobody's way.
        let _ = fs::remove_dir_all(&old);
        let _ = fs::remove_file(self.0.join(".aside").join(format!("{name}.json")));
        self.note(name, None)?;
        Ok(manifest)
    }
}
