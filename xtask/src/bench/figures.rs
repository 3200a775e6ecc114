//! Figures of the page.

use serde::{Deserialize, Serialize};

/// Figures in the order in which they were taken.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Figures {
    /// One for each piece of work.
    pub rows: Vec<Row>,
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    /// What was measured, in words.
    pub work: String,
    /// How much.
    pub value: f64,
    /// Of what: "ms", "s", "bytes", "clicks".
    pub unit: String,
}
