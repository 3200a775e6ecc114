//! How far the studies of a batch are.

use std::fmt;
use std::time::Duration;

use anyhow::Result;
use fluoropose_report::counted;

use super::claim::{End, Held};
use super::folders::{Failure, FailureKind, Folders};
use super::list::Entry;
use super::manifest::{Manifest, Settings};
use crate::exit;

/// What is known of a study.
#[derive(Clone, Debug)]
pub(super) enum StudyState {
    /// Its results are whole.
    Done(Manifest),
    /// Its results are of another version or of other settings.
    Outdated,
    /// A task works on it, or did.
    Claimed(Held),
    /// It has no results, and why.
    Failed(Failure),
    /// Nothing was done, or not all.
    Unfinished,
}

/// The results of a study where they are whole: of this version and these settings, or of others.
///
/// # Errors
/// For a manifest that cannot be understood.
pub(super) fn results(
    entry: &Entry,
    settings: &Settings,
    folders: &Folders,
) -> Result<Option<Result<Manifest, Outdated>>> {
    let manifest = Manifest::read(&folders.results(&entry.name))?;
    let judged = |manifest: Manifest| {
        let of_this = manifest.inputs.version == env!("CARGO_PKG_VERSION");
        match of_this && manifest.inputs.settings == *settings {
            true => Ok(manifest),
            false => Err(Outdated),
        }
    };
    Ok(manifest.map(judged))
}

/// Results of another version or of other settings.
pub(super) struct Outdated;

impl StudyState {
    /// Looks a study up; claims are over after `stale` without a heartbeat.
    ///
    /// # Errors
    /// For a manifest that cannot be understood.
    pub(super) fn of(
        entry: &Entry,
        settings: &Settings,
        folders: &Folders,
        stale: Duration,
    ) -> Result<Self> {
        let outdated = match results(entry, settings, folders)? {
            Some(Ok(manifest)) => return Ok(Self::Done(manifest)),
            other => other.is_some(),
        };
        if let Some(held) = Held::on(&folders.claims(), &entry.name, stale) {
            return Ok(Self::Claimed(held));
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
            Self::Claimed(Held { end: None, .. }) => "claimed",
            Self::Claimed(_) => "abandoned",
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
            "doubtful" => exit::DOUBTFUL,
            "failed" => exit::BAD_INPUT,
            "crashed" => exit::CRASHED,
            _ => exit::NOT_DONE,
        }
    }
}

/// A sentence without its full stop.
impl fmt::Display for StudyState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done(manifest) => write!(
                f,
                "{}, {} doubtful",
                counted(manifest.frames, "frame"),
                manifest.doubtful
            ),
            Self::Outdated => {
                f.write_str("the results are of another version or of other settings")
            }
            Self::Claimed(Held { claimant, end }) => {
                write!(f, "by process {} on {}", claimant.process, claimant.host)?;
                if let Some(task) = &claimant.task {
                    write!(f, ", task {task}")?;
                }
                let next = "the next task takes it over and goes on where it was";
                match end {
                    Some(End::Gone) => write!(f, ", which is gone: {next}"),
                    Some(End::Silent(ago)) => {
                        write!(f, ", silent for {} s: {next}", ago.as_secs())
                    }
                    None => Ok(()),
                }
            }
            Self::Failed(failure) => f.write_str(&failure.because),
            Self::Unfinished => f.write_str("not yet, or not to its end"),
        }
    }
}
