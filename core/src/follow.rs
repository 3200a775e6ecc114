//! A component followed through a film: from frames in which its pose is known to those beside them, and which to doubt.
//!
//! [`Trail`] goes from frame to frame in one direction. Where the motion so far leads to is the pose that is expected
//! ([`Trail::expect`]); it is refined on the frame ([`look`]), and where what comes of it is out of the ordinary, poses
//! around it are searched. A [`Way`] leads from an [`Anchor`], a frame whose pose is known, over the frames beside it; where
//! two ways meet, [`join_ways`] takes the better of both. [`mirrored_pose`] gives the rival on the other side of the mirror;
//! [`choose_sides`] tells over the film which side is the right one, and [`runs_to_go_over`] where to go over to it; the same
//! for poses that are no mirror image ([`elsewhere`]). Jumps are crossed from both sides (`Crossing`, feature `alloc`), before sides are chosen
//! and at the end. Frames that then
//! stand out are looked at once more from where those beside them lead (`second_looks`, feature `alloc`). `Settling` has the order of all
//! that. [`judge_film`] says at the end how far each frame is to be trusted, and [`Conclusion`] in which state it is and why.
//!
//! [`Following`] (feature `alloc`) does all of it for a caller that gives frames when they are asked for; before it, [`FilmReading`] reads
//! what the constants of the film are estimated from.
//!
//! Where nobody points at a component [`SearchPlan`] says in which order it is looked for, and by which search, until it is found;
//! [`click_outcome`], whether what somebody pointed at leads on beside that.
//!
//! Nothing here knows files, threads or time: whoever calls gives frames one by one, in the order that he likes.

mod cell;
mod click_leads;
#[cfg(feature = "alloc")]
mod conclude;
mod conclusion;
mod contrast;
#[cfg(feature = "alloc")]
mod crossing;
mod distrust;
mod elsewhere;
#[cfg(test)]
mod fake;
#[cfg(feature = "alloc")]
mod false_minimum;
#[cfg(feature = "alloc")]
mod film_reading;
#[cfg(feature = "alloc")]
mod following;
mod frame_pose;
#[cfg(feature = "alloc")]
mod good_frames;
mod in_joint;
mod joint_places;
mod joint_search;
#[cfg(feature = "alloc")]
mod known_femur;
mod look;
mod meeting;
#[cfg(feature = "alloc")]
mod merged_sides;
mod mirrored;
mod motion;
mod near;
#[cfg(feature = "alloc")]
mod other_margins;
mod search_order;
mod search_plan;
#[cfg(feature = "alloc")]
mod second_look;
#[cfg(feature = "alloc")]
mod set_aside;
mod set_pose;
mod settle;
#[cfg(feature = "alloc")]
mod settling;
mod side_margin;
mod side_samples;
mod sides;
mod starts;
mod state;
mod subject;
mod thinned;
mod trail;
mod trust;
mod trust_limits;
mod valley;
mod way;

pub use cell::{Anchor, Cell};
pub use click_leads::{BesideClick, ClickOutcome, click_outcome, holds_place, leads_by_itself};
#[cfg(feature = "alloc")]
pub use conclude::{KnownBeside, conclude, trusted_middles};
pub use conclusion::{Conclusion, Why, fill_gaps};
pub use contrast::{Contrast, contrast};
#[cfg(feature = "alloc")]
pub use crossing::{Crossing, frames_to_cross_from};
pub use distrust::Distrust;
pub use elsewhere::elsewhere;
#[cfg(feature = "alloc")]
pub use false_minimum::{ROUNDS, leaves_less, runs_elsewhere};
#[cfg(feature = "alloc")]
pub use film_reading::FilmReading;
#[cfg(feature = "alloc")]
pub use following::Following;
pub use frame_pose::{FramePose, From, frame_pose_at, refined_on_frame};
#[cfg(feature = "alloc")]
pub use good_frames::{frames_to_ask, good_poses};
pub use in_joint::{BENDS, InJoint, Limb};
pub use joint_places::{JOINT_PLACES, JointPlaces};
pub use joint_search::JointSearch;
#[cfg(feature = "alloc")]
pub use known_femur::KnownFemur;
pub use look::{Looked, Missing, look};
pub use meeting::{have_met, join_ways};
pub use mirrored::mirrored_pose;
pub use motion::{Expected, Known, between};
pub use near::{NEAR, near_poses};
#[cfg(feature = "alloc")]
pub use other_margins::other_margins;
#[cfg(feature = "alloc")]
pub use search_order::RunsToSearch;
pub use search_order::{TRIES, frames_to_search};
pub use search_plan::{
    Ends, FAR, KnownFrame, LED, NOWHERE, Other, Places, Search, SearchPlan, SearchStep, Sought,
    VAIN, WAYS,
};
#[cfg(feature = "alloc")]
pub use second_look::{SecondLook, second_looks};
#[cfg(feature = "alloc")]
pub use set_aside::{set_aside, take_better};
pub use set_pose::refined_around;
pub use settle::settled;
#[cfg(feature = "alloc")]
pub use settling::{Settling, SettlingStep};
pub use side_margin::SideMargin;
pub use side_samples::{SideSample, frames_for_sides, runs_to_go_over};
pub use sides::{KneeFigures, Rival, Side, SideEvidence, SideFigures, SideStep, choose_sides};
pub use starts::Starts;
pub use state::State;
pub use subject::Subject;
pub use trail::{Trail, Usual};
pub use trust::{FrameEvidence, Trust, judge_film};
pub use trust_limits::TrustLimits;
pub use way::Way;
