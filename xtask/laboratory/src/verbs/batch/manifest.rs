//! What a study's results were made from, and that they are whole: the last file that is written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::list::Entry;
use crate::files::{Study, files_in, name_of, read, read_text, sha256, write_json};
use crate::verbs::track::FixedPoses;

/// Its name in the folder of a study's results.
pub(super) const MANIFEST: &str = "manifest.json";

/// What can be chosen of a run, beside the studies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Frames a second of studies that state none, neither by themselves nor by their frames.
    pub frames_per_s: Option<f64>,
    /// Cutoff of the filter, Hz.
    pub cutoff_hz: Option<f64>,
    /// Longest gap that is filled, frames.
    pub interpolate: usize,
    /// Nothing is looked for: the way through list, claims and folders alone.
    pub rehearsal: bool,
}

/// What results depend on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Version of the program.
    pub version: String,
    /// What was chosen.
    pub settings: Settings,
    /// Clicks as they stand in the list.
    pub clicks: Vec<String>,
    /// SHA-256 of each file by what it is, and of all frames.
    pub sha256: BTreeMap<String, String>,
    /// Number of files of frames, and their bytes in all.
    pub frames: (usize, u64),
}

/// A study's results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The study.
    pub name: String,
    /// What the results depend on.
    pub inputs: Inputs,
    /// Frames of the film.
    pub frames: usize,
    /// Frames of which a component is doubtful or has no pose, or that show what no knee does.
    pub doubtful: usize,
    /// SHA-256 of each file of results.
    pub outputs: BTreeMap<String, String>,
}

/// How thoroughly inputs are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// All but the contents of the frames, of which number and length are told: a film is long to read.
    Quick,
    /// Everything.
    Whole,
}

/// A digest of the frames' order where it is not that of letters, which was taken once: results of that order are done again.
fn order_of(files: &[PathBuf]) -> Option<String> {
    let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
    (!names.is_sorted()).then(|| self::sha256(names.join("\n").as_bytes()))
}

/// What the next file of fixed poses is called: several may be of one component.
fn fixed_key(before: &[FixedPoses], component: &str) -> String {
    let own = |one: &&FixedPoses| one.component == component;
    match before.iter().filter(own).count() {
        0 => format!("fixed {component}"),
        more => format!("fixed {component}, {}", more + 1),
    }
}

impl Inputs {
    /// Reads what a study depends on.
    ///
    /// # Errors
    /// For files that cannot be read.
    pub(super) fn read(entry: &Entry, settings: &Settings, look: Look) -> Result<Self> {
        let study = Study::read(&entry.study)?;
        let folder = study.frames_folder()?;
        study.check_files(Some(folder))?;
        let mut sha256 = BTreeMap::new();
        let mut take = |what: String, file: &Path| -> Result<()> {
            sha256.insert(what, digest(file)?);
            Ok(())
        };
        take("study".to_owned(), &entry.study)?;
        take("calibration".to_owned(), &study.calibration)?;
        for component in &study.components {
            take(format!("model of {}", component.name), &component.model)?;
        }
        for (at, fixed) in entry.fixed.iter().enumerate() {
            take(fixed_key(&entry.fixed[..at], &fixed.component), &fixed.file)?;
        }
        let files = files_in(folder)?;
        let length = |path: &PathBuf| std::fs::metadata(path).map_or(0, |about| about.len());
        if let Some(order) = order_of(&files) {
            sha256.insert("order of the frames".to_owned(), order);
        }
        if look == Look::Whole {
            let mut all = Sha256::new();
            for path in &files {
                all.update(name_of(path));
                all.update(Sha256::digest(read(path)?));
            }
            let all: [u8; 32] = all.finalize().into();
            sha256.insert(
                "frames".to_owned(),
                all.iter().map(|byte| format!("{byte:02x}")).collect(),
            );
        }
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            settings: settings.clone(),
            clicks: entry
                .clicks
                .iter()
                .map(|click| click.called.clone())
                .collect(),
            frames: (files.len(), files.iter().map(length).sum()),
            sha256,
        })
    }

    /// Whether they are those of the study that a list names now: by its clicks, its own file and its calibration, which are soon read.
    ///
    /// # Errors
    /// For files that cannot be read.
    pub fn are_of(&self, entry: &Entry, study: &Study) -> Result<bool> {
        let now = entry.clicks.iter().map(|click| &click.called);
        let mut alike = now.eq(&self.clicks);
        for (what, file) in [("study", &entry.study), ("calibration", &study.calibration)] {
            let known = self.sha256.get(what);
            alike &= known == Some(&digest(file)?);
        }
        Ok(alike)
    }

    /// Whether these are the same as far as both were looked at.
    #[must_use]
    pub(super) fn agree(&self, other: &Self) -> bool {
        let known = |key: &String| other.sha256.contains_key(key) || key == "frames";
        let alike = |(key, digest): (&String, &String)| {
            other.sha256.get(key).is_none_or(|own| own == digest)
        };
        self.version == other.version
            && self.settings == other.settings
            && self.clicks == other.clicks
            && self.frames == other.frames
            && self.sha256.keys().all(known)
            && other
                .sha256
                .keys()
                .all(|key| self.sha256.contains_key(key) || key == "frames")
            && self.sha256.iter().all(alike)
    }
}

impl Manifest {
    /// Reads the manifest of a folder; `None` where there is none.
    ///
    /// # Errors
    /// For a file that cannot be understood.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(MANIFEST);
        if !path.is_file() {
            return Ok(None);
        }
        let manifest = serde_json::from_str(&read_text(&path)?);
        manifest
            .map(Some)
            .with_context(|| format!("in {}", path.display()))
    }

    /// Lists the files of a folder with their digests and writes itself beside them.
    ///
    /// # Errors
    /// For files that cannot be read or written.
    pub(super) fn write(mut self, folder: &Path) -> Result<Self> {
        list_files(folder, "", &mut self.outputs)?;
        write_json(Some(&folder.join(MANIFEST)), &self)?;
        Ok(self)
    }
}

/// The digests of all files in a folder and the folders in it.
fn list_files(folder: &Path, before: &str, digests: &mut BTreeMap<String, String>) -> Result<()> {
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    for entry in entries {
        let path = entry?.path();
        let name = format!("{before}{}", name_of(&path));
        if path.is_dir() {
            list_files(&path, &format!("{name}/"), digests)?;
        } else {
            digests.insert(name, digest(&path)?);
        }
    }
    Ok(())
}

fn digest(file: &Path) -> Result<String> {
    Ok(sha256(&read(file)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_fixed_poses_has_a_digest_of_its_own() {
        let of = |text: &str| text.parse::<FixedPoses>().expect("a file");
        let all = ["femur=a.jts", "tibia=b.jts", "femur=c.jts"].map(of);
        let keys = (0..3).map(|at| fixed_key(&all[..at], &all[at].component));
        let keys: Vec<String> = keys.collect();
        assert_eq!(keys, ["fixed femur", "fixed tibia", "fixed femur, 2"]);
    }
}
