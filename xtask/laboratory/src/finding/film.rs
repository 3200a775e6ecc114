//! Poses of every frame of a sequence.

use std::path::{Path, PathBuf};

use anyhow::Error;
use fluoropose::finder::{Candidate, FindError};
use fluoropose::locate::Located;
use rayon::prelude::*;

use super::finder::Finder;
use crate::noise::Disturbed;
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
    let masks: Vec<_> = sequence.masks().collect();
    let bar = progress(masks.len(), "masks");
    let find = |finder: &mut Finder<'_>, (frame, (file, mask)): (usize, (&Path, &Disturbed))| {
        let file = file.to_owned();
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
                failure: Some(why(mask, &error)),
            },
        }
    };
    let frames = masks.into_par_iter().enumerate();
    let found = frames.map_init(|| finder.clone(), find).collect();
    bar.finish_and_clear();
    found
}

/// Why nothing was found in a mask: that it is in pieces, rather than that an outline around all of them fits nowhere. Where pixels are told to be
/// unknown, they may divide it.
fn why(mask: &Disturbed, error: &Error) -> String {
    let pieces = match mask.unknown {
        None if error.is::<FindError>() => mask.mask.in_pieces().ok().flatten(),
        _ => None,
    };
    pieces.unwrap_or_else(|| format!("{error:#}"))
}
