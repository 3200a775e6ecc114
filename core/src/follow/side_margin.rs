//! By how much the pose of a frame is more likely than another one.

#[cfg(feature = "alloc")]
use super::cell::Cell;
#[cfg(feature = "alloc")]
use super::side_samples::SideSample;
use super::sides::{Rival, SAME_DEG};
#[cfg(feature = "alloc")]
use super::sides::{Side, SideStep};
#[cfg(feature = "alloc")]
use crate::math::{add, dot, scale, subtract};
#[cfg(feature = "alloc")]
use crate::pose::{Pose, geodesic_deg};

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

    /// The same in a frame whose pose is another than that of the one that was seen: sides that meet there may have parted here.
    #[cfg(feature = "alloc")]
    pub(super) fn apart_as(self, seen: &SideSample, cell: Option<&Cell>) -> Self {
        let now = cell.and_then(Cell::found);
        let times = now
            .zip(seen.other.as_ref())
            .map(|(now, other)| times_apart([&seen.own.pose, &other.pose], &now.pose));
        Self {
            apart_deg: self.apart_deg * times.unwrap_or(1.0),
            ..self
        }
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
    let sample = &samples[nearest];
    let other = sample.free()?;
    let step = steps.get(nearest)?;
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

/// How many times as far from its mirror image as the poses that a frame was seen with are from each other another pose of the part is, that
/// lies near them: by the directions it is seen from, of which mirror images lie alike on both sides of a plane. 1 where both are seen from one.
#[cfg(feature = "alloc")]
pub(super) fn times_apart([own, other]: [&Pose; 2], now: &Pose) -> f64 {
    let [own, other, now] = [own, other, now].map(|pose| pose.rotation[2]);
    let half = scale(&subtract(&own, &other), 0.5);
    let squared = dot(&half, &half);
    let middle = scale(&add(&own, &other), 0.5);
    match squared > 0.0 {
        true => (dot(&subtract(&now, &middle), &half) / squared).abs(),
        false => 1.0,
    }
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
    use crate::math::{multiply, radians, rotation_by};
    use proptest::array::uniform3;
    use proptest::prelude::*;

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

    properties! {
        /// A part at any place of the camera's frame, in any axes of its model.
        #[test]
        fn a_pose_is_as_far_from_its_mirror_image_as_its_view_says(
            model in uniform3(-1.8..1.8f64), swing in -0.9..0.9f64,
            near in 0.2..1.0f64, far in -6.0..6.0f64, aside in -3.0..3.0f64,
        ) {
            let model = rotation_by(&model);
            let seen = |out_deg: f64, aside_deg: f64| {
                let mut pose = turned(0.0, 0.3).pose;
                let turn = rotation_by(&[radians(out_deg), radians(aside_deg), 0.0]);
                pose.rotation = multiply(&rotation_by(&[0.0, 0.0, swing]), &multiply(&turn, &model));
                pose
            };
            let times = times_apart([&seen(near, 0.0), &seen(-near, 0.0)], &seen(far, aside));
            prop_assert!((times - (far / near).abs()).abs() < 0.01 + 0.01 * (far / near).abs(), "{times}");
        }
    }
}
