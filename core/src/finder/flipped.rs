//! Whether a knee that its pictures show as no knee is one with the pictures flipped left to right.
//!
//! A flipped picture is met by mirrored models as the picture is by the models themselves, so nothing is drawn or read anew: the models are
//! mirrored and refined from the poses at hand.

use alloc::vec::Vec;

use super::choice::DECISIVE_RATIO;
use super::rivals::refine_rivals;
use crate::joint::beside::{Beside, Flipped, Middles};
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
    femur: Mirrored,
    tibia: Mirrored,
    middles: Middles,
}

#[derive(Clone, Debug)]
struct Mirrored {
    model: OwnedModel,
    /// The plane that it was mirrored in: through its middle, nearly one of symmetry.
    plane: SymmetryPlane,
}

/// A mirrored model on what was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlippedFit {
    /// Its pose.
    pub pose: Pose,
    /// How many times as much the model itself leaves; below 1 where that fits better.
    pub gain: f64,
}

impl FlippedFit {
    /// Whether it fits so much worse that, where it is so in most frames, nothing is told whatever else is seen.
    #[must_use]
    pub fn is_poor(&self) -> bool {
        self.gain * DECISIVE_RATIO < 1.0
    }
}

/// Frames of a film that are looked at as if they were flipped.
const FRAMES: usize = 3;

/// Which looks tell whether a film is flipped, in their order. The femur comes first: where most of its fits tell that nothing is flipped, no
/// more is looked at.
#[derive(Clone, Debug)]
pub struct FlippedLooks {
    all: Vec<(KneeComponent, usize)>,
    /// So many of them, the first, say whether the others are needed.
    most: usize,
    taken: Vec<Option<FlippedFit>>,
}

impl FlippedLooks {
    /// At frames spread over all that have both poses: `apart` is how far the components lie beside each other in each
    /// ([`Middles::apart_of`]).
    #[must_use]
    pub fn new(apart: &[f64]) -> Self {
        let known: Vec<usize> = (0..apart.len()).filter(|&k| apart[k].is_finite()).collect();
        let step = known.len().div_ceil(FRAMES).max(1);
        let spread = known.iter().copied().skip(step / 2).step_by(step);
        let of = |component| spread.clone().map(move |frame| (component, frame));
        let all: Vec<_> = of(KneeComponent::Femur)
            .chain(of(KneeComponent::Tibia))
            .collect();
        let frames = all.len() / 2;
        Self {
            most: frames.min(frames / 2 + 1),
            all,
            taken: Vec::new(),
        }
    }

    /// Looks that may be done at once: components with their frames. Nothing where all is told.
    #[must_use]
    pub fn wanted(&self) -> &[(KneeComponent, usize)] {
        let end = match self.is_told_by_femur() {
            true => self.taken.len(),
            false if self.taken.len() < self.most => self.most,
            false => self.all.len(),
        };
        self.all.get(self.taken.len()..end).unwrap_or_default()
    }

    /// Takes what came of the first look that is wanted.
    pub fn take(&mut self, fit: Option<FlippedFit>) {
        self.taken.push(fit);
    }

    /// What was seen, as [`FlippedKnee::judge`] takes it; one frame without fits where the femur tells that nothing is flipped, or
    /// where not all was seen.
    #[must_use]
    pub fn fits(&self) -> Vec<Option<[FlippedFit; 2]>> {
        if self.taken.len() < self.all.len() {
            return alloc::vec![None];
        }
        let (femur, tibia) = self.taken.split_at(self.all.len() / 2);
        let both = femur.iter().zip(tibia);
        both.map(|(femur, tibia)| Some([(*femur)?, (*tibia)?]))
            .collect()
    }

    fn is_told_by_femur(&self) -> bool {
        let first = self.taken.get(..self.most);
        self.most > 0
            && first.is_some_and(|fits| fits.iter().all(|fit| fit.is_none_or(|fit| fit.is_poor())))
    }
}

/// Of outlines without noise what is left is rounding, square pixels: less is no better.
const LEAST_LOSS: f64 = 1e-3;

impl FlippedKnee {
    /// From both models with their anatomical axes, as [`Middles::new`] takes them. `None` where the tray has no plate.
    #[must_use]
    pub fn new(femur: (&Model<'_>, &Pose), tibia: (&Model<'_>, &Pose)) -> Option<Self> {
        let flipped = [Mirrored::of(femur)?, Mirrored::of(tibia)?];
        let [a, b] = [&flipped[0], &flipped[1]].map(|part| *part.model.as_model().mesh());
        let middles = Middles::new((a, femur.1), (b, tibia.1))?;
        let [femur, tibia] = flipped;
        Some(Self {
            femur,
            tibia,
            middles,
        })
    }

    /// How a component's mirrored model fits what was seen, from the pose of the model itself; `None` where it cannot be refined.
    #[must_use]
    pub fn fit(
        &self,
        component: KneeComponent,
        (model, pose): (&Model<'_>, &Pose),
        view: CameraView<'_>,
        options: RefineOptions,
        buffers: &mut RefineBuffers,
    ) -> Option<FlippedFit> {
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
        Some(FlippedFit {
            pose: other.pose,
            gain: sqrt(own.loss.max(LEAST_LOSS) / other.loss.max(LEAST_LOSS)),
        })
    }

    /// What is told of each frame, with what is so with the pictures flipped: `fits` are those of femur and tibia in some frames, `apart`
    /// is how far the components lie beside each other in each ([`Middles::apart_of`]). Where both fit better flipped, and that is a
    /// knee, it is told of all frames, wherever the tray lies. Where a component was not refined, nothing is added.
    pub fn judge(
        &self,
        told: &mut [Option<Beside>],
        apart: &[f64],
        fits: &[Option<[FlippedFit; 2]>],
    ) {
        let Some(flipped) = self.flipped(fits) else {
            return;
        };
        let known = || apart.iter().filter(|mm| mm.is_finite());
        let own_mm = median(known().map(|mm| mm.abs()));
        for (told, mm) in told.iter_mut().zip(apart) {
            let new = || {
                Some(Beside {
                    mm: own_mm?,
                    most_mm: self.middles.most_mm(),
                    of_film: known().count() > 1,
                    flipped: None,
                })
            };
            if told.is_none() && flipped.is_better && mm.is_finite() {
                *told = new();
            }
            if let Some(told) = told {
                told.flipped = Some(flipped);
            }
        }
    }

    /// What is so with the pictures flipped, where both components fit as well in them and are a knee.
    fn flipped(&self, fits: &[Option<[FlippedFit; 2]>]) -> Option<Flipped> {
        let fits = fits.iter().copied().collect::<Option<Vec<_>>>()?;
        let gain = |component: usize| median(fits.iter().map(|fit| fit[component].gain));
        let (femur, tibia) = (gain(0)?, gain(1)?);
        let fit_as_well = femur.min(tibia) * DECISIVE_RATIO >= 1.0; // [`FlippedFit::is_poor`]
        let apart = |[femur, tibia]: &[FlippedFit; 2]| {
            let mm = self.middles.apart_mm(&femur.pose, &tibia.pose);
            mm.abs()
        };
        let mm = median(fits.iter().map(apart))?;
        let is_knee = mm <= self.middles.most_mm();
        let times = sqrt(femur * tibia);
        (fit_as_well && is_knee).then_some(Flipped {
            mm,
            times,
            is_better: times >= DECISIVE_RATIO,
        })
    }
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

impl Mirrored {
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

#[cfg(test)]
mod tests;
