//! The built-in implants: a femoral component and a tibial tray, made from numbers.
//!
//! # Axes
//!
//! Both parts use the axes of the field's implant files, so poses and kinematics carry over. For a **left** knee
//! `x` points to the front of the patient (anterior), `y` towards the head (proximal) and `z` to the patient's right,
//! which is medial. At rotation identity the camera, looking along `-z`, therefore has a lateral film before it. A
//! **right** part is the left one mirrored in `x`: there `x` points to the back, and `z` is medial again.
//!
//! # Origins
//!
//! Femur: on the axis of the posterior condyles' circular arcs, half-way between medial and lateral edge.
//! Tibia: half-way up the plate, on the axis of the stem, half-way between medial and lateral edge.
//!
//! # Size
//!
//! One anatomic dimension, the mediolateral width, scales everything; [`Size`] names the usual widths.
//!
//! The same parameters give the same bytes on every machine: transcendental functions come from `libm`, and nothing
//! depends on the order of a hash map or of threads.

mod arcs;
mod builder;
pub mod check;
mod femur;
mod femur_grid;
mod outline;
mod parameters;
mod peg;
mod rim;
mod section;
mod shape;
mod tibia;
mod triangles;

pub use parameters::{
    ImplantError, Parameters, RESOLUTION_RANGE, SIZES_MM, Side, Size, WIDTH_RANGE_MM,
};
pub use triangles::Triangles;

/// Makes the femoral component.
pub fn femur(parameters: &Parameters) -> Result<Triangles, ImplantError> {
    let resolution = parameters.checked_resolution()?;
    Ok(femur::build(resolution).finish(parameters.side, parameters.size))
}

/// Makes the tibial tray.
pub fn tibia(parameters: &Parameters) -> Result<Triangles, ImplantError> {
    let resolution = parameters.checked_resolution()?;
    Ok(tibia::build(resolution).finish(parameters.side, parameters.size))
}
