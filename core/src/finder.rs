//! From what a camera saw to one pose, with its reason and its verdict.
//!
//! [`find()`] is the way from a silhouette or a grey frame to the poses that explain it; [`Found::decide`] chooses among
//! them and says how far the choice is to be trusted. Whoever wants a step alone finds it beside them: first poses,
//! refinement of several rivals, starts round a pose that is roughly known, choice over a whole film.

mod around;
#[cfg(feature = "alloc")]
mod buffers;
mod candidate;
pub mod choice;
mod component;
mod corrected;
mod error;
#[cfg(all(test, feature = "alloc"))]
pub(crate) mod fake;
mod find;
mod first;
#[cfg(feature = "alloc")]
mod flipped;
mod memory;
mod mirrored;
pub mod nearby;
pub mod rivals;
mod rounds;
mod usual;
mod verdict;

pub use around::look_around;
#[cfg(feature = "alloc")]
pub use buffers::FinderBuffers;
pub use candidate::{CANDIDATES, Candidate};
pub use component::Component;
pub use corrected::{correct_candidates, onto_target};
pub use error::FindError;
pub use find::{Found, FrameSearch, Goal, Wanted, find, find_into, find_paced};
pub use first::{FIRST_POSES, FirstPoses, first_poses};
#[cfg(feature = "alloc")]
pub use flipped::{FlippedFit, FlippedKnee, FlippedLooks};
pub use memory::FinderMemory;
pub use usual::{FilmMisfits, look_beyond};
pub use verdict::{
    Away, Decision, Doubt, Limits, OTHER_DEG, Refusal, Verdict, contenders, is_determined, judge,
    judge_fit, judge_one,
};
