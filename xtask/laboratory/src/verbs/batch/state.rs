//! How far the studies of a batch are.

use std::fmt;

use anyhow::Result;

use super::claim::{Claimant, holder};
use super::folders::{Failure, FailureKind, Folders};
use super::list::Entry;
use super::manifest::{Manifest, Settings};

/// What is known of a study.
#[derive(Clone, Debug)]
pub(super) enum StudyState {
    /// Its results are whole.
    Done(Manifest),
    /// Its results are of another version or of other settings.
    Outdated,
    /// A task works on it.
    Claimed(Claimant),
    /// It has no results, and why.
    Failed(Failure),
    /// Nothing was done, or not all.
    Unfinished,
}

impl StudyState {
    /// Looks a study up.
    ///
    /// # Errors
    /// For a manifest that cannot be understood.
    pub(super) fn of(entry: &Entry, settings: &Settings, folders: &Folders) -> Result<Self> {
        let manifest = Manifest::read(&folders.results(&entry.name))?;
        let own = |manifest: &Manifest| {
            manifest.inputs.version == env!("CARGO_PKG_VERSION")
                && manifest.inputs.settings == *settings
        };
        let outdated = manifest.as_ref().is_some_and(|manifest| !own(manifest));
        if let Some(manifest) = manifest.filter(|manifest| own(manifest)) {
            return Ok(Self::Done(manifest));
        }
        if let Some(claimant) = holder(&folders.claims().join(&entry.name)) {
            return Ok(Self::Claimed(claimant));
        }
        if let Some(failure) = folders.failure(&entry.name) {
            return Ok(Self::Failed(failure));
        }
        Ok(if outdated {
            Self::Outdated
        } else {
            Self::Unfinished
        })
    }

    /// The word for it.
    #[must_use]
    pub(super) fn word(&self) -> &'static str {
        match self {
            Self::Done(manifest) if manifest.doubtful > 0 => "doubtful",
            Self::Done(_) => "done",
            Self::Outdated => "outdated",
            Self::Claimed(_) => "claimed",
            Self::Failed(failure) if failure.kind == FailureKind::Crash => "crashed",
            Self::Failed(_) => "failed",
            Self::Unfinished => "unfinished",
        }
    }

    /// What a task that has such a study at its end exits with; the highest of all studies counts.
    #[must_use]
    pub(super) fn exit_code(&self) -> u8 {
        match self.word() {
            "done" => 0,
            "doubtful" => 3,
            "failed" => 4,
            "crashed" => 5,
            _ => 6,
        }
    }
}

/// A sentence without its full stop.
impl fmt::Display for StudyState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done(manifest) => write!(
                f,
                "{} frames, {} doubtful",
                manifest.frames, manifest.doubtful
            ),
            Self::Outdated => {
                f.write_str("the results are of another version or of other settings")
            }
            Self::Claimed(claimant) => {
                write!(f, "by process {} on {}", claimant.process, claimant.host)?;
                match &claimant.task {
                    Some(task) => write!(f, ", task {task}"),
                    None => Ok(()),
                }
            }
            Self::Failed(failure) => f.write_str(&failure.because),
            Self::Unfinished => f.write_str("not yet, or not to its end"),
        }
    }
}
