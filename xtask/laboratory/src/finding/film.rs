//! Poses of every frame of a sequence.

use std::path::PathBuf;

use fluoropose::finder::Candidate;
use fluoropose::locate::Located;
use rayon::prelude::*;

use super::finder::Finder;
use crate::progress::progress;
use crate::sequence::Sequence;

/// What was found in one frame.
#[derive(Clone, Debug)]
pub struct FrameFound {
    /// File of the mask.
    pub file: PathBuf,
    /// The poses that explain it, best first; none where none was found.
    pub candidates: Vec<Candidate>,
    /// Why none was found.
    pub failure: Option<String>,
}

/// The best first pose of every frame that has one, of whole outlines alone: quick, for a look at a sequence.
pub fn first_poses(finder: &Finder<'_>, sequence: &Sequence<'_>) -> Vec<Located> {
    let first = |finder: &mut Finder<'_>, frame| {
        let first = sequence.look(frame, |seen| finder.first(seen)).ok()?;
        Some(first.poses.first()?.located)
    };
    let frames = (0..sequence.masks().len()).into_par_iter();
    let first = frames.map_init(|| finder.clone(), first);
    first.collect::<Vec<_>>().into_iter().flatten().collect()
}

/// Finds the poses of every frame of a sequence, on all cores. A frame without one has no candidates and says why.
pub fn find_poses(finder: &Finder<'_>, sequence: &Sequence<'_>) -> Vec<FrameFound> {
    let files: Vec<PathBuf> = sequence.masks().map(|(path, _)| path.to_owned()).collect();
    let bar = progress(files.len(), "masks");
    let find = |finder: &mut Finder<'_>, (frame, file): (usize, PathBuf)| {
        let found = sequence.look(frame, |seen| finder.all(seen));
        bar.inc(1);
        match found {
            Ok(found) => FrameFound {
                file,
                candidates: found.candidates.to_vec(),
                failure: None,
            },
            Err(error) => FrameFound {
                file,
                candidates: Vec::new(),
                failure: Some(format!("{error:#}")),
            },
        }
    };
    let frames = files.into_par_iter().enumerate();
    let found = frames.map_init(|| finder.clone(), find).collect();
    bar.finish_and_clear();
    found
}
