//! Whether what a click led to leads a film.
//!
//! Whoever clicks knows where the component is, and nobody knows how it lies there. So a pose that convinces leads because a person pointed
//! at it, and one that does not is compared with what the film finds by itself, by the score that chooses everywhere else: a wrong pose in
//! one frame is followed into all others, and makes the other component of its joint doubtful too.

use super::frame_pose::FramePose;
use super::joint_search::{MET, TRAY_SCORE};

/// A pose is as good as another that scores no more than this many times as much: by less, right ones of one film differ from frame to frame.
const ALIKE: f64 = 1.18;

/// What the film finds by itself, to be compared with what a click led to.
#[derive(Clone, Copy, Debug)]
pub struct BesideClick<'p> {
    /// Its pose in the frame of the click, or, where it is lost on the way there, in the nearest frame in which it is known.
    pub found: &'p FramePose,
    /// Whether what is drawn in the frame of the click holds the place that was pointed at; `None` where it is lost on the way.
    pub holds: Option<bool>,
}

/// Whether what a click led to leads without being compared with anything: it has what is asked of a tray that its joint leaves. Right clicks of
/// sharp films scored 0.43 to 0.82, wrong ones at most 0.33; in a film that is finer than its blur right ones have less too, which costs a
/// search and no more.
#[must_use]
pub fn leads_by_itself(clicked: &FramePose) -> bool {
    clicked.score() >= TRAY_SCORE && clicked.fit.met >= MET
}

/// Whether what a click led to leads on, though the film finds the `other` by itself. What does not hold the place that was pointed at is
/// something else, as another knee is, however well it is seen. Else the better one leads, and of two alike the one that holds the place
/// (`holds`: of the clicked one).
#[must_use]
pub fn click_leads(clicked: &FramePose, holds: bool, other: BesideClick<'_>) -> bool {
    let [own, others] = [clicked, other.found].map(FramePose::score);
    match other.holds {
        Some(false) => true,
        Some(true) if !holds => own > ALIKE * others,
        _ => ALIKE * own >= others,
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

    fn leads((own, holds): (f64, bool), (other, other_holds): (f64, Option<bool>)) -> bool {
        let [own, other] = [own, other].map(scored);
        let other = BesideClick {
            found: &other,
            holds: other_holds,
        };
        click_leads(&own, holds, other)
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
    fn what_is_much_better_leads_where_it_holds_the_place_or_is_lost_on_the_way() {
        for holds in [true, false] {
            for other_holds in [Some(true), None] {
                assert!(!leads((0.2, holds), (0.5, other_holds)));
                assert!(leads((0.35, holds), (0.2, other_holds)));
            }
        }
    }

    /// Of two knees in a picture the one that nobody pointed at may be seen better.
    #[test]
    fn what_lies_elsewhere_is_something_else_however_well_it_is_seen() {
        for holds in [true, false] {
            assert!(leads((0.2, holds), (0.8, Some(false))));
        }
    }

    /// Nobody is told that he pointed at something else where the film does not say so.
    #[test]
    fn of_two_alike_the_one_that_holds_the_place_leads() {
        for (own, other) in [(0.30, 0.33), (0.33, 0.30), (0.30, 0.30)] {
            for other_holds in [Some(true), None] {
                assert!(leads((own, true), (other, other_holds)));
            }
            assert!(leads((own, false), (other, None)));
            assert!(!leads((own, false), (other, Some(true))));
        }
    }
}
