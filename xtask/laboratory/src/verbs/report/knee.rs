//! The joint of a study, frame by frame.

use anyhow::{Context, Result, bail};
use fluoropose::joint::beside::{Lying, Middles};
use fluoropose::joint::flange::OtherSide;
use fluoropose::joint::low_pass::LowPass;
use fluoropose::joint::numbers::{NUMBERS, Posed};
use fluoropose::joint::relative::Relative;
use fluoropose::joint::shared::KnownTo;
use fluoropose::joint::{Joint, JointFrame};
use fluoropose::mesh::anatomy::AnatomicalAxes;
use fluoropose::{Pose, Side};
use fluoropose_report::{Facts, JointFilm, JointRow};

use super::sources::{Body, Sources};
use crate::files::{Role, shape_doubt};
use crate::finding::axes_of;

/// Points of the tray's border.
const BORDER: usize = 180;

/// What is filtered, if anything.
pub struct Filtering {
    frames_per_s: Option<f64>,
    low_pass: Option<LowPass>,
}

impl Filtering {
    /// A filter of this cutoff, or none; it needs the frames a second.
    ///
    /// # Errors
    /// For a cutoff without or too near to the frames a second.
    pub fn new(frames_per_s: Option<f64>, cutoff_hz: Option<f64>) -> Result<Self> {
        let low_pass = match (cutoff_hz, frames_per_s) {
            (None, _) => None,
            (Some(cutoff), Some(rate)) => Some(LowPass::new(cutoff, rate)?),
            (Some(_), None) => bail!("a filter needs the frames a second (--fps)"),
        };
        Ok(Self {
            frames_per_s,
            low_pass,
        })
    }
}

/// The joint and the words of its axes.
pub struct Knee<'s> {
    name: String,
    side: Side,
    joint: Joint<'s>,
    middles: Middles,
    /// The femoral axes.
    pub femur_axes: AnatomicalAxes,
    /// The tibial axes.
    pub tibia_axes: AnatomicalAxes,
    /// What a reader has to know of these data.
    pub remarks: Vec<String>,
}

impl<'s> Knee<'s> {
    /// The joint of two components whose axes are stated or told by their shapes.
    ///
    /// # Errors
    /// For shapes that do not tell their axes, and a tibial model without a plate.
    pub fn new(name: &str, side: Side, sources: &'s Sources) -> Result<Self> {
        let femur = axes(&sources.femur, Role::Femur)?;
        let tibia = axes(&sources.tibia, Role::Tibia)?;
        let mut remarks = sources.changed.clone();
        let bodies = [(&sources.femur, Role::Femur), (&sources.tibia, Role::Tibia)];
        for (body, role) in bodies {
            if let Some(doubt) = shape_doubt(&body.model, role) {
                remarks.push(format!("The model of the component {}: {doubt}", body.name));
            }
        }
        for (body, axes) in [(&sources.femur, &femur), (&sources.tibia, &tibia)] {
            if !axes.front_is_known {
                remarks.push(format!("The shape of the component {} does not tell front from back; if flexion has the wrong sign, its axes have to be stated.", body.name));
            }
        }
        let femoral = sources.femur.model.as_model();
        let other = OtherSide::than(side, femoral.mesh(), &femur);
        remarks.extend(other.map(Facts::side_remark));
        let says = |body: &Body| body.uncertain.values().all(|one| one.film_steps.is_some());
        if !says(&sources.femur) || !says(&sources.tibia) {
            remarks.push("The covariances do not say what of them is the film's, so that it counts twice, as if it were wrong in each component by itself: `track` writes it now.".to_owned());
        }
        let parts = [(&sources.femur, &femur), (&sources.tibia, &tibia)];
        let [a, b] =
            parts.map(|(body, axes)| (*body.model.as_model().mesh(), &axes.model_from_field));
        let both = Joint::new(a, b, side).zip(Middles::new(a, b));
        let (joint, middles) =
            both.context("no part of the tibial model faces upwards like a tray's plate")?;
        Ok(Self {
            name: name.to_owned(),
            side,
            joint,
            middles,
            femur_axes: femur,
            tibia_axes: tibia,
            remarks,
        })
    }

    /// The numbers of all frames.
    ///
    /// # Errors
    /// For poses that cannot be filtered.
    pub fn film(&self, sources: &Sources, filtering: &Filtering) -> Result<JointFilm> {
        let frames = sources.femur.poses.len();
        let relative: Vec<Option<Relative>> = (0..frames)
            .map(|frame| self.relative(sources, frame))
            .collect();
        let mut memory = vec![0; self.joint.memory_needed()];
        let beside = self
            .middles
            .judge_poses(&lying(&sources.femur), &lying(&sources.tibia));
        let mut rows = Vec::new();
        for (frame, relative) in relative.iter().enumerate() {
            let joint: Option<JointFrame> = match relative {
                Some(relative) => Some(self.joint.at(relative, &mut memory)?),
                None => None,
            };
            let row = JointRow::new(frame + 1, joint, sources.doubts.get(&frame).cloned());
            rows.push(JointRow {
                checked: sources.checked.contains(&frame),
                accepted: sources.accepted.get(&frame).cloned(),
                ..row.lying(beside.get(frame).copied().flatten())
            });
        }
        // A doubtful pose would bend what is good around it.
        let counts = |(relative, row): (&Option<Relative>, &JointRow)| {
            relative.filter(|_| row.doubt.is_none())
        };
        let relied: Vec<Option<Relative>> = relative.iter().zip(&rows).map(counts).collect();
        let filtered = self.filtered(&relied, filtering, &mut memory)?;
        for (row, filtered) in rows.iter_mut().zip(filtered) {
            row.filtered = filtered;
        }
        let mut outline = vec![[0.0; 2]; BORDER];
        self.joint.plate_outline(&mut outline);
        let plate = self.joint.plate();
        Ok(JointFilm {
            name: self.name.clone(),
            side: self.side,
            plate_depth_mm: plate.depth_mm,
            plate_width_mm: plate.width_mm,
            plate_outline: outline,
            frames_per_s: filtering.frames_per_s,
            cutoff_hz: filtering.low_pass.map(|low_pass| low_pass.cutoff_hz),
            remarks: self.remarks.clone(),
            has_verdicts: sources.has_verdicts,
            rows,
        })
    }

    fn relative(&self, sources: &Sources, frame: usize) -> Option<Relative> {
        let of = |body: &Body| {
            let uncertain = body.uncertain.get(&frame);
            Some(Posed {
                pose: body.poses[frame]?,
                covariance: uncertain.map(|one| one.covariance),
                film_steps: uncertain.and_then(|one| one.film_steps).unwrap_or_default(),
            })
        };
        let (femur, tibia) = (of(&sources.femur)?, of(&sources.tibia)?);
        Some(self.joint.relative(&femur, &tibia, KnownTo::USUALLY))
    }

    /// The numbers of the filtered relative poses; nothing without a filter.
    fn filtered(
        &self,
        relative: &[Option<Relative>],
        filtering: &Filtering,
        memory: &mut [u32],
    ) -> Result<Vec<Option<[f64; NUMBERS]>>> {
        let Some(low_pass) = filtering.low_pass else {
            return Ok(Vec::new());
        };
        let pose = |relative: &Option<Relative>| relative.map(|one| one.tibia_from_femur);
        let mut poses: Vec<Option<Pose>> = relative.iter().map(pose).collect();
        let mut room = vec![0.0; LowPass::pose_memory_needed(poses.len())];
        let middle = relative.iter().flatten().next().map(|one| one.middle);
        low_pass.smooth_poses(&mut poses, &middle.unwrap_or_default(), &mut room)?;
        let mut numbers = Vec::new();
        for (pose, relative) in poses.into_iter().zip(relative) {
            let Some((tibia_from_femur, relative)) = pose.zip(*relative) else {
                numbers.push(None);
                continue;
            };
            let smooth = Relative {
                tibia_from_femur,
                covariance: None,
                ..relative
            };
            numbers.push(Some(self.joint.at(&smooth, memory)?.numbers));
        }
        Ok(numbers)
    }
}

fn axes(body: &Body, role: Role) -> Result<AnatomicalAxes> {
    let axes = axes_of(&body.model.as_model(), role, body.stated_axes.as_deref())?;
    axes.with_context(|| {
        format!(
            "the shape of {} does not tell its axes: state them in the study",
            body.name
        )
    })
}

/// Poses with how well their depths are known.
fn lying(body: &Body) -> Vec<Option<Lying>> {
    let lying = |(frame, pose): (usize, &Option<Pose>)| {
        let uncertain = body.uncertain.get(&frame);
        Some(Lying::new((*pose)?, uncertain.map(|one| &one.covariance)))
    };
    body.poses.iter().enumerate().map(lying).collect()
}
