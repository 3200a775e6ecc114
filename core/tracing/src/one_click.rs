//! One click inside an implant, or a rough box round it: a first outline and pose without tracing.
//!
//! Nothing is learned and nothing tuned to a film; three kinds of evidence are put together:
//!
//! 1. *Regions.* Metal is dark, so the threshold regions that hold the click are hypotheses: all
//!    of them come from one pass (`grow`), those with the sharpest borders are looked at (`tally`),
//!    and each once more with thin bridges to other dark things cut (`shape`).
//! 2. *Library.* The canonical form of each region is matched against the views
//!    ([`fluoropose::locate::whole`]), and the model drawn at the poses: what neither covers the region nor lies
//!    on edges is dropped.
//! 3. *Edges.* The best poses are brought onto the region's outline, which pulls from afar and
//!    forgives the parts of it that are wrong, and then onto the edges of the frame itself
//!    ([`fluoropose::refine`]), where the region no longer matters. What counts in the end is how much
//!    of the model's outline lies on edges of the right sign (`support`).
//!
//! The outline that comes out is the model's silhouette at the refined pose, or, without a
//! model, the region with the sharpest border. The work is done in steps, so that a page can show
//! progress and stop in between.

mod candidates;
mod expect;
mod eye;
mod grow;
mod job;
mod looks;
mod prompt;
mod rounds;
mod shape;
mod support;
mod tally;
mod window;

pub use candidates::{Answer, Start};
pub use job::{ANSWERS, OneClick, Progress, STARTS};
pub use support::Support;

use thiserror::Error;

use fluoropose::camera::Camera;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Grey;
use fluoropose::image::mask::{Mask, MaskError, Word, words_needed};
use fluoropose::library::Library;
use fluoropose::locate::{LocateError, Workspace};
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::SymmetryPlane;
use fluoropose::refine::{Polarity, RefineError, RefineMemory};
use fluoropose::render::RenderError;

/// What the person pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prompt {
    /// A place inside the implant.
    Click(Point),
    /// A rough box round it: its upper left and its lower right corner.
    Box(Point, Point),
}

/// The frame that is looked at.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The frame.
    pub frame: &'a dyn Grey,
    /// The camera that saw it.
    pub camera: &'a Camera,
    /// Whether metal is dark or bright.
    pub polarity: Polarity,
    /// Pixels that belong to something else, as to another component that is outlined already.
    pub excluded: Option<&'a Mask<'a>>,
}

impl core::fmt::Debug for Scene<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Scene")
            .field("size", &self.frame.size())
            .field("polarity", &self.polarity)
            .finish_non_exhaustive()
    }
}

/// The component that is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// Its library.
    pub library: &'a Library<'a>,
    /// Its model.
    pub model: &'a Model<'a>,
    /// The model's planes of near-symmetry ([`fluoropose::mesh::symmetry::symmetry_planes`]).
    pub planes: &'a [SymmetryPlane],
}

/// Why there is no outline.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum OneClickError {
    /// The prompt is not on the frame.
    #[error("the click lies outside of the frame; click inside the implant")]
    Outside,
    /// The box has no room for an implant.
    #[error(
        "the box is {width:.0} x {height:.0} pixels; draw one round the whole implant, at least {least:.0} pixels wide and high"
    )]
    SmallBox {
        /// Columns.
        width: f64,
        /// Rows.
        height: f64,
        /// Least of both.
        least: f64,
    },
    /// Nothing there is set off from its surroundings.
    #[error(
        "nothing of an implant's size is set off from its surroundings there; click in the middle of the implant, or draw a box round it"
    )]
    NoRegion,
    /// There is something, but not this component.
    #[error(
        "what is there does not look like this component from any view of its library; click in the middle of the implant, or trace it"
    )]
    NoFit,
    /// Lent memory has the wrong length.
    #[error("a first outline needs {needed} {what} but {given} were lent")]
    Memory {
        /// Which memory.
        what: &'static str,
        /// Length needed.
        needed: usize,
        /// Length lent.
        given: usize,
    },
    /// Frame, camera or masks differ in size.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The model cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The silhouette has no canonical form.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// Refinement is not possible.
    #[error(transparent)]
    Refine(#[from] RefineError),
}

/// Working memory of [`OneClick::step`]; the same from the first step to the last.
#[derive(Debug)]
pub struct OneClickMemory<'a> {
    /// Pixels of the window: see [`OneClick::needs`].
    pub grey: &'a mut [u16],
    /// As many.
    pub reached: &'a mut [u16],
    /// As many.
    pub distance: &'a mut [u16],
    /// As many.
    pub marks: &'a mut [u8],
    /// See [`OneClick::needs`].
    pub links: &'a mut [u32],
    /// See [`OneClick::needs`].
    pub tallies: &'a mut [u32],
    /// See [`OneClick::needs`]: masks of the frame.
    pub words: &'a mut [Word],
    /// As for [`fluoropose::locate::locate`]; empty without a library.
    pub workspace: Workspace<'a>,
    /// As for [`fluoropose::refine::refine`]; without a model nothing of it is used.
    pub refine: RefineMemory<'a>,
}

/// Lengths of an [`OneClickMemory`]'s own slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OneClickNeeds {
    /// Of `grey`, `reached`, `distance` and `marks` each.
    pub pixels: usize,
    /// Of `links`.
    pub links: usize,
    /// Of `tallies`.
    pub tallies: usize,
    /// Of `words`.
    pub words: usize,
}

impl OneClickNeeds {
    fn of(pixels: usize, camera: &Camera) -> Self {
        Self {
            pixels,
            links: grow::links_needed(pixels),
            tallies: tally::TALLIES,
            words: MASKS * words_needed(camera.width(), camera.height()),
        }
    }
}

/// Masks of the frame's size: the region and what is in doubt of it.
const MASKS: usize = 2;

impl OneClickMemory<'_> {
    /// The same memory for a smaller window.
    fn cut(&mut self, pixels: usize) -> OneClickMemory<'_> {
        fn head<T>(slice: &mut [T], length: usize) -> &mut [T] {
            let length = length.min(slice.len());
            slice.get_mut(..length).unwrap_or_default()
        }
        OneClickMemory {
            grey: head(self.grey, pixels),
            reached: head(self.reached, pixels),
            distance: head(self.distance, pixels),
            marks: head(self.marks, pixels),
            links: head(self.links, grow::links_needed(pixels)),
            tallies: &mut *self.tallies,
            words: &mut *self.words,
            workspace: self.workspace.reborrow(),
            refine: RefineMemory {
                projected: &mut *self.refine.projected,
                drawn: &mut *self.refine.drawn,
                places: &mut *self.refine.places,
                border: &mut *self.refine.border,
            },
        }
    }

    fn check(&self, needs: &OneClickNeeds) -> Result<(), OneClickError> {
        let lengths = [
            ("grey values", needs.pixels, self.grey.len()),
            ("thresholds", needs.pixels, self.reached.len()),
            ("distances", needs.pixels, self.distance.len()),
            ("marks", needs.pixels, self.marks.len()),
            ("links", needs.links, self.links.len()),
            ("tallies", needs.tallies, self.tallies.len()),
            ("words", needs.words, self.words.len()),
        ];
        let wrong = lengths
            .into_iter()
            .find(|(_, needed, given)| needed != given);
        match wrong {
            Some((what, needed, given)) => Err(OneClickError::Memory {
                what,
                needed,
                given,
            }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
