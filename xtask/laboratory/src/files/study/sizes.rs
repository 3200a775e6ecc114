//! Frames and masks of one study are of one size: a calibration is of frames as they were taken, and many do not say of which size.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use fluoropose_decode::FrameFile;

use super::Study;
use crate::files::{files_in, name_of, read};

/// The first picture of a folder.
struct First {
    key: String,
    path: PathBuf,
    size: (u32, u32),
}

impl First {
    /// `None` where nothing can be read there: whoever needs it tells that.
    fn of(key: String, folder: &Path) -> Option<Self> {
        let path = files_in(folder).ok()?.into_iter().next()?;
        let file = FrameFile::open(read(&path).ok()?, &name_of(&path)).ok()?;
        Some(Self {
            key,
            path,
            size: file.size(0)?,
        })
    }
}

impl Study {
    /// Whether frames and masks, as far as they are at hand, are of one size; the first picture of each folder is looked at.
    ///
    /// # Errors
    /// Names two that differ.
    pub fn check_sizes(&self) -> Result<()> {
        let frames = self.frames.iter();
        let frames = frames.map(|folder| ("frames".to_owned(), folder));
        let masks = self
            .components
            .iter()
            .enumerate()
            .flat_map(|(number, one)| {
                let key = move |source: &String| format!("component.{number}.masks.{source}");
                let all = one.masks.iter().chain(&one.unknown);
                all.map(move |(source, folder)| (key(source), folder))
            });
        let all: Vec<First> = frames
            .chain(masks)
            .filter_map(|(key, folder)| First::of(key, folder))
            .collect();
        let Some((first, others)) = all.split_first() else {
            return Ok(());
        };
        match others.iter().find(|other| other.size != first.size) {
            Some(other) => bail!(
                "in {}: {} but {}: masks are as large as their frames, and those as they were calibrated",
                self.file.display(),
                self.words(other),
                self.words(first)
            ),
            None => Ok(()),
        }
    }

    fn words(&self, First { key, path, size }: &First) -> String {
        // Of `component.0.masks.hand` the line of `component.0.masks` is known, and a person wrote `masks.hand`.
        let mut parts = key.splitn(3, '.');
        let own = parts.nth(2).unwrap_or(key);
        let of = key.rsplit_once('.').map_or(key.as_str(), |(of, _)| of);
        let line = self.line(if of == key { key } else { of });
        let (width, height) = size;
        format!(
            "{line}{own} has {width} x {height} pixels ({})",
            path.display()
        )
    }
}
