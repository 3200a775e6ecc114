//! What a page's workers need of the core: libraries built and searched, poses refined and chosen, distortion grids, masks
//! of files.
//!
//! It holds what the page's own thread has too ([`fluoropose_page`]), so that frames and traced outlines are the same classes
//! in a worker. Memory and errors are as there.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod anatomy;
mod bead_grid;
mod beside;
mod camera;
mod choice;
mod detour;
mod exchange;
#[cfg(test)]
mod fake;
mod film;
mod follower;
mod found;
mod frame_search;
mod held;
mod hidden;
mod joint;
mod joint_report;
mod library;
mod library_check;
mod matcher;
mod search_plan;
mod shape;
mod squares;
mod uncertainty;
mod working_model;

pub use anatomy::{ShapeAxes, flange_side, model_remarks, shape_axes, shape_component};
pub use bead_grid::{BeadGrid, DistortionFit, fit_distortion};
pub use camera::{calibration_text, camera_doubts, search_distances};
pub use choice::{Chosen, Surroundings, choose_pose};
pub use detour::off_the_way;
pub use exchange::{MaskOutline, labels_of_mask, mask_of_outline, outline_of_mask};
pub use film::{FilmFacts, FilmStudy, stated_film, stated_film_words};
pub use follower::{FilmFollower, FilmReader, FollowedFilm};
pub use found::Match;
pub use frame_search::FrameSearch;
pub use joint::KneeJoint;
pub use joint_report::{JointReport, write_jtak, write_jtap, write_tra};
pub use library::{LibraryBuilder, LibraryViews};
pub use library_check::check_library;
pub use matcher::{
    Canonical, HandFit, HandVerdict, HiddenPixels, Landscape, Matcher, NearestView, OneClick,
    OneClickAnswer, ViewPose,
};
pub use search_plan::{SearchPlan, SearchStep};
