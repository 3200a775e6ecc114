//! What is known of the other component, and the choice with it.

use anyhow::{Context, Result, bail};
use fluoropose::finder::choice::{ChoiceContext, Counterpart, choose};
use fluoropose::finder::{Candidate, Limits, Verdict, contenders, judge};
use fluoropose::mesh::anatomy::field_axes;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::Pose;

use crate::files::{Component, Role, Study, read_model, read_poses};
use crate::finding::axes_of;

/// The femoral poses of each frame, in the field's axes, where they are known.
#[derive(Default)]
pub(super) struct Known {
    femurs: Vec<Option<Pose>>,
    /// From the field's axes to the tibial model's.
    axes: Option<Pose>,
}

impl Known {
    /// The reference poses of the study's femoral component.
    ///
    /// # Errors
    /// Where there are none, or the component is no tibia.
    pub(super) fn femurs(study: &Study, tibia: &Component) -> Result<Self> {
        if tibia.role() != Some(Role::Tibia) {
            bail!("{} is no tibial component", tibia.name);
        }
        let mut all = study.components.iter();
        let femur = all.find(|component| component.role() == Some(Role::Femur));
        let femur = femur.context("the study has no femoral component")?;
        let reference = femur.reference.as_ref();
        let poses = read_poses(reference.context("the femur has no reference poses")?)?;
        let axes = axes(femur)?.context("the femur's shape tells no axes")?;
        let in_field = |pose: Option<Pose>| pose.map(|pose| pose.compose(&axes));
        Ok(Self {
            femurs: poses.into_iter().map(in_field).collect(),
            axes: self::axes(tibia)?,
        })
    }

    /// The pose that the finder chooses, and how far it is to be trusted.
    pub(super) fn chosen(
        &self,
        candidates: &[Candidate],
        frame: usize,
    ) -> Option<(Candidate, Verdict)> {
        let femur = self.femurs.get(frame).copied().flatten();
        let mut rivals = contenders(candidates);
        let context = ChoiceContext {
            counterpart: femur
                .filter(|_| self.axes.is_some())
                .map(Counterpart::Femur),
            ..ChoiceContext::default()
        };
        if let Some(axes) = &self.axes {
            for rival in &mut rivals {
                rival.pose = rival.pose.compose(axes);
            }
        }
        let choice = choose(&rivals, &context)?;
        let verdict = judge(candidates, &choice, &Limits::USUAL)?;
        Some((*candidates.get(choice.index)?, verdict))
    }
}

/// The rotation from the field's axes to a component's, as the study states it or the shape tells it.
fn axes(component: &Component) -> Result<Option<Pose>> {
    let Some(role) = component.role() else {
        return Ok(None);
    };
    let owned = read_model(&component.model)?;
    let model = owned.as_model();
    let told = axes_of(&model, role, component.axes.as_deref())?;
    let unsigned = || {
        let planes = symmetry_planes(model.mesh());
        field_axes(model.mesh(), &planes, role.component())
    };
    Ok(told.map(|axes| axes.model_from_field).or_else(unsigned))
}
