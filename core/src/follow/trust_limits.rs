//! What makes a pose of a film doubtful.

use super::side_margin::{DECIDES, SideMargin};

/// Limits of trust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrustLimits {
    /// Most misfit, in usual ones of the film: in what its better frames leave, because all may move in the others while they are exposed.
    pub misfit: f64,
    /// A usual misfit below this counts as so much, pixels.
    pub least_misfit_px: f64,
    /// Most misfit whatever is usual, pixels: a film may be wrong as a whole.
    pub most_misfit_px: f64,
    /// The same of a pose that a person gave, who does not see a pixel: one that leaves more lies on something else, or in another
    /// frame.
    pub fixed_misfit_px: f64,
    /// Least strength of the edges, in usual ones of the film.
    pub strength: f64,
    /// Farthest from where the frames on both sides lead: degrees, mm, and in usual distances of the film.
    pub jump_deg: f64,
    /// The same along the image plane, mm, of what the other component does not do too.
    pub jump_mm: f64,
    /// Both in usual ones of the film.
    pub jump_times: f64,
    /// Least margin between the sides of the mirror.
    pub side: f64,
    /// Largest standard deviation of the rotation, degrees.
    pub sd_deg: f64,
    /// Farthest from the other component along the view, against what is usual in the film, mm.
    pub depth_mm: f64,
    /// The same whatever is usual: both belong to one joint.
    pub joint_mm: f64,
    /// Two ways to one frame may differ by this much, degrees.
    pub ways_deg: f64,
    /// Least part of the outline that is met.
    pub met: f64,
    /// Least part of the outline that is known.
    pub known: f64,
}

impl TrustLimits {
    /// The usual ones.
    pub const USUAL: Self = Self {
        misfit: 2.3,
        least_misfit_px: 0.2,
        most_misfit_px: 0.9,
        fixed_misfit_px: 2.0,
        strength: 0.6,
        jump_deg: 1.5,
        jump_mm: 2.0,
        jump_times: 5.0,
        side: DECIDES,
        sd_deg: 1.5,
        depth_mm: 40.0,
        joint_mm: 60.0,
        ways_deg: 1.5,
        met: 0.85,
        known: 0.6,
    };

    /// How bad it is that another pose is as likely: not at all where a mirror image is hardly another one.
    pub(super) fn open(&self, other: &SideMargin) -> f64 {
        match other.margin < self.side && !other.is_one_pose() {
            true => 2.0 - other.margin,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::Rival;

    #[test]
    fn another_pose_that_is_hardly_another_one_is_no_doubt() {
        let is_open = |rival: Rival, margin: f64, apart_deg: f64| {
            let other = SideMargin {
                rival,
                margin,
                apart_deg,
            };
            TrustLimits::USUAL.open(&other) > 1.0
        };
        assert!(!is_open(Rival::Mirrored, 0.0, 1.9) && !is_open(Rival::Mirrored, 1.1, 9.0));
        assert!(is_open(Rival::Mirrored, 0.9, 2.1) && is_open(Rival::Mirrored, 0.0, 9.0));
        // One that leaves less is the better pose, however near it is.
        assert!(is_open(Rival::Elsewhere, 0.0, 1.9));
    }

    /// 2 where nothing speaks against it, and at the margin that decides as bad as is doubtful: nothing lies between that and no doubt.
    #[test]
    fn another_pose_is_the_worse_the_less_its_margin_is() {
        let open = |margin: f64| {
            TrustLimits::USUAL.open(&SideMargin {
                rival: Rival::Mirrored,
                margin,
                apart_deg: 9.0,
            })
        };
        assert_eq!(
            [-1.5, 0.0, 0.25, 0.75, DECIDES, 4.0].map(open),
            [3.5, 2.0, 1.75, 1.25, 0.0, 0.0]
        );
        assert!(open(0.999) > 1.0);
    }
}
