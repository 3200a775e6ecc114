//! Which of its poses is chosen in each frame of a sequence, and why.

use std::fmt;

use anyhow::Result;
use fluoropose::finder::choice::{
    Choice, Counterpart, FilmFrame, FilmStep, OpenRival, Reason, RivalPose, choose_film, detours,
    rests_on_doubt,
};
use fluoropose::finder::{Candidate, Doubt, Limits, Verdict, contenders, judge};
use fluoropose::joint::beside::Lying;
use fluoropose::pose::Pose;

use crate::finding::FrameFound;

/// The pose of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Decision {
    /// The pose that was chosen.
    pub chosen: Candidate,
    /// The best of the others: one that nothing ruled out, where there is any.
    pub rival: Option<Candidate>,
    /// What decided.
    pub choice: Choice,
    /// How far it is to be trusted.
    pub verdict: Verdict,
}

impl Decision {
    /// The pose, unless it was refused.
    pub fn pose(&self) -> Option<Pose> {
        let refused = matches!(self.verdict, Verdict::NoFit(_));
        (!refused).then_some(self.chosen.pose)
    }

    /// The same with how well its depth is known.
    pub fn lying(&self) -> Option<Lying> {
        let pose = self.pose()?;
        Some(Lying::new(pose, self.chosen.covariance.as_ref()))
    }

    /// Whether the pose is doubtful.
    pub fn is_doubtful(&self) -> bool {
        matches!(self.verdict, Verdict::Doubtful(_))
    }
}

/// A sentence without its full stop.
impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.chosen.refined.is_some() {
            return self.choice.fmt(f);
        }
        // What the library leaves is counted in pixels that differ, and is no distance.
        match self.choice.reason {
            // Views are located, and their pixels counted, as long as one may be the best.
            Reason::Residual {
                chosen_px,
                other_px: f64::INFINITY,
            } => write!(
                f,
                "{chosen_px} unmatched pixels, those of the other pose not counted"
            )?,
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

/// The other component in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Its pose, in the field's axes.
    pub counterpart: Counterpart,
    /// Whether that is doubtful itself.
    pub is_doubtful: bool,
}

/// Chooses a pose in every frame of a sequence, all of them together ([`choose_film`]);
/// `counterparts` are the other component's poses, a frame each, where they are known. `axes` rotates the field's axes into
/// the model's ([`fluoropose::mesh::anatomy::field_axes`]); counterparts have the field's. `None` for frames without candidates.
///
/// # Errors
/// Those of [`choose_film`], which there are none of.
pub fn decide(
    film: &[FrameFound],
    counterparts: &[Option<Known>],
    axes: &Pose,
) -> Result<Vec<Option<Decision>>> {
    let in_field_axes = |rival: RivalPose| RivalPose {
        pose: rival.pose.compose(axes),
        ..rival
    };
    let candidates: Vec<Vec<RivalPose>> = film
        .iter()
        .map(|frame| {
            let rivals = contenders(&frame.candidates).into_iter();
            rivals.map(in_field_axes).collect()
        })
        .collect();
    let frames: Vec<FilmFrame<'_>> = candidates
        .iter()
        .enumerate()
        .map(|(frame, candidates)| {
            let known = counterparts.get(frame).copied().flatten();
            FilmFrame {
                candidates,
                counterpart: known.map(|known| known.counterpart),
                is_counterpart_doubtful: known.is_some_and(|known| known.is_doubtful),
            }
        })
        .collect();
    let mut choices = vec![None; frames.len()];
    let mut steps = vec![FilmStep::default(); frames.len()];
    choose_film(&frames, &mut steps, &mut choices)?;
    let decided = choices.into_iter().zip(film);
    let mut decided: Vec<Option<Decision>> = decided
        .map(|(choice, frame)| Decision::of(choice?, &frame.candidates))
        .collect();
    doubt_off_the_way(&mut decided);
    doubt_between_doubts(&mut decided);
    Ok(decided)
}

/// Makes frames doubtful that the film does not go through.
fn doubt_off_the_way(film: &mut [Option<Decision>]) {
    let is_good = |one: &&Decision| matches!(one.verdict, Verdict::Good);
    let pose = |one: &Option<Decision>| one.as_ref().filter(is_good).map(|one| one.chosen.pose);
    let good: Vec<Option<Pose>> = film.iter().map(pose).collect();
    let mut told = vec![None; film.len()];
    let [turns, sorted] = &mut [vec![0.0; film.len()], vec![0.0; film.len()]];
    detours(&good, turns, sorted, &mut told);
    for (one, detour) in film.iter_mut().zip(told) {
        if let Some(one) = one {
            one.verdict = one.verdict.or_doubt(detour.map(Doubt::OffTheWay));
        }
    }
}

/// Makes frames doubtful that the film decided, by frames that are doubtful.
fn doubt_between_doubts(film: &mut [Option<Decision>]) {
    let is_good = |one: &Decision| matches!(one.verdict, Verdict::Good);
    let good: Vec<Option<bool>> = film.iter().map(|one| one.as_ref().map(is_good)).collect();
    for (at, one) in film.iter_mut().enumerate() {
        if let Some(one) = one
            .as_mut()
            .filter(|one| rests_on_doubt(at, &one.choice, &good))
        {
            one.verdict = one.verdict.or_doubt(Some(Doubt::BesideDoubt));
        }
    }
}

impl Decision {
    fn of(choice: Choice, candidates: &[Candidate]) -> Option<Self> {
        let others = candidates.iter().enumerate();
        let others = others.filter(|&(index, _)| index != choice.index);
        let best = others.min_by(|(_, a), (_, b)| a.misfit().total_cmp(&b.misfit()));
        let open = choice.open.and_then(|open| candidates.get(open.index));
        Some(Self {
            chosen: *candidates.get(choice.index)?,
            rival: open.or(best.map(|(_, candidate)| candidate)).copied(),
            verdict: judge(candidates, &choice, &Limits::USUAL)?,
            choice,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::EulerPose;
    use fluoropose::refine::Fit;

    #[test]
    fn pixels_that_were_not_counted_are_no_number() {
        let chosen = Candidate {
            pose: Pose::IDENTITY,
            start: Pose::IDENTITY,
            located: None,
            refined: None,
            covariance: None,
            fit: Fit::default(),
        };
        let told = |other_px: f64| {
            let reason = Reason::Residual {
                chosen_px: 565.0,
                other_px,
            };
            let choice = Choice {
                index: 0,
                reason,
                open: None,
                no_knee_deg: None,
            };
            let decision = Decision {
                chosen,
                rival: None,
                choice,
                verdict: Verdict::Good,
            };
            decision.to_string()
        };
        assert_eq!(told(978.0), "565 unmatched pixels against 978");
        let alone = "565 unmatched pixels, those of the other pose not counted";
        assert_eq!(told(f64::INFINITY), alone);
    }

    /// The only pose of a frame, turned by so much, which fits.
    fn fits(y_rot_deg: f64) -> FrameFound {
        let euler = EulerPose {
            y_rot_deg,
            z_mm: -1000.0,
            ..EulerPose::default()
        };
        let pose = Pose::from(euler);
        let fit = Fit {
            known: 1.0,
            met: 1.0,
            residual_px: 0.5,
            misfit_px: 0.5,
            size_px: 200.0,
            ..Fit::default()
        };
        let candidate = Candidate {
            pose,
            start: pose,
            located: None,
            refined: None,
            covariance: None,
            fit,
        };
        FrameFound {
            file: "mask.png".into(),
            candidates: vec![candidate],
            failure: None,
        }
    }

    /// It fits, and nothing else was found: residual and knee have no word against it.
    #[test]
    fn a_pose_that_the_film_does_not_go_through_is_doubtful_and_those_beside_it_are_not() {
        let film: Vec<FrameFound> = [0.0, 2.0, 4.0, 66.0, 8.0, 10.0, 12.0].map(fits).into();
        let decided = decide(&film, &[], &Pose::IDENTITY).expect("decided");
        let verdicts: Vec<Verdict> = decided.iter().flatten().map(|one| one.verdict).collect();
        for (frame, verdict) in verdicts.iter().enumerate() {
            let is_off = matches!(verdict, Verdict::Doubtful(Doubt::OffTheWay(_)));
            assert_eq!(is_off, frame == 3, "{frame}: {verdict}");
            assert!(is_off || *verdict == Verdict::Good, "{frame}: {verdict}");
        }
        let told = verdicts[3].to_string();
        assert!(
            told.contains("through it the film would turn 116\u{b0} farther"),
            "{told}"
        );
    }
}
