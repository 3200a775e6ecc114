//! Whether a knee that its pictures show as no knee is one with the pictures flipped left to right.
//!
//! A flipped picture is met by mirrored models as the picture is by the models themselves, so nothing is drawn or read anew: the models are
//! mirrored and refined from the poses at hand.

use alloc::vec::Vec;

use super::choice::DECISIVE_RATIO;
use super::rivals::refine_rivals;
use crate::joint::beside::{Beside, Middles};
use crate::math::sqrt;
use crate::mesh::anatomy::KneeComponent;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::mesh::{Model, OwnedModel};
use crate::pose::Pose;
use crate::refine::{CameraView, RefineBuffers, RefineOptions};

/// Both models of a knee, mirrored.
#[derive(Clone, Debug)]
pub struct FlippedKnee {
    femur: Flipped,
    tibia: Flipped,
    middles: Middles,
}

#[derive(Clone, Debug)]
struct Flipped {
    model: OwnedModel,
    /// The plane that it was mirrored in: through its middle, nearly one of symmetry.
    plane: SymmetryPlane,
}

impl FlippedKnee {
    /// From both models with their anatomical axes, as [`Middles::new`] takes them. `None` where the tray has no plate.
    #[must_use]
    pub fn new(femur: (&Model<'_>, &Pose), tibia: (&Model<'_>, &Pose)) -> Option<Self> {
        let flipped = [Flipped::of(femur)?, Flipped::of(tibia)?];
        let [a, b] = [&flipped[0], &flipped[1]].map(|part| *part.model.as_model().mesh());
        let middles = Middles::new((a, femur.1), (b, tibia.1))?;
        let [femur, tibia] = flipped;
        Some(Self {
            femur,
            tibia,
            middles,
        })
    }

    /// The pose of a component's mirrored model on what was seen, from that of the model itself; `None` where it fits worse than the model
    /// by the ratio that rules a pose out.
    #[must_use]
    pub fn fit(
        &self,
        component: KneeComponent,
        (model, pose): (&Model<'_>, &Pose),
        view: CameraView<'_>,
        options: RefineOptions,
        buffers: &mut RefineBuffers,
    ) -> Option<Pose> {
        let flipped = match component {
            KneeComponent::Femur => &self.femur,
            KneeComponent::Tibia => &self.tibia,
        };
        let mut best = |model: &Model<'_>, starts: &[Pose]| {
            let mut memory = buffers.borrow_for(model, &[view]);
            let found = refine_rivals(model, &[view], starts, &[], options, &mut memory).ok()?;
            found.first().map(|first| first.refined)
        };
        let own = best(model, &[*pose])?;
        let starts = [*pose, mirror_pose(pose, &flipped.plane)];
        let other = best(&flipped.model.as_model(), &starts)?;
        (sqrt(other.loss) <= DECISIVE_RATIO * sqrt(own.loss)).then_some(other.pose)
    }

    /// What was told, with what is so with the pictures flipped: from the poses of [`Self::fit`], femur and tibia, of some frames. Where a
    /// component does not fit in any frame, or that is no knee either, nothing is added.
    #[must_use]
    pub fn judge(&self, told: Beside, poses: &[Option<[Pose; 2]>]) -> Beside {
        let apart = |both: &Option<[Pose; 2]>| {
            let [femur, tibia] = both.as_ref()?;
            Some(self.middles.apart_mm(femur, tibia))
        };
        let Some(mut apart) = poses.iter().map(apart).collect::<Option<Vec<f64>>>() else {
            return told;
        };
        apart.sort_unstable_by(f64::total_cmp);
        let median = apart.get(apart.len() / 2).map(|mm| mm.abs());
        Beside {
            flipped_mm: median.filter(|&mm| mm <= self.middles.most_mm()),
            ..told
        }
    }
}

impl Flipped {
    fn of((model, axes): (&Model<'_>, &Pose)) -> Option<Self> {
        let plane = SymmetryPlane {
            point: model.centre(),
            normal: axes.rotation.map(|row| row[2]),
            deviation_mm: 0.0,
        };
        let reflect = |vertex: &[f32; 3]| plane.reflect(&vertex.map(f64::from)).map(|x| x as f32);
        let vertices: Vec<f32> = model.vertices().iter().flat_map(reflect).collect();
        let turned = model.triangles().iter().flat_map(|&[a, b, c]| [a, c, b]);
        let model = OwnedModel::new(vertices, turned.collect()).ok()?;
        Some(Self { model, plane })
    }
}
