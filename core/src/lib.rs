#![doc = include_str!("../README.md")]
//!
//! ## Modules, in the order of the data
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`memory`], [`shortlist`], [`pace`], [`math`] | | what every other module stands on |
//! | [`image`] | points, grey values | [`Outline`], [`Frame`], [`Mask`] and what is measured of them |
//! | [`pose`] | matrices, angles, `.jts` files | [`Pose`], [`PoseCovariance`] |
//! | [`camera`] | calibration files | [`Camera`] |
//! | [`mesh`] | vertices and triangles | [`Model`], its planes of symmetry, its anatomical axes |
//! | [`joint`] | the poses and models of both components | how the joint moves: [`Joint`], with standard deviations |
//! | [`render`] | a model and its pose | the mask of its silhouette |
//! | [`film`] | a model and its pose, profiles of frames | where its edges seem to be on a film, constants of the film |
//! | [`canonical`] | a mask | [`canonical::CanonicalForm`] |
//! | [`library`] | a model | [`Library`]: its canonical silhouettes from many directions |
//! | [`search`] | a canonical silhouette, libraries | the views that differ from it in the fewest pixels |
//! | [`mod@locate`] | a silhouette, whole or in part | first poses |
//! | [`mod@refine`] | a first pose | [`Refined`], and how certain it is |
//! | [`finder`] | a silhouette or a frame | all poses that explain it, the one chosen, why, and a verdict |
//! | [`implant`] | a model, its library | one file of all that is known of an implant, read in place |
//! | [`follow`] | a pose in one frame of a film | those in the frames beside it, and which of them to doubt |
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(feature = "alloc", test))]
extern crate alloc;
#[cfg(test)]
extern crate std;

#[cfg(test)]
#[macro_use]
mod properties;

mod checksum;
pub mod memory;
pub mod pace;
pub mod shortlist;

pub mod math;

pub mod image;

pub mod pose;

pub mod camera;

pub mod mesh;

pub mod joint;

pub mod render;

pub mod film;

pub mod canonical;

pub mod library;

pub mod search;

pub mod locate;

pub mod refine;

pub mod finder;

pub mod implant;

pub mod follow;

pub use camera::Camera;
pub use camera::calibration::Calibration;
pub use canonical::CanonicalSpec;
#[cfg(feature = "alloc")]
pub use finder::FinderBuffers;
pub use finder::choice::{choose, choose_film};
pub use finder::rivals::refine_rivals;
pub use finder::{Component, FinderMemory, Found, Goal, Verdict, find};
pub use image::contour::{Contour, Outline, Point};
pub use image::frame::Frame;
pub use image::mask::{Mask, MaskMut};
pub use image::silhouette::Silhouette;
pub use joint::kinematics::{Side, coronal_tilt_deg, joint_angles, joint_axes, relative_pose};
pub use joint::{Joint, JointFrame};
pub use library::{Builder, Library, ViewGrid};
pub use locate::{Workspace, locate, workspace_needed};
#[cfg(feature = "alloc")]
pub use mesh::OwnedModel;
pub use mesh::{Mesh, Model};
pub use pose::covariance::PoseCovariance;
pub use pose::{EulerPose, Pose};
pub use refine::{CameraView, RefineMemory, RefineOptions, Refined, refine, uncertainty};
