//! Which of its poses is chosen in each frame of a sequence, and why.

use std::fmt;

use anyhow::Result;
use fluoropose::finder::choice::{
    Choice, Counterpart, FilmFrame, FilmStep, OpenRival, Reason, RivalPose, choose_film,
};

use crate::finding::{Answer, FrameFound, misfit};
use fluoropose::pose::Pose;

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
            Some(OpenRival {
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
/// `counterparts` are the other component's poses, a frame each, where they are known. `axes` rotates the field's axes into
/// the model's ([`fluoropose::mesh::anatomy::field_axes`]); counterparts have the field's. `None` for frames without answers.
///
/// # Errors
/// Those of [`choose_film`], which there are none of.
pub fn decide(
    film: &[FrameFound],
    counterparts: &[Option<Counterpart>],
    axes: &Pose,
) -> Result<Vec<Option<Decision>>> {
    let candidate = |answer: &Answer| RivalPose {
        pose: answer.pose.compose(axes),
        residual_px: misfit(answer),
    };
    let candidates: Vec<Vec<RivalPose>> = film
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
