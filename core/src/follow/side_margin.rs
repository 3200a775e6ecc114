//! By how much the pose of a frame is more likely than another one.

#[cfg(feature = "alloc")]
use super::side_samples::SideSample;
use super::sides::{Rival, SAME_DEG};
#[cfg(feature = "alloc")]
use super::sides::{Side, SideStep};
#[cfg(feature = "alloc")]
use crate::pose::geodesic_deg;

/// The margin from which on another pose is less likely.
pub(super) const DECIDES: f64 = 1.0;

/// By how much another pose of a frame is less likely than its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideMargin {
    /// What the other pose is.
    pub rival: Rival,
    /// 1 is what a frame says that decides by itself.
    pub margin: f64,
    /// How far the other pose is turned from this one, degrees.
    pub apart_deg: f64,
}

impl SideMargin {
    /// Whether the other pose is less likely by as much as decides.
    #[cfg(feature = "alloc")]
    pub(super) fn decides(&self) -> bool {
        self.margin >= DECIDES
    }

    /// Whether the other pose is a mirror image that is hardly another one.
    pub(super) fn is_one_pose(&self) -> bool {
        self.rival == Rival::Mirrored && self.apart_deg < SAME_DEG
    }

    /// The same where either pose may be the right one.
    #[cfg(feature = "alloc")]
    pub(super) fn open(self) -> Self {
        Self {
            margin: 0.0,
            ..self
        }
    }
}

/// By how much the other pose of a frame is less likely, by the nearest frame that was seen with it; `None` where there is
/// none.
#[cfg(feature = "alloc")]
pub(super) fn side_margin(
    samples: &[SideSample],
    steps: &[SideStep],
    frame: usize,
) -> Option<SideMargin> {
    let nearest = nearest(samples, frame)?;
    let margin = margin_in_sample(samples, steps, nearest)?;
    let behind = samples[nearest].frame < frame;
    let next = if behind {
        nearest.checked_add(1)
    } else {
        nearest.checked_sub(1)
    };
    let next = next.and_then(|next| {
        Some((
            samples.get(next)?.frame,
            margin_in_sample(samples, steps, next)?,
        ))
    });
    // Two sides part or meet on the way to a frame that leaves it open; where that one is certain, so is what lies before it.
    let apart_deg = match next.filter(|(_, next)| !next.decides()) {
        Some((next_frame, next)) => {
            let all = samples[nearest].frame.abs_diff(next_frame).max(1);
            let part = samples[nearest].frame.abs_diff(frame) as f64 / all as f64;
            let between = margin.apart_deg + part * (next.apart_deg - margin.apart_deg);
            between.max(margin.apart_deg)
        }
        None => margin.apart_deg,
    };
    Some(SideMargin {
        apart_deg,
        ..margin
    })
}

/// What a frame that was seen with another pose says of that.
#[cfg(feature = "alloc")]
fn margin_in_sample(samples: &[SideSample], steps: &[SideStep], at: usize) -> Option<SideMargin> {
    let sample = samples.get(at)?;
    let other = sample.free()?;
    let step = steps.get(at)?;
    let margin = match (sample.rival, step.side) {
        // Nothing went over to what leaves less.
        (Rival::Elsewhere, Side::Mirrored) => 0.0,
        _ => step.margin,
    };
    Some(SideMargin {
        rival: sample.rival,
        margin,
        apart_deg: geodesic_deg(&sample.own.pose.rotation, &other.pose.rotation),
    })
}

/// The more likely of two other poses of a frame: one that is a pose of its own before one that is hardly another.
#[cfg(feature = "alloc")]
pub(super) fn nearer_rival(
    one: Option<SideMargin>,
    other: Option<SideMargin>,
) -> Option<SideMargin> {
    let open = |rival: &SideMargin| (rival.decides(), rival.is_one_pose());
    let both = one.into_iter().chain(other);
    both.min_by(|one, other| {
        let by_margin = one.margin.total_cmp(&other.margin);
        open(one).cmp(&open(other)).then(by_margin)
    })
}

/// The sample that is nearest to a frame.
#[cfg(feature = "alloc")]
pub(super) fn nearest(samples: &[SideSample], frame: usize) -> Option<usize> {
    (0..samples.len()).min_by_key(|&k| samples[k].frame.abs_diff(frame))
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::follow::fake::turned;
    use std::vec::Vec;

    /// Two frames, 4 and 10, with other poses so far off and so sure.
    fn apart(others: [(f64, f64); 2], frame: usize) -> f64 {
        let sample = |(k, (deg, _)): (usize, &(f64, f64))| SideSample {
            frame: 4 + 6 * k,
            own: turned(0.0, 0.3),
            rival: Rival::Mirrored,
            other: Some(turned(*deg, 0.3)),
            fixed: false,
        };
        let samples: Vec<SideSample> = others.iter().enumerate().map(sample).collect();
        let mut steps = [SideStep::default(); 2];
        steps[0].margin = others[0].1;
        steps[1].margin = others[1].1;
        side_margin(&samples, &steps, frame).map_or(-1.0, |one| one.apart_deg)
    }

    #[test]
    fn a_pose_elsewhere_is_not_hidden_by_a_mirror_image_that_is_hardly_another_pose() {
        let rival = |rival, margin, apart_deg| SideMargin {
            rival,
            margin,
            apart_deg,
        };
        let hardly = rival(Rival::Mirrored, 0.2, 1.5);
        let nearer = |other: SideMargin| {
            let both = [(hardly, other), (other, hardly)];
            both.map(|(one, other)| nearer_rival(Some(one), Some(other)))
        };
        let open = rival(Rival::Elsewhere, 0.8, 5.0);
        assert_eq!(nearer(open), [Some(open); 2]);
        assert_eq!(nearer(rival(Rival::Elsewhere, 1.2, 5.0)), [Some(hardly); 2]);
    }

    #[test]
    fn between_two_frames_that_leave_it_open_the_other_pose_is_as_far_as_between_theirs() {
        let told = |others, expected: [f64; 4]| {
            for (frame, expected) in [2, 6, 10, 12].into_iter().zip(expected) {
                let apart = apart(others, frame);
                assert!((apart - expected).abs() < 1e-9, "{frame}: {apart}");
            }
        };
        told([(1.0, 0.5), (7.0, 0.5)], [1.0, 3.0, 7.0, 7.0]);
        told([(7.0, 0.5), (1.0, 0.5)], [7.0, 7.0, 1.0, 1.0]);
        // One that is certain tells what lies before the other.
        told([(1.0, 0.5), (7.0, 2.0)], [1.0, 1.0, 7.0, 7.0]);
    }
}
