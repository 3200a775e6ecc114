//! Why there is no outline.

use thiserror::Error;

use fluoropose::image::mask::MaskError;
use fluoropose::locate::LocateError;
use fluoropose::memory::TooLittleMemory;
use fluoropose::refine::RefineError;
use fluoropose::render::RenderError;

/// Why there is no outline.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum OneClickError {
    /// The click lies outside of the frame.
    #[error("the click lies outside of the frame; click inside the implant")]
    Outside,
    /// The part of the box inside the frame has no room for an implant.
    #[error(
        "the box is {width:.0} x {height:.0} pixels; draw one around the whole implant, at least {least:.0} pixels wide and high"
    )]
    SmallBox {
        /// Its columns.
        width: f64,
        /// Its rows.
        height: f64,
        /// The least number of either.
        least: f64,
    },
    /// No region at the prompt is set off from its surroundings.
    #[error(
        "nothing of an implant's size is set off from its surroundings there; click in the middle of the implant, or draw a box around it"
    )]
    NoRegion,
    /// The frame shows nothing at all.
    #[error("{}", fluoropose::image::blank::BLANK)]
    Blank,
    /// There is a region at the prompt, but it is not this component.
    #[error(
        "what is there does not look like this component from any view of its library; click in the middle of the implant, or trace it"
    )]
    NoFit,
    /// A borrowed slice is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// Frame, camera or masks differ in size.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The model cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The silhouette has no canonical form.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// The pose cannot be refined.
    #[error(transparent)]
    Refine(#[from] RefineError),
}
