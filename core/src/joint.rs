//! How a knee moves, from the poses of its two components: the numbers that are published, each with its standard deviation.
//!
//! | module | gives |
//! | --- | --- |
//! | [`kinematics`] | the six numbers by the field's convention, and the axes they are taken in |
//! | [`floating`] | the translations of Grood and Suntay |
//! | [`relative`] | the femoral component as the tibial one sees it, and the covariance of that |
//! | [`shared`] | what is wrong with a whole film alike |
//! | [`plate`] | the plane and the extent of a tray's plate, from its mesh |
//! | [`condyles`] | the lowest point of either condyle above the plate, and lift-off |
//! | [`numbers`] | all of these of one frame, by name: what callers use |
//! | [`beside`] | whether a tray lies beside its femoral component, as where a picture is mirrored |
//! | [`impossible`] | whether a knee can have such numbers |
//! | [`pivot`] | the centre of rotation on the plate over several frames |
//! | [`course`] | numbers against flexion, and over a cycle |
//! | [`group`] | numbers of several knees together |
//! | [`low_pass`] | numbers and poses without what is faster than a cutoff |

pub mod beside;
pub mod condyles;
pub mod course;
#[cfg(test)]
pub(crate) mod fake;
pub mod flange;
pub mod floating;
pub mod group;
pub mod impossible;
pub mod kinematics;
pub mod low_pass;
pub mod numbers;
pub mod pivot;
pub mod plate;
pub mod relative;
pub mod shared;

pub use numbers::{COLUMNS, Column, Convention, Joint, JointFrame};
