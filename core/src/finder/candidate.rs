//! A pose that explains a frame, and how well.

use heapless::Vec;

use super::choice::{CONTENDERS, RivalPose};
use crate::locate::rerank::Reranked;
use crate::math::{norm, radians, sqrt, subtract};
use crate::pose::covariance::PoseCovariance;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{Fit, Refined};
use crate::shortlist::keep;

/// Most candidates of a frame: as many as are compared.
pub const CANDIDATES: usize = CONTENDERS;

/// Of poses nearer to each other than this, degrees, the best is kept.
pub(super) const SAME_DEG: f64 = 0.5;

/// A pose that explains a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// `camera_from_model`, as good as was asked for.
    pub pose: Pose,
    /// The pose that it was refined from: one of the library, the mirror image of a refined pose, or, on a grey frame, that
    /// of the outline. Of a pose that was not refined, itself.
    pub start: Pose,
    /// What the library said, where it led to the pose.
    pub located: Option<Reranked>,
    /// What refinement made of it, where it was asked for.
    pub refined: Option<Refined>,
    /// How sure the refined pose is.
    pub covariance: Option<PoseCovariance>,
    /// How well the model drawn there is met by what was seen.
    pub fit: Fit,
}

impl Candidate {
    /// By what candidates of a frame are compared: pixels that differ when the model is drawn, or, after refinement, the
    /// root of twice the robust loss in pixels. That is the root mean square of what remains between the outlines where it
    /// is small, and counts outline that has no counterpart.
    #[must_use]
    pub fn misfit(&self) -> f64 {
        let refined = self.refined.as_ref().map(misfit_of);
        let located = || self.located.map(|located| located.unmatched as f64);
        refined.or_else(located).unwrap_or(f64::INFINITY)
    }

    /// The same in pixels of a frame that was looked at in squares with sides of so many of them
    /// ([`crate::film::FilmConstants::square_px`]).
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        Self {
            refined: self.refined.map(|refined| refined.in_pixels(side)),
            fit: self.fit.in_pixels(side),
            ..*self
        }
    }

    /// The candidate as it is compared with others.
    #[must_use]
    pub fn rival(&self) -> RivalPose {
        RivalPose {
            pose: self.pose,
            residual_px: self.misfit(),
        }
    }
}

/// By what a refined pose is compared with others ([`Candidate::misfit`]), pixels.
pub(super) fn misfit_of(refined: &Refined) -> f64 {
    sqrt(2.0 * refined.loss)
}

/// Keeps a candidate in place of those that came to the same pose and fit worse, and not at all where one of these fits as well: two that are one are
/// no reason to doubt either.
pub(super) fn keep_once(candidates: &mut Vec<Candidate, CANDIDATES>, candidate: Candidate) {
    if has_as_good(candidates, &candidate.pose, candidate.misfit()) {
        return;
    }
    candidates.retain(|other| !is_same(&candidate.pose, &other.pose));
    keep(candidates, candidate, Candidate::misfit);
}

/// Whether one of the candidates is this pose and fits as well as that leaves.
pub(super) fn has_as_good(candidates: &[Candidate], pose: &Pose, misfit_px: f64) -> bool {
    let mut same = candidates.iter().filter(|other| is_same(pose, &other.pose));
    same.any(|other| other.misfit() <= misfit_px)
}

/// Whether two poses are turned alike, and their places no farther apart than as much of their distance: an inner rim is met by a pose that is
/// turned alike and lies farther, and that is another one.
pub(super) fn is_same(one: &Pose, other: &Pose) -> bool {
    let shift = norm(&subtract(&one.translation, &other.translation));
    geodesic_deg(&one.rotation, &other.rotation) < SAME_DEG
        && shift < radians(SAME_DEG) * norm(&one.translation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::EulerPose;

    #[test]
    fn of_candidates_that_came_to_one_pose_the_best_is_kept() {
        let at = |x_rot_deg: f64, loss: f64| {
            let pose = Pose::from(EulerPose {
                x_rot_deg,
                z_mm: -1000.0,
                ..EulerPose::default()
            });
            Candidate {
                pose,
                start: pose,
                located: None,
                refined: Some(Refined {
                    loss,
                    ..Refined::at(pose)
                }),
                covariance: None,
                fit: Fit::default(),
            }
        };
        let kept = |all: &[Candidate]| {
            let mut candidates = Vec::new();
            all.iter().for_each(|&one| keep_once(&mut candidates, one));
            candidates
        };
        let [one, twin, better, other] = [at(0.0, 0.2), at(0.3, 0.2), at(0.4, 0.1), at(9.0, 0.3)];
        assert_eq!(kept(&[one, other, twin]), [one, other]);
        assert_eq!(kept(&[one, other, better]), [better, other]);
        // Turned alike, and 20 mm farther: what is open is shown.
        let mut farther = twin;
        farther.pose.translation[2] -= 20.0;
        assert_eq!(kept(&[one, farther]), [one, farther]);
        // Two that are not each other's, and one between them.
        assert_eq!(kept(&[one, at(0.8, 0.2), better]), [better]);
    }
}
