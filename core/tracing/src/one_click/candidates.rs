//! Regions, poses of the library, first poses and answers, and lists that keep the best of them, each once.

use heapless::Vec;

use fluoropose::math::norm;
use fluoropose::mesh::Model;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::Refined;
use fluoropose::shortlist;

use super::support::Support;

/// How a region is cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    /// The preprocessing pass.
    pub(super) pass: usize,
    /// The threshold.
    pub(super) level: u16,
    /// Radius of the disc that cuts its bridges, pixels.
    pub(super) radius: f64,
}

/// A pose that the library has for a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocatedPose {
    pub(super) pose: Pose,
    /// The region that led to it; poses without a region are scored by edges alone.
    pub(super) region: Option<Region>,
    /// Number of canonical pixels that differ, divided by the canonical area.
    pub(super) mismatch: f64,
}

/// A first pose and its evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// `camera_from_model`.
    pub pose: Pose,
    pub(super) region: Option<Region>,
    /// Intersection of the region and the model drawn at the pose, divided by their union: 0 to 1. 1 without a region.
    pub overlap: f64,
    /// What the frame says about the outline there.
    pub support: Support,
    /// Sum of overlap and strength of edges, multiplied by how well the prompt agrees: 0 to 2.
    pub score: f64,
}

/// A refined pose and its evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The pose, refined on the frame.
    pub refined: Refined,
    /// The first pose that led to it.
    pub start: Pose,
    /// What the frame says about the outline.
    pub support: Support,
    /// Whether it was refined from the mirror image of another answer.
    pub mirrored: bool,
    /// Strength of edges, multiplied by how near they lie to the outline and by how well the prompt agrees: 0 to 1.
    /// Answers are sorted by it.
    pub score: f64,
}

/// Something with a pose that is ranked by a number, the greatest first.
pub(super) trait Ranked: Copy {
    fn pose(&self) -> &Pose;
    fn rank(&self) -> f64;
}

impl Ranked for LocatedPose {
    fn pose(&self) -> &Pose {
        &self.pose
    }
    fn rank(&self) -> f64 {
        -self.mismatch
    }
}

impl Ranked for Start {
    fn pose(&self) -> &Pose {
        &self.pose
    }
    fn rank(&self) -> f64 {
        self.score
    }
}

impl Ranked for Answer {
    fn pose(&self) -> &Pose {
        &self.refined.pose
    }
    fn rank(&self) -> f64 {
        self.score
    }
}

/// Up to where two poses count as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    /// Angle between the rotations.
    pub(super) degrees: f64,
    /// Distance between the model's centres, divided by that from the focus.
    pub(super) place: f64,
}

/// Located and first poses that lead to the same answer.
pub(super) const SAME_START: Nearness = Nearness {
    degrees: 5.0,
    place: 0.04,
};
/// Answers that are the same, up to what refinement leaves.
pub(super) const SAME_ANSWER: Nearness = Nearness {
    degrees: 2.0,
    place: 0.01,
};

impl Nearness {
    /// Whether two poses of a model count as one.
    pub(super) fn holds(&self, a: &Pose, b: &Pose, model: &Model<'_>) -> bool {
        let middle = model.bounds().centre;
        let (here, there) = (a.transform(&middle), b.transform(&middle));
        let apart = norm(&core::array::from_fn(|k| here[k] - there[k]));
        geodesic_deg(&a.rotation, &b.rotation) < self.degrees && apart < self.place * here[2].abs()
    }
}

/// Inserts `item` at its place in a list, the best first. Of items that count as one the best stays, and if there are more
/// than there is room for, the best stay.
pub(super) fn keep<T: Ranked, const N: usize>(
    list: &mut Vec<T, N>,
    item: T,
    near: Nearness,
    model: &Model<'_>,
) {
    let twin = |other: &T| near.holds(other.pose(), item.pose(), model);
    if list
        .iter()
        .any(|other| twin(other) && other.rank() >= item.rank())
    {
        return;
    }
    list.retain(|other| !twin(other));
    shortlist::keep(list, item, |other| -other.rank());
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::EulerPose;

    const NEAR: Nearness = Nearness {
        degrees: 3.0,
        place: 0.02,
    };

    fn located(x_mm: f64, z_rot_deg: f64, mismatch: f64) -> LocatedPose {
        let region = Region {
            pass: 0,
            level: 0,
            radius: 0.0,
        };
        let pose = EulerPose {
            x_mm,
            z_mm: -1000.0,
            z_rot_deg,
            ..EulerPose::default()
        };
        LocatedPose {
            pose: pose.into(),
            region: Some(region),
            mismatch,
        }
    }

    #[test]
    fn the_best_of_each_kind_stay_in_order() {
        let vertices = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
        let model = Model::from_triangles(&vertices, &[[0, 1, 2]]).expect("valid");
        let mut list: Vec<LocatedPose, 3> = Vec::new();
        let given = [
            located(0.0, 0.0, 0.3),
            // The same, better and worse.
            located(5.0, 2.0, 0.2),
            located(3.0, 1.0, 0.4),
            // Others: by place, by rotation, and one too many.
            located(40.0, 0.0, 0.1),
            located(0.0, 90.0, 0.5),
            located(0.0, 45.0, 0.05),
            located(0.0, -90.0, 0.6),
        ];
        for item in given {
            keep(&mut list, item, NEAR, &model);
        }
        let kept: std::vec::Vec<_> = list.iter().map(|located| located.mismatch).collect();
        assert_eq!(kept, [0.05, 0.1, 0.2]);
    }
}
