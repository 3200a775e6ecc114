//! Whether what a click led to leads a film.
//!
//! Whoever clicks knows where the component is, and nobody knows how it lies there. So a pose that convinces leads because a person pointed
//! at it, and one that does not is compared with what the film finds by itself, by the score that chooses everywhere else: a wrong pose in
//! one frame is followed into all others, and makes the other component of its joint doubtful too.

use super::frame_pose::FramePose;

/// What is asked of a click's pose that leads by itself, as of one that a joint leaves: its score ([`FramePose::score`]), and the part of its
/// outline that is met. Right ones of sharp films have 0.43 to 0.82, wrong ones at most 0.33; in a film that is finer than its blur right
/// ones have less too, which costs a search and no more.
const SCORE: f64 = 0.38;
const MET: f64 = 0.7;
/// A pose is as good as another that scores no more than this many times as much: by less, right ones of one film differ from frame to frame.
const ALIKE: f64 = 1.18;

/// A pose in the frame of a click, and whether what is drawn there holds the place that was pointed at.
#[derive(Clone, Copy, Debug)]
pub struct AtClick<'p> {
    /// The pose.
    pub found: &'p FramePose,
    /// Whether it holds the place.
    pub holds: bool,
}

/// Whether what a click led to leads without being compared with anything.
#[must_use]
pub fn leads_by_itself(clicked: &FramePose) -> bool {
    clicked.score() >= SCORE && clicked.fit.met >= MET
}

/// Whether what a click led to leads on, though the film finds the `other` by itself: where it is as good and holds the place that was
/// pointed at, or the other does not hold it either, and where it is better.
#[must_use]
pub fn click_leads(clicked: AtClick<'_>, other: AtClick<'_>) -> bool {
    let [own, others] = [clicked, other].map(|one| one.found.score());
    match (clicked.holds, other.holds) {
        (true, _) | (false, false) => ALIKE * own >= others,
        (false, true) => own > ALIKE * others,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::turned;

    /// A pose with so strong edges along its outline, nothing of which remains.
    fn scored(strength: f64) -> FramePose {
        let mut found = turned(0.0, 0.0);
        found.contrast.strength = strength;
        found.fit.met = 1.0;
        found
    }

    fn leads((own, holds): (f64, bool), (other, other_holds): (f64, bool)) -> bool {
        let [own, other] = [own, other].map(scored);
        let clicked = AtClick { found: &own, holds };
        let other = AtClick {
            found: &other,
            holds: other_holds,
        };
        click_leads(clicked, other)
    }

    #[test]
    fn a_pose_that_convinces_leads_by_itself() {
        assert!(leads_by_itself(&scored(0.4)) && !leads_by_itself(&scored(0.3)));
        let mut half_met = scored(0.9);
        half_met.fit.met = 0.6;
        assert!(!leads_by_itself(&half_met));
        let mut far_off = scored(0.9);
        far_off.misfit_px = 1.3;
        assert!(!leads_by_itself(&far_off));
    }

    #[test]
    fn what_is_much_better_leads_whatever_was_pointed_at() {
        for holds in [true, false] {
            for other_holds in [true, false] {
                assert!(!leads((0.2, holds), (0.5, other_holds)));
                assert!(leads((0.35, holds), (0.2, other_holds)));
            }
        }
    }

    /// Nobody is told that he pointed at something else where the film does not say so.
    #[test]
    fn of_two_alike_the_one_that_holds_the_place_leads() {
        for (own, other) in [(0.30, 0.33), (0.33, 0.30), (0.30, 0.30)] {
            assert!(leads((own, true), (other, true)));
            assert!(leads((own, true), (other, false)));
            assert!(leads((own, false), (other, false)));
            assert!(!leads((own, false), (other, true)));
        }
    }
}
