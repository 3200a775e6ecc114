//! Frames of a film whose poses no film goes through.
//!
//! Residual and tilt choose a frame's pose whatever its film says. Where a part of an outline is missing, or lies off in long stretches, they can choose
//! one that is far off and fits. The film comes from a pose and goes on to one: what it would turn more by way of a frame's pose than past it is
//! little, at rest and on the way alike, and so much everywhere in pictures that are no film.

use crate::math::median;
use crate::pose::{Pose, geodesic_deg};

/// Least detour that is told, degrees: half of it is how far off the pose is. A shank that swings turns back by 10 degrees within two frames of
/// fifteen a second. A judgement.
const LEAST_DEG: f64 = 20.0;

/// The same in usual ones of the film, as of [`crate::follow::TrustLimits`].
const TIMES: f64 = 5.0;

/// What is usual of fewer frames says nothing.
const LEAST_FRAMES: usize = 6;

/// A pose by way of which the film turns farther than past it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Detour {
    /// By how much, degrees.
    pub deg: f64,
    /// The median of the film's, degrees.
    pub usual_deg: f64,
}

/// What is told of each frame of a film by the poses in all of them, `None` where a frame has none that is good. `turns` and `sorted` are working
/// memory, of as many numbers as there are frames; frames beyond the shortest of all are left out.
pub fn detours(
    good: &[Option<Pose>],
    turns: &mut [f64],
    sorted: &mut [f64],
    told: &mut [Option<Detour>],
) {
    for (at, turn) in turns.iter_mut().enumerate().take(good.len()) {
        *turn = detour_deg(good, at).unwrap_or(f64::NAN);
    }
    let turns = &turns[..turns.len().min(good.len())];
    told.fill(None);
    let known = turns.iter().filter(|turn| !turn.is_nan()).count();
    let Some(usual_deg) = median(turns, sorted).filter(|_| known >= LEAST_FRAMES) else {
        return;
    };
    let most_deg = LEAST_DEG.max(TIMES * usual_deg);
    for (told, &deg) in told.iter_mut().zip(turns) {
        *told = (deg > most_deg).then_some(Detour { deg, usual_deg });
    }
}

/// How much farther the film turns by way of a frame's pose than past it, between the nearest poses before and after it. At an end of the film, how
/// much farther than it would go on.
fn detour_deg(good: &[Option<Pose>], at: usize) -> Option<f64> {
    let own = (*good.get(at)?)?;
    let mut before = good[..at].iter().rev().zip(1..).filter_map(known);
    let mut after = good[at + 1..].iter().zip(1..).filter_map(known);
    match (before.next(), after.next()) {
        (Some((before, _)), Some((after, _))) => {
            Some(turn_deg(&before, &own) + turn_deg(&own, &after) - turn_deg(&before, &after))
        }
        (Some(near), None) => beyond_deg(&own, near, before.next()?),
        (None, Some(near)) => beyond_deg(&own, near, after.next()?),
        (None, None) => None,
    }
}

/// A pose that is known, and how many frames away it is.
fn known((pose, away): (&Option<Pose>, usize)) -> Option<(Pose, usize)> {
    Some(((*pose)?, away))
}

fn turn_deg(a: &Pose, b: &Pose) -> f64 {
    geodesic_deg(&a.rotation, &b.rotation)
}

/// How much farther the last pose is from the one beside it than that and the next would have it.
fn beyond_deg(own: &Pose, near: (Pose, usize), next: (Pose, usize)) -> Option<f64> {
    let frames = near.1 as f64 / (next.1 - near.1) as f64;
    let led_deg = frames * turn_deg(&near.0, &next.0);
    Some((turn_deg(own, &near.0) - led_deg).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::EulerPose;
    use std::vec;
    use std::vec::Vec;

    fn turned(y_rot_deg: f64) -> Pose {
        EulerPose {
            y_rot_deg,
            ..EulerPose::default()
        }
        .into()
    }

    fn told(good: &[Option<Pose>]) -> Vec<Option<Detour>> {
        let mut told = vec![None; good.len()];
        let mut memory = [vec![0.0; good.len()], vec![0.0; good.len()]];
        let [turns, sorted] = &mut memory;
        detours(good, turns, sorted, &mut told);
        told
    }

    /// A part that turns by three degrees from frame to frame, with a tremor.
    fn film(count: usize) -> Vec<Option<Pose>> {
        let at =
            |frame: usize| 3.0 * frame as f64 + if frame.is_multiple_of(2) { 0.5 } else { 0.0 };
        (0..count).map(|frame| Some(turned(at(frame)))).collect()
    }

    #[test]
    fn a_frame_is_told_that_leaves_the_way_and_its_neighbours_are_not() {
        let mut film = film(9);
        assert_eq!(told(&film), [None; 9]);
        film[4] = Some(turned(40.0));
        let all = told(&film);
        let deg = all[4].expect("told").deg;
        // Past it from 9 to 15 degrees.
        assert!((deg - (31.0 + 25.0 - 6.0)).abs() < 1.0, "{deg}");
        assert_eq!(all.iter().flatten().count(), 1);
        // Half of it is how far the pose is off.
        film[4] = Some(turned(15.0 + 9.0));
        assert_eq!(told(&film)[4], None);
        film[4] = Some(turned(15.0 + 11.0));
        assert!(told(&film)[4].is_some());
    }

    #[test]
    fn what_lies_on_the_way_is_no_detour_however_far_apart_the_frames_are() {
        let mut film = film(30);
        film[6..24].fill(None);
        film[15] = Some(turned(45.0));
        assert_eq!(told(&film), [None; 30]);
        film[15] = Some(turned(-45.0));
        assert!(told(&film)[15].is_some());
    }

    #[test]
    fn at_an_end_the_film_goes_on_as_it_came() {
        let mut film = film(9);
        film[8] = Some(turned(21.0 + 3.0 + 17.0));
        assert_eq!(told(&film), [None; 9]);
        film[8] = Some(turned(21.0 + 2.5 + 23.0));
        assert!(told(&film)[8].is_some());
        film.reverse();
        assert!(told(&film)[0].is_some_and(|one| (one.deg - 23.0).abs() < 1.0));
        // Where the frames beside it are not known it may have gone farther.
        film[1..5].fill(None);
        film[0] = Some(turned(9.0 + 15.0 + 17.0));
        assert_eq!(told(&film)[0], None);
        // At the rate at which it is seen to go, in whatever frames that is seen.
        let mut film = self::film(14);
        film[1..5].fill(None);
        film[6] = None;
        film[0] = Some(turned(15.0 - 15.0 - 23.0));
        assert!(told(&film)[0].is_some());
    }

    #[test]
    fn of_pictures_that_are_no_film_nothing_is_told() {
        let stills = [0.0, 90.0, 10.0, 80.0, 0.0, 100.0, 20.0, 60.0];
        let stills = stills.map(|deg| Some(turned(deg)));
        assert_eq!(told(&stills), [None; 8]);
        // Nor of so few that nothing is usual.
        let mut few = film(5);
        few[3] = Some(turned(90.0));
        assert_eq!(told(&few), [None; 5]);
        assert_eq!(told(&[]), []);
    }
}
