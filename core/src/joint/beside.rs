//! A tray that lies beside its femoral component, across the knee: what one view shows where the picture is mirrored.
//!
//! From behind a part casts nearly the shadow that its mirror image casts from the front. A mirrored film is therefore met, by each component
//! as if it were seen from its other side. The parts are not quite their own mirror images, though, nor alike: each is found at a distance of its own,
//! and in a view from the side that is across the knee. No knee goes there: what stands between the condyles of an insert
//! lies under the notch of the femoral component.

use core::fmt;

use crate::joint::kinematics::Side;
use crate::joint::plate::Plate;
use crate::math::{Decimal, Vector3, apply, deviation, dot, median, sqrt};
use crate::mesh::Mesh;
use crate::pose::Pose;
use crate::pose::covariance::PoseCovariance;

/// A condyle bears at a third of the femoral component's width to either side of its middle. That is how knees are made, whatever
/// their size: condyles are as wide as the notch between them and more.
const CONDYLE_OF_WIDTH: f64 = 1.0 / 3.0;

/// What is farther off than so many standard deviations of depth is so whatever depth is.
const FAR: f64 = 4.0;

/// A tray's width, in what a knee allows of both that are equally wide: a half less a third is a sixth.
const WHOLE_TRAY: f64 = 6.0;

/// How far the middles of both components of a knee lie beside each other. Whose side of the body it is does not matter, nor which end of
/// an axis is which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Middles {
    /// Mediolateral in the femoral component's model, a unit.
    across: Vector3,
    /// Its middle along that, mm.
    femur_mm: f64,
    femur_width_mm: f64,
    /// The middle of the plate in the tray's model.
    plate: Vector3,
    plate_width_mm: f64,
}

/// Components that lie beside each other as those of no knee do. In words it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Beside {
    /// How far, mm.
    pub mm: f64,
    /// How far they may, mm.
    pub most_mm: f64,
    /// Whether that is the median of a film, and not of a frame.
    pub of_film: bool,
    /// What is so with the picture flipped, where both components fit as well then and that is a knee.
    pub flipped: Option<Flipped>,
}

/// A knee of which the picture was flipped left to right.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Flipped {
    /// How far its components lie beside each other, mm.
    pub mm: f64,
    /// How many times as much remains between the outlines without flipping; above 1 both fit better flipped.
    pub times: f64,
    /// Whether that is so many times as decides between poses.
    pub is_better: bool,
}

/// A component in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lying {
    /// `camera_from_model`.
    pub pose: Pose,
    /// One standard deviation of its depth, mm; 0 where that is not known.
    pub depth_sd_mm: f64,
}

impl From<Pose> for Lying {
    fn from(pose: Pose) -> Self {
        Self::new(pose, None)
    }
}

impl Lying {
    /// A pose with its covariance, where that is known.
    #[must_use]
    pub fn new(pose: Pose, covariance: Option<&PoseCovariance>) -> Self {
        let variance = covariance.map_or(0.0, |covariance| covariance.matrix[5][5]);
        Self {
            pose,
            depth_sd_mm: deviation(variance),
        }
    }
}

impl Middles {
    /// From both meshes, each with its anatomical axes, of which directions alone matter (`model_from_field` of
    /// [`crate::mesh::anatomy::AnatomicalAxes`]). `None` where the tray has no plate.
    #[must_use]
    pub fn new(femur: (Mesh<'_>, &Pose), tibia: (Mesh<'_>, &Pose)) -> Option<Self> {
        let plate = Plate::of(&tibia.0, tibia.1, Side::Left)?;
        let across = femur.1.rotation.map(|row| row[2]);
        let places = femur.0.vertices().iter();
        let places = places.map(|vertex| dot(&across, &vertex.map(f64::from)));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        let model_from_plate = tibia.1.compose(&plate.from_tibia.inverse());
        Some(Self {
            across,
            femur_mm: (low + high) / 2.0,
            femur_width_mm: high - low,
            plate: model_from_plate.translation,
            plate_width_mm: plate.width_mm,
        })
    }

    /// How far the middle of the tray's plate lies off the plane through the middle of the femoral component in a frame, mm: both poses
    /// are those of the files (`camera_from_model`).
    #[must_use]
    pub fn apart_mm(&self, femur: &Pose, tibia: &Pose) -> f64 {
        let plate = femur.inverse().transform(&tibia.transform(&self.plate));
        dot(&self.across, &plate) - self.femur_mm
    }

    /// The same where depths are known well enough to tell it: to what a knee allows, or where it is more by four standard deviations.
    /// Else NaN.
    #[must_use]
    pub fn known_mm(&self, femur: &Lying, tibia: &Lying) -> f64 {
        let [.., along_the_view] = apply(&femur.pose.rotation, &self.across);
        let [a, b] = [femur, tibia].map(|lying| along_the_view * lying.depth_sd_mm);
        let sd_mm = sqrt(a * a + b * b);
        let apart_mm = self.apart_mm(&femur.pose, &tibia.pose);
        let is_known = sd_mm <= self.most_mm() || apart_mm.abs() > self.most_mm() + FAR * sd_mm;
        if is_known { apart_mm } else { f64::NAN }
    }

    /// How far they may: beyond it a condyle does not bear on the tray but beside it. A femoral component that is wider than its tray
    /// counts as no wider.
    #[must_use]
    pub fn most_mm(&self) -> f64 {
        let width_mm = self.femur_width_mm.min(self.plate_width_mm);
        self.plate_width_mm / 2.0 - CONDYLE_OF_WIDTH * width_mm
    }

    /// What is told of each frame of a film, by what [`Self::apart_mm`] gave; what is no number is not known. Where the median tells
    /// it, it is told of all: mirrored films are mirrored as a whole. `sorted` is working memory of as many numbers.
    pub fn judge(&self, apart: &[f64], sorted: &mut [f64], told: &mut [Option<Beside>]) {
        let median = median(apart, sorted).and_then(|mm| self.told(mm, true));
        for (told, &mm) in told.iter_mut().zip(apart) {
            *told = median.or_else(|| self.told(mm, false));
        }
    }

    /// [`Self::judge`] for the poses of both components in the frames of a film, as long as the shorter of both.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn judge_poses<L: Into<Lying> + Copy>(
        &self,
        femur: &[Option<L>],
        tibia: &[Option<L>],
    ) -> alloc::vec::Vec<Option<Beside>> {
        let apart = self.apart_of(femur, tibia);
        let mut told = alloc::vec![None; apart.len()];
        self.judge(&apart, &mut alloc::vec![0.0; apart.len()], &mut told);
        told
    }

    /// [`Self::known_mm`] of each frame, NaN where a pose is missing too.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn apart_of<L: Into<Lying> + Copy>(
        &self,
        femur: &[Option<L>],
        tibia: &[Option<L>],
    ) -> alloc::vec::Vec<f64> {
        let apart = |(femur, tibia): (&Option<L>, &Option<L>)| {
            let both = (*femur).zip(*tibia);
            both.map_or(f64::NAN, |(femur, tibia)| {
                self.known_mm(&femur.into(), &tibia.into())
            })
        };
        femur.iter().zip(tibia).map(apart).collect()
    }

    fn told(&self, mm: f64, of_film: bool) -> Option<Beside> {
        let (mm, most_mm) = (mm.abs(), self.most_mm());
        (mm > most_mm).then_some(Beside {
            mm,
            most_mm,
            of_film,
            flipped: None,
        })
    }
}

impl Beside {
    /// What of it speaks against a pose that `is_good` by itself, beside the other component's, which is or is not. The tray may lie farther off than
    /// it is wide, which no mirrored picture does: where one of both poses is doubtful for a reason of its own, that one is astray, and nothing is told
    /// of the other.
    #[must_use]
    pub fn against(self, is_good: bool, other_is_good: bool) -> Option<Self> {
        let other_is_astray = self.is_beyond_flipping() && is_good && !other_is_good;
        (!other_is_astray).then_some(self)
    }

    /// Whether the tray lies farther off than mirrored pictures leave it.
    #[must_use]
    pub fn is_beyond_flipping(&self) -> bool {
        self.mm > WHOLE_TRAY * self.most_mm && self.flipped.is_none()
    }
}

impl fmt::Display for Beside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            mm,
            most_mm,
            of_film,
            flipped,
        } = *self;
        if mm > most_mm {
            let over = if of_film {
                " over the film (median)"
            } else {
                ""
            };
            let [mm, most_mm] = Decimal::told_apart(mm, most_mm, 0);
            write!(
                f,
                "the tray would lie {mm} mm beside the femoral component{over}, where a knee allows {most_mm} mm: "
            )?;
        } else {
            f.write_str("both components fit better with the picture flipped: ")?;
        }
        if self.is_beyond_flipping() {
            return f.write_str(
                "that is farther than the tray is wide, which no mirrored picture does: is a model in another unit, or are poses or models those of the other component?",
            );
        }
        let tells = flipped.filter(|flipped| flipped.is_better);
        f.write_str(match (of_film, tells) {
            (true, Some(_)) => "are the pictures mirrored, or the models those of the other side of the body?",
            (true, None) => "are the pictures mirrored, the models those of the other side of the body, or the poses of one component wrong throughout?",
            (false, _) => "is the picture mirrored, is a model that of the other side of the body, or is one of the poses wrong?",
        })?;
        match flipped {
            // That both lie beside each other then is no reason to flip pictures whose poses may be wrong.
            Some(Flipped { mm, .. }) if tells.is_none() => write!(
                f,
                " Flipped left to right both fit about as well and lie {} mm beside each other. Where the pictures are mirrored, flip them and the masks, or take the models of the other side; where they are not, look at the poses",
                Decimal::new(mm, 0)
            ),
            Some(Flipped { mm, times, .. }) => write!(
                f,
                " Flipped left to right both fit ({} times as much remains without) and lie {} mm beside each other: flip pictures and masks, or take the models of the other side",
                Decimal::new(times, 1),
                Decimal::new(mm, 0)
            ),
            None => f.write_str(
                " Compare the picture with the exporter's, and the models' side with the patient's",
            ),
        }
    }
}

#[cfg(test)]
mod tests;
