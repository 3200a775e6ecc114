//! What was seen beside each piece of the model's outline at a pose: for who shows where a pose fits and where it does not.

use super::border::Residual;
use super::error::RefineError;
use super::fit::{Fit, MET_WITHIN_PX};
use super::memory::RefineMemory;
use super::result::Refined;
use super::uncertainty::observe;
use super::view::CameraView;
use crate::image::profile::NormalReading;
use crate::mesh::Model;
use crate::pose::Pose;

/// A piece of the model's outline within the frame, and what was seen beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineReading {
    /// The middle of the pixel in which the outline lies, continuous image coordinates, pixels.
    pub column: f64,
    /// Downwards.
    pub row: f64,
    /// Outward unit normal, to the right and downwards.
    pub normal: [f64; 2],
    /// Arc length of the outline that it stands for, pixels: where one pixel of several is read, theirs too.
    pub length: f64,
    /// How far beyond the model's outline what was seen has its own, pixels. Against a film that is known this is the distance from
    /// where that film would show the outline.
    pub seen: NormalReading,
}

impl OutlineReading {
    /// Whether the model's outline is met here; `None` where nothing can be told.
    #[must_use]
    pub fn is_met(&self) -> Option<bool> {
        match self.seen {
            NormalReading::At(px) => Some(px.abs() < MET_WITHIN_PX),
            NormalReading::Nothing => Some(false),
            NormalReading::Unknown => None,
        }
    }
}

/// Reads what a camera saw along the outline of `model` at `pose`, which need not be a refined one: as [`super::fit_at`], which
/// gives the sums of it. Pieces come in the order of their rows; against a film that is known, one pixel of several.
///
/// # Errors
/// [`RefineError`] as of [`super::refine`].
pub fn outline_readings(
    model: &Model<'_>,
    view: CameraView<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
    mut visit: impl FnMut(&OutlineReading),
) -> Result<Fit, RefineError> {
    observe(model, &[view], &Refined::at(*pose), memory, |looked| {
        for sample in looked.border {
            let seen = match sample.residual() {
                Residual::None => continue,
                Residual::Unknown => NormalReading::Unknown,
                Residual::Missing => NormalReading::Nothing,
                Residual::Px(px) => NormalReading::At(px.into()),
            };
            let [column, row] = sample.place();
            visit(&OutlineReading {
                column,
                row,
                normal: sample.normal().map(f64::from),
                length: sample.weight.into(),
                seen,
            });
        }
    })
}
