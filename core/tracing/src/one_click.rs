//! One click inside an implant, or a rough box around it: a first outline and pose without tracing.
//!
//! Nothing is learned, and nothing is tuned to a study. Three kinds of evidence are combined:
//!
//! 1. *Regions.* Metal is dark, by itself or against the background (`background`), so the threshold regions that hold the
//!    click are hypotheses. One pass finds all of them
//!    (`flooding`), those with the sharpest borders are chosen (`statistics`), and each is tried once more with thin bridges
//!    to other dark things cut (`opening`).
//! 2. *Library.* The canonical form of each region is matched with the views ([`mod@fluoropose::locate`]), and the model is
//!    drawn at the poses. A pose is dropped if it neither covers its region nor lies on edges.
//! 3. *Edges.* The best poses are first brought onto the region's outline, which pulls from far away and tolerates parts of
//!    it that are wrong, and then onto the edges of the frame itself ([`mod@fluoropose::refine`]), where the region no longer
//!    matters. What counts in the end is how much of the model's outline lies on edges of the right sign ([`Support`]).
//!
//! Where the joint's other component is known, and regions do not convince, the model's outline slides over the frame where its joint leaves
//! it (`in_joint`): a faint tray is no region. What it leads to is judged as all answers are.
//!
//! The resulting outline is the model's silhouette at the refined pose or, without a component, the region with the
//! sharpest border ([`OneClick::draw_region`]). The work is done in steps ([`OneClick::step`]), so that a page can show
//! progress and stop in between:
//!
//! ```text
//! Prompt, Observation, Component --> OneClick::new --> needs --> step, step, ... --> starts, answers
//! ```

// In the order of the data.
mod drawn;
mod error;
mod observation;

pub(crate) mod background;
pub(crate) mod window;

mod flooding;
mod opening;
mod statistics;

#[cfg(feature = "alloc")]
mod buffers;
mod candidates;
mod expected;
mod memory;
mod prompt;
mod scoring;
mod support;

mod in_joint;
mod job;
mod judged;
mod preprocessing;
mod rims;
mod rounds;
mod state;

#[cfg(feature = "alloc")]
pub use buffers::OneClickBuffers;
pub use candidates::{Answer, Start};
pub use error::OneClickError;
pub(crate) use expected::DISTANCES;
pub use job::Progress;
pub use judged::candidates;
pub use memory::{OneClickMemory, OneClickNeeds};
pub use observation::Observation;
pub use prompt::Prompt;
pub(crate) use state::SQUARE;
pub use state::{ANSWERS, OneClick, STARTS};
pub use support::Support;

#[cfg(test)]
pub(crate) mod tests;
