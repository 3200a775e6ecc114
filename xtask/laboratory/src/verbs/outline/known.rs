//! What is known of the other component, and the choice with it.

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::finder::choice::{ChoiceContext, Counterpart, choose};
use fluoropose::finder::{Candidate, Limits, Verdict, contenders, judge};
use fluoropose::follow::{InJoint, Limb};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::{AnatomicalAxes, field_axes};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::Pose;

use crate::files::{Component, MaskBuffer, Role, Study, read_poses};
use crate::finding::{Neighbour, axes_of, covered};

/// The femoral poses of each frame, where they are known, and both components as their shapes tell them.
#[derive(Default)]
pub(super) struct Known {
    femurs: Vec<Option<Pose>>,
    shapes: Option<[Shape; 2]>,
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
        let shapes = [Shape::of(femur)?, Shape::of(tibia)?];
        if shapes[0].axes.is_none() {
            bail!("the femur's shape tells no axes");
        }
        Ok(Self {
            femurs: poses,
            shapes: Some(shapes),
        })
    }

    /// What the femur of a frame says of a tray there.
    ///
    /// # Errors
    /// For a pose that cannot be drawn.
    pub(super) fn beside(&self, frame: usize, camera: &Camera) -> Result<Option<BesideFemur<'_>>> {
        let (Some([femur, tibia]), Some(pose)) = (&self.shapes, self.femur(frame)) else {
            return Ok(None);
        };
        let (Some(femurs), Some(clicked)) = (femur.limb(), tibia.limb()) else {
            return Ok(None);
        };
        Ok(Some(BesideFemur {
            joint: InJoint::beside(&femurs, &pose),
            clicked,
            covered: covered(&femur.model.as_model(), camera, &pose)?,
        }))
    }

    fn femur(&self, frame: usize) -> Option<Pose> {
        self.femurs.get(frame).copied().flatten()
    }

    /// The pose that the finder chooses, and how far it is to be trusted.
    pub(super) fn chosen(
        &self,
        candidates: &[Candidate],
        frame: usize,
    ) -> Option<(Candidate, Verdict)> {
        let axes = self
            .shapes
            .as_ref()
            .map(|shapes| shapes.each_ref().map(|shape| shape.axes));
        let femur = self.femur(frame);
        let mut rivals = contenders(candidates);
        let mut context = ChoiceContext::default();
        if let Some([Some(femurs), Some(own)]) = axes {
            context.counterpart = femur.map(|pose| Counterpart::Femur(pose.compose(&femurs)));
            for rival in &mut rivals {
                rival.pose = rival.pose.compose(&own);
            }
        }
        let choice = choose(&rivals, &context)?;
        let verdict = judge(candidates, &choice, &Limits::USUAL)?;
        Some((*candidates.get(choice.index)?, verdict))
    }
}

/// What the femur of a frame says of the tray there.
pub(super) struct BesideFemur<'k> {
    joint: InJoint,
    clicked: Limb<'k>,
    covered: MaskBuffer,
}

impl BesideFemur<'_> {
    /// As a click is told it.
    pub(super) fn neighbour(&self) -> Neighbour<'_> {
        Neighbour {
            joint: &self.joint,
            clicked: &self.clicked,
            covered: self.covered.mask(),
        }
    }
}

/// A component, and what its shape tells.
struct Shape {
    model: OwnedModel,
    /// The rotation from the field's axes to the model's, as the study states it or the shape tells it.
    axes: Option<Pose>,
    /// The same with their signs, where those are told too.
    told: Option<AnatomicalAxes>,
    role: Role,
}

impl Shape {
    fn of(component: &Component) -> Result<Self> {
        let role = component
            .role()
            .context("the component is no part of a knee")?;
        let owned = component.read_model()?;
        let model = owned.as_model();
        let told = axes_of(&model, role, component.axes.as_deref())?;
        let unsigned = || {
            let planes = symmetry_planes(model.mesh());
            field_axes(model.mesh(), &planes, role.component())
        };
        Ok(Self {
            axes: told.map(|axes| axes.model_from_field).or_else(unsigned),
            told,
            role,
            model: owned,
        })
    }

    fn limb(&self) -> Option<Limb<'_>> {
        Some(Limb {
            mesh: *self.model.as_model().mesh(),
            component: self.role.component(),
            axes: self.told?,
        })
    }
}
