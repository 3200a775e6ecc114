//! Which of its poses is chosen in each frame of a sequence, and why.

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::Result;
use fluoropose::finder::choice::{
    Candidate, Choice, Counterpart, FilmFrame, FilmStep, Open, Reason, choose_film,
};
use fluoropose::pose::Pose;
use serde::{Deserialize, Serialize};

use super::build::progress;
use super::finder::{Answer, Finder};
use super::source::Sequence;

/// Which component of a knee something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The femoral component
    Femur,
    /// The tibial component
    Tibia,
}

impl Role {
    /// The role of a component that is named by it.
    pub fn of_name(name: &str) -> Option<Self> {
        match name.to_lowercase().as_str() {
            "femur" => Some(Self::Femur),
            "tibia" => Some(Self::Tibia),
            _ => None,
        }
    }

    /// The other component at `pose`, for candidates of this role.
    pub fn against(self, pose: Pose) -> Counterpart {
        match self {
            Self::Femur => Counterpart::Tibia(pose),
            Self::Tibia => Counterpart::Femur(pose),
        }
    }
}

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

/// The pose of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Decision {
    /// The pose that was chosen.
    pub answer: Answer,
    /// The best of the others: one that nothing ruled out, where there is any.
    pub rival: Option<Answer>,
    /// What decided.
    pub choice: Choice,
}

/// A sentence without its full stop.
impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.answer.refined.is_some() {
            return self.choice.fmt(f);
        }
        // What the library leaves is counted in pixels that differ, and is no distance.
        match self.choice.reason {
            Reason::Residual {
                chosen_px,
                other_px,
            } => write!(f, "{chosen_px} unmatched pixels against {other_px}")?,
            Reason::Undecided { .. } => f.write_str("undecided")?,
            reason => reason.fmt(f)?,
        }
        match self.choice.open {
            Some(Open {
                chosen_px,
                other_px,
                ..
            }) => write!(
                f,
                "; another pose is open: {chosen_px} unmatched pixels against {other_px}"
            ),
            None => Ok(()),
        }
    }
}

/// Chooses a pose in every frame of a sequence, all of them together ([`choose_film`]);
/// `counterparts` are the other component's poses, a frame each, where they are known. `None` for
/// frames without answers.
///
/// # Errors
/// Those of [`choose_film`], which there are none of.
pub fn decide(
    film: &[FrameFound],
    counterparts: &[Option<Counterpart>],
) -> Result<Vec<Option<Decision>>> {
    let candidate = |answer: &Answer| Candidate {
        pose: answer.pose,
        residual_px: misfit(answer),
    };
    let candidates: Vec<Vec<Candidate>> = film
        .iter()
        .map(|frame| frame.answers.iter().map(candidate).collect())
        .collect();
    let frames: Vec<FilmFrame<'_>> = candidates
        .iter()
        .enumerate()
        .map(|(frame, candidates)| FilmFrame {
            candidates,
            counterpart: counterparts.get(frame).copied().flatten(),
        })
        .collect();
    let mut choices = vec![None; frames.len()];
    let mut steps = vec![FilmStep::default(); frames.len()];
    choose_film(&frames, &mut steps, &mut choices)?;
    let decided = choices.into_iter().zip(film);
    Ok(decided
        .map(|(choice, frame)| Decision::of(choice?, &frame.answers))
        .collect())
}

impl Decision {
    fn of(choice: Choice, answers: &[Answer]) -> Option<Self> {
        let others = answers.iter().enumerate();
        let others = others.filter(|&(index, _)| index != choice.index);
        let best = others.min_by(|(_, a), (_, b)| misfit(a).total_cmp(&misfit(b)));
        let open = choice.open.and_then(|open| answers.get(open.index));
        Some(Self {
            answer: *answers.get(choice.index)?,
            rival: open.or(best.map(|(_, answer)| answer)).copied(),
            choice,
        })
    }
}

/// How many frames were decided by what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Reasons {
    /// There was one pose alone.
    pub only: usize,
    /// The residual, or the unmatched pixels.
    pub residual: usize,
    /// The coronal tilt against the other component.
    pub tilt: usize,
    /// The frames before and after.
    pub continuity: usize,
    /// Nothing.
    pub undecided: usize,
    /// Frames in which another pose is open, undecided ones among them.
    pub open: usize,
}

impl Reasons {
    /// Counts decisions.
    pub fn of(decisions: &[Option<Decision>]) -> Self {
        let mut counts = Self::default();
        for decision in decisions.iter().flatten() {
            counts.open += usize::from(!decision.choice.is_decided());
            let count = match decision.choice.reason {
                Reason::Only => &mut counts.only,
                Reason::Residual { .. } => &mut counts.residual,
                Reason::Tilt { .. } => &mut counts.tilt,
                Reason::Turn { .. } | Reason::Film { .. } => &mut counts.continuity,
                Reason::Undecided { .. } => &mut counts.undecided,
            };
            *count += 1;
        }
        counts
    }
}

impl fmt::Display for Reasons {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = [
            ("the only pose", self.only),
            ("residual", self.residual),
            ("coronal tilt", self.tilt),
            ("continuity", self.continuity),
            ("undecided", self.undecided),
        ];
        let counted = words.iter().filter(|(_, count)| *count > 0);
        let counted: Vec<String> = counted
            .map(|(word, count)| format!("{word} {count}"))
            .collect();
        f.write_str(&counted.join(", "))?;
        match self.open {
            0 => Ok(()),
            open => write!(f, "; another pose is open in {open}"),
        }
    }
}
