//! Refinement: the pose that brings the model's outline onto what the cameras saw.
//!
//! Damped Gauss-Newton on the distance between two outlines, measured along the normals of the
//! model's as it is drawn at the present pose. Against a silhouette both outlines are sampled by
//! the same pixels and read by the same interpolation, so their bias cancels, and at the pose at
//! which a mask was drawn every residual is zero. Against a grey frame the target is the edge
//! that the outline predicts (`edge.rs`).
//!
//! The Jacobian is that of full perspective at the 3-D point behind each sample of the outline
//! (Fregly, Rahman and Banks, J. Biomech. Eng. 127, 2005, compare outlines alike). Cameras that
//! saw the implant at once add their residuals to the same equations.

mod beyond;
mod border;
#[cfg(feature = "alloc")]
mod buffers;
mod common_distance;
mod correct;
mod correlation;
mod depth;
mod distances;
mod drawing;
mod drawn;
pub(crate) mod edge;
mod edge_bias;
mod effort;
mod equations;
mod error;
mod eye;
mod fit;
mod jacobians;
mod locks;
mod loss;
mod memory;
mod motion;
mod offset;
mod options;
mod outline;
mod places;
mod polarity;
mod probe;
mod problem;
mod profiles;
mod readings;
mod refinement;
mod result;
mod run;
mod samples;
mod stages;
mod step;
mod uncertainty;
mod unless;
mod view;

pub(crate) use beyond::part_beyond;
pub use border::BorderPixel;
#[cfg(feature = "alloc")]
pub use buffers::RefineBuffers;
pub use effort::Effort;
pub use error::RefineError;
pub use fit::{Fit, MET_WITHIN_PX};
pub use locks::Locks;
pub use memory::{FILM_EVERY, RefineMemory};
pub use offset::outline_offset;
pub use options::RefineOptions;
pub use places::places_needed;
pub use polarity::{polarity_across, polarity_at, polarity_inside, polarity_near};
pub use profiles::film_profiles;
pub use readings::{OutlineReading, outline_readings};
pub(crate) use refinement::{Part, Refinement};
pub use result::{Iterate, Refined};
pub(crate) use run::correct_unless;
pub use run::{correct, refine, refine_paced, refine_traced};
pub use samples::{OutlineSample, outline_samples};
pub use uncertainty::{Assessment, assess, fit_at, uncertainty};
pub(crate) use unless::{Ended, Unless};
#[cfg(not(feature = "frames"))]
pub use view::NoFrame;
pub use view::{CameraView, ImageTarget, Polarity, Target};
