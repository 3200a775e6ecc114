//! Identification of an implant: one silhouette searched for in many libraries at once.
//!
//! Patches of neighbouring views are the leaves of a tree over all libraries. Each node has the
//! least and the most set pixels that any view below it has in each block, and the gap between
//! those and the silhouette's is a lower bound on the unmatched pixels of all of them. Similar implants lie in the
//! same nodes, so the search grows more slowly than the catalogue. It is exact: a node is left out only where its bound
//! exceeds what has been found.

mod build;
mod error;
mod identify;
#[cfg(test)]
mod tests;
mod tree;

pub use build::{CatalogueMemory, CatalogueNeeds, catalogue_needed};
pub use error::CatalogueError;
pub use identify::{Identified, identify_bytes_needed};
pub use tree::{Catalogue, Leaf};
