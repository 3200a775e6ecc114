//! Whether what a click led to leads a film.
//!
//! Whoever clicks knows where the component is, and nobody knows how it lies there. So a pose that convinces leads because a person pointed
//! at it, and one that does not is compared with what the film finds by itself, by the score that chooses everywhere else: a wrong pose in
//! one frame is followed into all others, and makes the other component of its joint doubtful too.

use super::frame_pose::FramePose;
use super::joint_search::{MET, TRAY_SCORE};
use crate::image::mask::Mask;
use crate::pose::geodesic_deg;

/// A pose is as good as another that scores no more than this many times as much: by less, right ones of one film differ from frame to frame.
const ALIKE: f64 = 1.18;
/// Poses that hold the place and are turned by less than this against each other are one, degrees.
const SAME_DEG: f64 = 3.0;
/// A hand points a little beside what it means: at most this part of the silhouette's size, which is the side of a square as large.
const BESIDE: f64 = 0.1;

/// What the film finds by itself, to be compared with what a click led to.
#[derive(Clone, Copy, Debug)]
pub struct BesideClick<'p> {
    /// Its pose in the frame of the click, or, where it is lost on the way there, in the nearest frame in which it is known.
    pub found: &'p FramePose,
    /// Whether what is drawn in the frame of the click holds the place that was pointed at; `None` where it is lost on the way.
    pub holds: Option<bool>,
}

/// What a click comes to, once it is known what the film finds without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClickOutcome {
    /// What the film finds is the same, and leads.
    Same,
    /// The click leads.
    Leads,
    /// What the film finds is another, and leads.
    Outdone,
}

/// Compares what a click led to with what the film finds by itself. `holds`: whether what is drawn where the click led to holds the place that
/// was pointed at.
#[must_use]
pub fn click_outcome(clicked: &FramePose, holds: bool, other: BesideClick<'_>) -> ClickOutcome {
    let turned = || geodesic_deg(&clicked.pose.rotation, &other.found.pose.rotation);
    if other.holds == Some(true) && turned() < SAME_DEG {
        return ClickOutcome::Same;
    }
    match click_leads(clicked, holds, other) {
        true => ClickOutcome::Leads,
        false => ClickOutcome::Outdone,
    }
}

/// Whether what a click led to leads without being compared with anything: it has what is asked of a tray that its joint leaves. Right clicks of
/// sharp films scored 0.43 to 0.82, wrong ones at most 0.33; in a film that is finer than its blur right ones have less too, which costs a
/// search and no more.
#[must_use]
pub fn leads_by_itself(clicked: &FramePose) -> bool {
    clicked.score() >= TRAY_SCORE && clicked.fit.met >= MET
}

/// Whether a silhouette holds the place (column, row, pixels) that was pointed at, or has it close beside it.
#[must_use]
pub fn holds_place(drawn: &Mask<'_>, [column, row]: [f64; 2]) -> bool {
    let reach = BESIDE * libm::sqrt(drawn.area() as f64);
    let near = |at: f64, end: usize| {
        let behind = libm::floor(at + reach) + 1.0;
        libm::ceil(at - reach) as usize..end.min(behind as usize)
    };
    let is_near = |x: usize, y: usize| {
        let (across, down) = (x as f64 - column, y as f64 - row);
        across * across + down * down <= reach * reach && drawn.get(x, y)
    };
    near(row, drawn.height()).any(|y| near(column, drawn.width()).any(|x| is_near(x, y)))
}

/// Whether what a click led to leads on, though the film finds the `other` by itself. What does not hold the place that was pointed at is
/// something else, as another knee is, however well it is seen. Else the better one leads, and of two alike the one that holds the place
/// (`holds`: of the clicked one).
fn click_leads(clicked: &FramePose, holds: bool, other: BesideClick<'_>) -> bool {
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
    use crate::image::mask::{MaskMut, words_needed};

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

    #[test]
    fn a_place_a_tenth_of_its_size_beside_a_silhouette_is_held() {
        let mut words = [0; words_needed(48, 40)];
        let mut mask = MaskMut::new(&mut words, 48, 40).expect("fits");
        (10..30).for_each(|row| mask.fill_span(row, 15, 35));
        let mask = mask.as_mask();
        for (place, held) in [
            ([20.0, 20.0], true),
            ([13.0, 20.0], true),
            ([12.9, 20.0], false),
            ([36.0, 12.0], true),
            ([36.1, 12.0], false),
            ([20.0, 31.0], true),
            // As far beside both sides, and farther from the corner.
            ([13.5, 8.5], false),
            ([-400.0, 20.0], false),
            ([20.0, 4000.0], false),
            ([f64::NAN, 20.0], false),
        ] {
            assert_eq!(holds_place(&mask, place), held, "{place:?}");
        }
        let empty = Mask::new(&[0; words_needed(48, 40)], 48, 40).expect("fits");
        assert!(!holds_place(&empty, [20.0, 20.0]));
    }

    /// Elsewhere it may be another knee, and lost on the way it is not known.
    #[test]
    fn what_holds_the_place_and_is_hardly_turned_is_the_same_whatever_is_weaker() {
        let outcome = |degrees: f64, holds| {
            let mut found = scored(0.8);
            found.pose.rotation = turned(degrees, 0.0).pose.rotation;
            let found = &found;
            click_outcome(&scored(0.2), true, BesideClick { found, holds })
        };
        assert_eq!(outcome(2.9, Some(true)), ClickOutcome::Same);
        assert_eq!(outcome(3.1, Some(true)), ClickOutcome::Outdone);
        assert_eq!(outcome(0.0, None), ClickOutcome::Outdone);
        assert_eq!(outcome(0.0, Some(false)), ClickOutcome::Leads);
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
