//! What is read and written: models, masks, calibrations, poses, frames, corrections, studies.

mod calibration;
mod covariances;
mod distortion;
mod film;
mod found_with;
mod frames;
mod listing;
mod mask;
mod model;
mod name;
mod outputs;
mod pose_rows;
mod poses;
mod role;
mod stated_axes;
mod stated_geometry;
mod states;
mod study;
mod text;

pub use fluoropose_noise::MaskBuffer;

pub use calibration::{camera_for, camera_of_frames, read_calibration, size_taken};
pub use covariances::{Uncertain, covariances_beside, read_covariances, write_covariances};
pub use distortion::{Undistorter, read_distortion, write_distortion};
pub use film::Film;
pub use fluoropose_decode::name_order;
pub use found_with::FoundWith;
pub use frames::{Frames, grey, other_count, reduced, stated_frames_per_s};
pub use listing::{files_in, gaps_in, is_of_system};
pub use mask::{read_mask, read_masks};
pub use model::{
    Unit, other_shape, owned, read_model, read_model_and_remarks, read_model_and_remarks_of,
    read_model_of, shape_doubt,
};
pub use name::check_file_name;
pub use outputs::check_outputs;
pub use pose_rows::{PoseRows, read_poses_of};
pub use poses::{read_poses, write_poses};
pub use role::Role;
pub use stated_geometry::doubt_beside;
pub use states::{State, States};
pub use study::{Component, StatedFilm, Study};
pub use text::{
    csv_fields, name_of, read, read_text, sha256, write_bytes, write_figure, write_json, write_text,
};
