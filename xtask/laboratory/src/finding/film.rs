//! Poses of every frame of a sequence.

use std::path::{Path, PathBuf};

use super::finder::{Answer, Finder};
use crate::progress::progress;
use crate::sequence::Sequence;

/// What was found in one frame.
#[derive(Clone, Debug)]
pub struct FrameFound {
    /// File of the mask.
    pub file: PathBuf,
    /// The poses that explain it, best first; none where none was found.
    pub answers: Vec<Answer>,
}

/// Finds the poses of every frame of a sequence. A frame without one is named on standard error
/// and has no answers.
pub fn find_poses(finder: &mut Finder<'_>, sequence: &Sequence<'_>) -> Vec<FrameFound> {
    let bar = progress(sequence.masks().len(), "masks");
    let files = sequence.masks().map(|(path, _)| path).enumerate();
    let found = files.map(|(frame, path): (usize, &Path)| {
        let answers = sequence.look(frame, |seen| finder.all(seen));
        bar.inc(1);
        FrameFound {
            file: path.to_owned(),
            answers: answers.unwrap_or_else(|error| {
                bar.suspend(|| eprintln!("no pose for {}: {error:#}", path.display()));
                Vec::new()
            }),
        }
    });
    let found = found.collect();
    bar.finish_and_clear();
    found
}

/// How badly a pose fits, by which the poses of a frame are compared: pixels that differ when the
/// model is drawn, or, after refinement, the root of twice the robust loss in pixels. That is the
/// root mean square of what remains between the outlines where it is small, and counts outline
/// that has no counterpart.
pub fn misfit(answer: &Answer) -> f64 {
    let refined = answer.refined.map(|refined| (2.0 * refined.loss).sqrt());
    refined.unwrap_or(answer.located.unmatched as f64)
}
