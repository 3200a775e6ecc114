//! All numbers of a joint in one frame, by name, each with its standard deviation.

use crate::joint::condyles::{Above, Condyles, probability_beyond};
use crate::joint::floating::floating_translations;
use crate::joint::kinematics::{Side, joint_angles, joint_axes};
use crate::joint::plate::Plate;
use crate::joint::relative::{Carried, Placed, Relative};
use crate::joint::shared::{ERRORS, KnownTo, Step};
use crate::math::{Vector3, radians, wrap};
use crate::memory::TooLittleMemory;
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;

/// By whose convention a number is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// The field's program for single-plane studies: the femoral origin in the tibial component's axes.
    Field,
    /// Both: with these axes the sequence of rotations is Grood and Suntay's.
    FieldAndGroodSuntay,
    /// Grood and Suntay 1983: the tibia's shift, from the femur, along their axes.
    GroodSuntay,
    /// The lowest points of the femoral component above the tray's plate, from the middle of the plate.
    LowestPoints,
}

/// What a number of [`JointFrame`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name in files, with the unit at its end.
    pub name: &'static str,
    /// `mm`, `deg` or `%`.
    pub unit: &'static str,
    /// By whose convention.
    pub convention: Convention,
}

const fn column(name: &'static str, unit: &'static str, convention: Convention) -> Column {
    Column {
        name,
        unit,
        convention,
    }
}

/// Numbers of a frame.
pub const NUMBERS: usize = 18;

/// Places of the numbers that are asked for by name.
pub mod place {
    /// Mediolateral translation by the field's convention, positive to medial.
    pub const MEDIAL: usize = 2;
    /// Flexion.
    pub const FLEXION: usize = 3;
    /// Abduction.
    pub const ABDUCTION: usize = 4;
    /// Internal rotation.
    pub const ROTATION: usize = 5;
    /// Anterior place of the medial lowest point, mm.
    pub const MEDIAL_AP: usize = 9;
    /// Of the lateral one.
    pub const LATERAL_AP: usize = 10;
    /// Place of the medial lowest point across the plate, mm to medial.
    pub const MEDIAL_ACROSS: usize = 13;
    /// Of the lateral one.
    pub const LATERAL_ACROSS: usize = 14;
    /// Height of the lateral lowest point above the medial one.
    pub const LIFT_OFF: usize = 17;
}

/// What the numbers are, in their order.
pub const COLUMNS: [Column; NUMBERS] = {
    use Convention::{Field, FieldAndGroodSuntay as Both, GroodSuntay, LowestPoints};
    [
        column("field_anterior_mm", "mm", Field),
        column("field_superior_mm", "mm", Field),
        column("field_medial_mm", "mm", Field),
        column("flexion_deg", "deg", Both),
        column("abduction_deg", "deg", Both),
        column("internal_rotation_deg", "deg", Both),
        column("gs_lateral_mm", "mm", GroodSuntay),
        column("gs_anterior_mm", "mm", GroodSuntay),
        column("gs_distraction_mm", "mm", GroodSuntay),
        column("medial_ap_mm", "mm", LowestPoints),
        column("lateral_ap_mm", "mm", LowestPoints),
        column("medial_ap_percent", "%", LowestPoints),
        column("lateral_ap_percent", "%", LowestPoints),
        column("medial_across_mm", "mm", LowestPoints),
        column("lateral_across_mm", "mm", LowestPoints),
        column("medial_height_mm", "mm", LowestPoints),
        column("lateral_height_mm", "mm", LowestPoints),
        column("lift_off_mm", "mm", LowestPoints),
    ]
};

/// A joint in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointFrame {
    /// In the order of [`COLUMNS`].
    pub numbers: [f64; NUMBERS],
    /// One standard deviation of each; `None` where the covariance of a pose is not known.
    pub deviations: Option<[f64; NUMBERS]>,
    /// How each moves with one standard deviation of each error that the whole film has alike ([`super::shared`]); the deviations hold
    /// it. Zero where they are not known.
    pub shared: [[f64; NUMBERS]; ERRORS],
}

impl JointFrame {
    /// What a relative pose alone tells: the first nine numbers, to [`place::MEDIAL_AP`]. Those that need both meshes are NaN.
    #[must_use]
    pub fn without_models(relative: &Relative, side: Side) -> Self {
        let numbers = |pose: &Pose| {
            let mut numbers = [f64::NAN; NUMBERS];
            numbers[..place::MEDIAL_AP].copy_from_slice(&of_pose(&pose.inverse(), side));
            numbers
        };
        let here = numbers(&relative.tibia_from_femur);
        Self::carried(here, relative.carry(|pose| nearest(numbers(pose), &here)))
    }

    fn carried(numbers: [f64; NUMBERS], carried: Option<Carried<NUMBERS>>) -> Self {
        Self {
            numbers,
            deviations: carried.map(|carried| carried.deviations),
            shared: carried.map_or([[0.0; NUMBERS]; ERRORS], |carried| carried.shared),
        }
    }

    /// Probability that one condyle is higher than the other by more than a threshold, mm; 0.7 and 1.0 are in use. `None`
    /// without a standard deviation, and where no lift-off is known.
    #[must_use]
    pub fn lift_off_probability(&self, threshold_mm: f64) -> Option<f64> {
        let deviation = self.deviations?[place::LIFT_OFF];
        let lift_off = self.numbers[place::LIFT_OFF];
        let probability = probability_beyond(lift_off, deviation, threshold_mm);
        Some(probability).filter(|known| !known.is_nan())
    }
}

/// The numbers before [`place::MEDIAL_AP`], in the order of [`COLUMNS`] (mm, degrees), of a relative pose
/// (`femur_from_tibia`, [`relative_pose`](crate::joint::kinematics::relative_pose)) in the axes of [`joint_axes`].
#[must_use]
pub fn of_pose(relative: &Pose, side: Side) -> [f64; place::MEDIAL_AP] {
    let six = joint_angles(relative, side);
    let floating = floating_translations(relative, side);
    [
        six.anterior_mm,
        six.superior_mm,
        six.lateral_mm,
        six.flexion_deg,
        six.abduction_deg,
        six.internal_deg,
        floating.lateral_mm,
        floating.anterior_mm,
        floating.distraction_mm,
    ]
}

/// What is known of a component's pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed {
    /// That of its file (`camera_from_model`).
    pub pose: Pose,
    /// Its covariance, where that is known.
    pub covariance: Option<PoseCovariance>,
    /// What of the covariance is the film's ([`crate::refine::Assessment::film_steps`]); zero where nothing is said of it.
    pub film_steps: [Step; 2],
}

impl From<Pose> for Posed {
    /// Without a covariance.
    fn from(pose: Pose) -> Self {
        Self {
            pose,
            covariance: None,
            film_steps: [[0.0; 6]; 2],
        }
    }
}

/// The two components of a knee, as their meshes and the anatomical axes of these.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'m> {
    side: Side,
    femur_axes: Pose,
    tibia_axes: Pose,
    femur_centre: Vector3,
    tibia_centre: Vector3,
    tibia: Mesh<'m>,
    plate: Plate,
    above: Above<'m>,
}

impl<'m> Joint<'m> {
    /// From both meshes, each with its anatomical axes (`model_from_field` of
    /// [`crate::mesh::anatomy::AnatomicalAxes`]). `None` where the tray has no plate.
    #[must_use]
    pub fn new(femur: (Mesh<'m>, &Pose), tibia: (Mesh<'m>, &Pose), side: Side) -> Option<Self> {
        let femur_axes = joint_axes(femur.1, side);
        let tibia_axes = joint_axes(tibia.1, side);
        let plate = Plate::of(&tibia.0, &tibia_axes, side)?;
        Some(Self {
            side,
            femur_axes,
            tibia_axes,
            femur_centre: femur.0.bounds().centre,
            tibia_centre: tibia.0.bounds().centre,
            tibia: tibia.0,
            plate,
            above: Above::new(femur.0, &femur_axes, plate),
        })
    }

    /// The tray's plate.
    #[must_use]
    pub fn plate(&self) -> &Plate {
        &self.plate
    }

    /// The plate's border from above; see [`Plate::outline`].
    pub fn plate_outline(&self, outline: &mut [[f64; 2]]) {
        self.plate.outline(&self.tibia, &self.tibia_axes, outline);
    }

    /// How many numbers of triangles [`Self::at`] needs as working memory.
    #[must_use]
    pub fn memory_needed(&self) -> usize {
        self.above.memory_needed()
    }

    /// One component as the other sees it, from what is known of both poses, and how well camera and models are known.
    #[must_use]
    pub fn relative(&self, femur: &Posed, tibia: &Posed, known: KnownTo) -> Relative {
        let placed = |posed: &Posed, axes, centre| {
            Placed::new(&posed.pose, axes, centre, posed.covariance).on_film(posed.film_steps)
        };
        let femur = placed(femur, &self.femur_axes, &self.femur_centre);
        let tibia = placed(tibia, &self.tibia_axes, &self.tibia_centre);
        Relative::new(&femur, &tibia, known)
    }

    /// All numbers of a frame.
    ///
    /// # Errors
    /// [`TooLittleMemory`] for fewer than [`Self::memory_needed`].
    pub fn at(
        &self,
        relative: &Relative,
        memory: &mut [u32],
    ) -> Result<JointFrame, TooLittleMemory> {
        let pose = &relative.tibia_from_femur;
        let near = self.above.near(pose, memory)?;
        let numbers = |pose: &Pose| {
            let condyles = self.above.lowest_points(pose, near.iter().copied());
            self.numbers(pose, &condyles)
        };
        let here = numbers(pose);
        let carried = relative.carry(|pose| nearest(numbers(pose), &here));
        Ok(JointFrame::carried(here, carried))
    }

    fn numbers(&self, tibia_from_femur: &Pose, condyles: &Condyles) -> [f64; NUMBERS] {
        let Condyles { medial, lateral } = condyles;
        let mut numbers = [0.0; NUMBERS];
        let (of_poses, of_condyles) = numbers.split_at_mut(place::MEDIAL_AP);
        of_poses.copy_from_slice(&of_pose(&tibia_from_femur.inverse(), self.side));
        of_condyles.copy_from_slice(&[
            medial.anterior_mm,
            lateral.anterior_mm,
            self.plate.percent(medial.anterior_mm),
            self.plate.percent(lateral.anterior_mm),
            medial.medial_mm,
            lateral.medial_mm,
            medial.height_mm,
            lateral.height_mm,
            condyles.lift_off_mm(),
        ]);
        numbers
    }
}

/// Numbers of a pose nearby, with angles that did not pass half a turn.
fn nearest(mut moved: [f64; NUMBERS], here: &[f64; NUMBERS]) -> [f64; NUMBERS] {
    for k in [place::FLEXION, place::ABDUCTION, place::ROTATION] {
        moved[k] = here[k] + turned(moved[k] - here[k]);
    }
    moved
}

/// A difference of angles by less than half a turn, degrees.
fn turned(difference: f64) -> f64 {
    let whole = core::f64::consts::TAU;
    crate::math::degrees(wrap(radians(difference), whole))
}

#[cfg(test)]
mod tests;
