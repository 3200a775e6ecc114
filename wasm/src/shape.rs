//! A component as its joint knows it: which one it is, and its axes with their signs.

use fluoropose::follow::Limb;
use fluoropose::mesh::Mesh;
use fluoropose::mesh::anatomy::{AnatomicalAxes, KneeComponent};
use wasm_bindgen::JsError;

use fluoropose_page::pose_numbers::axes_from;

/// What is known of a component's shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    component: KneeComponent,
    axes: AnatomicalAxes,
}

impl Shape {
    /// With axes as a page has them.
    ///
    /// # Errors
    /// A sentence where axes are no right-handed frame.
    pub(crate) fn of(
        component: KneeComponent,
        axes: &[f64],
        front_is_known: bool,
    ) -> Result<Self, JsError> {
        Ok(Self {
            component,
            axes: AnatomicalAxes {
                model_from_field: axes_from(axes)?,
                front_is_known,
                are_files_own: false,
            },
        })
    }

    /// The other one of its joint.
    pub(crate) fn other_component(&self) -> KneeComponent {
        match self.component {
            KneeComponent::Femur => KneeComponent::Tibia,
            KneeComponent::Tibia => KneeComponent::Femur,
        }
    }

    /// With its surface.
    pub(crate) fn limb<'m>(&self, mesh: Mesh<'m>) -> Limb<'m> {
        Limb {
            mesh,
            component: self.component,
            axes: self.axes,
        }
    }
}
