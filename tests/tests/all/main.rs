//! What crosses crates, in one program: it is linked once.

mod accuracy;
mod anatomy;
mod biplane;
mod calibration;
mod embedded;
mod flips;
mod following;
mod fuzz;
mod golden;
mod implant;
mod in_joint;
mod joint;
mod library;
mod made_implant;
mod mirrored;
mod mirrored_film;
mod nearby;
mod offset;
mod options;
mod parity;
mod partial;
mod readings;
mod sides;
mod slices;
mod symmetry;
mod track;
