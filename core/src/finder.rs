//! Which of several poses: rivals refined side by side, and the choice between them.

pub mod choice;
pub mod nearby;
pub mod rivals;
