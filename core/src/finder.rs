//! From several poses that fit alike to one: rivals are refined side by side, and one of them is chosen.

pub mod choice;
pub mod nearby;
pub mod rivals;
