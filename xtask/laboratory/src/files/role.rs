//! The two components of a knee.

use fluoropose::finder::choice::Counterpart;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::pose::Pose;
use serde::Deserialize;

/// Which component of a knee something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The femoral component
    Femur,
    /// The tibial component
    Tibia,
}

impl Role {
    /// The role of a component that is named by it.
    pub fn of_name(name: &str) -> Option<Self> {
        match name.to_lowercase().as_str() {
            "femur" => Some(Self::Femur),
            "tibia" => Some(Self::Tibia),
            _ => None,
        }
    }

    /// The component as its anatomy knows it.
    pub fn component(self) -> KneeComponent {
        match self {
            Self::Femur => KneeComponent::Femur,
            Self::Tibia => KneeComponent::Tibia,
        }
    }

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Femur => Self::Tibia,
            Self::Tibia => Self::Femur,
        }
    }

    /// The other component at `pose`, for candidates of this role.
    pub fn against(self, pose: Pose) -> Counterpart {
        match self {
            Self::Femur => Counterpart::Tibia(pose),
            Self::Tibia => Counterpart::Femur(pose),
        }
    }
}
