//! A component followed through a film: from frames in which its pose is known to those beside them, and which to doubt.
//!
//! [`Trail`] goes from frame to frame in one direction. Where the motion so far leads to is the pose that is expected
//! ([`Trail::expect`]); it is refined on the frame ([`look`]), and where what comes of it is out of the ordinary, poses
//! around it are searched. [`mirrored_pose`] gives the rival on the other side of the mirror; [`choose_sides`] tells over
//! the film which side is the right one. [`judge_film`] says at the end how far each frame is to be trusted.
//!
//! Nothing here knows files, threads or time: whoever calls gives frames one by one, in the order that he likes.

mod contrast;
mod frame_pose;
mod look;
mod motion;
mod near;
mod settle;
mod sides;
mod state;
mod subject;
mod trail;
mod trust;

pub use contrast::{Contrast, contrast};
pub use frame_pose::{FramePose, From, frame_pose_at, mirrored_pose, refined_on_frame};
pub use look::{Looked, Missing, look};
pub use motion::{Expected, Known, between};
pub use near::{NEAR, near_poses};
pub use settle::settled;
pub use sides::{Side, SideEvidence, SideFigures, SideStep, choose_sides};
pub use state::State;
pub use subject::Subject;
pub use trail::{Trail, Usual};
pub use trust::{Distrust, FrameEvidence, Trust, TrustLimits, judge_film};
