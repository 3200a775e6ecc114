//! The views of a library that differ from a silhouette in the fewest pixels: found exactly, while reading little of it.

mod catalogue;
mod exact;
#[cfg(test)]
pub(crate) mod exhaustive;
pub mod kernels;
mod query;
mod scores;

pub use catalogue::{
    Catalogue, CatalogueError, CatalogueMemory, CatalogueNeeds, Identified, Leaf, catalogue_needed,
    identify_bytes_needed,
};
pub use exact::*;
pub use query::{Query, query_bytes_needed};
pub use scores::{MatchError, Scores, ViewMatch, scores_needed};
