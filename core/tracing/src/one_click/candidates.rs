//! Regions, first poses and answers, and lists that keep the best of them once.

use heapless::Vec;

use fluoropose::math::norm;
use fluoropose::mesh::Model;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::Refined;
use fluoropose::shortlist;

use super::support::Support;

/// How a region was cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    pub(super) look: usize,
    pub(super) level: u16,
    /// Of the disc that cut its bridges, pixels.
    pub(super) radius: f64,
}

/// A pose that the library has for a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Find {
    pub(super) pose: Pose,
    /// The region that led to it, where one did: others are judged by edges alone.
    pub(super) region: Option<Region>,
    /// Canonical pixels that differ, parts of the canonical area.
    pub(super) mismatch: f64,
}

/// A first pose and what speaks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// `camera_from_model`.
    pub pose: Pose,
    pub(super) region: Option<Region>,
    /// What the region and the model drawn at the pose have in common, 0 to 1; 1 without a region.
    pub overlap: f64,
    /// What the frame says of the outline there.
    pub support: Support,
    /// Overlap and strength of edges together, 0 to 2, where the prompt agrees.
    pub score: f64,
}

/// A refined pose and what speaks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The pose, refined on the frame.
    pub refined: Refined,
    /// The first pose that led to it.
    pub start: Pose,
    /// What the frame says of the outline.
    pub support: Support,
    /// Whether it was refined from the mirror image of another answer.
    pub mirrored: bool,
    /// Strength of edges, less where they lie off the outline, where the prompt agrees, 0 to 1:
    /// answers are in its order.
    pub score: f64,
}

/// Something that is found by a pose and ranked by a number, the greatest first.
pub(super) trait Ranked: Copy {
    fn pose(&self) -> &Pose;
    fn rank(&self) -> f64;
}

impl Ranked for Find {
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

/// Up to where two poses are one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    pub(super) degrees: f64,
    /// Distance of the model's middles, parts of that from the focus.
    pub(super) place: f64,
}

impl Nearness {
    /// Whether two poses of a model are one.
    pub(super) fn holds(&self, a: &Pose, b: &Pose, model: &Model<'_>) -> bool {
        let middle = model.bounds().centre;
        let (here, there) = (a.transform(&middle), b.transform(&middle));
        let apart = norm(&core::array::from_fn(|k| here[k] - there[k]));
        geodesic_deg(&a.rotation, &b.rotation) < self.degrees && apart < self.place * here[2].abs()
    }
}

/// Puts `item` in its place in a list, best first. Of items that are one the best stays, and of
/// more than there is room for the best.
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

    fn find(x_mm: f64, z_rot_deg: f64, mismatch: f64) -> Find {
        let region = Region {
            look: 0,
            level: 0,
            radius: 0.0,
        };
        let pose = EulerPose {
            x_mm,
            z_mm: -1000.0,
            z_rot_deg,
            ..EulerPose::default()
        };
        Find {
            pose: pose.into(),
            region: Some(region),
            mismatch,
        }
    }

    #[test]
    fn the_best_of_each_kind_stay_in_order() {
        let vertices = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
        let model = Model::from_triangles(&vertices, &[[0, 1, 2]]).expect("valid");
        let mut list: Vec<Find, 3> = Vec::new();
        let given = [
            find(0.0, 0.0, 0.3),
            // The same, better and worse.
            find(5.0, 2.0, 0.2),
            find(3.0, 1.0, 0.4),
            // Others: by place, by rotation, and one too many.
            find(40.0, 0.0, 0.1),
            find(0.0, 90.0, 0.5),
            find(0.0, 45.0, 0.05),
            find(0.0, -90.0, 0.6),
        ];
        for item in given {
            keep(&mut list, item, NEAR, &model);
        }
        let kept: std::vec::Vec<_> = list.iter().map(|find| find.mismatch).collect();
        assert_eq!(kept, [0.05, 0.1, 0.2]);
    }
}
