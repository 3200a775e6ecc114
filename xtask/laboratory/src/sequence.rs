//! From folders to what the method gets to see of each frame.

mod seen;
mod source;

pub use seen::Seen;
pub use source::{Folders, InMemory, Sequence, Source};
