//! From what is seen to the poses that explain it, with the memory that the core borrows.

mod axes;
mod beside;
pub mod biplane;
mod build;
mod clicker;
mod film;
mod film_model;
mod film_squares;
mod filmed;
mod finder;
mod mask_offset;
pub mod misfits;
pub mod prompts;
mod refiner;
mod tools;
mod views;

pub use axes::{axes_of, say_axes};
pub use beside::{Beside, covered, hidden};
pub use build::{Built, build_library, build_views};
pub use clicker::{Clicked, Clicker, Neighbour};
pub use film::{FrameFound, find_poses, first_poses};
pub use film_model::{KnownFilm, bring_onto_frames};
pub use filmed::{Filmed, Stated, in_squares};
pub use finder::{EdgeOptions, Finder, Method, image};
pub use mask_offset::offset_words;
pub use refiner::Refiner;
pub use tools::{threshold_outline, wire_outline};
pub use views::ViewOptions;
